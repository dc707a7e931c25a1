//! Rays in the format of a structure that traces them one by one, converted before the clock starts.

use crate::accel::{Accel, Loaded, Observer};
use crate::geometry::{Hit, Ray};

/// A structure whose queries take a ray in its own format.
pub(crate) trait Prepare: Accel {
    /// A ray in the structure's format. It does not depend on the tree.
    type Ready: Send + Sync;

    /// Converts a ray. Returns `None` if the ray can hit nothing.
    fn ready(&self, ray: &Ray) -> Option<Self::Ready>;

    fn closest<O: Observer>(&self, ready: &Self::Ready, observer: &mut O) -> Option<Hit>;

    fn any<O: Observer>(&self, ready: &Self::Ready, observer: &mut O) -> bool;
}

/// The queries of an [`Accel`] that implements [`Prepare`].
macro_rules! prepared_queries {
    () => {
        #[inline]
        fn closest_hit<O: $crate::accel::Observer>(
            &self,
            ray: &$crate::geometry::Ray,
            observer: &mut O,
        ) -> Option<$crate::geometry::Hit> {
            self.closest(&self.ready(ray)?, observer)
        }

        #[inline]
        fn any_hit<O: $crate::accel::Observer>(&self, ray: &$crate::geometry::Ray, observer: &mut O) -> bool {
            self.ready(ray).is_some_and(|ready| self.any(&ready, observer))
        }

        fn load<'a>(
            &'a self,
            rays: std::borrow::Cow<'a, [$crate::geometry::Ray]>,
        ) -> Box<dyn $crate::accel::Loaded + 'a> {
            $crate::external::prepared::load(self, &rays)
        }
    };
}

pub(crate) use prepared_queries;

/// [`Accel::load`] of a structure that implements [`Prepare`].
pub(crate) fn load<'a, S: Prepare>(structure: &'a S, rays: &[Ray]) -> Box<dyn Loaded + 'a> {
    Box::new(PreparedBatch { structure, rays: rays.iter().map(|ray| structure.ready(ray)).collect() })
}

/// A batch of prepared rays; `None` for rays that can hit nothing.
struct PreparedBatch<'a, S: Prepare> {
    structure: &'a S,
    rays: Vec<Option<S::Ready>>,
}

impl<S: Prepare> Loaded for PreparedBatch<'_, S> {
    fn closest_hits(&self, hits: &mut [Option<Hit>]) {
        assert_eq!(self.rays.len(), hits.len(), "one result per ray");
        for (ray, hit) in self.rays.iter().zip(hits) {
            *hit = ray.as_ref().and_then(|ray| self.structure.closest(ray, &mut ()));
        }
    }

    fn any_hits(&self, hits: &mut [bool]) {
        assert_eq!(self.rays.len(), hits.len(), "one result per ray");
        for (ray, hit) in self.rays.iter().zip(hits) {
            *hit = ray.as_ref().is_some_and(|ray| self.structure.any(ray, &mut ()));
        }
    }
}
