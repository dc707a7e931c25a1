/// Defines common items of triangle tests whose first stage decides all hits.
macro_rules! decided_at_once {
    () => {
        type First<const N: usize, L: $crate::simd::Lanes<N>> = L;
        type Values<const N: usize> = [f32; N];
        type Depth<'a> = f32;

        #[inline(always)]
        fn values<const N: usize, L: $crate::simd::Lanes<N>>(t: L) -> [f32; N] {
            t.store()
        }

        #[inline(always)]
        fn decide<const N: usize>(_: &Self::Ray, _: &Self::Block<N>, lane: usize, t: &[f32; N]) -> Option<f32> {
            Some(t[lane])
        }
    };
}

macro_rules! decided_on_rays {
    () => {
        type Ray = (glam::Vec3, glam::Vec3);

        decided_at_once!();

        #[inline(always)]
        fn prepare(ray: &$crate::geometry::Ray) -> Self::Ray {
            (ray.origin, ray.direction)
        }
    };
}

macro_rules! decided_on_corners {
    () => {
        type Block<const N: usize> = $crate::triangle::Corners<N>;

        decided_on_rays!();

        fn block<const N: usize>(triangles: &[[glam::Vec3; 3]]) -> Self::Block<N> {
            $crate::triangle::Corners::new(triangles)
        }
    };
}

/// `$solve` returns a bit mask of the triangles that the line hits, and `t` for all triangles.
macro_rules! decided_in_f64 {
    ($solve:ident) => {
        decided_on_corners!();

        #[inline(always)]
        fn candidates<const N: usize, L: $crate::simd::Lanes<N>>(
            &(origin, direction): &Self::Ray,
            block: &Self::Block<N>,
            from: f32,
            to: f32,
        ) -> (u32, L) {
            let wide = |v| $crate::simd::LaneVec3::<N, L>::splat(v).widen();
            let corners = $crate::simd::each(&block.load::<L>(), |corner| corner.widen());
            let (inside, t) = $solve(wide(origin), wide(direction), corners);
            // `from` is compared with the unrounded `t`. Rounding may turn a small negative `t` into zero.
            let inside = inside & L::splat(from).widen().le(t);
            let t = L::narrow(t);
            (inside & t.le(L::splat(to)), t)
        }
    };
}

#[cfg(feature = "suite")]
pub(crate) use decided_at_once;
