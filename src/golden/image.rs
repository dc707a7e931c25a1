//! Golden images for the tests of other crates.

use std::path::Path;

use super::{Golden, GoldenError, file_name, put};
use crate::render::Picture;

/// When a picture is accepted.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Match {
    /// All bytes are equal, as with a deterministic renderer.
    Exact,
    /// No channel of a pixel differs by more than this, of 255: other machines may round differently.
    Within(u8),
}

/// The environment variable that makes [`assert_image`] write golden images instead of comparing, if it is `update`.
pub const UPDATE: &str = "SAHARA_GOLDEN";

/// The folder for the pictures of failures, relative to the current directory, which is the crate's folder in tests.
const OUT: &str = "out/golden";

/// Compares `actual` with the golden image `path`, a PNG file; for tests.
///
/// With the environment variable `SAHARA_GOLDEN=update` the file is written instead, folders included.
///
/// ```
/// use sahara::golden::{Match, assert_image};
/// use sahara::render::Picture;
///
/// # let folder = tempfile::tempdir().unwrap();
/// # let golden = folder.path().join("sunset.png");
/// let drawn = Picture::new([64, 64], vec![[200, 90, 40]; 64 * 64]);
/// # drawn.write(&golden).unwrap();
/// assert_image(&golden, &drawn, Match::Exact);
///
/// // Another machine rounds one pixel differently: not equal, but near.
/// let mut pixels = drawn.pixels().to_vec();
/// pixels[100][0] += 1;
/// let rounded = Picture::new([64, 64], pixels);
/// assert_image(&golden, &rounded, Match::Within(1));
/// # assert!(sahara::golden::check_image(&golden, &rounded, Match::Exact, &folder.path().join("out")).is_err());
/// ```
///
/// # Panics
/// If the picture is not accepted, has another size, or there is no golden image. Then `out/golden` holds the actual
/// and the expected picture under the golden image's file name, and their difference if they are of one size.
#[track_caller]
pub fn assert_image(path: impl AsRef<Path>, actual: &Picture, how: Match) {
    let path = path.as_ref();
    let result = match std::env::var(UPDATE).as_deref() {
        Ok("update") => put(path, actual),
        _ => check_image(path, actual, how, Path::new(OUT)),
    };
    if let Err(error) = result {
        panic!("{error}");
    }
}

/// As [`assert_image`], without a panic and with the pictures of a failure in `out`.
///
/// # Errors
/// If the picture is not accepted, or the golden image cannot be read.
pub fn check_image(path: &Path, actual: &Picture, how: Match, out: &Path) -> Result<(), GoldenError> {
    let stem = path.file_stem().unwrap_or(path.as_os_str()).to_string_lossy();
    let golden = Golden {
        path,
        label: stem.clone().into_owned(),
        shown: out.join(file_name(&stem)),
        remedy: "run the test once with SAHARA_GOLDEN=update to make the golden image",
    };
    golden.check(actual, |difference| matches!(how, Match::Within(step) if difference.largest <= step))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn picture(shade: u8) -> Picture {
        Picture::new([16, 16], vec![[shade, 50, 50]; 256])
    }

    #[test]
    fn each_refusal_says_why_and_leaves_pictures() {
        let directory = tempfile::tempdir().unwrap();
        let (golden, out) = (directory.path().join("a/b.png"), directory.path().join("out"));
        let refusal = |actual: &Picture, how| check_image(&golden, actual, how, &out).unwrap_err().to_string();
        assert!(refusal(&picture(10), Match::Exact).contains("SAHARA_GOLDEN=update"));
        put(&golden, &picture(10)).unwrap();
        check_image(&golden, &picture(10), Match::Exact, &out).unwrap();
        assert!(!out.exists());

        assert!(refusal(&picture(11), Match::Exact).contains("256 of 256 pixels differ"));
        check_image(&golden, &picture(11), Match::Within(1), &out).unwrap();
        assert!(refusal(&picture(255), Match::Within(244)).contains("by up to 245 of 255"));
        assert_eq!(Picture::read(&out.join("b-actual.png")).unwrap(), picture(255));
        assert_eq!(std::fs::read_dir(&out).unwrap().count(), 3);
        let small = refusal(&Picture::new([1, 1], vec![[0; 3]]), Match::Exact);
        assert!(small.contains("[1, 1]") && small.contains("SAHARA_GOLDEN=update"), "{small}");
        assert_eq!(Picture::read(&out.join("b-actual.png")).unwrap().size(), [1, 1]);

        // The reason is in the message even if the pictures cannot be written.
        std::fs::remove_dir_all(&out).unwrap();
        std::fs::write(&out, b"no folder").unwrap();
        let reason = refusal(&picture(11), Match::Exact);
        assert!(reason.contains("256 of 256 pixels differ") && reason.contains("could not be written"), "{reason}");
    }
}
