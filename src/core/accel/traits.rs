//! The one interface of all structures.

use std::borrow::Cow;
use std::fmt::Debug;
use std::sync::Arc;

use rayon::prelude::*;
use serde::Serialize;
use serde::de::DeserializeOwned;

use super::{Capabilities, Counts, Footprint, Loaded, Observed, Observer, Remote, TreeShape};
use crate::geometry::{Hit, Mesh, Ray};

/// Why a structure could not be built.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum BuildError {
    /// A value of the configuration is out of range; the sentence says which, and what is allowed.
    #[error("{0}")]
    Config(String),
    /// The structure's limits do not admit the mesh; the sentence says why.
    #[error("{0}")]
    Mesh(String),
    /// What the structure needs of the system is not there; the sentence says what, and how to get it.
    #[error("{0}")]
    Unavailable(String),
    /// The program that it runs in failed; the clause says how.
    #[error("{0}")]
    Remote(String),
    /// The rays need what the structure declines.
    #[error("declined: it has no {0}, which these rays need")]
    Declined(&'static str),
    /// The structure's own code panicked.
    #[error("its builder panicked on this mesh: omit the structure, or check for extreme coordinates")]
    Panic,
}

/// An acceleration structure, with two queries: closest hit and any hit.
///
/// The contract, held by the conformance suite:
/// 1. `closest_hit` gives the least `t` in [`t_min`, `t_max`) as the structure's triangle test computes it, over all
///    triangles of the mesh that are not degenerate; a `t` that rounds to no finite `f32` is no hit, also where
///    `t_max` is infinite; the exact `t` of a test may be rounded to `t_max` when it is returned;
/// 2. among equal `t` any primitive (the structures of this crate give the lowest number);
/// 3. `any_hit(ray) == closest_hit(ray).is_some()`;
/// 4. answers depend on nothing but the mesh, the configuration and the ray;
/// 5. every mesh that [`Mesh`] admits builds, the empty one included.
///
/// A ray for which [`Ray::is_valid`] is false hits nothing. What a structure cannot do it declines, by
/// [`CAPABILITIES`](Accel::CAPABILITIES), [`OBSERVED`](Accel::OBSERVED) and [`TRIANGLE_TEST`](Accel::TRIANGLE_TEST).
#[diagnostic::on_unimplemented(
    message = "`{Self}` is not an acceleration structure",
    label = "does not implement `sahara::accel::Accel`",
    note = "implement `sahara::accel::Accel` for `{Self}`: the front page of sahara's documentation walks through an example"
)]
pub trait Accel: Sized + Send + Sync + 'static {
    /// Build parameters. Serialisation gives them names: the command line sets them as `key=value`, and exports show
    /// them.
    type Config: Clone + Debug + Default + Serialize + DeserializeOwned + Send + Sync + 'static;

    /// Name of the triangle test whose results the structure returns: those with the same test must agree bit for bit
    /// in `t`. A structure with a test that nobody shares keeps `"own"`.
    const TRIANGLE_TEST: &'static str = "own";

    /// What it does otherwise by design, one clause each, for people to read. What of it changes answers belongs into
    /// [`CAPABILITIES`](Accel::CAPABILITIES): that is not counted as errors; what is a defect belongs into neither.
    const CONVENTIONS: &'static [&'static str] = &[];

    /// The events that the observer receives.
    const OBSERVED: Observed = Observed::ALL;

    /// What queries the structure supports. By default all.
    const CAPABILITIES: Capabilities = Capabilities::ALL;

    /// # Errors
    /// If a value of `config` is out of range.
    fn build(mesh: &Arc<Mesh>, config: &Self::Config) -> Result<Self, BuildError>;

    /// The nearest hit of `ray`.
    fn closest_hit<O: Observer>(&self, ray: &Ray, observer: &mut O) -> Option<Hit>;

    /// Whether `ray` hits anything.
    ///
    /// By default whether there is a closest hit; of a structure that declines [`Capabilities::t_max`], whether that
    /// lies before `t_max`, as far as its rounded `t` tells. A structure that leaves it so should decline
    /// [`Capabilities::any_hit`], so that nobody takes its time for that of an any-hit query.
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
        assert_eq!(rays.len(), hits.len(), "one answer a ray");
        for (ray, hit) in rays.iter().zip(hits) {
            *hit = self.closest_hit(ray, observer);
        }
    }

    /// For each ray of a batch, whether it hits anything.
    ///
    /// # Panics
    /// If the slices differ in length.
    #[inline]
    fn any_hits<O: Observer>(&self, rays: &[Ray], hits: &mut [bool], observer: &mut O) {
        assert_eq!(rays.len(), hits.len(), "one answer a ray");
        for (ray, hit) in rays.iter().zip(hits) {
            *hit = self.any_hit(ray, observer);
        }
    }

    /// Takes a batch of rays that is traced many times. This is done before the clock starts, so it is not timed.
    ///
    /// By default the rays stay as they are, and whatever a query prepares of a ray counts as its time: right for every
    /// structure that is asked with a [`Ray`], as all of this crate are; there is nothing to do then. An adapter to a
    /// library with a ray of its own converts the rays here, once, so that the library is timed and not the conversion.
    /// Only what follows from the rays alone may be done here: no walk, no answers.
    fn load<'a>(&'a self, rays: Cow<'a, [Ray]>) -> Box<dyn Loaded + 'a> {
        Box::new(RayBatch { accel: self, rays })
    }

    /// Bytes that the finished structure takes.
    fn footprint(&self) -> Footprint;

    /// What its tree looks like.
    fn shape(&self) -> TreeShape;
}

