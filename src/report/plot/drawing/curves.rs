//! Draws curves.

use plotters::series::LineSeries;
use plotters::style::Color;

use super::axes::{legend, legend_height, log_log, padded};
use super::canvas::{Area, DrawResult};
use super::palette::colours;
use crate::report::plot::curves::Curves;

impl Curves {
    fn names(&self) -> Vec<String> {
        self.lines.iter().map(|line| format!("{} {}", line.label, line.note).trim_end().to_owned()).collect()
    }

    /// Height of a drawing of this width.
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
