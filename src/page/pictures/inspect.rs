//! The rays of some pixels, and the work of every structure on them.

use super::camera_rays::{CameraRays, StructureWork};
use crate::geometry::{Hit, Ray};
use crate::render::{Work, error_name};
use crate::report::inspector::{Answer, InspectedHit, InspectedStructure, Inspector};
use crate::report::words::each_once;
use crate::scene::offset::barycentrics;

/// The maximum of numbers in a picture: each takes some ten bytes on the page.
const NUMBERS: usize = 75_000;

/// Numbers per ray, without the numbers of each structure.
const OF_RAY: usize = 8;

/// The maximum of rays in a picture with these structures.
pub fn most_rays(structures: usize) -> usize {
    NUMBERS / (structures + OF_RAY)
}

/// The data of `pixels`, which are indices of pixels in ascending order. The sentence `which` describes the selection.
pub fn inspector(camera: &CameraRays, pixels: Vec<usize>, which: String) -> Inspector {
    let options: Vec<String> = camera.structures.iter().map(|s| format!("-s {}", s.label)).collect();
    let answers: Vec<Vec<Answer>> = pixels.iter().map(|&pixel| answers(camera, pixel)).collect();
    let of_structure = |structure: &StructureWork| {
        let numbers = |known: bool, number: fn(&Work) -> u64| {
            let asked = pixels.iter().map(|&pixel| number(&structure.work[pixel]));
            if known { asked.collect() } else { vec![] }
        };
        let own = |(answers, &pixel): (&Vec<Answer>, &usize)| {
            let answer = answer(camera, pixel, structure.work[pixel].hit);
            answers.iter().position(|other| *other == answer).expect("the ray has the answers of all structures")
        };
        InspectedStructure {
            label: structure.label.clone(),
            nodes: numbers(structure.observed.steps, |work| work.counts.inner),
            leaves: numbers(sees_leaves(structure), |work| work.counts.leaves),
            tests: numbers(structure.observed.tests, |work| work.counts.tests),
            answers: answers.iter().zip(&pixels).map(own).collect(),
        }
    };
    let structures = camera.structures.iter().map(of_structure).collect();
    Inspector {
        size: camera.exact.size,
        which,
        command: format!("sahara validate {} {} --ray", camera.loaded.words(), options.join(" ")),
        pixels: pixels.iter().map(|&pixel| pixel as u32).collect(),
        rays: pixels.iter().map(|&pixel| camera.exact.rays[pixel].to_string()).collect(),
        truths: pixels.iter().map(|&pixel| truth(camera, pixel)).collect(),
        answers,
        structures,
    }
}

/// Whether leaves are observed: in some trees they are not separate nodes. If leaves are counted, every structure that
/// tests triangles has entered one.
fn sees_leaves(structure: &StructureWork) -> bool {
    let any = |number: fn(&Work) -> u64| structure.work.iter().any(|work| number(work) > 0);
    structure.observed.steps && (any(|work| work.counts.leaves) || !any(|work| work.counts.tests))
}

fn truth(camera: &CameraRays, pixel: usize) -> Answer {
    let truth = camera.exact.truths[pixel].as_ref().map(|truth| Hit::new(truth.rounded(), truth.ids[0]));
    Answer { hit: truth.map(|hit| of_hit(camera, &camera.exact.rays[pixel], hit)), wrong: "" }
}

fn answers(camera: &CameraRays, pixel: usize) -> Vec<Answer> {
    each_once(camera.structures.iter().map(|structure| answer(camera, pixel, structure.work[pixel].hit)))
}

fn answer(camera: &CameraRays, pixel: usize, hit: Option<Hit>) -> Answer {
    let wrong = error_name(camera.exact.outcome(pixel, hit)).unwrap_or("");
    Answer { hit: hit.map(|hit| of_hit(camera, &camera.exact.rays[pixel], hit)), wrong }
}

fn of_hit(camera: &CameraRays, ray: &Ray, hit: Hit) -> InspectedHit {
    let triangle = hit.prim.index();
    let weights = barycentrics(ray, camera.loaded.scene.mesh.corners(triangle));
    InspectedHit { t: hit.t, triangle, weights: [weights.y, weights.z] }
}
