//! Draws charts as SVG with the crate `plotters`.

mod axes;
mod bars;
mod canvas;
pub mod palette;
mod scatter;
#[cfg(test)]
mod tests;

use plotters::drawing::IntoDrawingArea;
use plotters::prelude::SVGBackend;
use plotters::series::LineSeries;
use plotters::style::Color;

use crate::report::plot::chart::{Chart, Curves};
pub use axes::tick_text;
use axes::{legend, legend_height, log_log, padded};
use canvas::{Area, DrawResult, register};
use palette::{PAPER, colours};

const DRAWN: &str = "drawing into memory cannot fail, and the font is registered";

impl Chart {
    /// Width and height in pixels. The parameter `width` is in units of two pixels.
    fn size(&self, width: f64) -> (u32, u32) {
        // The labels between the points of a scatter plot need this width.
        let width = if matches!(self, Self::Scatter(_)) { 800.0 } else { width };
        let width = (2.0 * width).round() as i32;
        let height = match self {
            Self::Bars(bars) => bars.height(width),
            Self::Curves(curves) => curves.height(width),
            Self::Scatter(scatter) => scatter.height(width),
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
        }
        area.present()
    }

    /// The text of an SVG file. `width` is in units of two pixels. Scatter plots ignore `width`.
    pub fn svg(&self, width: f64) -> String {
        let mut text = String::new();
        self.draw(&SVGBackend::with_string(&mut text, self.size(width)).into_drawing_area()).expect(DRAWN);
        text
    }
}

impl Curves {
    fn names(&self) -> Vec<String> {
        self.lines.iter().map(|line| format!("{} {}", line.label, line.note).trim_end().to_owned()).collect()
    }

    pub fn height(&self, width: i32) -> i32 {
        (4 * width / 5).min(860) + legend_height(&self.names())
    }

    pub fn draw(&self, area: &Area) -> DrawResult {
        let labels: Vec<String> = self.lines.iter().map(|line| line.label.clone()).collect();
        let colours = colours(&labels);
        let area = legend(area, &self.names(), &colours)?;
        let points = || self.lines.iter().flat_map(|line| &line.points);
        let ends = [padded(points().map(|(x, _)| *x), [0.02; 2]), padded(points().map(|(_, y)| *y), [0.08; 2])];
        let mut axes = log_log(&area, [&self.x_title, &self.y_title], ends)?;
        for (line, &colour) in self.lines.iter().zip(&colours) {
            let style = colour.filled().stroke_width(4);
            axes.draw_series(LineSeries::new(line.points.iter().copied(), style).point_size(6))?;
        }
        Ok(())
    }
}
