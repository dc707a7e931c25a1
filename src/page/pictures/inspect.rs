//! The rays of some pixels, and what every structure does for them.

use super::seen::{Seen, SeenStructure};
use crate::geometry::{Hit, Ray};
use crate::render::{Work, error_name};
use crate::report::inspector::{Answer, InspectedHit, InspectedRay, InspectedStructure, Inspector};
use crate::scene::offset::barycentrics;

/// Numbers that a picture may hold, at most: some ten bytes each on the page.
const NUMBERS: usize = 75_000;

/// Numbers of a ray besides those of each structure.
const OF_RAY: usize = 8;

/// Rays that a picture with these structures may hold.
pub fn most_rays(structures: usize) -> usize {
    NUMBERS / (structures + OF_RAY)
}

/// Everything about `pixels`, which are numbers of pixels in ascending order. `which` says in a sentence which ones they are.
pub fn inspector(seen: &Seen, pixels: Vec<usize>, which: String) -> Inspector {
    let structures: Vec<String> = seen.structures.iter().map(|s| format!("-s {}", s.label)).collect();
    let rays: Vec<InspectedRay> = pixels.iter().map(|&pixel| of_ray(seen, pixel)).collect();
    let of_structure = |structure: &SeenStructure| {
        let numbers = |known: bool, number: fn(&Work) -> u64| {
            let asked = pixels.iter().map(|&pixel| number(&structure.work[pixel]));
            if known { asked.collect() } else { vec![] }
        };
        let own = |(ray, &pixel): (&InspectedRay, &usize)| {
            let answer = answer(seen, pixel, structure.work[pixel].hit);
            ray.answers.iter().position(|other| *other == answer).expect("the ray has the answers of all structures")
        };
        InspectedStructure {
            label: structure.label.clone(),
            nodes: numbers(structure.observed.steps, |work| work.counts.inner),
            leaves: numbers(sees_leaves(structure), |work| work.counts.leaves),
            tests: numbers(structure.observed.tests, |work| work.counts.tests),
            answers: rays.iter().zip(&pixels).map(own).collect(),
        }
    };
    let structures_asked = seen.structures.iter().map(of_structure).collect();
    Inspector {
        size: seen.exact.size,
        which,
        command: format!("sahara validate {} {} --ray", seen.shown.quoted(), structures.join(" ")),
        structures: structures_asked,
        rays,
    }
}

/// Whoever tests triangles has entered a leaf, if leaves are counted: in some trees they are no nodes of their own.
fn sees_leaves(structure: &SeenStructure) -> bool {
    let any = |number: fn(&Work) -> u64| structure.work.iter().any(|work| number(work) > 0);
    structure.observed.steps && (any(|work| work.counts.leaves) || !any(|work| work.counts.tests))
}

fn of_ray(seen: &Seen, pixel: usize) -> InspectedRay {
    let ray = &seen.exact.rays[pixel];
    let mut answers: Vec<Answer> = vec![];
    for structure in &seen.structures {
        let answer = answer(seen, pixel, structure.work[pixel].hit);
        if !answers.contains(&answer) {
            answers.push(answer);
        }
    }
    let truth = seen.exact.truths[pixel].as_ref().map(|truth| Hit::new(truth.rounded(), truth.ids[0]));
    InspectedRay {
        pixel: pixel as u32,
        text: ray.to_string(),
        truth: Answer { hit: truth.map(|hit| of_hit(seen, ray, hit)), wrong: "" },
        answers,
    }
}

fn answer(seen: &Seen, pixel: usize, hit: Option<Hit>) -> Answer {
    let wrong = error_name(seen.exact.outcome(pixel, hit)).unwrap_or("");
    Answer { hit: hit.map(|hit| of_hit(seen, &seen.exact.rays[pixel], hit)), wrong }
}

fn of_hit(seen: &Seen, ray: &Ray, hit: Hit) -> InspectedHit {
    let triangle = hit.prim.index();
    let weights = barycentrics(ray, seen.shown.scene.mesh.corners(triangle));
    InspectedHit { t: hit.t, triangle, weights: [weights.y, weights.z] }
}
