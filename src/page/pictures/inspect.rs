//! The data of the pixel inspector. The inspector shows the ray of a selected pixel.

use serde_json::{Value, json};

use super::camera_rays::{CameraRays, StructureWork};
use crate::geometry::Hit;
use crate::render::{Work, error_name};
use crate::report::words::each_once;
use crate::scene::offset::barycentrics;

/// The maximum number of values in the data of one figure. Each value takes about ten bytes on the page.
const NUMBERS: usize = 75_000;

/// Values per ray that do not depend on a structure.
const OF_RAY: usize = 8;

/// Returns the maximum number of rays. This limit keeps the page small.
pub fn most_rays(structures: usize) -> usize {
    NUMBERS / (structures + OF_RAY)
}

/// `pixels` is in ascending order. Pixels are numbered row by row from the top left.
pub fn inspector(camera: &CameraRays, pixels: &[usize], which: &str) -> Value {
    let options: Vec<String> = camera.structures.iter().map(|s| format!("-s {}", s.label)).collect();
    let answer = |structure: &StructureWork, pixel: usize| {
        let hit = structure.work[pixel].hit;
        answer(camera, pixel, hit, error_name(camera.exact.outcome(pixel, hit)).unwrap_or(""))
    };
    let answers_of = |pixel: &usize| each_once(camera.structures.iter().map(|structure| answer(structure, *pixel)));
    let answers: Vec<Vec<Value>> = pixels.iter().map(answers_of).collect();
    let truth = |&pixel: &usize| {
        let truth = camera.exact.truths[pixel].as_ref().map(|truth| Hit::new(truth.rounded(), truth.ids[0]));
        self::answer(camera, pixel, truth, "")
    };
    let of_structure = |structure: &StructureWork| {
        let numbers = |known: bool, number: fn(&Work) -> u64| -> Vec<u64> {
            pixels.iter().filter(|_| known).map(|&pixel| number(&structure.work[pixel])).collect()
        };
        let own = |(answers, &pixel): (&Vec<Value>, &usize)| {
            let answer = answer(structure, pixel);
            answers.iter().position(|other| *other == answer).expect("the ray has the answers of all structures")
        };
        json!({
            "label": structure.label,
            "nodes": numbers(structure.observed.steps, |work| work.counts.inner),
            "leaves": numbers(sees_leaves(structure), |work| work.counts.leaves),
            "tests": numbers(structure.observed.tests, |work| work.counts.tests),
            "answers": answers.iter().zip(pixels).map(own).collect::<Vec<usize>>(),
        })
    };
    json!({
        "size": camera.exact.size,
        "which": which,
        // The page appends the text of the selected ray to this command.
        "command": format!("sahara validate {} {} --ray", camera.loaded.words(), options.join(" ")),
        "pixels": pixels,
        "rays": pixels.iter().map(|&pixel| camera.exact.rays[pixel].to_string()).collect::<Vec<_>>(),
        "truths": pixels.iter().map(truth).collect::<Vec<_>>(),
        "answers": answers,
        "structures": camera.structures.iter().map(of_structure).collect::<Vec<_>>(),
    })
}

/// Returns whether the leaf counts are known. A tree without separate leaf nodes counts triangle tests but no leaves.
fn sees_leaves(structure: &StructureWork) -> bool {
    let any = |number: fn(&Work) -> u64| structure.work.iter().any(|work| number(work) > 0);
    structure.observed.steps && (any(|work| work.counts.leaves) || !any(|work| work.counts.tests))
}

fn answer(camera: &CameraRays, pixel: usize, hit: Option<Hit>, wrong: &str) -> Value {
    let hit = hit.map(|hit| {
        let triangle = hit.prim.index();
        let weights = barycentrics(&camera.exact.rays[pixel], camera.loaded.scene.mesh.corners(triangle));
        (hit.t, triangle, [weights.y, weights.z])
    });
    answer_of(hit, wrong)
}

/// The array for a hit is `[t, triangle, u, v]`. The array for a miss is `[]`. A non-empty `wrong` is appended to the
/// array. `u` and `v` are the barycentric coordinates of the second and third corner.
fn answer_of(hit: Option<(f32, u32, [f64; 2])>, wrong: &str) -> Value {
    let mut fields = hit.map_or(vec![], |(t, triangle, weights)| {
        // `f64::from(t)` would have more digits in the JSON text.
        let t: f64 = t.to_string().parse().expect("a number");
        let [u, v] = weights.map(|weight| libm::round(weight * 1e9) / 1e9);
        vec![json!(t), json!(triangle), json!(u), json!(v)]
    });
    fields.extend((!wrong.is_empty()).then(|| json!(wrong)));
    Value::Array(fields)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn answers_are_short() {
        let hit = Some((0.1, 7, [0.25, 1.0 / 3.0]));
        for (hit, wrong, json) in [
            (hit, "", "[0.1,7,0.25,0.333333333]"),
            (hit, "too far", "[0.1,7,0.25,0.333333333,\"too far\"]"),
            (None, "", "[]"),
            (None, "missed", "[\"missed\"]"),
        ] {
            assert_eq!(answer_of(hit, wrong).to_string(), json);
        }
    }
}
