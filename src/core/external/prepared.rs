//! Converts a batch of rays to the format of a structure before the batch is traced.

use crate::accel::{Accel, Loaded, Observer};
use crate::geometry::{Hit, Ray};

pub(crate) trait Prepare: Accel {
    type Ready: Send + Sync;

    /// Returns `None` if the structure reports a miss without tracing the ray.
    fn ready(&self, ray: &Ray) -> Option<Self::Ready>;

    fn closest<O: Observer>(&self, ready: &Self::Ready, observer: &mut O) -> Option<Hit>;

    fn any<O: Observer>(&self, ready: &Self::Ready, observer: &mut O) -> bool;
}

/// Implements the query methods of [`Accel`] with the methods of [`Prepare`].
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

pub(crate) fn load<'a, S: Prepare>(structure: &'a S, rays: &[Ray]) -> Box<dyn Loaded + 'a> {
    Box::new(PreparedBatch { structure, rays: rays.iter().map(|ray| structure.ready(ray)).collect() })
}

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
