//! Single rays of a picture and the work of every structure on them: data for the pixel inspector of the page.

use serde::{Serialize, Serializer};

/// Some rays of a picture, each with all hits. It is stored by columns, so a few thousand rays stay small on a page.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct Inspector {
    pub size: [u32; 2],
    /// The pixels that it covers, in a sentence.
    pub which: String,
    /// The command that traces a ray again with all structures, up to the text of the ray.
    pub command: String,
    /// Indices of the pixels, row by row from the top left.
    pub pixels: Vec<u32>,
    /// The rays through the centres of the pixels, in the format of `--ray`.
    pub rays: Vec<String>,
    /// The exact hits.
    pub truths: Vec<Answer>,
    pub answers: Vec<Vec<Answer>>,
    /// For each structure, its label and its work on each ray.
    pub structures: Vec<InspectedStructure>,
}

/// A closest hit or a miss.
#[derive(Clone, Debug, PartialEq)]
pub struct Answer {
    pub hit: Option<InspectedHit>,
    /// The fault, in a few words; empty if the hit is right.
    pub wrong: &'static str,
}

/// `[t, triangle, u, v]`, or `[]` for a miss; the fault follows.
impl Serialize for Answer {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let hit = self.hit.map(|InspectedHit { t, triangle, weights }| {
            // Keep only the printed digits.
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

/// A printed hit.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct InspectedHit {
    pub t: f32,
    pub triangle: u32,
    /// Weights of the second and third corner at the point in which the ray meets the plane of the triangle.
    pub weights: [f64; 2],
}

/// The work of one structure, by ray. Columns that it does not report are empty.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct InspectedStructure {
    pub label: String,
    /// Inner nodes and leaves entered.
    pub nodes: Vec<u64>,
    pub leaves: Vec<u64>,
    pub tests: Vec<u64>,
    /// The index of its hit among the hits of the ray.
    pub answers: Vec<usize>,
}
