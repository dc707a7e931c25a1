//! Bars with intervals on one logarithmic axis: how many times faster.

use super::canvas::{self, Canvas, Side};
use super::labels::BarLabels;
use super::palette::{FAINT, INK, MIDDLE, colours};
use super::scale::{Axis, Scale};
use crate::measure::Estimate;
use crate::report::number::figures;
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

const ROW: f64 = 27.0;
const BAR: f64 = 15.0;
const HEAD: f64 = 30.0;
const FOOT: f64 = 34.0;

/// Least width of a group, without the labels.
const GROUP: f64 = 190.0;

impl Bars {
    /// Height of the drawing where it is `width` wide.
    pub(super) fn height(&self, width: f64) -> f64 {
        self.groups.len().div_ceil(self.columns(width)).max(1) as f64 * self.line(width) + 24.0
    }

    /// Height of the groups that stand side by side.
    fn line(&self, width: f64) -> f64 {
        HEAD + self.labels.len() as f64 * self.row(width) + FOOT
    }

    /// Height of a bar with what is above it.
    fn row(&self, width: f64) -> f64 {
        ROW + BarLabels::of(&self.labels, width).height()
    }

    /// Groups side by side.
    fn columns(&self, width: f64) -> usize {
        match BarLabels::of(&self.labels, width) {
            BarLabels::Above => 1,
            BarLabels::Beside(column) => (((width - column) / GROUP) as usize).clamp(1, self.groups.len().max(1)),
        }
    }

    pub(super) fn draw(&self, canvas: &Canvas, width: f64) {
        let (columns, line, height) = (self.columns(width), self.line(width), self.row(width));
        let labels = BarLabels::of(&self.labels, width);
        let left = labels.left();
        let column = (width - left) / columns as f64;
        let colours = colours(&self.labels);
        let ends = self.ends();
        for (i, group) in self.groups.iter().enumerate() {
            let x = left + (i % columns) as f64 * column;
            let top = (i / columns) as f64 * line;
            // Room for the number at the end of the longest bar.
            let axis = Axis::new(Scale::Log, ends, [x, x + column - 62.0]);
            canvas.text(&group.title, [x, top + 12.0], canvas::BODY, INK.light, Side::Left);
            let (above, below) = (top + HEAD - 4.0, top + line - FOOT);
            upright_ticks(canvas, axis, [above, below]);
            let zero = axis.place(self.reference);
            for (row, bar) in group.bars.iter().enumerate() {
                let y = top + HEAD + (row + 1) as f64 * height - ROW / 2.0;
                if labels == BarLabels::Above {
                    canvas.text(&self.labels[row], [x, y - ROW / 2.0 - 3.0], canvas::BODY, INK.light, Side::Left);
                } else if i % columns == 0 {
                    canvas.text(&self.labels[row], [left - 12.0, y], canvas::BODY, INK.light, Side::Right);
                }
                match bar {
                    Bar::Missing(why) => canvas.text(why, [zero + 6.0, y], canvas::SMALL, MIDDLE.light, Side::Left),
                    Bar::Of(value) => {
                        let at = axis.place(value.estimate);
                        canvas.rect([zero.min(at), y - BAR / 2.0], [zero.max(at), y + BAR / 2.0], colours[row]);
                        let end = zero.max(at).max(whisker(canvas, *value, axis, y)) + 7.0;
                        canvas.text(&figures(value.estimate), [end, y], canvas::SMALL, INK.light, Side::Left);
                        let told = format!("{}, {}: {}", self.labels[row], group.title, interval(*value));
                        canvas.tip([x, y - ROW / 2.0], [x + column - 4.0, y + ROW / 2.0], told);
                    }
                }
            }
            canvas.line(&[[zero, above], [zero, below]], MIDDLE.light, 1.5);
        }
        let middle = left + (width - left) * 0.5;
        let bottom = self.groups.len().div_ceil(columns) as f64 * line + 4.0;
        canvas.centred(&self.x_title, [middle, bottom], canvas::SMALL, MIDDLE.light, width);
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

/// A line from top to bottom for each tick of a horizontal axis, with its text below.
pub(super) fn upright_ticks(canvas: &Canvas, axis: Axis, [top, bottom]: [f64; 2]) {
    for (tick, text) in axis.ticks_across() {
        let at = axis.place(tick);
        canvas.line(&[[at, top], [at, bottom]], FAINT.light, 1.0);
        canvas.text(&text, [at, bottom + 12.0], canvas::SMALL, MIDDLE.light, Side::Centre);
    }
}

/// Ends of an axis that hold the intervals as well, unless these are so wide that nothing else would be seen.
pub(super) fn with_intervals([low, high]: [f64; 2], values: impl Iterator<Item = Estimate>) -> [f64; 2] {
    let room = libm::sqrt(high / low).max(1.5);
    let intervals = values.filter_map(|value| value.interval);
    let held = intervals.fold([low, high], |[low, high], i| [low.min(i.low), high.max(i.high)]);
    [held[0].max(low / room), held[1].min(high * room)]
}

/// An interval: a line with an end at either side, on a plate of its own so that it is seen on the bar. Without an end where
/// it goes on beyond the axis, and nothing where it is not known. Gives the place where it stops.
pub(super) fn whisker(canvas: &Canvas, value: Estimate, axis: Axis, y: f64) -> f64 {
    let Some(interval) = value.interval else { return axis.place(value.estimate) };
    let places = [interval.low, interval.high].map(|value| axis.place(value));
    let [from, to] = places.map(|place| place.clamp(axis.places()[0], axis.places()[1]));
    for (colour, width) in [(super::palette::PAPER.light, 3.5), (INK.light, 1.5)] {
        canvas.line(&[[from, y], [to, y]], colour, width);
    }
    for (end, place) in [from, to].into_iter().zip(places) {
        if end == place {
            canvas.line(&[[end, y - 4.0], [end, y + 4.0]], INK.light, 1.5);
        }
    }
    to
}
