//! Lines through points with their intervals.

use plotters::chart::ChartContext;
use plotters::coord::cartesian::Cartesian2d;
use plotters::coord::combinators::BindKeyPoints;
use plotters::coord::ranged1d::Ranged;
use plotters::coord::types::RangedCoordf64;
use plotters::element::Circle;
use plotters::prelude::DrawingBackend;
use plotters::style::Color;

use super::axes::{self, GAP, Labels, axes, height_with_legend, left_of, legend, padded, tick_text};
use super::canvas::{Canvas, DrawResult, Place, widest};
use super::palette::{Colour, colours};
use crate::measure::Estimate;
use crate::report::number::figures;
use crate::report::words::interval;

/// Lines over one pair of logarithmic axes.
#[derive(Clone, Debug, PartialEq)]
pub struct Curves {
    pub x_title: String,
    pub y_title: String,
    /// Names of the values 1, 2 and so on, which the axis shows, evenly spaced, in place of numbers; none where it shows
    /// numbers.
    pub x_names: Vec<String>,
    pub lines: Vec<Line>,
}

/// A line through points, from left to right.
#[derive(Clone, Debug, PartialEq)]
pub struct Line {
    /// Structures have their colours.
    pub label: String,
    /// What stands behind it.
    pub note: String,
    pub points: Vec<CurvePoint>,
}

/// A point. Both coordinates are positive.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CurvePoint {
    pub x: f64,
    pub y: Estimate,
    /// Whether a ring is about it.
    pub is_marked: bool,
}

impl CurvePoint {
    pub fn new(x: f64, y: Estimate) -> Self {
        Self { x, y, is_marked: false }
    }
}

impl Line {
    fn name(&self) -> String {
        if self.note.is_empty() { self.label.clone() } else { format!("{} {}", self.label, self.note) }
    }
}

impl Curves {
    /// Height of the drawing where it is `width` wide.
    pub fn height(&self, width: i32) -> i32 {
        height_with_legend((4 * width / 5).min(860), self.lines.len(), width)
    }

    pub fn draw<B: DrawingBackend>(&self, canvas: &Canvas<B>) -> DrawResult<B> {
        let labels: Vec<String> = self.lines.iter().map(|line| line.label.clone()).collect();
        let colours = colours(&labels);
        // Names follow each other like the ends of their lines.
        let mut order: Vec<usize> = (0..self.lines.len()).collect();
        let last = |i: usize| self.lines[i].points.last().map_or(0.0, |point| point.y.estimate);
        order.sort_by(|&a, &b| last(b).total_cmp(&last(a)));
        let names: Vec<(String, Colour)> = order.into_iter().map(|i| (self.lines[i].name(), colours[i])).collect();
        let area = legend(&canvas.area, &names)?;
        let (width, height) = area.dim_in_pixel();
        let points = || self.lines.iter().flat_map(|line| &line.points);
        // Intervals may be so wide that nothing else would be seen: they do not make room for themselves.
        let y_ends = padded(points().map(|point| point.y.estimate), [0.08; 2]);
        let y = axes::upward(y_ends, height as i32 - GAP - axes::BOTTOM);
        // The last name on the axis stands in the middle below the last value.
        let [left, right] = [left_of(&y), GAP.max(widest(self.x_names.last()) / 2)];
        let text = |x: &f64| self.x_text(*x);
        let labels = Labels {
            x_title: &self.x_title,
            y_title: &self.y_title,
            x: &text,
            y: &|y| tick_text(*y),
            left,
            top: GAP,
            right,
        };
        let length = width as i32 - left - right;
        if self.x_names.is_empty() {
            let x = axes::across(padded(points().map(|point| point.x), [0.02; 2]), length);
            return self.draw_lines(canvas, &colours, axes(&area, (x, y), &labels)?);
        }
        let x: RangedCoordf64 = (0.5..self.x_names.len() as f64 + 0.5).into();
        let shown = self.named(f64::from(length) / self.x_names.len() as f64);
        self.draw_lines(canvas, &colours, axes(&area, (x.with_key_points(shown), y), &labels)?)
    }

