use std::cmp::Ordering;
use std::marker::PhantomData;

use crate::geometry::Ray;
use crate::simd::{EightLanes, Kernel, Level, dispatch};

/// The length of [`Depth::inputs`]. The first nine inputs are the coordinates of the corners.
pub const INPUTS: usize = 16;
/// The index of the origin's first coordinate in [`Depth::inputs`].
pub const ORIGIN: usize = 9;
/// The index of the direction's first coordinate in [`Depth::inputs`].
pub const DIRECTION: usize = 12;
/// The index in [`Depth::inputs`] of the difference between an upper and a lower bound of `t`.
pub const BETWEEN_BOUNDS: usize = 15;

/// The position of a hit along its ray, in the precision of the triangle test.
pub trait Depth: Copy {
    /// The order of two hits along the same ray. If `None`, [`order_closely`](super::TriangleTest::order_closely) must
    /// decide.
    fn order(&self, other: &Self) -> Option<Ordering>;

    /// The depth of a hit at `t`, or `None` if depths of this type contain more than `t`.
    fn of(t: f32) -> Option<Self>;

    /// The `t` of the hit, rounded to `f32`. `ray` must be the ray of the hit.
    fn t(&self, ray: &Ray) -> f32;

    /// Whether the depth stores bounds of `t` instead of `t`. If true, the type must implement
    /// [`inputs`](Self::inputs) and [`ts`](Self::ts).
    const LATE: bool = false;

    /// The inputs of [`ts`](Self::ts) for a hit of `ray`.
    #[inline(always)]
    fn inputs(&self, _ray: &Ray) -> [f32; INPUTS] {
        unreachable!("a depth with `LATE` implements `inputs`")
    }

    /// Computes [`t`](Self::t) for up to eight hits, one per lane of `inputs`. Bit `i` of `which` is set if lane `i`
    /// has a hit.
    #[inline(always)]
    fn ts<L: EightLanes>(_inputs: &[[f32; 8]; INPUTS], _which: u32) -> [f32; 8] {
        unreachable!("a depth with `LATE` implements `ts`")
    }

    /// An upper bound of `t`.
    fn bound(&self) -> f32;

    /// A lower bound of `t`.
    fn least(&self) -> f32;
}

#[inline(always)]
pub(crate) fn last_bits<D: Depth>(level: Level, inputs: &[[f32; 8]; INPUTS], which: u32) -> [f32; 8] {
    dispatch(level, LastBits::<D> { inputs, which, depth: PhantomData })
}

struct LastBits<'a, D> {
    inputs: &'a [[f32; 8]; INPUTS],
    which: u32,
    depth: PhantomData<D>,
}

impl<D: Depth> Kernel for LastBits<'_, D> {
    type Output = [f32; 8];

    #[inline(always)]
    fn run<L: EightLanes>(self) -> [f32; 8] {
        D::ts::<L>(self.inputs, self.which)
    }
}

/// No hit has a NaN `t`, so `order` never returns `None`.
impl Depth for f32 {
    #[inline(always)]
    fn of(t: f32) -> Option<f32> {
        Some(t)
    }

    #[inline(always)]
    fn order(&self, other: &Self) -> Option<Ordering> {
        self.partial_cmp(other)
    }

    #[inline(always)]
    fn t(&self, _: &Ray) -> f32 {
        *self
    }

    #[inline(always)]
    fn bound(&self) -> f32 {
        *self
    }

    #[inline(always)]
    fn least(&self) -> f32 {
        *self
    }
}
