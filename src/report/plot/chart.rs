//! All kinds of charts behind one name.

use std::path::Path;

use super::{Bars, Curves, Scatter, Tradeoff};
use crate::escaped::Escaped as _;

/// Width of drawings that stand alone, in their units.
pub const WIDTH: f64 = 900.0;

#[derive(Clone, Debug, PartialEq)]
pub enum Chart {
    Bars(Bars),
    Curves(Curves),
    /// Always as wide as it is, 800: labels stand all over.
    Scatter(Scatter),
    Tradeoff(Tradeoff),
}

/// A form in which a chart can be had.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Format {
    Svg,
    Png,
}

impl Format {
    /// The form that the ending of a file name asks for. Standard output, `-`, gets SVG.
    pub fn of(path: &Path) -> anyhow::Result<Self> {
        let is = |ending: &str| path.extension().is_some_and(|own| own.eq_ignore_ascii_case(ending));
        match () {
            () if is("svg") || path == Path::new(crate::output::STDOUT) => Ok(Self::Svg),
            () if is("png") => Ok(Self::Png),
            () => anyhow::bail!("cannot plot to {}: name a file that ends in .svg or .png", path.escaped()),
        }
    }
}
