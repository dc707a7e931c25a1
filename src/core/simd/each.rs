use std::mem::MaybeUninit;

/// Like `array::from_fn`, but always inlined.
///
/// Only inlined functions are compiled with the instructions of a SIMD [`Level`](super::Level).
#[inline(always)]
pub fn indexed<const N: usize, B: Copy>(f: impl Fn(usize) -> B) -> [B; N] {
    let mut results = [const { MaybeUninit::uninit() }; N];
    for (i, result) in results.iter_mut().enumerate() {
        result.write(f(i));
    }
    // SAFETY: the loop has written all results. `[MaybeUninit<B>; N]` has the layout of `[B; N]`.
    unsafe { std::ptr::from_ref(&results).cast::<[B; N]>().read() }
}

/// Like `array::map`, but always inlined.
#[inline(always)]
pub fn each<const N: usize, A, B: Copy>(values: &[A; N], f: impl Fn(&A) -> B) -> [B; N] {
    indexed(|i| f(&values[i]))
}
