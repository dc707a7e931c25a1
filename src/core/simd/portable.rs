use super::{Arithmetic, EightLanes, Lanes, each, indexed};

/// Lanes as an array, without vector instructions.
#[derive(Clone, Copy, Debug)]
pub struct Portable<const N: usize, S = f32>([S; N]);

macro_rules! lanewise {
    ($all:ident -> $result:ty; $($name:ident: $one:expr,)*) => {$(
        #[inline(always)]
        fn $name(self, other: Self) -> $result {
            self.$all(other, $one)
        }
    )*};
}

macro_rules! inlined {
    ($(fn $name:ident($($parameter:tt)*) -> $result:ty { $($body:tt)* })*) => {$(
        #[inline(always)]
        fn $name($($parameter)*) -> $result {
            $($body)*
        }
    )*};
}

macro_rules! arithmetic {
    ($scalar:ty, $sign:literal) => {
        impl<const N: usize> Portable<N, $scalar> {
            #[inline(always)]
            fn zip(self, other: Self, f: impl Fn($scalar, $scalar) -> $scalar) -> Self {
                Self(indexed(|i| f(self.0[i], other.0[i])))
            }

            #[inline(always)]
            fn bits(self, other: Self, f: impl Fn($scalar, $scalar) -> bool) -> u32 {
                (0..N).fold(0, |bits, i| bits | u32::from(f(self.0[i], other.0[i])) << i)
            }
        }

        impl<const N: usize> Arithmetic<N> for Portable<N, $scalar> {
            type Scalar = $scalar;

            inlined! {
                fn splat(value: $scalar) -> Self {
                    Self([value; N])
                }
                fn store(self) -> [$scalar; N] {
                    self.0
                }
                fn mul_add_loosely(self, factor: Self, term: Self) -> Self {
                    self.mul(factor).add(term)
                }
                fn mul_sub_loosely(self, factor: Self, term: Self) -> Self {
                    self.mul(factor).sub(term)
                }
            }

            lanewise! {
                zip -> Self;
                add: |a, b| a + b,
                sub: |a, b| a - b,
                mul: |a, b| a * b,
                div: |a, b| a / b,
                min: |a, b| if a < b { a } else { b },
                max: |a, b| if a > b { a } else { b },
                flip_sign: |a, b| <$scalar>::from_bits(a.to_bits() ^ (b.to_bits() & $sign)),
            }

            lanewise! {
                bits -> u32;
                le: |a, b| a <= b,
                lt: |a, b| a < b,
            }
        }
    };
}

arithmetic!(f32, 0x8000_0000);
arithmetic!(f64, 0x8000_0000_0000_0000);

impl<const N: usize> Lanes<N> for Portable<N> {
    type Double = Portable<N, f64>;

    inlined! {
        fn load(values: &[f32; N]) -> Self {
            Self(*values)
        }
        fn widen(self) -> Portable<N, f64> {
            Portable(each(&self.0, |&x| f64::from(x)))
        }
        fn narrow(wide: Portable<N, f64>) -> Self {
            Self(each(&wide.0, |&x| x as f32))
        }
    }
}

impl EightLanes for Portable<8> {
    type Mask = u32;
    type Numbers = [u32; 8];

    const FAST: bool = false;

    #[inline(always)]
    unsafe fn compress_ordered(
        self,
        limit: Self,
        values: &[u32; 8],
        order: u32,
        keys: *mut f32,
        chosen: *mut u32,
    ) -> u32 {
        let (mut set, mut count) = (0, 0);
        for at in 0..8 {
            let lane = (order >> (3 * at) & 7) as usize;
            if self.0[lane] <= limit.0[lane] {
                // SAFETY: by contract, `keys` and `chosen` are valid for writes of eight elements. `count` is below 8.
                unsafe {
                    keys.add(count).write(self.0[lane]);
                    chosen.add(count).write(values[lane]);
                }
                set |= 1 << at;
                count += 1;
            }
        }
        set
    }

    #[inline(always)]
    unsafe fn compress(self, limit: Self, values: &[u32; 8], chosen: *mut u32) -> u32 {
        let (mut set, mut count) = (0, 0);
        for (lane, &value) in values.iter().enumerate() {
            if self.0[lane] <= limit.0[lane] {
                // SAFETY: by contract, `chosen` is valid for writes of eight elements. `count` is below 8.
                unsafe { chosen.add(count).write(value) };
                set |= 1 << lane;
                count += 1;
            }
        }
        set
    }

    inlined! {
        fn transpose(rows: [Self; 8]) -> [Self; 8] {
            indexed(|i| Self(indexed(|j| rows[j].0[i])))
        }
        fn cmp_le(self, other: Self) -> u32 {
            self.le(other)
        }
        fn cmp_lt(self, other: Self) -> u32 {
            self.lt(other)
        }
        fn mask(bits: u32) -> u32 {
            bits
        }
        fn bits(mask: u32) -> u32 {
            mask
        }
        fn both(one: u32, other: u32) -> u32 {
            one & other
        }
        fn either(one: u32, other: u32) -> u32 {
            one | other
        }
        fn choose(self, other: Self, mask: u32) -> Self {
            Self(indexed(|i| if mask >> i & 1 == 1 { self.0[i] } else { other.0[i] }))
        }
        fn numbers(numbers: &[u32; 8]) -> [u32; 8] {
            *numbers
        }
        fn splat_number(number: u32) -> [u32; 8] {
            [number; 8]
        }
        fn store_numbers(numbers: [u32; 8]) -> [u32; 8] {
            numbers
        }
        fn cmp_le_numbers(one: [u32; 8], other: [u32; 8]) -> u32 {
            (0..8).fold(0, |bits, i| bits | u32::from(one[i] <= other[i]) << i)
        }
        fn choose_numbers(one: [u32; 8], other: [u32; 8], mask: u32) -> [u32; 8] {
            indexed(|i| if mask >> i & 1 == 1 { one[i] } else { other[i] })
        }
    }
}
