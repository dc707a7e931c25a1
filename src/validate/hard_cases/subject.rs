//! What properties ask of a structure under test.

use std::sync::Arc;

use super::case::Property;
use crate::accel::DynAccel;
use crate::geometry::{Hit, Mesh, Ray};
use crate::validate::conformance::Subject;

/// Rays of one property; the strata and meshes share them out.
pub(super) fn shared(rays: usize, among: usize) -> usize {
    rays.div_ceil(among).max(4)
}

/// Builds, or says in a property that it cannot be built.
pub(super) fn built(subject: &Subject, mesh: &Arc<Mesh>) -> Result<Box<dyn DynAccel>, Property> {
    (subject.build)(mesh).map_err(|error| {
        let example = Some(format!("{} does not build: {error}", subject.name));
        Property { checked: 1, broken: 1, example }
    })
}

pub(super) fn closest(accel: &dyn DynAccel, ray: Ray) -> Option<Hit> {
    let mut hit = [None];
    accel.closest_hits(&[ray], &mut hit);
    hit[0]
}
