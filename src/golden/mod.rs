//! Golden images: each built-in scene must look the same with every structure, byte for byte. [`assert_image`] is for
//! the tests of other crates.

mod assert;
mod difference;
mod file;
mod layout;
mod mask;
pub mod measures;

use std::path::{Path, PathBuf};

use image::DynamicImage;

use crate::accel::DynAccel;
use crate::escaped::Escaped as _;
use crate::render::{of_colours, render};
use crate::scene::Scene;
use crate::triangle::{Exact, TriangleTest};

pub use assert::{Match, UPDATE, assert_image, check_image};
pub use difference::{Difference, difference_picture, pixels_over};
pub use file::{PictureError, read, write};
pub use layout::Layout;
pub use mask::Mask;

/// The folders of golden images and of the pictures of failures.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Goldens {
    scenes: PathBuf,
    out: PathBuf,
}

/// The triangle test that golden images are rendered with: an exact one, so that they show no rounding errors.
pub const TRIANGLE_TEST: &str = Exact::NAME;

/// Width and height of a golden image.
pub const SIZE: [u32; 2] = [160, 160];

/// Why a picture is not accepted. `remedy` says how golden images are made.
#[derive(Debug, thiserror::Error)]
pub enum GoldenError {
    #[error("{cause}: {remedy}")]
    Missing { cause: PictureError, remedy: &'static str },
    #[error(
        "the golden image {} has {expected}, and what was drawn has {found}: see {}-actual.png and -expected.png; \
         if it is right, {remedy}",
        path.escaped(), shown.escaped()
    )]
    Layout { path: PathBuf, expected: Layout, found: Layout, shown: PathBuf, remedy: &'static str },
    #[error(
        "{label}: {} of {} pixels differ from {}, first at column {}, row {}, by up to {} of {}: see {}-actual.png, \
         -expected.png and -difference.png",
        difference.pixels, size[0] * size[1], path.escaped(), difference.first[0], difference.first[1],
        difference.largest, difference.full_scale, shown.escaped()
    )]
    Differs { label: String, path: PathBuf, difference: Difference, size: [u32; 2], shown: PathBuf },
    #[error("{refusal}; but these could not be written: {cause}")]
    NotShown { refusal: Box<GoldenError>, cause: Box<GoldenError> },
    #[error(transparent)]
    Picture(#[from] PictureError),
}

impl Goldens {
    /// Golden images `NAME/golden.png` in the directory `scenes`, by the scene's name in small letters; the pictures of
    /// failures go to the directory `out`.
    pub fn new(scenes: impl Into<PathBuf>, out: impl Into<PathBuf>) -> Self {
        Self { scenes: scenes.into(), out: out.into() }
    }

    /// The golden images of this project, whatever the current directory; pictures of failures go to `out/golden` in
    /// the current directory.
    pub fn builtin() -> Self {
        Self::new(concat!(env!("CARGO_MANIFEST_DIR"), "/scenes"), "out/golden")
    }

    /// The golden image of a scene.
    pub fn path(&self, scene: &Scene) -> PathBuf {
        self.scenes.join(scene.name.to_lowercase()).join("golden.png")
    }

    /// Compares the shaded view of `scene`, traced by `accel`, with its golden image. `structure` names the pictures of
    /// a failure.
    ///
    /// The scene must be the built-in one with generated meshes, not with the real meshes that a machine may have.
    ///
    /// # Errors
    /// If the golden image is missing or broken, or a pixel differs. Then `actual`, `expected` and `difference` are
    /// written.
    pub fn check(&self, scene: &Scene, structure: &str, accel: &dyn DynAccel) -> Result<(), GoldenError> {
        let golden = Golden {
            path: &self.path(scene),
            label: format!("{} with {structure}", scene.name),
            shown: self.out.join(file_name(&format!("{}-{structure}", scene.name.to_lowercase()))),
            remedy: "make the golden images with `sahara golden update`",
        };
        golden.check(&draw(scene, accel), |_| false)
    }

    /// Renders the golden image of `scene` again; returns whether it has changed.
    ///
    /// # Errors
    /// If it cannot be written.
    pub fn update(&self, scene: &Scene, accel: &dyn DynAccel) -> Result<bool, GoldenError> {
        let path = self.path(scene);
        let picture = draw(scene, accel);
        if file::read(&path).is_ok_and(|there| there == picture) {
            return Ok(false);
        }
        file::write(&path, &picture)?;
        Ok(true)
    }
}

fn draw(scene: &Scene, accel: &dyn DynAccel) -> DynamicImage {
    of_colours(SIZE, &render(scene, accel, SIZE).0).into()
}

