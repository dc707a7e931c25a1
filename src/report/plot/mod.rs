//! Plots: panels of points on two logarithmic axes, as SVG and as PNG, the same picture; bars, curves and stacked factors
//! as SVG of the width that is asked for, so that text keeps its size on a narrow screen.
//!
//! Pictures are drawn at twice their own units, so that they are sharp where they are shown smaller.

mod bars;
mod canvas;
mod chart;
mod curves;
mod labels;
pub mod palette;
mod panel;
mod scale;
mod scatter;
mod stack;

use canvas::{Canvas, WIDTH};
use palette::{INK, colours};

use crate::escaped::Escaped as _;

pub use bars::{Bar, BarGroup, Bars};
pub use chart::Chart;
pub use curves::{CurvePoint, Curves, Line, Mark};
pub use scale::{Scale, plain as tick_text};
pub use scatter::{Scatter, ScatterCase, ScatterPoint};
pub use stack::{Stack, StackRow};

/// A picture of panels, one below the other, with one legend.
#[derive(Clone, Debug, PartialEq)]
pub struct Figure {
    pub panels: Vec<Panel>,
    /// The colours: names of the groups that points belong to.
    pub groups: Vec<String>,
    /// Lines at the foot.
    pub notes: Vec<String>,
}

/// Points on two logarithmic axes.
#[derive(Clone, Debug, PartialEq)]
pub struct Panel {
    pub title: String,
    pub x_title: String,
    pub y_title: String,
    pub points: Vec<Point>,
}

/// A point with a label.
#[derive(Clone, Debug, PartialEq)]
pub struct Point {
    /// Positive and finite.
    pub x: f64,
    /// Positive and finite, at most 1: a share.
    pub y: f64,
    /// Whether nothing but an upper bound is known of `y`: then an arrow points down from it.
    pub is_bound: bool,
    /// Whether no other point is better in both: these are filled, and a line joins them.
    pub is_front: bool,
    pub label: String,
    /// Index into the groups of the figure.
    pub group: usize,
}

/// A form in which a figure can be had.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Format {
    Svg,
    Png,
}

/// What the ending of a file name does not tell.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("cannot plot to {0}: name a file that ends in .svg or .png")]
pub struct UnknownFormat(String);

impl Format {
    /// The form that the ending of a file name asks for.
    ///
    /// # Errors
    /// If it is neither `.svg` nor `.png`. Standard output, `-`, gets SVG.
    pub fn of(path: &std::path::Path) -> Result<Self, UnknownFormat> {
        if path == std::path::Path::new(crate::output::STDOUT) {
            return Ok(Self::Svg);
        }
        let ending = path.extension().map(|ending| ending.to_ascii_lowercase());
        match ending.as_deref().and_then(|ending| ending.to_str()) {
            Some("svg") => Ok(Self::Svg),
            Some("png") => Ok(Self::Png),
            _ => Err(UnknownFormat(path.escaped().to_string())),
        }
    }
}

/// Points of a panel that are all labelled; where there are more, those of the front alone are.
pub const LABELLED: usize = 20;

/// Height of a line of the legend, and of each note.
const LEGEND: f64 = 30.0;
const NOTE: f64 = 20.0;
const MARGIN: f64 = 12.0;

impl Figure {
    /// The bytes of a file of this form; the same for the same figure.
    pub fn bytes(&self, format: Format) -> Vec<u8> {
        let size = [WIDTH, self.height()];
        match format {
            Format::Svg => canvas::svg(size, |canvas| self.draw(canvas)).into_bytes(),
            Format::Png => canvas::png(size, |canvas| self.draw(canvas)),
        }
    }

    fn height(&self) -> f64 {
        self.panels.len() as f64 * panel::HEIGHT + self.foot() + self.notes.len() as f64 * NOTE + 2.0 * MARGIN
    }

    /// Where a dot and a name stand for each group.
    fn legend(&self) -> Vec<[f64; 2]> {
        let widths = self.groups.iter().map(|name| 18.0 + canvas::width_of(name, canvas::BODY));
        labels::legend(widths, 24.0, WIDTH - panel::LEFT - MARGIN, LEGEND)
    }

    /// Height of the legend.
    fn foot(&self) -> f64 {
        self.legend().last().map_or(LEGEND, |[_, y]| y + LEGEND * 0.5)
    }

    fn draw(&self, canvas: &Canvas) {
        let (mut top, colours) = (MARGIN, colours(&self.groups));
        for panel in &self.panels {
            panel::draw(panel, &colours, canvas, top);
            top += panel::HEIGHT;
        }
        for (group, ([x, y], name)) in self.legend().into_iter().zip(&self.groups).enumerate() {
            let (x, y) = (panel::LEFT + x, top + y);
            canvas.dot([x + 6.0, y], 6.0, colours[group], true);
            canvas.text(name, [x + 18.0, y], canvas::BODY, colours[group], canvas::Side::Left);
        }
        for (row, note) in self.notes.iter().enumerate() {
            let y = top + self.foot() + (row as f64 + 0.5) * NOTE;
            canvas.text(note, [panel::LEFT, y], canvas::SMALL, INK.light, canvas::Side::Left);
        }
    }
}

#[cfg(test)]
mod tests;
