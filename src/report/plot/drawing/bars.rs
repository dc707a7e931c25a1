//! Draws bar charts.

use plotters::coord::combinators::{BindKeyPoints, WithKeyPoints};
use plotters::coord::types::RangedCoordi32;
use plotters::element::Rectangle;
use plotters::style::Color;
use plotters::style::text_anchor::HPos;

use super::axes::{self, Axes, AxisLabels, BOTTOM_WITHOUT_TITLE, GAP, axes, legend, legend_height};
use super::canvas::{Area, DrawResult, Place, TEXT, line, text, widest, width_of};
use super::palette::{Colour, INK, MIDDLE, PAPER, PARTS, colours};
use crate::measure::Estimate;
use crate::report::number::figures;
use crate::report::plot::chart::{Bar, BarGroup, Bars};

impl Bar {
    /// The low end and the high end of the bar.
    fn reach(&self) -> [f64; 2] {
        let mut reach = self.value().map_or([1.0; 2], |value| [value.estimate.min(1.0), value.estimate.max(1.0)]);
        if let Self::Product(factors, _) = self {
            let product = |is_taken: fn(&f64) -> bool| factors.iter().copied().filter(is_taken).product::<f64>();
            reach = [reach[0].min(product(|f| *f < 1.0)), reach[1].max(product(|f| *f > 1.0))];
        }
        reach
    }
}

const FOOT: i32 = 48;

/// Minimum width of a group in pixels if several groups are side by side. The width does not include labels.
const GROUP: i32 = 380;

/// Space for the number at the end of the longest bar.
const NUMBER: i32 = 124;

struct Layout {
    /// Width of the labels beside the bars. If the width is 0, the labels are above the bars.
    left: i32,
    /// Height of a bar.
    bar: i32,
    /// Height of a row, not including a label above the bar.
    row: i32,
    /// Vertical distance between the middles of two adjacent rows.
    step: i32,
    /// Number of groups side by side.
    columns: usize,
    /// Width of a group, not including labels.
    column: i32,
    /// Height of the heading of a group.
    head: i32,
    /// Height of a group, including the heading.
    group: i32,
    height: i32,
}

impl Layout {
    /// The vertical middle of a row, in pixels below the top of the plotting area.
    fn middle(&self, row: usize) -> i32 {
        (row as i32 + 1) * self.step - self.row / 2
    }
}

/// The fill colour and the text colour of a factor.
fn part_colours(part: usize) -> [Colour; 2] {
    let part = part % PARTS.len();
    [PARTS[part].light, if part == PARTS.len() - 1 { INK.light } else { PAPER.light }]
}

impl Bars {
    fn layout(&self, width: i32) -> Layout {
        let beside = widest(&self.labels) + GAP;
        let left = if beside > width / 2 { 0 } else { beside };
        let [row, bar] = if self.parts.is_empty() { [54, 30] } else { [88, 48] };
        let step = if left == 0 { row + TEXT + 2 } else { row };
        let most = if left == 0 { 1 } else { self.groups.len().max(1) };
        let columns = (((width - left) / GROUP) as usize).clamp(1, most);
        let head = if self.groups.iter().all(|group| group.title.is_empty()) { GAP } else { 52 };
        let group = head + self.labels.len() as i32 * step + BOTTOM_WITHOUT_TITLE;
        let height = self.groups.len().div_ceil(columns) as i32 * group;
        Layout { left, bar, row, step, columns, column: (width - left) / columns as i32, head, group, height }
    }

    pub fn height(&self, width: i32) -> i32 {
        self.layout(width).height + FOOT + legend_height(&self.parts)
    }

    pub fn draw(&self, whole: &Area) -> DrawResult {
        let part_colours: Vec<Colour> = (0..self.parts.len()).map(|part| part_colours(part)[0]).collect();
        let area = legend(whole, &self.parts, &part_colours)?;
        let width = area.dim_in_pixel().0 as i32;
        let layout = self.layout(width);
        let across: Vec<i32> = (1..layout.columns as i32).map(|i| layout.left + i * layout.column).collect();
        let down: Vec<i32> = (1..=layout.height / layout.group).map(|i| i * layout.group).collect();
        for (i, (group, cell)) in self.groups.iter().zip(area.split_by_breakpoints(across, down)).enumerate() {
            let left = if i % layout.columns == 0 { layout.left } else { 0 };
            self.draw_group(whole, group, &layout, &cell, left)?;
        }
        let half = width_of(&self.x_title) / 2;
        let middle = ((width + layout.left) / 2).min(width - half).max(half);
        text(whole, &self.x_title, (middle, layout.height + FOOT / 2), MIDDLE.light, HPos::Center)
    }

