//! Properties that every structure must have.

use std::sync::Arc;

use super::case::Property;
use super::meshes::star;
use crate::accel::{BuildError, DynAccel};
use crate::geometry::{Mesh, Ray};
use crate::validate::conformance::Subject;
use crate::validate::degenerate::{exponential, huge_and_small, needles, soup};
use crate::validate::{Reference, Sampler, Stratum, Validation, has_replied, validate};

pub(super) fn shared(rays: usize, among: usize) -> usize {
    rays.div_ceil(among).max(4)
}

fn with_reference(subject: &Subject, mesh: &Arc<Mesh>) -> Result<(Box<dyn DynAccel>, Reference), BuildError> {
    Ok(((subject.build)(mesh)?, Reference::of_test(subject.triangle_test, mesh)?))
}

pub(super) fn any_equals_closest(subject: &Subject, rays: usize) -> Result<Property, BuildError> {
    let errors = |found: &Validation| (found.any_hit_errors, "any hit contradicts closest hit");
    validated(subject, &[star(), soup(500, 1)], rays, errors)
}

pub(super) fn batch_equals_single(subject: &Subject, rays: usize) -> Result<Property, BuildError> {
    let errors = |found: &Validation| (found.unrepeatable, "the single ray has another hit");
    validated(subject, &[star(), soup(500, 1)], rays, errors)
}

pub(super) fn sizes(subject: &Subject, rays: usize) -> Result<Property, BuildError> {
    let meshes: Vec<Arc<Mesh>> = (0..=40).map(|n| soup(n, 100 + n as u64)).collect();
    validated(subject, &meshes, rays, |found| (found.errors(), "a hit is wrong"))
}

/// `errors` returns the number and a description of the errors that break the property.
fn validated(
    subject: &Subject,
    meshes: &[Arc<Mesh>],
    rays: usize,
    errors: fn(&Validation) -> (u64, &'static str),
) -> Result<Property, BuildError> {
    let mut property = Property::default();
    let each = shared(rays, meshes.len() * Stratum::ALL.len());
    for mesh in meshes {
        let (accel, reference) = with_reference(subject, mesh)?;
        for stratum in Stratum::ALL {
            let validation = validate(&*accel, &reference, mesh, &stratum.rays(mesh, each, 76));
            has_replied(&*accel)?;
            let (broken, what) = errors(&validation);
            property.checked += validation.rays;
            property.broken += broken;
            if broken > 0 && property.example.is_none() {
                let worst = validation.worst_error().map_or(String::new(), |worst| format!(": {worst}"));
                property.example = Some(format!("{} triangles, {}: {what}{worst}", mesh.len(), stratum.name()));
            }
        }
    }
    Ok(property)
}

/// The maximum number of rays that `continued` returns. A structure that ignores `t_min` reaches this limit.
/// No scene here needs as many rays.
const CROSSINGS: usize = 4096;

/// Returns `ray` and, for each hit along `ray`, a copy that starts behind the hit.
fn continued(accel: &dyn DynAccel, ray: Ray) -> Vec<Ray> {
    let mut rays = vec![ray];
    while let Some(hit) = accel.closest(&rays[rays.len() - 1..])[0] {
        if rays.len() == CROSSINGS {
            break;
        }
        rays.push(Ray { t_min: hit.t.next_up(), ..ray });
    }
    rays
}

fn through_star(count: usize, seed: u64) -> Vec<Ray> {
    let mut sampler = Sampler::new(seed);
    let ray = |_| {
        let origin = sampler.direction() * 20.0;
        Ray::new(origin, sampler.cube() * 5.0 - origin)
    };
    (0..count).map(ray).collect()
}

pub(super) fn continuation(subject: &Subject, rays: usize) -> Result<Property, BuildError> {
    let mesh = star();
    let (accel, reference) = with_reference(subject, &mesh)?;
    let through = through_star(shared(rays, 10), 73);
    let steps: Vec<Ray> = through.into_iter().flat_map(|ray| continued(&*reference.accel, ray)).collect();
    let found = validate(&*accel, &reference, &mesh, &steps);
    has_replied(&*accel)?;
    let example = found.worst_error().map(ToString::to_string);
    Ok(Property { checked: found.rays, broken: found.errors(), example })
}

/// The number of crossings must be even, or equal to the number of crossings with the reference.
pub(super) fn parity(subject: &Subject, rays: usize) -> Result<Property, BuildError> {
    let (accel, reference) = with_reference(subject, &star())?;
    let mut property = Property::default();
    for ray in through_star(shared(rays, 10), 74) {
        let crossings = |accel: &dyn DynAccel| continued(accel, ray).len() - 1;
        let own = crossings(&*accel);
        has_replied(&*accel)?;
        let holds = own.is_multiple_of(2) || crossings(&*reference.accel) == own;
        property.note(holds, || format!("{own} crossings of a closed mesh by the ray \"{ray}\""));
    }
    Ok(property)
}

/// The maximum ratio of the number of references to the number of triangles.
const REFERENCES: usize = 64;
/// The maximum number of edges from root to leaf.
const DEPTH: usize = 1024;

pub(super) fn limits(subject: &Subject, _rays: usize) -> Result<Property, BuildError> {
    let mut property = Property::default();
    let meshes = [("needles", needles(2200)), ("a sequence", exponential(300)), ("a huge triangle", huge_and_small())];
    for (name, mesh) in meshes {
        let (shape, triangles) = ((subject.build)(&mesh)?.shape(), mesh.len());
        property.note(shape.references <= REFERENCES * triangles, || {
            format!("{} references to {triangles} triangles over {name}: at most {REFERENCES} each", shape.references)
        });
        property.note(shape.depth <= DEPTH, || format!("{} levels over {name}: at most {DEPTH}", shape.depth));
    }
    Ok(property)
}
