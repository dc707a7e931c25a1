//! The command `golden compare`: compares pictures of any renderer.

use std::io;
use std::ops::RangeInclusive;
use std::path::{Path, PathBuf};

use anyhow::Context;
use rayon::prelude::*;

use super::{Outputs, VERDICTS, tally};
use crate::cli::progress::spinner;
use crate::cli::terminal::Terminal;
use crate::escaped::Escaped as _;
use crate::golden::measures::PIXELS_PER_DEGREE;
use crate::golden::page::{Page, PicturePair, Values};
use crate::golden::{self, Allowed, Comparison, Mask, Match, Pair, Verdict, pairs, read};
use crate::report::number::{count, plural};
use crate::report::{Cell, Table, Tone};
use crate::study::Status;

const TOLERANCE: &str = "Tolerance";

const STATUSES: &str = "Exit status: 0 if all pictures are accepted; 2 if a picture differs; 1 if a picture exists in \
                        only one of the folders or is unreadable.";

#[derive(Debug, clap::Args)]
#[command(after_help = STATUSES)]
pub struct Args {
    /// Reference picture (PNG; also JPEG, WebP and EXR if installed with `--features pictures`), or a folder
    expected: PathBuf,
    /// Picture to compare with it, or a folder of pictures with the same names
    actual: PathBuf,
    /// Accept differences of at most N per channel, in 1/255 of full scale at any bit depth; in floating-point
    /// pictures, in units of the stored values [default: 0]
    #[arg(long, help_heading = TOLERANCE, value_name = "N", value_parser = within(0.0..=f64::MAX, "give a number of at least 0"), allow_negative_numbers = true)]
    max_difference: Option<f64>,
    /// Accept N pixels, or P percent of the pixels, that differ by more than --max-difference
    #[arg(long, help_heading = TOLERANCE, value_name = "N|P%", value_parser = allowed)]
    allow_pixels: Option<Allowed>,
    /// Instead of --max-difference and --allow-pixels: accept a mean FLIP error (visible differences) of at most X,
    /// from 0 to 1
    #[arg(long, help_heading = TOLERANCE, value_name = "X", value_parser = within(0.0..=1.0, "give a number from 0 to 1"), conflicts_with_all = ["max_difference", "allow_pixels"],
        allow_negative_numbers = true)]
    max_flip: Option<f64>,
    /// Pixels per degree of visual angle for --max-flip [default: 67, a 0.7 m screen of 3840 pixels seen from 0.7 m]
    #[arg(long, help_heading = TOLERANCE, value_name = "N", value_parser = within(1.0..=1000.0, "give a number from 1 to 1000"), requires = "max_flip", allow_negative_numbers = true)]
    pixels_per_degree: Option<f64>,
    /// Picture of the same size whose black pixels are not compared
    #[arg(long, help_heading = TOLERANCE, value_name = "M.png")]
    mask: Option<PathBuf>,
    #[command(flatten)]
    outputs: Outputs,
}

fn within(range: RangeInclusive<f64>, advice: &'static str) -> impl Fn(&str) -> Result<f64, &'static str> + Clone {
    move |text: &str| text.parse().ok().filter(|number| range.contains(number)).ok_or(advice)
}

fn allowed(text: &str) -> Result<Allowed, &'static str> {
    let number = match text.strip_suffix('%') {
        Some(percent) => percent.parse().ok().filter(|percent| (0.0..=100.0).contains(percent)).map(Allowed::Percent),
        None => text.parse().ok().map(Allowed::Pixels),
    };
    number.ok_or("give a number of pixels, such as 20, or of percent, such as 0.1%")
}

impl Args {
    fn how(&self) -> Match {
        match (self.max_flip, self.max_difference, self.allow_pixels) {
            (Some(mean), ..) => {
                Match::Flip { mean, pixels_per_degree: self.pixels_per_degree.unwrap_or(PIXELS_PER_DEGREE) }
            }
            (None, None, None) => Match::Exact,
            (None, difference, pixels) => {
                Match::Tolerance { difference: difference.unwrap_or(0.0), pixels: pixels.unwrap_or(Allowed::Pixels(0)) }
            }
        }
    }

    fn pairs(&self) -> anyhow::Result<Vec<Pair>> {
        let [expected, actual] = [&self.expected, &self.actual];
        if let Some(missing) = [expected, actual].into_iter().find(|path| !path.exists()) {
            anyhow::bail!("there is no {}: name two folders or two pictures", missing.escaped());
        }
        let both = format!("{} and {}", expected.escaped(), actual.escaped());
        match (expected.is_dir(), actual.is_dir()) {
            (true, true) => {
                let pairs = pairs(expected, actual).with_context(|| format!("cannot read {both}"))?;
                anyhow::ensure!(!pairs.is_empty(), "{both} contain no pictures: name folders with pictures");
                Ok(pairs)
            }
            (false, false) => {
                let name = actual.file_name().unwrap_or(actual.as_os_str()).into();
                Ok(vec![Pair { name, expected: Some(expected.clone()), actual: Some(actual.clone()) }])
            }
            _ => anyhow::bail!("{both} are a folder and a file: name two folders or two pictures"),
        }
    }
}