    fn draw_group<'s>(
        &self,
        whole: &Area<'s>,
        group: &BarGroup,
        layout: &Layout,
        cell: &Area<'s>,
        left: i32,
    ) -> DrawResult {
        let x = axes::across(self.ends(), cell.dim_in_pixel().0 as i32 - GAP - left - NUMBER);
        let rows = 0..self.labels.len();
        let bottom = rows.len() as i32 * layout.step;
        let middles = rows.map(|row| layout.middle(row)).collect();
        let y = (bottom..0).with_key_points(middles);
        let y_text = |middle: &i32| self.labels[(middle / layout.step) as usize].clone();
        let top = layout.head;
        let labels = AxisLabels { x_title: "", y_title: "", y_text: &y_text, top, left, right: NUMBER };
        let chart = BarChart { whole, layout, axes: axes(cell, x, y, &labels)? };
        let start = chart.axes.x_range().start;
        text(whole, &group.title, chart.place(start, -top / 2), INK.light, HPos::Left)?;
        line(whole, &[chart.place(1.0, 0), chart.place(1.0, bottom)], MIDDLE.light, 3)?;
        let colours = colours(&self.labels);
        for (row, bar) in group.bars.iter().enumerate() {
            let middle = layout.middle(row);
            if layout.left == 0 {
                let place = chart.place(start, middle - layout.row / 2 - 6);
                text(whole, &self.labels[row], place, INK.light, HPos::Left)?;
            }
            match bar {
                Bar::Missing(why) => {
                    let (x, y) = chart.place(1.0, middle);
                    text(whole, why, (x + 12, y), MIDDLE.light, HPos::Left)?;
                }
                Bar::Of(value) => {
                    chart.bar(row, [1.0, value.estimate], colours[row])?;
                    chart.value(row, *value, bar.reach()[1], 0)?;
                }
                Bar::Product(factors, product) => {
                    chart.value(row, *product, bar.reach()[1], layout.bar / 2 + 10)?;
                    chart.factors(row, factors)?;
                }
            }
        }
        Ok(())
    }

    /// The ends of the horizontal axis. The axis includes all bars. Intervals extend each end by at most the factor
    /// `margin`.
    fn ends(&self) -> [f64; 2] {
        let bars = || self.groups.iter().flat_map(|group| &group.bars);
        let reach = bars().map(Bar::reach);
        let [low, high] = reach.fold([1.0f64, 1.5f64], |a, b| [a[0].min(b[0]), a[1].max(b[1])]);
        let margin = libm::sqrt(high / low).max(1.5);
        let intervals = bars().filter_map(|bar| bar.value()?.interval);
        let held = intervals.fold([low, high], |[low, high], i| [low.min(i.low), high.max(i.high)]);
        [held[0].max(low / margin), held[1].min(high * margin)]
    }
}

/// Vertical coordinates are pixels below the top of the plotting area.
struct BarChart<'a, 's> {
    whole: &'a Area<'s>,
    layout: &'a Layout,
    axes: Axes<'s, WithKeyPoints<RangedCoordi32>>,
}

impl BarChart<'_, '_> {
    fn place(&self, x: f64, y: i32) -> Place {
        self.axes.backend_coord(&(x, y))
    }

    fn bar(&self, row: usize, [from, to]: [f64; 2], colour: Colour) -> DrawResult<[Place; 2]> {
        let (middle, half) = (self.layout.middle(row), self.layout.bar / 2);
        let corners = [self.place(from.min(to), middle - half), self.place(from.max(to), middle + half)];
        self.whole.draw(&Rectangle::new(corners, colour.filled()))?;
        Ok(corners)
    }

    fn factors(&self, row: usize, factors: &[f64]) -> DrawResult {
        let (mut up, mut down) = (1.0, 1.0);
        for (part, &factor) in factors.iter().enumerate() {
            let side = if factor >= 1.0 { &mut up } else { &mut down };
            let ends = [*side, *side * factor];
            *side = ends[1];
            let [colour, on_it] = part_colours(part);
            let [min, max] = self.bar(row, ends, colour)?;
            let number = figures(factor);
            if width_of(&number) + 16 < max.0 - min.0 {
                let middle = ((min.0 + max.0) / 2, (min.1 + max.1) / 2);
                text(self.whole, &number, middle, on_it, HPos::Center)?;
            }
        }
        Ok(())
    }

    /// `end` is the right end of the bar. The interval is drawn `below` pixels under the middle of the row.
    fn value(&self, row: usize, value: Estimate, end: f64, below: i32) -> DrawResult {
        let (axis, middle) = (self.axes.x_range(), self.layout.middle(row));
        let high = value.high().unwrap_or(value.estimate);
        if let Some(interval) = value.interval {
            self.whisker([interval.low, high], middle + below)?;
        }
        let (x, y) = self.place(end.max(high).min(axis.end), middle);
        text(self.whole, &figures(value.estimate), (x + 14, y), INK.light, HPos::Left)
    }

    /// A light border makes the interval visible on a bar. An end outside the axis has no cap.
    fn whisker(&self, ends: [f64; 2], y: i32) -> DrawResult {
        let axis = self.axes.x_range();
        let stem = ends.map(|end| self.place(end.clamp(axis.start, axis.end), y));
        line(self.whole, &stem, PAPER.light, 7)?;
        line(self.whole, &stem, INK.light, 3)?;
        for end in ends.into_iter().filter(|end| (axis.start..=axis.end).contains(end)) {
            let (x, y) = self.place(end, y);
            line(self.whole, &[(x, y - 8), (x, y + 8)], INK.light, 3)?;
        }
        Ok(())
    }
}