/// A golden image, with the names of the message and of the pictures of a failure.
struct Golden<'a> {
    path: &'a Path,
    label: String,
    shown: PathBuf,
    remedy: &'static str,
}

impl Golden<'_> {
    /// Whether `actual` is the golden image, or the difference is `allowed`.
    fn check(self, actual: &DynamicImage, allowed: impl Fn(&Difference) -> bool) -> Result<(), GoldenError> {
        let Self { path, label, shown, remedy } = self;
        let expected = file::read(path).map_err(|cause| match cause {
            PictureError::Read { .. } => GoldenError::Missing { cause, remedy },
            cause => GoldenError::Picture(cause),
        })?;
        let path = path.to_path_buf();
        let [found, layout] = [actual, &expected].map(Layout::of);
        let refusal = if found != layout {
            GoldenError::Layout { path, expected: layout, found, shown: shown.clone(), remedy }
        } else {
            match Difference::between(actual, &expected) {
                Some(difference) if !allowed(&difference) => {
                    GoldenError::Differs { label, path, difference, size: found.size, shown: shown.clone() }
                }
                _ => return Ok(()),
            }
        };
        // The difference stays the reason if its pictures cannot be written.
        match leave(&shown, actual, &expected) {
            Ok(()) => Err(refusal),
            Err(cause) => Err(GoldenError::NotShown { refusal: Box::new(refusal), cause: Box::new(cause) }),
        }
    }
}

/// Writes the pictures of a failure: `SHOWN-actual.png`, `-expected.png` and, of pictures of one layout,
/// `-difference.png`.
fn leave(shown: &Path, actual: &DynamicImage, expected: &DynamicImage) -> Result<(), GoldenError> {
    let write = |what: &str, picture: &DynamicImage| {
        let path = PathBuf::from(format!("{}-{what}.png", shown.display()));
        // PNG has no floats; to look at, 8 bits are enough.
        if Layout::of(picture).bits > 16 {
            return file::write(&path, &picture.to_rgba8().into());
        }
        file::write(&path, picture)
    };
    write("actual", actual)?;
    write("expected", expected)?;
    if Layout::of(actual) == Layout::of(expected) {
        write("difference", &difference_picture(actual, expected).into())?;
    }
    Ok(())
}

/// `text` with everything but letters, digits and `.`, `-`, `_` replaced.
fn file_name(text: &str) -> String {
    text.chars().map(|c| if c.is_alphanumeric() || ".-_".contains(c) { c } else { '_' }).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::accel::Accel;
    use crate::brute_force::BruteForce;
    use crate::kdtree::{KdConfig, KdTree};
    use crate::scene::Builtin;

    #[test]
    fn a_golden_image_holds_until_the_scene_changes() {
        let directory = tempfile::tempdir().unwrap();
        let goldens = Goldens::new(directory.path().join("scenes"), directory.path().join("out"));
        let mut scene = Builtin::find("cube").unwrap().scene(None).unwrap();
        let tree = KdTree::<Exact>::build(&scene.mesh, &KdConfig::SAH).unwrap();
        let all = BruteForce::<Exact>::build(&scene.mesh, &Default::default()).unwrap();

        let missing = goldens.check(&scene, "sah-kd", &tree).unwrap_err();
        assert!(matches!(missing, GoldenError::Missing { .. }), "{missing}");
        assert!(goldens.update(&scene, &tree).unwrap());
        assert!(!goldens.update(&scene, &all).unwrap(), "the same picture is not written again");
        goldens.check(&scene, "brute-force", &all).unwrap();

        // Another background changes every pixel that misses, including the first.
        scene.background.x += 0.5;
        let error = goldens.check(&scene, "sah-kd:leaf=1", &tree).unwrap_err();
        let GoldenError::Differs { difference, shown, .. } = &error else { panic!("{error}") };
        assert_eq!(difference.first, [0, 0]);
        assert!(difference.pixels > 10_000 && difference.largest >= 127.0, "{error}");
        let picture = |what: &str| file::read(&PathBuf::from(format!("{}-{what}.png", shown.display()))).unwrap();
        assert_eq!(Difference::between(&picture("actual"), &picture("expected")), Some(*difference));
        assert_eq!(picture("difference"), difference_picture(&picture("actual"), &picture("expected")).into());
        assert!(error.to_string().contains("Cube with sah-kd:leaf=1"), "{error}");
        assert_eq!(std::fs::read_dir(directory.path().join("out")).unwrap().count(), 3);
    }
}
