//! Draws curves.

use plotters::prelude::DrawingBackend;
use plotters::series::LineSeries;
use plotters::style::Color;

use super::axes::{GAP, height_with_legend, legend, log_log, padded};
use super::canvas::{Area, DrawResult};
use super::palette::{Colour, colours};
use crate::report::plot::curves::{Curves, Line};

impl Curves {
    /// The indices of the lines from the one that ends highest on, as their names follow each other.
    fn order(&self) -> Vec<usize> {
        let end = |&i: &usize| self.lines[i].points.last().map_or(0.0, |(_, y)| *y);
        let mut order: Vec<usize> = (0..self.lines.len()).collect();
        order.sort_by(|a, b| end(b).total_cmp(&end(a)));
        order
    }

    /// The names of the lines, in the order in which they stand.
    fn names(&self) -> Vec<String> {
        let name = |line: &Line| format!("{} {}", line.label, line.note).trim_end().to_owned();
        self.order().into_iter().map(|i| name(&self.lines[i])).collect()
    }

    /// Height of the drawing where it is `width` wide.
    pub fn height(&self, width: i32) -> i32 {
        height_with_legend((4 * width / 5).min(860), &self.names(), width)
    }

    pub fn draw<B: DrawingBackend>(&self, area: &Area<B>) -> DrawResult<B> {
        let labels: Vec<String> = self.lines.iter().map(|line| line.label.clone()).collect();
        let colours = colours(&labels);
        let ordered: Vec<Colour> = self.order().into_iter().map(|i| colours[i]).collect();
        let area = legend(area, &self.names(), &ordered)?;
        let points = || self.lines.iter().flat_map(|line| &line.points);
        let ends = [padded(points().map(|(x, _)| *x), [0.02; 2]), padded(points().map(|(_, y)| *y), [0.08; 2])];
        let mut axes = log_log(&area, GAP, [&self.x_title, &self.y_title], ends)?;
        for (line, &colour) in self.lines.iter().zip(&colours) {
            let style = colour.filled().stroke_width(4);
            axes.draw_series(LineSeries::new(line.points.iter().copied(), style).point_size(6))?;
        }
        Ok(())
    }
}
