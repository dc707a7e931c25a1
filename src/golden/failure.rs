//! What is left of a picture that is not accepted.

use std::path::{Path, PathBuf};

use image::DynamicImage;

use super::comparison::compare;
use super::judgement::{Judgement, Match};
use super::page::PageFolder;
use super::sides::{PageError, Sides, Values};
use super::{GoldenError, Layout, difference_picture, file};

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
    let difference = if found == wanted {
        match Judgement::new([expected, actual], how, None)? {
            Some(judged) if !judged.accepted => Some(Box::new(judged.difference)),
            _ => return Ok(()),
        }
    } else {
        None
    };
    let left = leave(shown, label, [expected, actual], how, values);
    let (page, fault) = left.map_or_else(|fault| (None, Some(fault)), |page| (page, None));
    let (label, shown, size) = (label.into(), shown.into(), found.size);
    let refusal = match difference {
        Some(difference) => GoldenError::Differs { label, path, difference, size, shown, page },
        None => GoldenError::Layout { path, expected: wanted, found, shown, remedy },
    };
    // The difference stays the reason if its pictures cannot be written.
    Err(match fault {
        None => refusal,
        Some(cause) => GoldenError::NotShown { refusal: Box::new(refusal), cause: Box::new(cause) },
    })
}

/// Tells where the page is, if this program makes pages.
fn leave(
    shown: &Path,
    label: &str,
    [expected, actual]: [&DynamicImage; 2],
    how: Match,
    values: Values,
) -> Result<Option<PathBuf>, GoldenError> {
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
    let folder = match PageFolder::check(shown, []) {
        Err(PageError::Unavailable) => return Ok(None),
        folder => folder?,
    };
    folder.write(label, |page| {
        let (comparison, maps) = compare(label, [expected, actual], how, None);
        page.add(0, &comparison, Sides { expected: Some(expected), actual: Some(actual), values }, maps.as_ref())
    })?;
    Ok(Some(folder.index()))
}

/// `text` with everything but letters, digits and `.`, `-`, `_` replaced.
pub fn file_name(text: &str) -> String {
    text.chars().map(|c| if c.is_alphanumeric() || ".-_".contains(c) { c } else { '_' }).collect()
}
