//! A page of comparisons: pictures one upon the other, their differences and the values of their pixels.

mod side;

use std::fs;
use std::io;
use std::path::{Path, PathBuf};
use std::sync::{Mutex, PoisonError};

use image::{DynamicImage, RgbImage};
use minijinja::value::Serde;
use minijinja::{AutoEscape, Environment, UndefinedBehavior, Value, context};
use serde::Serialize;

use super::comparison::{Comparison, Maps};
use super::judgement::Verdict;
use super::measures::Measures;
use super::sides::{PageError, Sides};
use crate::output::OutputFolder;
use crate::render::{from_pixels, ramp_colour};
use side::{shown, values};

const INDEX: &str = "index.html";

/// A page that is being written: comparisons may be added in any order and by several threads.
pub struct Page<'a> {
    folder: &'a Path,
    entries: Mutex<Vec<Entry>>,
}

/// A comparison as the template sees it.
#[derive(Clone, Debug, Serialize)]
struct Entry {
    /// Its place in the order in which things were compared; names its files.
    number: usize,
    #[serde(flatten)]
    comparison: Comparison,
    fails: bool,
    size: [u32; 2],
    worst: [u32; 2],
    maps: Vec<Map>,
    /// A script with the values of the pixels.
    values: Option<String>,
    numbers: Vec<(&'static str, String)>,
}

#[derive(Clone, Debug, Serialize)]
struct Map {
    name: &'static str,
    file: String,
}

/// A folder for a page, which is empty, not there, or has a page of before.
#[derive(Clone, Debug)]
pub struct PageFolder(OutputFolder);

impl PageFolder {
    /// # Errors
    /// If something else is there, or one of `inputs`, the pictures that are compared.
    pub fn check<'a>(path: &Path, inputs: impl IntoIterator<Item = &'a Path>) -> Result<Self, PageError> {
        Ok(Self(OutputFolder::check(path)?.apart_from(inputs)?))
    }

    /// The file that a browser opens.
    pub fn index(&self) -> PathBuf {
        self.0.path().join(INDEX)
    }

    /// Writes a page, to which `fill` adds comparisons.
    ///
    /// # Errors
    /// If it cannot be written.
    pub fn write<T>(&self, title: &str, fill: impl FnOnce(&Page) -> io::Result<T>) -> Result<T, PageError> {
        Ok(self.0.write_in(|folder| {
            fs::create_dir(folder.join("pictures"))?;
            let page = Page { folder, entries: Mutex::default() };
            let filled = fill(&page)?;
            let entries = page.entries.into_inner().unwrap_or_else(PoisonError::into_inner);
            fs::write(folder.join(INDEX), html(title, entries))?;
            Ok(filled)
        })?)
    }
}

impl Page<'_> {
    /// Adds a comparison with its pictures. Of pictures that are equal one is shown.
    pub fn add(&self, number: usize, comparison: &Comparison, sides: Sides, maps: Option<&Maps>) -> io::Result<()> {
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
        for (name, picture) in [("expected", sides.expected), ("actual", sides.actual.filter(|_| !is_identical))] {
            picture.map_or(Ok(()), |picture| add(name, &shown(picture, sides.values)))?;
        }
        if let Some(maps) = maps {
            add("difference", &maps.difference.clone().into())?;
            let flip = maps.flip.as_ref();
            flip.map_or(Ok(()), |map| add("FLIP", &flip_picture(map.size, &map.values).into()))?;
        }
        let mut script = None;
        if !is_identical {
            let file = format!("pictures/{number}-values.js");
            fs::write(self.folder.join(&file), values(number, sides))?;
            script = Some(file);
        }
        let entry = Entry {
            number,
            fails: comparison.fails(),
            size,
            worst: comparison.measures.map_or([0, 0], |measures| measures.difference.worst),
            maps: files,
            values: script,
            numbers: comparison.measures.as_ref().map(numbers).unwrap_or_default(),
            comparison: comparison.clone(),
        };
        self.entries.lock().unwrap_or_else(PoisonError::into_inner).push(entry);
        Ok(())
    }
}

fn flip_picture(size: [u32; 2], values: &[f32]) -> RgbImage {
    from_pixels(size, values.iter().map(|&value| ramp_colour(value.into())).collect())
}

/// The measures with their names.
fn numbers(measures: &Measures) -> Vec<(&'static str, String)> {
    let Measures { compared, masked, difference, pixels_over, mean, psnr, ssim, flip } = measures;
    let four = |x: f64| format!("{x:.4}");
    let mut numbers = vec![
        ("pixels that differ", format!("{} of {compared}", difference.pixels)),
        ("largest difference", format!("{} of {}", difference.largest, difference.full_scale)),
        ("mean difference", four(*mean)),
        ("pixels over the tolerance", pixels_over.to_string()),
        ("PSNR", format!("{psnr:.2} dB")),
    ];
    numbers.extend((*masked > 0).then(|| ("masked pixels", masked.to_string())));
    numbers.extend(ssim.map(|ssim| ("SSIM", format!("{ssim:.5}"))));
    if let Some(flip) = flip {
        numbers.extend([
            ("FLIP, mean", four(flip.mean)),
            ("FLIP, 95th percentile", four(flip.percentile_95)),
            ("FLIP, largest", four(flip.largest)),
        ]);
    }
    numbers
}

/// Failing comparisons first, all others in their order after them.
fn html(title: &str, mut entries: Vec<Entry>) -> String {
    entries.sort_by_key(|entry| (entry.comparison.verdict, entry.number));
    let mut environment = Environment::new();
    environment.set_auto_escape_callback(|_| AutoEscape::Html);
    environment.set_undefined_behavior(UndefinedBehavior::Strict);
    environment.add_template("page.html", include_str!("page.html")).expect(RENDERED);
    let template = environment.get_template("page.html").expect(RENDERED);
    let failing = entries.iter().filter(|entry| entry.fails).count();
    let page = context! {
        title => title,
        failing => failing,
        entries => Value::from(Serde(entries)),
        css => include_str!("page.css"),
        js => include_str!("page.js"),
        version => env!("CARGO_PKG_VERSION"),
    };
    template.render(page).expect(RENDERED)
}

const RENDERED: &str = "a test renders the template with all kinds of comparisons";
