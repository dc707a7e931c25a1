use std::cmp::Ordering;
use std::marker::PhantomData;

use crate::geometry::Ray;
use crate::simd::{EightLanes, Kernel, Level, dispatch};

/// How many numbers [`Depth::inputs`] are. First come the coordinates of three corners; where the others begin, the constants beside this one tell.
pub const INPUTS: usize = 16;
/// The first coordinate of the origin among the inputs.
pub const ORIGIN: usize = 9;
/// That of the direction.
pub const DIRECTION: usize = 12;
/// How far apart the bounds of the `t` are.
pub const BETWEEN_BOUNDS: usize = 15;

/// Where along a ray a hit is, as exactly as its triangle test knows.
pub trait Depth: Copy {
    /// The order along the ray; nothing where it takes the ray to tell, see [`TriangleTest::order`](super::TriangleTest::order).
    fn order(&self, other: &Self) -> Option<Ordering>;

    /// The depth of a hit at `t`, if that is all there is to know of it.
    fn of(t: f32) -> Option<Self>;

    /// As reported, of a hit of `ray`: the nearest float.
    fn t(&self, ray: &Ray) -> f32;

    /// Whether `t` takes more than the depth, so that it pays to compute that of eight hits together. A test that says so writes
    /// [`inputs`](Self::inputs) and [`ts`](Self::ts) as well.
    const LATE: bool = false;

    /// What `ts` takes of a hit of `ray`: the corners of the triangle, the origin, the direction and the distance of its bounds.
    #[inline(always)]
    fn inputs(&self, _ray: &Ray) -> [f32; INPUTS] {
        unreachable!("a depth whose `t` is late has inputs")
    }

    /// The same bits as [`t`](Self::t), of those of eight hits that `which` names as bits, from their inputs.
    #[inline(always)]
    fn ts<L: EightLanes>(_inputs: &[[f32; 8]; INPUTS], _which: u32) -> [f32; 8] {
        unreachable!("a depth whose `t` is late computes those of eight hits")
    }

    /// A float that is not before the hit. What lies beyond it along the ray need not be looked at.
    fn bound(&self) -> f32;

    /// A float that is not behind it.
    fn least(&self) -> f32;
}

/// As [`Depth::ts`], on a level.
#[inline(always)]
pub(crate) fn last_bits<D: Depth>(level: Level, inputs: &[[f32; 8]; INPUTS], which: u32) -> [f32; 8] {
    dispatch(level, LastBits::<D> { inputs, which, depth: PhantomData })
}

/// The `t` of hits together: a kernel of its own, because it would cost the walk its registers.
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

/// What an `f32` test computes, which is never NaN.
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
