//! Single rays of a picture, and what every structure does for them: data of a part of the page that is looked into.

/// Some rays of a picture, each with all answers.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Inspector {
    /// Width and height of the picture in pixels.
    pub size: [u32; 2],
    /// Which pixels can be asked for, in a sentence.
    pub which: String,
    /// The command that asks all structures again, up to the text of the ray.
    pub command: String,
    /// Row by row.
    pub rays: Vec<InspectedRay>,
    /// Labels, and what each structure does for each ray.
    pub structures: Vec<InspectedStructure>,
}

/// A ray through the centre of a pixel.
#[derive(Clone, Debug, PartialEq)]
pub struct InspectedRay {
    /// Number of the pixel, row by row from the top left.
    pub pixel: u32,
    /// As `--ray` reads it.
    pub text: String,
    /// What exact arithmetic answers.
    pub truth: Answer,
    /// The different answers of the structures.
    pub answers: Vec<Answer>,
}

/// A closest hit, or that there is none.
#[derive(Clone, Debug, PartialEq)]
pub struct Answer {
    pub hit: Option<InspectedHit>,
    /// What is wrong with it, in a few words; empty where nothing is.
    pub wrong: &'static str,
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
#[derive(Clone, Debug, Default, PartialEq)]
pub struct InspectedStructure {
    pub label: String,
    /// Inner nodes and leaves entered.
    pub nodes: Vec<u64>,
    pub leaves: Vec<u64>,
    /// Triangles tested.
    pub tests: Vec<u64>,
    /// Which of the answers of the ray is its own.
    pub answers: Vec<usize>,
}
