//! All kinds of charts behind one name, as SVG and as PNG.

use std::path::Path;

use image::RgbImage;
use plotters::drawing::IntoDrawingArea;
use plotters::prelude::{BitMapBackend, DrawingBackend, SVGBackend};

use super::canvas::{Area, DrawResult, register};
use super::palette::PAPER;
use super::{Bars, Curves, Scatter, Tradeoff};
use crate::escaped::Escaped as _;
use crate::render::png;

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

/// Memory takes every stroke, and the font is there: nothing can fail.
const DRAWN: &str = "memory takes every stroke, and the font is registered";

impl Chart {
    /// Width and height in pixels where it is to be `width` wide.
    pub(super) fn size(&self, width: f64) -> (u32, u32) {
        let width = if matches!(self, Self::Scatter(_)) { 800.0 } else { width };
        let width = (2.0 * width).round() as i32;
        let height = match self {
            Self::Bars(bars) => bars.height(width),
            Self::Curves(curves) => curves.height(width),
            Self::Scatter(scatter) => scatter.height(width),
            Self::Tradeoff(tradeoff) => tradeoff.scatter().height(width),
        };
        (width as u32, height as u32)
    }

    fn draw<B: DrawingBackend>(&self, area: &Area<B>) -> DrawResult<B> {
        register();
        area.fill(&PAPER.light)?;
        match self {
            Self::Bars(bars) => bars.draw(area)?,
            Self::Curves(curves) => curves.draw(area)?,
            Self::Scatter(scatter) => scatter.draw(area)?,
            Self::Tradeoff(tradeoff) => tradeoff.scatter().draw(area)?,
        }
        area.present()
    }

    /// The text of an SVG file, `width` units wide if it can be; a unit is half as long as one of the file's view box.
    pub fn svg(&self, width: f64) -> String {
        let mut text = String::new();
        self.draw(&SVGBackend::with_string(&mut text, self.size(width)).into_drawing_area()).expect(DRAWN);
        text
    }

    /// The bytes of a PNG file of two pixels a unit.
    pub fn png(&self, width: f64) -> Vec<u8> {
        let (width, height) = self.size(width);
        let mut bytes = vec![255; width as usize * height as usize * 3];
        self.draw(&BitMapBackend::with_buffer(&mut bytes, (width, height)).into_drawing_area()).expect(DRAWN);
        png(&RgbImage::from_raw(width, height, bytes).expect("all pixels are there"))
    }
}
