//! What the answers of a structure must have in common, whatever they are.

use std::sync::Arc;

use super::case::{Property, cases};
use super::metamorphic::metamorphic;
use super::set::star;
use super::subject::{built, shared};
use crate::accel::DynAccel;
use crate::geometry::{Mesh, Ray};
use crate::validate::conformance::Subject;
use crate::validate::degenerate::{exponential, huge_and_small, needles, soup};
use crate::validate::{Reference, Sampler, Stratum, Validation, validate};

cases! {
    Added 73 "continuation", Property => continuation,
        "Going on behind each hit must visit all crossings of a ray, each once.",
        "Embree, verify.cpp, sphere_filter_multi_hit";
    Added 74 "parity", Property => parity,
        "A ray from outside crosses a closed surface an even number of times.",
        "survey: tests of volumes and of points in solids rest on it";
    Added 75 "metamorphic", Property => metamorphic,
        "Reordered, mirrored and doubled scenes have the same t; so have turned, moved and cut ones where answers are exact.",
        "survey: finds what a comparison with one's own test cannot";
    Added 76 "any_equals_closest", Property => |subject, rays| {
        validated(subject, &[star(), soup(500, 1)], rays, |v| (v.any_hit_errors, "any hit contradicts closest hit"))
    },
        "Any hit has a loop of its own in most systems, and its own mistakes.",
        "pbrt-v4: a second copy of the loop";
    Added 77 "batch_equals_single", Property => |subject, rays| {
        validated(subject, &[star(), soup(500, 1)], rays, |v| (v.unrepeatable, "asked alone, the answer is another"))
    },
        "Packets and batches must answer as single rays do.",
        "Embree, verify.cpp: the same tests for every packet size";
    Added 81 "sizes_0_to_40", Property => |subject, rays| {
        let meshes: Vec<Arc<Mesh>> = (0..=40).map(|n| soup(n, 100 + n as u64)).collect();
        validated(subject, &meshes, rays, |v| (v.errors(), "an answer is wrong"))
    },
        "No, one, two, three triangles and all sizes of a leaf: where blocks and nodes are partly filled.",
        "survey";
    Added 84 "limits", Property => limits,
        "Numbers of nodes and references must stay bounded where triangles cannot be separated, before memory ends.",
        "pbrt-v4, kd-tree: depth 8 + 1.3 log2 N and bad refines; Embree, regression with failing allocations";
}

/// Holds all strata on some meshes against brute force, and counts one kind of error.
fn validated(
    subject: &Subject,
    meshes: &[Arc<Mesh>],
    rays: usize,
    errors: fn(&Validation) -> (u64, &'static str),
) -> Result<Property, String> {
    let mut property = Property::default();
    let each = shared(rays, meshes.len() * Stratum::ALL.len());
    for mesh in meshes {
        let (accel, reference) = both(subject, mesh)?;
        for stratum in Stratum::ALL {
            let validation = validate(&*accel, &reference, mesh, &stratum.rays(mesh, each, 76));
            let (broken, what) = errors(&validation);
            let example = (broken > 0).then(|| {
                let worst = validation.worst_error().map_or(String::new(), |worst| format!(": {worst}"));
                format!("{} triangles, {}: {what}{worst}", mesh.len(), stratum.name())
            });
            property.append(Property { checked: validation.rays, broken, example });
        }
    }
    Ok(property)
}

/// No ray of these scenes has more crossings; a structure that does not move on is stopped here.
const CROSSINGS: usize = 4096;

/// The rays that go on behind each hit of `ray` as `accel` finds them, the first being `ray` itself.
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

/// The structure and brute force with its triangle test.
fn both(subject: &Subject, mesh: &Arc<Mesh>) -> Result<(Box<dyn DynAccel>, Reference), String> {
    let reference = Reference::of_test(subject.triangle_test, mesh).map_err(|error| error.to_string());
    Ok((built(subject, mesh)?, reference?))
}

/// Each continued ray is held against brute force, which says where to go on.
fn continuation(subject: &Subject, rays: usize) -> Result<Property, String> {
    let mesh = star();
    let (accel, reference) = both(subject, &mesh)?;
    let through = through_star(shared(rays, 10), 73);
    let steps: Vec<Ray> = through.into_iter().flat_map(|ray| continued(&*reference.accel, ray)).collect();
    let found = validate(&*accel, &reference, &mesh, &steps);
    let example = found.worst_error().map(ToString::to_string);
    Ok(Property { checked: found.rays, broken: found.errors(), example })
}

/// Where brute force with the same test counts an odd number too, the test is to blame.
fn parity(subject: &Subject, rays: usize) -> Result<Property, String> {
    let mesh = star();
    let (accel, reference) = both(subject, &mesh)?;
    let mut property = Property::default();
    for ray in through_star(shared(rays, 10), 74) {
        let crossings = |accel: &dyn DynAccel| continued(accel, ray).len() - 1;
        let own = crossings(&*accel);
        let holds = own.is_multiple_of(2) || crossings(&*reference.accel) == own;
        property.note(holds, || format!("{own} crossings of a closed mesh by the ray \"{ray}\""));
    }
    Ok(property)
}

/// References a triangle from which on a tree has lost control, whatever it is built over.
const REFERENCES: usize = 64;
/// Edges from root to leaf likewise.
const DEPTH: usize = 1024;

fn limits(subject: &Subject, _rays: usize) -> Result<Property, String> {
    let mut property = Property::default();
    let meshes = [("needles", needles(2200)), ("a sequence", exponential(300)), ("a huge triangle", huge_and_small())];
    for (name, mesh) in meshes {
        let shape = built(subject, &mesh)?.shape();
        property.note(shape.references <= REFERENCES * mesh.len(), || {
            format!(
                "{} references to {} triangles over {name}: at most {REFERENCES} each",
                shape.references,
                mesh.len()
            )
        });
        property.note(shape.depth <= DEPTH, || format!("{} levels over {name}: at most {DEPTH}", shape.depth));
    }
    Ok(property)
}
