use std::cmp::Ordering;
use std::marker::PhantomData;

use crate::geometry::Ray;
use crate::simd::{EightLanes, Kernel, Level, dispatch};

/// The length of [`Depth::inputs`]: corners, origin, direction, and the distance between the bounds of `t`.
pub const INPUTS: usize = 16;
/// The index of the origin's first coordinate in [`Depth::inputs`].
pub const ORIGIN: usize = 9;
/// The index of the direction's first coordinate in [`Depth::inputs`].
pub const DIRECTION: usize = 12;
/// The index of the distance between the bounds of `t` in [`Depth::inputs`].
pub const BETWEEN_BOUNDS: usize = 15;

/// The position of a hit along its ray, as exactly as the triangle test knows it.
pub trait Depth: Copy {
    /// The order along the ray, or `None` if it depends on data of the ray. Then
    /// [`TriangleTest::order`](super::TriangleTest::order) decides.
    fn order(&self, other: &Self) -> Option<Ordering>;

    /// The depth of a hit at `t`, or `None` if depths of this type contain more than `t`.
    fn of(t: f32) -> Option<Self>;

    /// The `t` to return for a hit of `ray`: the float nearest to the depth.
    fn t(&self, ray: &Ray) -> f32;

    /// Whether [`t`](Self::t) takes a further computation, which [`ts`](Self::ts) does faster for eight hits at once.
    const LATE: bool = false;

    /// The inputs of `ts` for a hit of `ray`: corners, origin, direction, and the distance between the bounds.
    #[inline(always)]
    fn inputs(&self, _ray: &Ray) -> [f32; INPUTS] {
        unreachable!("a depth with `LATE` implements `inputs`")
    }

    /// The [`t`](Self::t) of hits, from their [`inputs`](Self::inputs). `which`: the lanes that have a hit, as bits.
    #[inline(always)]
    fn ts<L: EightLanes>(_inputs: &[[f32; 8]; INPUTS], _which: u32) -> [f32; 8] {
        unreachable!("a depth with `LATE` implements `ts`")
    }

    /// An upper bound of `t`, as a float. A traversal can skip everything beyond it.
    fn bound(&self) -> f32;

    /// A lower bound of `t`, as a float.
    fn least(&self) -> f32;
}

#[inline(always)]
pub(crate) fn last_bits<D: Depth>(level: Level, inputs: &[[f32; 8]; INPUTS], which: u32) -> [f32; 8] {
    dispatch(level, LastBits::<D> { inputs, which, depth: PhantomData })
}

/// Runs [`Depth::ts`] as a separate kernel. Inlined, it would take registers from the traversal.
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

/// The depth of tests that compute `t` as a float. It is never NaN.
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
