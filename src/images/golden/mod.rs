//! Compares pictures of any renderer with golden images. Every exact structure must render the same pixels of a
//! built-in scene. [`assert_image`] is for the tests of other crates.
//!
#![doc = include_str!("GOLDEN.md")]

mod assert;
mod comparison;
mod difference;
mod failure;
mod file;
mod folders;
mod layout;
mod mask;
pub mod measures;
pub mod numbers;
pub mod page;
mod rule;
mod scene;

use std::path::PathBuf;

use crate::escaped::Escaped as _;

pub use assert::{UPDATE, assert_image, check_image};
pub use comparison::{Comparison, Maps, Verdict, compare};
pub use difference::{Difference, difference_picture, pixels_over};
pub use file::{PictureError, read, write};
pub use folders::{Pair, pairs};
pub use layout::Layout;
pub use mask::Mask;
pub use rule::{Allowed, Limit, Match, NoFlip};
pub use scene::{Overwrite, SIZE, SceneGolden, TRIANGLE_TEST, Update, VIEWS};

#[derive(Debug, thiserror::Error)]
pub enum GoldenError {
    #[error("{cause}: {remedy}")]
    Missing { cause: PictureError, remedy: &'static str },
    #[error(
        "the golden image {} has {expected}, but the rendered picture has {found}: see {}; if it is correct, {remedy}",
        path.escaped(), shown.escaped()
    )]
    Layout { path: PathBuf, expected: Layout, found: Layout, shown: PathBuf, remedy: &'static str },
    #[error(
        "the golden image {} has {} x {} pixels, but {} x {} are requested: pass --size {}x{}, or replace it with \
         `sahara golden update`",
        path.escaped(), golden[0], golden[1], requested[0], requested[1], golden[0], golden[1]
    )]
    Size { path: PathBuf, golden: [u32; 2], requested: [u32; 2] },
    #[error(
        "the golden image {} was rendered with {golden}, but {requested} is requested: pass the former, or replace the \
         image with `sahara golden update`",
        path.escaped()
    )]
    Camera { path: PathBuf, golden: String, requested: String },
    #[error("{} was not written by `sahara golden update`: pass --force to replace it", .0.escaped())]
    Foreign(PathBuf),
    #[error(
        "the golden images of built-in scenes are compiled into the program and can only be updated in its source \
         tree, which was not found: pass --goldens DIR to use a folder"
    )]
    NoSources,
    #[error("{label}: {said}: see {}; the golden image is {}", shown.escaped(), path.escaped())]
    Differs { label: String, path: PathBuf, said: String, difference: Box<Difference>, shown: PathBuf },
    #[error("{refusal}; but the pictures could not be written: {cause}")]
    NotShown { refusal: Box<GoldenError>, cause: Box<GoldenError> },
    #[error(transparent)]
    NoFlip(#[from] NoFlip),
    #[error(transparent)]
    Picture(#[from] PictureError),
}