/// [`Accel`] without its type: one virtual call hands over a batch, inside everything is monomorphised.
pub trait DynAccel: Send + Sync {
    /// As [`Accel::closest_hits`], unobserved.
    fn closest_hits(&self, rays: &[Ray], hits: &mut [Option<Hit>]);
    /// As [`Accel::any_hits`], unobserved.
    fn any_hits(&self, rays: &[Ray], hits: &mut [bool]);
    /// The closest hit of each ray.
    fn closest(&self, rays: &[Ray]) -> Vec<Option<Hit>> {
        let mut hits = vec![None; rays.len()];
        self.closest_hits(rays, &mut hits);
        hits
    }
    /// Of each ray, whether it hits anything.
    fn any(&self, rays: &[Ray]) -> Vec<bool> {
        let mut hits = vec![false; rays.len()];
        self.any_hits(rays, &mut hits);
        hits
    }
    /// As `closest_hits`, adding to `counts` what was done.
    fn closest_hits_counted(&self, rays: &[Ray], hits: &mut [Option<Hit>], counts: &mut Counts);
    /// As `any_hits`, adding to `counts` what was done.
    fn any_hits_counted(&self, rays: &[Ray], hits: &mut [bool], counts: &mut Counts);
    /// As [`Accel::load`].
    fn load<'a>(&'a self, rays: Cow<'a, [Ray]>) -> Box<dyn Loaded + 'a> {
        Box::new(RayBatch { accel: self, rays })
    }
    /// [`Accel::OBSERVED`].
    fn observed(&self) -> Observed;
    /// [`Accel::CAPABILITIES`].
    fn capabilities(&self) -> Capabilities {
        Capabilities::ALL
    }
    /// As [`Accel::footprint`].
    fn footprint(&self) -> Footprint;
    /// As [`Accel::shape`].
    fn shape(&self) -> TreeShape;
    /// What is known of it besides, where it answers in a process of its own.
    fn remote(&self) -> Option<&dyn Remote> {
        None
    }
}

// Compiled once, not once for each structure and triangle test.
impl dyn DynAccel + '_ {
    /// The closest hit of each ray, found on all threads of the pool, each of which takes `chunk` rays at a time.
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

/// A batch of rays as they are: the structure prepares them in each query.
pub(crate) struct RayBatch<'a, A: ?Sized> {
    pub accel: &'a A,
    pub rays: Cow<'a, [Ray]>,
}

impl<A: DynAccel + ?Sized> Loaded for RayBatch<'_, A> {
    fn closest_hits(&self, hits: &mut [Option<Hit>]) {
        self.accel.closest_hits(&self.rays, hits);
    }

    fn any_hits(&self, hits: &mut [bool]) {
        self.accel.any_hits(&self.rays, hits);
    }
}
