use glam::Vec3;

use crate::simd::{LaneVec3, Lanes, indexed};

/// The corners of `N` triangles in structure-of-arrays layout.
#[derive(Clone, Copy, Debug)]
#[repr(C)]
pub struct Corners<const N: usize>([[[f32; N]; 3]; 3]);

const _: () = assert!(size_of::<Corners<1>>() == 36);

impl<const N: usize> Corners<N> {
    /// Stores at most `N` triangles. All corners of unused lanes lie at the origin.
    ///
    /// # Panics
    /// If there are more than `N` triangles.
    pub fn new(triangles: &[[Vec3; 3]]) -> Self {
        assert!(triangles.len() <= N, "a block of {N} lanes cannot hold {} triangles", triangles.len());
        let mut block = Self([[[0.0; N]; 3]; 3]);
        for (lane, corners) in triangles.iter().enumerate() {
            for (slots, corner) in block.0.iter_mut().zip(corners) {
                for axis in 0..3 {
                    slots[axis][lane] = corner[axis];
                }
            }
        }
        block
    }

    #[inline(always)]
    pub(super) fn load<L: Lanes<N>>(&self) -> [LaneVec3<N, L>; 3] {
        let [a, b, c] = &self.0;
        [LaneVec3::load(a), LaneVec3::load(b), LaneVec3::load(c)]
    }

    #[inline(always)]
    pub(super) fn splat<const M: usize, L: Lanes<M>>(&self, lane: usize) -> [LaneVec3<M, L>; 3] {
        let [a, b, c] = &self.0;
        [LaneVec3::splat_lane(a, lane), LaneVec3::splat_lane(b, lane), LaneVec3::splat_lane(c, lane)]
    }

    #[inline(always)]
    pub(super) fn axis<L: Lanes<N>>(&self, axis: usize) -> [L; 3] {
        let [a, b, c] = &self.0;
        [L::load(&a[axis]), L::load(&b[axis]), L::load(&c[axis])]
    }

    #[inline(always)]
    pub(super) fn place(&self, lane: usize) -> LaneCorners<'_> {
        assert!(lane < N);
        LaneCorners { coordinates: self.0.as_flattened().as_flattened(), lane }
    }
}

/// One triangle of [`Corners`].
#[derive(Clone, Copy, Debug)]
pub struct LaneCorners<'a> {
    coordinates: &'a [f32],
    lane: usize,
}

impl LaneCorners<'_> {
    #[inline(always)]
    pub(super) fn coordinates(&self) -> [f32; 9] {
        let lanes = self.coordinates.len() / 9;
        debug_assert!(self.lane < lanes);
        // SAFETY: only `Corners::place` creates a `LaneCorners`. `place` has checked that `lane < lanes`. The
        // coordinates are nine rows of `lanes` floats.
        indexed(|row| unsafe { *self.coordinates.get_unchecked(row * lanes + self.lane) })
    }

    #[inline(always)]
    pub(super) fn corners(&self) -> [Vec3; 3] {
        let [ax, ay, az, bx, by, bz, cx, cy, cz] = self.coordinates();
        [Vec3::new(ax, ay, az), Vec3::new(bx, by, bz), Vec3::new(cx, cy, cz)]
    }
}
