//! What properties ask of a structure under test.

use std::sync::Arc;

use crate::accel::DynAccel;
use crate::geometry::Mesh;
use crate::validate::conformance::Subject;

/// Rays of one property; the strata and meshes share them out.
pub(super) fn shared(rays: usize, among: usize) -> usize {
    rays.div_ceil(among).max(4)
}

/// Builds, or says that it cannot be built.
pub(super) fn built(subject: &Subject, mesh: &Arc<Mesh>) -> Result<Box<dyn DynAccel>, String> {
    (subject.build)(mesh).map_err(|error| format!("{} does not build: {error}", subject.name))
}
