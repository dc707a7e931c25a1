//! Runs traversals at the current SIMD level.

use crate::accel::{Counts, Observer};
use crate::geometry::{Hit, Ray};
use crate::simd::{EightLanes, Kernel, Level, Portable, dispatch};

pub(crate) trait Walk {
    /// If `ANY` is false, returns the nearest hit. If `ANY` is true, returns any hit. With `ANY`, the `t` of the hit is
    /// [`Depth::bound`](crate::triangle::Depth::bound).
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
        walk_without_observer::<ANY, L, W>(self.structure, self.ray)
    }
}

#[inline(always)]
pub(crate) fn walk_without_observer<const ANY: bool, L: EightLanes, W: Walk>(structure: &W, ray: &Ray) -> Option<Hit> {
    if L::FAST {
        structure.walk::<ANY, L, ()>(ray, &mut ())
    } else {
        // The traversal with `Counts` is reused to avoid compiling a second copy.
        walk_with_observer::<ANY, W, Counts>(structure, ray, &mut Counts::default())
    }
}

/// Portable lanes give the same counts on every machine. Not inlined, to compile one copy.
#[inline(never)]
fn walk_with_observer<const ANY: bool, W: Walk, O: Observer>(
    structure: &W,
    ray: &Ray,
    observer: &mut O,
) -> Option<Hit> {
    structure.walk::<ANY, Portable<8>, O>(ray, observer)
}

#[inline(always)]
pub(crate) fn single<const ANY: bool, W: Walk, O: Observer>(structure: &W, ray: &Ray, observer: &mut O) -> Option<Hit> {
    if O::ACTIVE {
        walk_with_observer::<ANY, W, O>(structure, ray, observer)
    } else {
        dispatch(Level::current(), Single::<ANY, W> { structure, ray })
    }
}

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
