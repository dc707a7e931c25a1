//! Single rays of a picture, and what every structure does for them: data of a part of the page that is looked into.

use serde::{Serialize, Serializer};

/// Some rays of a picture, each with all answers: columns, so that a few thousand rays stay small on a page.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct Inspector {
    pub size: [u32; 2],
    /// Which pixels can be asked for, in a sentence.
    pub which: String,
    /// The command that asks all structures again, up to the text of the ray.
    pub command: String,
    /// Numbers of the pixels, row by row from the top left.
    pub pixels: Vec<u32>,
    /// The rays through the centres of the pixels, as `--ray` reads them.
    pub rays: Vec<String>,
    /// What exact arithmetic answers.
    pub truths: Vec<Answer>,
    pub answers: Vec<Vec<Answer>>,
    /// Labels, and what each structure does for each ray.
    pub structures: Vec<InspectedStructure>,
}

/// A closest hit, or that there is none.
#[derive(Clone, Debug, PartialEq)]
pub struct Answer {
    pub hit: Option<InspectedHit>,
    /// What is wrong with it, in a few words; empty where nothing is.
    pub wrong: &'static str,
}

/// `[t, triangle, u, v]`, or `[]` of a miss; what is wrong with it stands behind.
impl Serialize for Answer {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let hit = self.hit.map(|InspectedHit { t, triangle, weights }| {
            // As many digits as are printed.
            let [u, v] = weights.map(|weight| libm::round(weight * 1e9) / 1e9);
            (t, triangle, u, v)
        });
        match (hit, self.wrong) {
            (Some(hit), "") => hit.serialize(serializer),
            (Some((t, triangle, u, v)), wrong) => (t, triangle, u, v, wrong).serialize(serializer),
            (None, "") => [(); 0].serialize(serializer),
            (None, wrong) => [wrong].serialize(serializer),
        }
    }
}

/// A hit as it is printed.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct InspectedHit {
    pub t: f32,
    pub triangle: u32,
    /// Weights of the second and third corner where the ray meets the plane of the triangle.
    pub weights: [f64; 2],
}

/// What one structure does, ray by ray. What it does not tell is empty.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct InspectedStructure {
    pub label: String,
    /// Inner nodes and leaves entered.
    pub nodes: Vec<u64>,
    pub leaves: Vec<u64>,
    pub tests: Vec<u64>,
    /// Which of the answers of the ray is its own.
    pub answers: Vec<usize>,
}
