//! What is left of a picture that is not accepted.

use std::path::{Path, PathBuf};

use image::DynamicImage;

use super::comparison::compare;
use super::judgement::{Judgement, Match};
use super::page::{self, Sides, Values};
use super::{GoldenError, Layout, PictureError, difference_picture, file};
use crate::escaped::Escaped as _;
use crate::output::OutputFolder;

/// Whether `actual` is accepted in the place of `expected`, which is the golden image `path`. If not, pictures are written
/// to `SHOWN-actual.png`, `-expected.png` and, of pictures of one layout, `-difference.png`, and a page to the folder
/// `SHOWN`.
pub fn check(
    path: &Path,
    label: &str,
    [expected, actual]: [&DynamicImage; 2],
    how: Match,
    values: Values,
    shown: &Path,
    remedy: &'static str,
) -> Result<(), GoldenError> {
    let path = path.to_path_buf();
    let [wanted, found] = [expected, actual].map(Layout::of);
    let refusal = if found != wanted {
        GoldenError::Layout { path, expected: wanted, found, shown: shown.into(), remedy }
    } else {
        match Judgement::new([expected, actual], how, None)? {
            Some(judged) if !judged.accepted => {
                let difference = judged.difference;
                GoldenError::Differs { label: label.into(), path, difference, size: found.size, shown: shown.into() }
            }
            _ => return Ok(()),
        }
    };
    // The difference stays the reason if its pictures cannot be written.
    match leave(shown, label, [expected, actual], how, values) {
        Ok(()) => Err(refusal),
        Err(cause) => Err(GoldenError::NotShown { refusal: Box::new(refusal), cause: Box::new(cause) }),
    }
}

fn leave(
    shown: &Path,
    label: &str,
    [expected, actual]: [&DynamicImage; 2],
    how: Match,
    values: Values,
) -> Result<(), GoldenError> {
    let write = |what: &str, picture: &DynamicImage| {
        let path = PathBuf::from(format!("{}-{what}.png", shown.display()));
        // PNG has no floats; to look at, 8 bits are enough.
        if Layout::of(picture).is_float() {
            return file::write(&path, &picture.to_rgba8().into());
        }
        file::write(&path, picture)
    };
    write("actual", actual)?;
    write("expected", expected)?;
    if Layout::of(actual) == Layout::of(expected) {
        write("difference", &difference_picture(actual, expected).into())?;
    }
    let folder = OutputFolder::check(shown).map_err(PictureError::from)?;
    let written = page::write(&folder, label, |page| {
        let (comparison, maps) = compare(label, [expected, actual], how, None);
        let sides = Sides { expected: Some(expected), actual: Some(actual), values };
        page.add(0, &comparison, sides, maps.as_ref())
    });
    Ok(written.map_err(PictureError::from)?)
}

/// The end of a message that names the page of a failure.
pub fn page_of(shown: &Path) -> String {
    format!(", or the page {}", shown.join(page::INDEX).escaped())
}

/// `text` with everything but letters, digits and `.`, `-`, `_` replaced.
pub fn file_name(text: &str) -> String {
    text.chars().map(|c| if c.is_alphanumeric() || ".-_".contains(c) { c } else { '_' }).collect()
}
