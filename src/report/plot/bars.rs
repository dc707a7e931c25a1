//! Bars with intervals on one logarithmic axis: how many times faster.

use plotters::prelude::DrawingBackend;
use plotters::style::text_anchor::HPos;

use super::axes::BOTTOM_WITHOUT_TITLE;
use super::canvas::{Canvas, DrawResult, TEXT, width_of};
use super::palette::{INK, MIDDLE, colours};
use super::rows::{Rows, with_intervals};
use crate::measure::Estimate;
use crate::report::words::interval;

/// Groups of bars that share labels, order and axis.
#[derive(Clone, Debug, PartialEq)]
pub struct Bars {
    /// What the axis says.
    pub x_title: String,
    /// Bars begin here: the value of what others are compared with.
    pub reference: f64,
    /// Names of the bars of every group; structures have their colours.
    pub labels: Vec<String>,
    pub groups: Vec<BarGroup>,
}

/// Bars below one heading.
#[derive(Clone, Debug, PartialEq)]
pub struct BarGroup {
    pub title: String,
    /// One for each label.
    pub bars: Vec<Bar>,
}

/// One bar.
#[derive(Clone, Debug, PartialEq)]
pub enum Bar {
    /// Positive, and so are the ends of its interval.
    Of(Estimate),
    /// Why there is none, in a word or two; may be empty.
    Missing(String),
}

/// Height of a row and of its bar.
const ROW: [i32; 2] = [54, 30];

/// Height of the heading of a group.
const HEAD: i32 = 52;

/// Height of the title of the axis, below all groups.
const FOOT: i32 = 48;

/// Least width of a group, without the labels.
const GROUP: i32 = 380;

impl Bars {
    fn rows(&self, width: i32) -> Rows<'_> {
        Rows::new(&self.labels, ROW, width)
    }

    /// Height of the groups that stand side by side.
    fn line(&self, width: i32) -> i32 {
        HEAD + self.rows(width).height() + BOTTOM_WITHOUT_TITLE
    }

    /// Groups side by side.
    fn columns(&self, width: i32) -> usize {
        match self.rows(width).left {
            0 => 1,
            left => (((width - left) / GROUP) as usize).clamp(1, self.groups.len().max(1)),
        }
    }

    /// Height of the drawing where it is `width` wide.
    pub fn height(&self, width: i32) -> i32 {
        self.groups.len().div_ceil(self.columns(width)).max(1) as i32 * self.line(width) + FOOT
    }

    pub fn draw<B: DrawingBackend>(&self, canvas: &Canvas<B>, width: i32) -> DrawResult<B> {
        let (rows, columns, line) = (self.rows(width), self.columns(width), self.line(width));
        let column = (width - rows.left) / columns as i32;
        let across: Vec<i32> = (1..columns as i32).map(|i| rows.left + i * column).collect();
        let down: Vec<i32> = (1..=self.groups.len().div_ceil(columns) as i32).map(|i| i * line).collect();
        let cells = canvas.area.split_by_breakpoints(across, down);
        let colours = colours(&self.labels);
        let [low, high] = self.ends();
        for (i, (group, cell)) in self.groups.iter().zip(&cells).enumerate() {
            // Labels stand to the left of the first of the groups that are side by side.
            let left = if i % columns == 0 { rows.left } else { 0 };
            let (x, y) = cell.get_base_pixel();
            canvas.text(&group.title, (x + left, y + HEAD / 2), INK.light, HPos::Left)?;
            let axes = rows.axes(canvas, cell, [low, self.reference, high], (left, HEAD, ""))?;
            for (row, bar) in group.bars.iter().enumerate() {
                match bar {
                    Bar::Missing(why) => axes.text(row, (self.reference, 12), why, MIDDLE.light, HPos::Left)?,
                    Bar::Of(value) => {
                        axes.bar(row, [self.reference, value.estimate], colours[row])?;
                        let told = format!("{}, {}: {}", self.labels[row], group.title, interval(*value));
                        axes.value(row, *value, 0, value.estimate, told)?;
                    }
                }
            }
        }
        // Below all groups, in the middle unless it would leave the drawing.
        let half = width_of(&self.x_title, TEXT) / 2;
        let middle = ((width + rows.left) / 2).min(width - half).max(half);
        canvas.text(&self.x_title, (middle, self.height(width) - FOOT / 2), MIDDLE.light, HPos::Center)
    }

    /// Ends of the axis, the reference between them.
    fn ends(&self) -> [f64; 2] {
        let bars = self.groups.iter().flat_map(|group| &group.bars);
        let values = || bars.clone().filter_map(|bar| if let Bar::Of(value) = bar { Some(*value) } else { None });
        let estimates = values().map(|value| value.estimate);
        let [low, high] = estimates.fold([self.reference; 2], |[low, high], v| [low.min(v), high.max(v)]);
        with_intervals([low, high.max(1.5 * low)], values())
    }
}