pub fn run(args: &Args, terminal: &Terminal) -> anyhow::Result<Status> {
    let pairs = args.pairs()?;
    let inputs = pairs.iter().flat_map(|pair| pair.expected.iter().chain(&pair.actual)).chain(&args.mask);
    let outputs = args.outputs.check(inputs.map(PathBuf::as_path))?;
    if let Some(page) = &args.outputs.page {
        let contains_page = |folder: &&PathBuf| {
            let [page, folder] = [page, folder].map(std::path::absolute);
            page.is_ok_and(|page| folder.is_ok_and(|folder| page.starts_with(folder)))
        };
        if let Some(folder) = [&args.expected, &args.actual].into_iter().find(contains_page) {
            anyhow::bail!("the next comparison would include the page: choose a --page outside {}", folder.escaped());
        }
    }
    let mask = args.mask.as_deref().map(|path| read_mask(path, terminal)).transpose()?;
    let waiting = spinner("comparing pictures", terminal);
    let title = format!("{} compared with {}", args.actual.escaped(), args.expected.escaped());
    let comparisons = outputs.with_page(&title, |page| {
        let compared = pairs.par_iter().enumerate();
        compared.map(|(number, pair)| compare(number, pair, args, mask.as_ref(), page)).collect::<io::Result<Vec<_>>>()
    })?;
    drop(waiting);
    if let [Comparison { verdict: Verdict::Failed, said, .. }] = &comparisons[..] {
        anyhow::bail!("{}", said.join("; "));
    }

    let table = table(&comparisons);
    if !table.rows.is_empty() {
        terminal.print_table(&table);
    }
    let failures = comparisons.iter().filter(|own| own.fails());
    terminal.print_lines(failures.map(|own| format!("{}: {}", own.name, own.said.join("; "))));
    terminal.print(&format!("{}\n", tally(&comparisons)));
    outputs.export(&comparisons, terminal)?;
    Ok(match comparisons.iter().map(|own| own.verdict).min() {
        Some(Verdict::Differs) => Status::Wrong,
        Some(verdict) if verdict < Verdict::Accepted => Status::Failed,
        _ => Status::Right,
    })
}

fn read_mask(path: &Path, terminal: &Terminal) -> anyhow::Result<Mask> {
    let mask = Mask::new(&read(path)?);
    let [masked, all] = [mask.masked_pixels(), mask.size.map(|side| side as usize).iter().product()];
    let path = path.escaped();
    anyhow::ensure!(masked < all, "the mask {path} is all black, so nothing would be compared: use another mask");
    let are = if masked == 1 { "is" } else { "are" };
    terminal.print(&format!("{path}: {} of {} {are} masked\n", count(masked as u64), plural(all, "pixel")));
    Ok(mask)
}

fn compare(
    number: usize,
    pair: &Pair,
    args: &Args,
    mask: Option<&Mask>,
    page: Option<&Page>,
) -> io::Result<Comparison> {
    let name = pair.name.escaped().to_string();
    let only = |verdict, [own, other]: [&Path; 2]| {
        Comparison::said(&name, verdict, format!("exists in {} but not in {}", own.escaped(), other.escaped()))
    };
    let pictures = [&pair.expected, &pair.actual].map(|path| path.as_deref().map(read).transpose());
    let unreadable = pictures.iter().filter_map(|picture| picture.as_ref().err()).next_back();
    let [expected, actual] = pictures.each_ref().map(|picture| picture.as_ref().ok()?.as_ref());
    let [wanted, found] = [&args.expected, &args.actual].map(PathBuf::as_path);
    let (comparison, maps) = match (expected, actual, unreadable) {
        (_, _, Some(cause)) => (Comparison::said(&name, Verdict::Failed, cause.to_string()), None),
        (Some(expected), Some(actual), None) => golden::compare(&name, [expected, actual], args.how(), mask),
        (Some(_), None, None) => (only(Verdict::Missing, [wanted, found]), None),
        (None, _, None) => (only(Verdict::Additional, [found, wanted]), None),
    };
    if let Some(page) = page {
        page.add(number, &comparison, PicturePair { expected, actual, values: Values::Colours }, maps.as_ref())?;
    }
    Ok(comparison)
}

fn table(comparisons: &[Comparison]) -> Table {
    let rows = comparisons.iter().filter(|own| own.verdict != Verdict::Identical);
    let known = |own: &Comparison, of: fn(&golden::measures::Measures) -> Cell| {
        own.measures.as_ref().map_or(Cell::default(), of)
    };
    let flip = |own: &Comparison, of: fn(&golden::measures::Flip) -> f64| {
        own.measures.and_then(|own| own.flip).map_or(Cell::default(), |flip| of(&flip).into())
    };
    Table::of(
        "",
        rows,
        &[
            ("picture", &|own: &&Comparison| (&own.name).into()),
            ("verdict", &|own| verdict(own)),
            ("pixels", &|own| known(own, |own| own.difference.pixels.into())),
            ("over", &|own| known(own, |own| own.pixels_over.into())),
            ("largest", &|own| known(own, |own| own.difference.largest.into())),
            ("mean", &|own| known(own, |own| own.mean.into())),
            ("PSNR", &|own| known(own, |own| own.psnr.into())),
            ("SSIM", &|own| known(own, |own| own.ssim.map_or(Cell::default(), |ssim| format!("{ssim:.5}").into()))),
            ("FLIP", &|own| flip(own, |flip| flip.mean)),
            ("FLIP 95 %", &|own| flip(own, |flip| flip.percentile_95)),
            ("FLIP max", &|own| flip(own, |flip| flip.largest)),
        ],
    )
    .without_empty_columns()
}

fn verdict(own: &Comparison) -> Cell {
    let name = VERDICTS.iter().find(|(verdict, ..)| *verdict == own.verdict).map_or("", |(_, name, _)| name);
    Cell::from(name).with(if own.fails() { Tone::Wrong } else { Tone::Plain })
}