    /// The values whose names are shown where each takes so many pixels: the last one, and before it at even distances as
    /// many as fit.
    fn named(&self, pixels: f64) -> Vec<f64> {
        let room = f64::from(widest(&self.x_names) + GAP);
        let step = libm::ceil(room / pixels).max(1.0) as usize;
        (1..=self.x_names.len()).rev().step_by(step).map(|n| n as f64).collect()
    }

    fn x_text(&self, x: f64) -> String {
        let name = self.x_names.get((x as usize).saturating_sub(1));
        name.map_or_else(|| tick_text(x), String::clone)
    }

    fn draw_lines<B, X, Y>(
        &self,
        canvas: &Canvas<B>,
        colours: &[Colour],
        chart: ChartContext<B, Cartesian2d<X, Y>>,
    ) -> DrawResult<B>
    where
        B: DrawingBackend,
        X: Ranged<ValueType = f64>,
        Y: Ranged<ValueType = f64>,
    {
        let (_, range) = chart.plotting_area().get_pixel_range();
        let range = [range.start, range.end];
        for (line, &colour) in self.lines.iter().zip(colours) {
            let place = |x: f64, y: f64| chart.backend_coord(&(x, y));
            let places: Vec<Place> = line.points.iter().map(|point| place(point.x, point.y.estimate)).collect();
            canvas.line(&places, colour, 4)?;
            for (point, &at) in line.points.iter().zip(&places) {
                if let Some(held) = point.y.interval {
                    let ends = [held.low, held.high].map(|end| place(point.x, end));
                    canvas.whisker(ends, colour, range)?;
                }
                canvas.area.draw(&Circle::new(at, 6, colour.filled()))?;
                if point.is_marked {
                    canvas.area.draw(&Circle::new(at, 14, colour.stroke_width(4)))?;
                }
                let x = if self.x_names.is_empty() { figures(point.x) } else { self.x_text(point.x) };
                canvas.tip_at(at, format!("{} at {x}: {}", line.label, interval(point.y)));
            }
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::report::plot::Chart;
    use crate::report::plot::canvas::{TEXT, width_of};

    fn history(runs: usize, marked: usize) -> Curves {
        let point = |n: usize| CurvePoint { is_marked: n == marked, ..CurvePoint::new(n as f64, Estimate::exact(2.0)) };
        let line = Line { label: "tree".into(), note: String::new(), points: (1..=runs).map(point).collect() };
        let x_names = (1..=runs).map(|n| format!("c0ff{n:03}")).collect();
        Curves { x_title: "commit".into(), y_title: "speed".into(), x_names, lines: vec![line] }
    }

    #[test]
    fn names_stand_for_numbers_and_rings_about_marked_points() {
        let svg = |marked: usize| Chart::Curves(history(40, marked)).svg(360.0);
        let plain = svg(0);
        // The last one is always there, others where there is room; a pointer is told each.
        assert!(plain.contains("\nc0ff040\n") && !plain.contains("\nc0ff039\n"), "{plain}");
        assert!(plain.contains("tree at c0ff039: 2.00"), "{plain}");
        let circles = |svg: &str| svg.matches("<circle").count();
        assert_eq!(circles(&svg(7)), circles(&plain) + 1, "its outline alone, which hides nothing");
    }

    #[test]
    fn names_on_the_axis_do_not_touch() {
        let curves = history(200, 0);
        let svg = Chart::Curves(curves.clone()).svg(360.0);
        let middle = |name: &String| {
            let (before, _) = svg.split_once(&format!("\n{name}\n"))?;
            let (_, text) = before.rsplit_once("<text x=\"")?;
            text.split('"').next()?.parse::<i32>().ok()
        };
        let middles: Vec<i32> = curves.x_names.iter().filter_map(middle).collect();
        let width = width_of(&curves.x_names[0], TEXT);
        let are_apart = middles.windows(2).all(|pair| pair[1] - pair[0] > width);
        assert!(middles.len() > 2 && are_apart, "{width}: {middles:?}");
    }

    #[test]
    fn there_is_a_line_for_each_name() {
        let line = Line { label: "tree".into(), note: String::new(), points: vec![] };
        let of = |lines: usize| Curves { lines: vec![line.clone(); lines], ..history(1, 0) };
        assert_eq!(of(3).height(1600), of(1).height(1600));
        assert!(of(30).height(1600) >= 30 * TEXT && of(3).height(720) >= of(1).height(720) + 2 * TEXT);
    }
}
