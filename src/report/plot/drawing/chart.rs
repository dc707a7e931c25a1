//! Draws a chart of any kind as SVG.

use plotters::drawing::IntoDrawingArea;
use plotters::prelude::SVGBackend;

use super::canvas::{Area, DrawResult, register};
use super::palette::PAPER;
use crate::report::plot::chart::Chart;

/// Drawing into memory with a registered font cannot fail.
const DRAWN: &str = "memory takes every stroke, and the font is registered";

impl Chart {
    /// Width and height in pixels for the requested `width`.
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

    fn draw(&self, area: &Area) -> DrawResult {
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

    /// The text of an SVG file, `width` units wide if possible; a unit is two units of the file's view box.
    pub fn svg(&self, width: f64) -> String {
        let mut text = String::new();
        self.draw(&SVGBackend::with_string(&mut text, self.size(width)).into_drawing_area()).expect(DRAWN);
        text
    }
}
