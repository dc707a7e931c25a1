//! The interface of all structures.

use std::borrow::Cow;
use std::fmt::Debug;
use std::sync::Arc;

use rayon::prelude::*;
use serde::Serialize;
use serde::de::DeserializeOwned;

use super::{Capabilities, Counts, Footprint, Loaded, Observed, Observer, Remote, TreeShape};
use crate::geometry::{Hit, Mesh, Ray};

/// The reason why a build failed.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum BuildError {
    /// A configuration value is out of range or has no effect. The message names the option and the allowed values.
    #[error("{0}")]
    Config(String),
    /// The structure cannot be built over this mesh.
    #[error("{0}")]
    Mesh(String),
    /// The system lacks a requirement of the structure. The message should state a remedy.
    #[error("{0}")]
    Unavailable(String),
    /// The external program of the structure failed. The message is a clause.
    #[error("{0}")]
    Remote(String),
    /// The rays need a feature that the structure does not support.
    #[error("declined: these rays need {0}, which the structure does not support")]
    Declined(&'static str),
    /// The code of the structure panicked.
    #[error("its builder panicked on this mesh: omit the structure, or check for extreme coordinates")]
    Panic,
}

/// An acceleration structure with two queries: closest hit and any hit.
///
/// A structure follows this contract:
///
/// 1. `closest_hit` returns the hit with the smallest `t` in [max(`t_min`, 0), `t_max`). Degenerate triangles have no
///    hits. The structure's triangle test defines `t`. A hit whose `t` rounds to infinity does not count. The returned
///    `t` may equal `t_max` after rounding.
/// 2. If several triangles are hit at the smallest `t`, `closest_hit` may return any of these triangles. Outside the
///    module `external`, the structures of this crate return the triangle with the lowest index.
/// 3. `any_hit(ray) == closest_hit(ray).is_some()`.
/// 4. Results depend only on the mesh, the configuration and the ray.
/// 5. `build` accepts the empty mesh.
///
/// An invalid ray hits nothing ([`Ray::is_valid`]).
#[diagnostic::on_unimplemented(
    message = "`{Self}` is not an acceleration structure",
    label = "does not implement `Accel` (`sahara_core::accel::Accel`)",
    note = "implement `Accel` for `{Self}`: the front page of sahara's documentation walks through an example"
)]
pub trait Accel: Sized + Send + Sync + 'static {
    /// Build parameters. The names of the serialised fields are keys on the command line and in exports.
    type Config: Clone + Debug + Default + Serialize + DeserializeOwned + Send + Sync + 'static;

    /// Name of the triangle test. Structures that share a triangle test return bit-identical `t`. The name `"own"`
    /// means that the triangle test is not shared.
    const TRIANGLE_TEST: &'static str = "own";

    /// Deliberate deviations from the contract, one clause each. Do not list defects. Deviations that change hits also
    /// belong in [`CAPABILITIES`](Accel::CAPABILITIES). Otherwise they count as errors.
    const CONVENTIONS: &'static [&'static str] = &[];

    /// The events that the structure reports to the observer.
    const OBSERVED: Observed = Observed::ALL;

    /// The features that the structure supports.
    const CAPABILITIES: Capabilities = Capabilities::ALL;

    /// Builds the structure over a mesh.
    ///
    /// # Errors
    /// If a value of `config` is out of range, or for another reason in [`BuildError`].
    fn build(mesh: &Arc<Mesh>, config: &Self::Config) -> Result<Self, BuildError>;

    /// The nearest hit of `ray`.
    fn closest_hit<O: Observer>(&self, ray: &Ray, observer: &mut O) -> Option<Hit>;

    /// Whether `ray` hits anything.
    ///
    /// The default implementation calls `closest_hit`. If [`Capabilities::t_max`] is `false`, the default
    /// implementation ignores a hit at or beyond `t_max`. A structure with the default implementation should set
    /// [`Capabilities::any_hit`] to `false`. Otherwise, closest-hit times are reported as any-hit times.
    #[inline]
    fn any_hit<O: Observer>(&self, ray: &Ray, observer: &mut O) -> bool {
        let may_be_beyond = !Self::CAPABILITIES.t_max;
        self.closest_hit(ray, observer).is_some_and(|hit| !may_be_beyond || hit.t < ray.t_max)
    }

    /// The nearest hits of a batch.
    ///
    /// # Panics
    /// If the slices differ in length.
    #[inline]
    fn closest_hits<O: Observer>(&self, rays: &[Ray], hits: &mut [Option<Hit>], observer: &mut O) {
        assert_eq!(rays.len(), hits.len(), "one result per ray");
        for (ray, hit) in rays.iter().zip(hits) {
            *hit = self.closest_hit(ray, observer);
        }
    }

    /// Whether each ray of a batch hits anything.
    ///
    /// # Panics
    /// If the slices differ in length.
    #[inline]
    fn any_hits<O: Observer>(&self, rays: &[Ray], hits: &mut [bool], observer: &mut O) {
        assert_eq!(rays.len(), hits.len(), "one result per ray");
        for (ray, hit) in rays.iter().zip(hits) {
            *hit = self.any_hit(ray, observer);
        }
    }

    /// Loads a batch of rays for many queries. The time of `load` is not measured.
    ///
    /// For example, an adapter may convert the rays to the ray type of a library. The loaded data must not depend on
    /// the tree.
    fn load<'a>(&'a self, rays: Cow<'a, [Ray]>) -> Box<dyn Loaded + 'a> {
        Box::new(RayBatch { accel: self, rays })
    }

    /// The memory of the finished structure.
    fn footprint(&self) -> Footprint;

    /// The shape of the tree.
    fn shape(&self) -> TreeShape;
}

