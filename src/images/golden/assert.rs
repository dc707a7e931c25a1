//! Compares pictures with golden images in tests.

use std::path::Path;

use image::DynamicImage;

use super::page::Values;
use super::{GoldenError, Match, PictureError, failure, file};

/// If this environment variable has the value `update`, [`assert_image`] writes golden images instead of comparing.
pub const UPDATE: &str = "SAHARA_GOLDEN";

/// The folder for pages, relative to the current directory. In tests, the current directory is the folder of the crate.
const OUT: &str = "out/golden";

/// Compares all channels of `actual`, including alpha, with the golden image at `path`.
///
/// If the environment has `SAHARA_GOLDEN=update`, the function writes `actual` to `path` as PNG instead.
///
/// ```
/// use sahara_images::golden::{Allowed, Match, assert_image};
/// use sahara_images::image::{Rgb, RgbImage};
///
/// # let folder = tempfile::tempdir().unwrap();
/// # let golden = folder.path().join("sunset.png");
/// let mut drawn = RgbImage::from_pixel(64, 64, Rgb([200, 90, 40]));
/// # sahara_images::golden::write(&golden, &drawn.clone().into()).unwrap();
/// assert_image(&golden, drawn.clone(), Match::Exact);
///
/// // Another machine rounds one pixel differently: not equal, but near.
/// drawn.get_pixel_mut(36, 1).0[0] += 1;
/// assert_image(&golden, drawn.clone(), Match::within(1.0));
///
/// // Noise may change a few pixels more: 1 % of all pixels may differ by any amount.
/// drawn.get_pixel_mut(9, 30).0[0] += 40;
/// assert_image(&golden, drawn.clone(), Match::Tolerance { difference: 2.0, pixels: Allowed::Percent(1.0) });
/// assert_image(&golden, drawn.clone(), Match::flip(0.01)); // as a person sees it
/// # assert!(sahara_images::golden::check_image(&golden, &drawn.into(), Match::Exact, &folder.path().join("out")).is_err());
/// ```
///
/// # Panics
/// If `how` rejects `actual`. If the size, channels or bits per channel differ. If the golden image cannot be read or
/// written.
///
/// If the pictures differ, the message contains the path of a page with the two pictures and the difference. The page
/// is in `out/golden/NAME`. `NAME` is the file name of the golden image without the extension. Without the feature
/// `page`, the message contains the path of the folder `out/golden/NAME` instead.
#[track_caller]
pub fn assert_image(path: impl AsRef<Path>, actual: impl Into<DynamicImage>, how: Match) {
    let (path, actual) = (path.as_ref(), actual.into());
    let result = match std::env::var(UPDATE).as_deref() {
        Ok("update") => file::write(path, &actual).map_err(GoldenError::from),
        _ => check_image(path, &actual, how, Path::new(OUT)),
    };
    if let Err(error) = result {
        panic!("{error}");
    }
}

/// Like [`assert_image`], but returns the error. The function never writes the golden image.
///
/// If the pictures differ, they are written to a folder in `out`.
///
/// # Errors
/// If `how` rejects `actual`. If the size, channels or bits per channel differ. If the golden image cannot be read.
pub fn check_image(path: &Path, actual: &DynamicImage, how: Match, out: &Path) -> Result<(), GoldenError> {
    let stem = path.file_stem().unwrap_or(path.as_os_str()).to_string_lossy();
    let remedy = "run the test once with SAHARA_GOLDEN=update to create the golden image";
    let expected = file::read(path).map_err(|cause| match cause {
        PictureError::Read { .. } => GoldenError::Missing { cause, remedy },
        cause => GoldenError::Picture(cause),
    })?;
    let shown = failure::folder(out, &stem);
    failure::check(path, &stem, [&expected, actual], how, Values::Colours, &shown, remedy)
}

#[cfg(test)]
mod tests {
    use image::{Rgb, Rgb32FImage, RgbImage};

    use super::*;
    use crate::golden::{read, write};

    fn picture(shade: u8) -> DynamicImage {
        RgbImage::from_pixel(16, 16, Rgb([shade, 50, 50])).into()
    }

    #[test]
    fn each_refusal_says_why_and_leaves_pictures() {
        let directory = tempfile::tempdir().unwrap();
        let (golden, out) = (directory.path().join("a/b.png"), directory.path().join("out"));
        let refusal = |actual: &DynamicImage, how| check_image(&golden, actual, how, &out).unwrap_err().to_string();
        assert!(refusal(&picture(10), Match::Exact).contains("SAHARA_GOLDEN=update"));
        write(&golden, &picture(10)).unwrap();
        check_image(&golden, &picture(10), Match::Exact, &out).unwrap();
        assert!(!out.exists());

        assert!(refusal(&picture(11), Match::Exact).contains("256 of 256 pixels differ"));
        check_image(&golden, &picture(11), Match::within(1.0), &out).unwrap();
        let refused = refusal(&picture(255), Match::within(244.0));
        let limit = "256 pixels differ by more than 244 of 255, and 0 are allowed";
        assert!(refused.contains(&format!("by up to 245 of 255; {limit}: see ")), "{refused}");
        assert_eq!(read(&out.join("b/pictures/0-actual.png")).unwrap(), picture(255));
        assert_eq!(std::fs::read_dir(&out).unwrap().count(), 1);
        #[cfg(feature = "page")]
        assert!(std::fs::read_to_string(out.join("b/index.html")).unwrap().contains(limit));
        let small = refusal(&RgbImage::new(1, 1).into(), Match::Exact);
        assert!(small.contains("1 x 1 pixels") && small.contains("SAHARA_GOLDEN=update"), "{small}");
        assert_eq!(read(&out.join("b/pictures/0-actual.png")).unwrap().width(), 1);

        refusal(&Rgb32FImage::new(2, 2).into(), Match::Exact);
        assert_eq!(read(&out.join("b/pictures/0-actual.png")).unwrap().width(), 2);

        // The pictures cannot be written, because `out` is a file.
        std::fs::remove_dir_all(&out).unwrap();
        std::fs::write(&out, b"no folder").unwrap();
        let reason = refusal(&picture(11), Match::Exact);
        assert!(reason.contains("256 of 256 pixels differ") && reason.contains("could not be written"), "{reason}");
    }
}
