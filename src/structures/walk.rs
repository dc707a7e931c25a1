//! Searches that are written once over lanes and run on the level in use.

use crate::accel::Observer;
use crate::geometry::{Hit, Ray};
use crate::simd::{Kernel, Level, Portable, Sieve, dispatch};

/// A structure whose search is written over lanes.
pub(super) trait Walk {
    /// The nearest hit, or with `ANY` some hit.
    fn walk<const ANY: bool, L: Sieve, O: Observer>(&self, ray: &Ray, observer: &mut O) -> Option<Hit>;
}

struct Single<'a, const ANY: bool, W, O> {
    structure: &'a W,
    ray: &'a Ray,
    observer: &'a mut O,
}

impl<const ANY: bool, W: Walk, O: Observer> Kernel for Single<'_, ANY, W, O> {
    type Output = Option<Hit>;

    #[inline(always)]
    fn run<L: Sieve>(self) -> Option<Hit> {
        self.structure.walk::<ANY, L, O>(self.ray, self.observer)
    }
}

/// One ray, on the level in use.
#[inline(always)]
pub(super) fn single<const ANY: bool, W: Walk, O: Observer>(structure: &W, ray: &Ray, observer: &mut O) -> Option<Hit> {
    if O::ACTIVE {
        // All levels take the same steps. Who counts does not hurry, and compiling is half the work.
        structure.walk::<ANY, Portable<8>, O>(ray, observer)
    } else {
        dispatch(Level::current(), Single::<ANY, W, O> { structure, ray, observer })
    }
}
