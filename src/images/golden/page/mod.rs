//! Writes a page that shows comparisons of pictures.

#[cfg(feature = "page")]
mod html;
mod side;

use std::fs;
use std::io;
use std::path::{Path, PathBuf};
use std::sync::{Mutex, PoisonError};

use image::DynamicImage;
use serde::Serialize;

use super::comparison::{Comparison, Maps, Verdict};
use crate::output::{OutputError, OutputFolder};
use crate::render::{from_pixels, ramp_colour};
use side::{shown, values};

pub use side::{PicturePair, Values};

const INDEX: &str = "index.html";

pub struct Page<'a> {
    folder: &'a Path,
    entries: Mutex<Vec<Entry>>,
}

/// The template `page.html` reads these fields by name.
#[derive(Clone, Debug, Serialize)]
struct Entry {
    number: usize,
    #[serde(flatten)]
    comparison: Comparison,
    fails: bool,
    size: [u32; 2],
    worst: [u32; 2],
    maps: Vec<Map>,
    /// The file of a script with the values of the pixels.
    values: Option<String>,
}

#[derive(Clone, Debug, Serialize)]
struct Map {
    name: &'static str,
    file: String,
}

/// Writes a page and its pictures into a folder. Without the feature `page`, the folder contains no HTML.
///
/// # Errors
/// If the page or its pictures cannot be written.
pub fn write<T>(
    folder: &OutputFolder,
    title: &str,
    fill: impl FnOnce(&Page) -> io::Result<T>,
) -> Result<T, OutputError> {
    folder.write_in(|folder| {
        fs::create_dir(folder.join("pictures"))?;
        let page = Page { folder, entries: Mutex::default() };
        let filled = fill(&page)?;
        let entries = page.entries.into_inner().unwrap_or_else(PoisonError::into_inner);
        #[cfg(feature = "page")]
        fs::write(folder.join(INDEX), html::page(title, entries))?;
        #[cfg(not(feature = "page"))]
        drop((title, entries));
        Ok(filled)
    })
}

pub fn index(folder: &Path) -> PathBuf {
    if cfg!(feature = "page") { folder.join(INDEX) } else { folder.into() }
}

impl Page<'_> {
    /// `number` must be unique, because file names contain it. Threads may add comparisons in any order.
    pub fn add(
        &self,
        number: usize,
        comparison: &Comparison,
        sides: PicturePair,
        maps: Option<&Maps>,
    ) -> io::Result<()> {
        let first = sides.expected.or(sides.actual);
        let size = first.map_or([1, 1], |picture| [picture.width(), picture.height()]);
        let mut files: Vec<Map> = vec![];
        let mut add = |name: &'static str, picture: &DynamicImage| {
            let file = format!("pictures/{number}-{}.png", name.to_lowercase());
            let bytes = super::file::encode(picture, None).map_err(io::Error::other)?;
            files.push(Map { name, file: file.clone() });
            fs::write(self.folder.join(file), bytes)
        };
        let is_identical = comparison.verdict == Verdict::Identical;
        let actual = sides.actual.filter(|_| !is_identical);
        for (name, picture) in [("expected", sides.expected), ("actual", actual)] {
            picture.map_or(Ok(()), |picture| add(name, &shown(picture, sides.values)))?;
        }
        if let Some(maps) = maps {
            add("difference", &maps.difference.clone().into())?;
            // FLIP of primitive numbers has no meaning.
            if let Some(map) = maps.flip.as_ref().filter(|_| sides.values != Values::Primitives) {
                let colours = map.values.iter().map(|&value| ramp_colour(value.into())).collect();
                add("FLIP", &from_pixels(map.size, colours).into())?;
            }
        }
        let script = (files.len() > 1).then(|| format!("pictures/{number}-values.js"));
        script.as_ref().map_or(Ok(()), |file| fs::write(self.folder.join(file), values(number, sides)))?;
        let entry = Entry {
            number,
            fails: comparison.fails(),
            size,
            worst: comparison.measures.map_or([0, 0], |measures| measures.difference.worst),
            maps: files,
            values: script,
            comparison: comparison.clone(),
        };
        self.entries.lock().unwrap_or_else(PoisonError::into_inner).push(entry);
        Ok(())
    }
}
