//! Writes the pictures of a failed comparison.

use std::fs;
use std::path::{Path, PathBuf};

use image::DynamicImage;

use super::comparison::compare;
use super::judgement::{Judgement, Match};
use super::page::{self, Sides, Values};
use super::{GoldenError, Layout, PictureError};
use crate::output::OutputFolder;

/// Checks whether `actual` is accepted as a replacement of `expected`, which is the golden image `path`. If not, writes
/// a page with pictures to the folder `shown`.
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
    let refusal = if found == wanted {
        match Judgement::new([expected, actual], how, None)? {
            Some(judged) if !judged.accepted => {
                let (said, difference) = (judged.said().join("; "), Box::new(judged.difference));
                GoldenError::Differs { label: label.into(), path, said, difference, shown: page::index(shown) }
            }
            _ => return Ok(()),
        }
    } else {
        GoldenError::Layout { path, expected: wanted, found, shown: page::index(shown), remedy }
    };
    let leave = || -> Result<(), PictureError> {
        let folder = shown.parent().unwrap_or(shown);
        fs::create_dir_all(folder).map_err(|cause| PictureError::Directory { path: folder.into(), cause })?;
        Ok(page::write(&OutputFolder::check(shown)?, label, |page| {
            let (comparison, maps) = compare(label, [expected, actual], how, None);
            page.add(0, &comparison, Sides { expected: Some(expected), actual: Some(actual), values }, maps.as_ref())
        })?)
    };
    // The difference stays the error if its pictures cannot be written.
    Err(match leave() {
        Ok(()) => refusal,
        Err(cause) => GoldenError::NotShown { refusal: Box::new(refusal), cause: Box::new(cause.into()) },
    })
}

/// The folder in `out` for `name`, with everything except letters, digits and `.`, `-`, `_` replaced.
pub fn folder(out: &Path, name: &str) -> PathBuf {
    out.join(name.chars().map(|c| if c.is_alphanumeric() || ".-_".contains(c) { c } else { '_' }).collect::<String>())
}
