//! Image regression: pictures of any renderer against golden images, exactly or by a tolerance. Each built-in scene must
//! look the same with every structure, byte for byte. [`assert_image`] is for the tests of other crates.
//!
#![doc = include_str!("GOLDEN.md")]

mod assert;
mod comparison;
mod difference;
mod failure;
mod file;
mod folders;
mod judgement;
mod layout;
mod mask;
pub mod measures;
pub mod numbers;
pub mod page;
mod scene;

use std::path::PathBuf;

use crate::escaped::Escaped as _;

pub use assert::{UPDATE, assert_image, check_image};
pub use comparison::{Comparison, Maps, compare};
pub use difference::{Difference, difference_picture, pixels_over};
pub use file::{PictureError, read, write};
pub use folders::{Pair, pairs};
pub use judgement::{Allowed, Match, NoFlip, Verdict};
pub use layout::Layout;
pub use mask::Mask;
pub use scene::{Overwrite, SIZE, SceneGolden, TRIANGLE_TEST, Update, VIEWS};

/// Why a picture is not accepted. `remedy` says how golden images are made.
#[derive(Debug, thiserror::Error)]
pub enum GoldenError {
    #[error("{cause}: {remedy}")]
    Missing { cause: PictureError, remedy: &'static str },
    #[error(
        "the golden image {} has {expected}, and what was drawn has {found}: see {}; if it is right, {remedy}",
        path.escaped(), shown.escaped()
    )]
    Layout { path: PathBuf, expected: Layout, found: Layout, shown: PathBuf, remedy: &'static str },
    #[error(
        "the golden image {} has {} x {} pixels, and {} x {} are asked for: give --size {}x{}, or make it with \
         `sahara golden update`",
        path.escaped(), golden[0], golden[1], asked[0], asked[1], golden[0], golden[1]
    )]
    Size { path: PathBuf, golden: [u32; 2], asked: [u32; 2] },
    #[error(
        "the golden image {} was drawn with {golden}, and now it is {asked}: give the former, or make the image with \
         `sahara golden update`",
        path.escaped()
    )]
    Camera { path: PathBuf, golden: String, asked: String },
    #[error(
        "{} is not as `sahara golden update` writes it, so somebody else may have made it: --force replaces it",
        .0.escaped()
    )]
    Foreign(PathBuf),
    #[error(
        "the golden images of built-in scenes are in this program, and its sources are not here: --goldens DIR makes \
         others in a folder"
    )]
    NoSources,
    #[error("{label}: {}: see {}; the golden image is {}", difference.sentence(*size), shown.escaped(), path.escaped())]
    Differs { label: String, path: PathBuf, difference: Box<Difference>, size: [u32; 2], shown: PathBuf },
    #[error("{refusal}; but these could not be written: {cause}")]
    NotShown { refusal: Box<GoldenError>, cause: Box<GoldenError> },
    #[error(transparent)]
    NoFlip(#[from] NoFlip),
    #[error(transparent)]
    Picture(#[from] PictureError),
}
