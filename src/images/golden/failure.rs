//! Compares a picture with a golden image. A page shows each rejected picture.

use std::fs;
use std::path::{Path, PathBuf};

use image::DynamicImage;

use super::comparison::{Verdict, compare};
use super::measures::Measures;
use super::page::{self, PicturePair, Values};
use super::rule::{Match, NoFlip};
use super::{GoldenError, Layout, PictureError};
use crate::output::OutputFolder;

/// `path` appears only in messages. `shown` is the folder of the page.
pub fn check(
    path: &Path,
    label: &str,
    pictures @ [expected, actual]: [&DynamicImage; 2],
    how: Match,
    values: Values,
    shown: &Path,
    remedy: &'static str,
) -> Result<(), GoldenError> {
    let [wanted, found] = pictures.map(Layout::of);
    // The check of a tolerance does not need the slow measures FLIP and SSIM.
    let is_tolerance = matches!(how, Match::Tolerance { .. }) && wanted == found;
    if is_tolerance && how.limit(pictures, None, None).is_some_and(|limit| limit.is_met()) {
        return Ok(());
    }
    let (comparison, maps) = compare(label, pictures, how, None);
    let (path, index) = (path.to_path_buf(), page::index(shown));
    let refusal = match (comparison.verdict, comparison.measures) {
        (Verdict::Identical | Verdict::Accepted, _) => return Ok(()),
        (Verdict::Failed, _) => return Err(NoFlip.into()),
        (_, Some(Measures { difference, .. })) => {
            let (said, difference) = (comparison.said.join("; "), Box::new(difference));
            GoldenError::Differs { label: label.into(), path, said, difference, shown: index }
        }
        _ => GoldenError::Layout { path, expected: wanted, found, shown: index, remedy },
    };
    let leave = || -> Result<(), PictureError> {
        let folder = shown.parent().unwrap_or(shown);
        fs::create_dir_all(folder).map_err(|cause| PictureError::Directory { path: folder.into(), cause })?;
        Ok(page::write(&OutputFolder::check(shown)?, label, |page| {
            page.add(
                0,
                &comparison,
                PicturePair { expected: Some(expected), actual: Some(actual), values },
                maps.as_ref(),
            )
        })?)
    };
    Err(match leave() {
        Ok(()) => refusal,
        Err(cause) => GoldenError::NotShown { refusal: Box::new(refusal), cause: Box::new(cause.into()) },
    })
}

pub fn folder(out: &Path, name: &str) -> PathBuf {
    out.join(name.chars().map(|c| if c.is_alphanumeric() || ".-_".contains(c) { c } else { '_' }).collect::<String>())
}