/// Type-erased [`Accel`], with one virtual call per batch.
pub trait DynAccel: Send + Sync {
    /// [`Accel::closest_hits`] without an observer.
    fn closest_hits(&self, rays: &[Ray], hits: &mut [Option<Hit>]);
    /// [`Accel::any_hits`] without an observer.
    fn any_hits(&self, rays: &[Ray], hits: &mut [bool]);
    /// The closest hit of each ray.
    fn closest(&self, rays: &[Ray]) -> Vec<Option<Hit>> {
        let mut hits = vec![None; rays.len()];
        self.closest_hits(rays, &mut hits);
        hits
    }
    /// Whether each ray hits anything.
    fn any(&self, rays: &[Ray]) -> Vec<bool> {
        let mut hits = vec![false; rays.len()];
        self.any_hits(rays, &mut hits);
        hits
    }
    /// Runs `closest_hits`. Adds the steps and triangle tests to `counts`.
    fn closest_hits_counted(&self, rays: &[Ray], hits: &mut [Option<Hit>], counts: &mut Counts);
    /// Runs `any_hits`. Adds the steps and triangle tests to `counts`.
    fn any_hits_counted(&self, rays: &[Ray], hits: &mut [bool], counts: &mut Counts);
    /// See [`Accel::load`].
    fn load<'a>(&'a self, rays: Cow<'a, [Ray]>) -> Box<dyn Loaded + 'a> {
        Box::new(RayBatch { accel: self, rays })
    }
    /// See [`Accel::OBSERVED`].
    fn observed(&self) -> Observed;
    /// See [`Accel::CAPABILITIES`].
    fn capabilities(&self) -> Capabilities {
        Capabilities::ALL
    }
    /// See [`Accel::footprint`].
    fn footprint(&self) -> Footprint;
    /// See [`Accel::shape`].
    fn shape(&self) -> TreeShape;
    /// The [`Remote`] interface of a structure in another process.
    fn remote(&self) -> Option<&dyn Remote> {
        None
    }
}

// An inherent method is compiled once. A trait method would be compiled once per structure.
impl dyn DynAccel + '_ {
    /// The closest hit of each ray. The threads of the current rayon pool trace chunks of `chunk` rays.
    pub fn closest_by_chunks(&self, rays: &[Ray], chunk: usize) -> Vec<Option<Hit>> {
        let mut hits = vec![None; rays.len()];
        let chunks = rays.par_chunks(chunk).zip(hits.par_chunks_mut(chunk));
        chunks.for_each(|(rays, hits)| self.closest_hits(rays, hits));
        hits
    }
}

impl<A: Accel> DynAccel for A {
    fn closest_hits(&self, rays: &[Ray], hits: &mut [Option<Hit>]) {
        Accel::closest_hits(self, rays, hits, &mut ());
    }

    fn any_hits(&self, rays: &[Ray], hits: &mut [bool]) {
        Accel::any_hits(self, rays, hits, &mut ());
    }

    fn closest_hits_counted(&self, rays: &[Ray], hits: &mut [Option<Hit>], counts: &mut Counts) {
        Accel::closest_hits(self, rays, hits, counts);
    }

    fn any_hits_counted(&self, rays: &[Ray], hits: &mut [bool], counts: &mut Counts) {
        Accel::any_hits(self, rays, hits, counts);
    }

    fn load<'a>(&'a self, rays: Cow<'a, [Ray]>) -> Box<dyn Loaded + 'a> {
        Accel::load(self, rays)
    }

    fn observed(&self) -> Observed {
        A::OBSERVED
    }

    fn capabilities(&self) -> Capabilities {
        A::CAPABILITIES
    }

    fn footprint(&self) -> Footprint {
        Accel::footprint(self)
    }

    fn shape(&self) -> TreeShape {
        Accel::shape(self)
    }
}

struct RayBatch<'a, A: ?Sized> {
    accel: &'a A,
    rays: Cow<'a, [Ray]>,
}

impl<A: DynAccel + ?Sized> Loaded for RayBatch<'_, A> {
    fn closest_hits(&self, hits: &mut [Option<Hit>]) {
        self.accel.closest_hits(&self.rays, hits);
    }

    fn any_hits(&self, hits: &mut [bool]) {
        self.accel.any_hits(&self.rays, hits);
    }
}

#[cfg(test)]
mod tests {
    use glam::Vec3;

    use super::*;

    struct AtOne<const ENDS: bool>;

    impl<const ENDS: bool> Accel for AtOne<ENDS> {
        type Config = ();

        const CAPABILITIES: Capabilities = Capabilities { t_max: ENDS, ..Capabilities::ALL };

        fn build(_: &Arc<Mesh>, (): &()) -> Result<Self, BuildError> {
            Ok(Self)
        }

        fn closest_hit<O: Observer>(&self, _: &Ray, _: &mut O) -> Option<Hit> {
            Some(Hit::new(1.0, 0))
        }

        fn footprint(&self) -> Footprint {
            Footprint::default()
        }

        fn shape(&self) -> TreeShape {
            TreeShape::default()
        }
    }

    #[test]
    fn the_default_any_hit_follows_from_the_closest_hit() {
        let until = |t_max| Ray::new(Vec3::ZERO, Vec3::X).until(t_max);
        // An exact `t` below `t_max` may round to `t_max`.
        assert!(AtOne::<true>.any_hit(&until(1.0), &mut ()));
        assert!(!AtOne::<false>.any_hit(&until(1.0), &mut ()) && AtOne::<false>.any_hit(&until(1.5), &mut ()));
    }
}
