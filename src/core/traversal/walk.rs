//! Runs traversals, which are written once over SIMD lanes, on the current SIMD level.

use crate::accel::{Counts, Observer};
use crate::geometry::{Hit, Ray};
use crate::simd::{EightLanes, Kernel, Level, Portable, dispatch};

pub(crate) trait Walk {
    /// The nearest hit. With `ANY`, any hit; the returned `t` is only an upper bound of its exact `t`.
    fn walk<const ANY: bool, L: EightLanes, O: Observer>(&self, ray: &Ray, observer: &mut O) -> Option<Hit>;
}

struct Single<'a, const ANY: bool, W> {
    structure: &'a W,
    ray: &'a Ray,
}

impl<const ANY: bool, W: Walk> Kernel for Single<'_, ANY, W> {
    type Output = Option<Hit>;

    #[inline(always)]
    fn run<L: EightLanes>(self) -> Option<Hit> {
        silent::<ANY, L, W>(self.structure, self.ray)
    }
}

#[inline(always)]
pub(crate) fn silent<const ANY: bool, L: EightLanes, W: Walk>(structure: &W, ray: &Ray) -> Option<Hit> {
    if L::FAST {
        structure.walk::<ANY, L, ()>(ray, &mut ())
    } else {
        // Use the counting traversal, which is compiled anyway. Counting costs little on portable lanes.
        watched::<ANY, W, Counts>(structure, ray, &mut Counts::default())
    }
}

/// Traverses with an observer. Portable lanes give the same counts on every machine. Not inlined, to compile one copy.
#[inline(never)]
fn watched<const ANY: bool, W: Walk, O: Observer>(structure: &W, ray: &Ray, observer: &mut O) -> Option<Hit> {
    structure.walk::<ANY, Portable<8>, O>(ray, observer)
}

#[inline(always)]
pub(crate) fn single<const ANY: bool, W: Walk, O: Observer>(structure: &W, ray: &Ray, observer: &mut O) -> Option<Hit> {
    if O::ACTIVE {
        watched::<ANY, W, O>(structure, ray, observer)
    } else {
        dispatch(Level::current(), Single::<ANY, W> { structure, ray })
    }
}

/// The queries of an [`Accel`](crate::accel::Accel) that implements [`Walk`].
macro_rules! walked_queries {
    () => {
        #[inline]
        fn closest_hit<O: $crate::accel::Observer>(
            &self,
            ray: &$crate::geometry::Ray,
            observer: &mut O,
        ) -> Option<$crate::geometry::Hit> {
            $crate::traversal::walk::single::<false, _, O>(self, ray, observer)
        }

        #[inline]
        fn any_hit<O: $crate::accel::Observer>(&self, ray: &$crate::geometry::Ray, observer: &mut O) -> bool {
            $crate::traversal::walk::single::<true, _, O>(self, ray, observer).is_some()
        }
    };
}

pub(crate) use walked_queries;
