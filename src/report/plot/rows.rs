//! Rows of horizontal bars with their names and intervals, over a logarithmic axis.

use plotters::chart::ChartContext;
use plotters::coord::cartesian::Cartesian2d;
use plotters::coord::combinators::{BindKeyPoints, WithKeyPoints};
use plotters::coord::types::RangedCoordf64;
use plotters::element::Rectangle;
use plotters::prelude::DrawingBackend;
use plotters::style::Color;
use plotters::style::text_anchor::HPos;

use super::axes::{self, GAP, Labels, LogAxis, axes, tick_text};
use super::canvas::{Area, Canvas, DrawResult, Place, TEXT, widest, width_of};
use super::palette::{Colour, INK, MIDDLE};
use crate::measure::Estimate;
use crate::report::number::figures;

/// Room for the number at the end of the longest bar.
const NUMBER: i32 = 124;

/// How rows are laid out.
pub struct Rows<'a> {
    labels: &'a [String],
    /// Height of a row without a label above it, and of its bar.
    row: i32,
    bar: i32,
    /// Room for labels to the left of the bars; none where each stands above its bar.
    pub left: i32,
}

impl<'a> Rows<'a> {
    /// Rows of a drawing `width` wide. Labels stand above the bars where beside them they would leave the bars less than
    /// half of it.
    pub fn new(labels: &'a [String], [row, bar]: [i32; 2], width: i32) -> Self {
        let beside = widest(labels) + GAP + 6;
        Self { labels, row, bar, left: if beside > width / 2 { 0 } else { beside } }
    }

    /// Height of a row with its label, where that is above the bar.
    fn step(&self) -> i32 {
        if self.left == 0 { self.row + TEXT + 2 } else { self.row }
    }

    /// Height of all rows.
    pub fn height(&self) -> i32 {
        self.labels.len() as i32 * self.step()
    }

    /// Where the middle of a bar is, from the top of the rows.
    fn middle(&self, row: usize) -> i32 {
        (row as i32 + 1) * self.step() - self.row / 2
    }

    /// Axes from `ends[0]` to `ends[1]`, in an area `width` wide, with a line at `reference`, where bars begin.
    pub fn axes<'c, B: DrawingBackend>(
        &'c self,
        canvas: &'c Canvas<B>,
        area: &Area<B>,
        [low, reference, high]: [f64; 3],
        (left, top, x_title): (i32, i32, &str),
    ) -> DrawResult<B, RowAxes<'c, B>> {
        let x = axes::across([low, high], area.dim_in_pixel().0 as i32 - left - NUMBER);
        let middles = (0..self.labels.len()).map(|row| f64::from(self.middle(row))).collect();
        let y = (f64::from(self.height())..0.0).with_key_points(middles);
        let label = |at: &f64| self.labels[(*at as i32 / self.step()) as usize].clone();
        let labels = Labels { x_title, y_title: "", x: &|x| tick_text(*x), y: &label, left, top, right: NUMBER };
        let chart = axes(area, (x, y), &labels)?;
        let axes = RowAxes { rows: self, canvas, chart, reference };
        canvas.line(&[axes.place(reference, 0), axes.place(reference, self.height())], MIDDLE.light, 3)?;
        if self.left == 0 {
            for (row, label) in self.labels.iter().enumerate() {
                let place = axes.place(low, self.middle(row) - self.row / 2 - 6);
                canvas.text(label, place, INK.light, HPos::Left)?;
            }
        }
        Ok(axes)
    }
}

/// Where bars are drawn.
pub struct RowAxes<'a, B: DrawingBackend> {
    rows: &'a Rows<'a>,
    canvas: &'a Canvas<B>,
    chart: ChartContext<'a, B, Cartesian2d<LogAxis, WithKeyPoints<RangedCoordf64>>>,
    reference: f64,
}

impl<B: DrawingBackend> RowAxes<'_, B> {
    fn place(&self, value: f64, y: i32) -> Place {
        self.chart.backend_coord(&(value, f64::from(y)))
    }

    /// A bar between two values. Gives its corners.
    pub fn bar(&self, row: usize, [from, to]: [f64; 2], colour: Colour) -> DrawResult<B, [Place; 2]> {
        let (middle, half) = (self.rows.middle(row), self.rows.bar / 2);
        let corners = [self.place(from.min(to), middle - half), self.place(from.max(to), middle + half)];
        self.canvas.area.draw(&Rectangle::new(corners, colour.filled()))?;
        Ok(corners)
    }

    /// A text on a bar or in its place.
    pub fn text(&self, row: usize, (value, dx): (f64, i32), text: &str, colour: Colour, side: HPos) -> DrawResult<B> {
        let (x, y) = self.place(value, self.rows.middle(row));
        self.canvas.text(text, (x + dx, y), colour, side)
    }

    /// The interval of a value, `below` the middle of its row, and the value behind it and behind `end`, the value at which
    /// bars end; `told` to a pointer at the row.
    pub fn value(&self, row: usize, value: Estimate, below: i32, end: f64, told: String) -> DrawResult<B> {
        let ends = self.chart.x_range();
        let y = self.rows.middle(row);
        let [left, right] = [ends.start, ends.end].map(|value| self.place(value, y).0);
        let [low, high] = [value.low(), value.high()].map(|end| end.unwrap_or(value.estimate));
        if value.interval.is_some() {
            let ends = [low, high].map(|end| self.place(end, y + below));
            self.canvas.whisker(ends, INK.light, [left, right])?;
        }
        let furthest = end.max(high).max(self.reference).min(ends.end);
        let number = figures(value.estimate);
        self.text(row, (furthest, 14), &number, INK.light, HPos::Left)?;
        let x = self.place(furthest, y).0 + 14 + width_of(&number, TEXT);
        let half = self.rows.row / 2;
        self.canvas.tip((left, y - half), (x, y + half), told);
        Ok(())
    }
}

/// Ends of an axis that hold the intervals as well, unless these are so wide that nothing else would be seen.
pub fn with_intervals([low, high]: [f64; 2], values: impl Iterator<Item = Estimate>) -> [f64; 2] {
    let room = libm::sqrt(high / low).max(1.5);
    let intervals = values.filter_map(|value| value.interval);
    let held = intervals.fold([low, high], |[low, high], i| [low.min(i.low), high.max(i.high)]);
    [held[0].max(low / room), held[1].min(high * room)]
}
