//! Lines with the band of their intervals, each named where it ends.

use super::canvas::{self, Canvas, Side};
use super::palette::{Colour, FAINT, INK, MIDDLE, colours};
use super::scale::{Axis, Scale};
use crate::measure::Estimate;
use crate::report::number::figures;
use crate::report::words::interval;

/// Lines over one pair of axes.
#[derive(Clone, Debug, PartialEq)]
pub struct Curves {
    pub x_title: String,
    pub y_title: String,
    pub x_scale: Scale,
    /// Names of the values 1, 2 and so on, which the axis shows in their place; none where it shows numbers.
    pub x_names: Vec<String>,
    pub y_scale: Scale,
    pub lines: Vec<Line>,
    /// A horizontal line at this height, and what it means: "equal".
    pub level: Option<(f64, String)>,
    /// What is higher is beyond the picture.
    pub highest: Option<f64>,
    /// A line where both coordinates are the same, and what it means: "as predicted".
    pub diagonal: Option<String>,
}

/// A line through points, from left to right.
#[derive(Clone, Debug, PartialEq)]
pub struct Line {
    /// Structures have their colours.
    pub label: String,
    /// What stands behind it.
    pub note: String,
    pub points: Vec<CurvePoint>,
    pub mark: Mark,
}

/// How points are drawn.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Mark {
    /// A line alone: what is fitted or derived.
    Line,
    /// Dots alone: what has no order.
    Dots,
    /// Dots that a line joins: what was measured.
    Both,
}

impl Line {
    /// A line with nothing behind its label.
    pub fn new(label: &str, mark: Mark, points: impl IntoIterator<Item = CurvePoint>) -> Self {
        Self { label: label.into(), note: String::new(), points: points.into_iter().collect(), mark }
    }

    fn name(&self) -> String {
        if self.note.is_empty() { self.label.clone() } else { format!("{} {}", self.label, self.note) }
    }
}

/// A point with the interval of its height.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CurvePoint {
    pub x: f64,
    pub y: f64,
    /// Lower and upper end.
    pub band: Option<[f64; 2]>,
    /// Whether a ring is about it.
    pub is_marked: bool,
}

impl CurvePoint {
    /// A point without an interval.
    pub fn exact(x: f64, y: f64) -> Self {
        Self { x, y, band: None, is_marked: false }
    }

    /// The estimate at `x`, with its interval if it has one.
    pub fn of(x: f64, y: Estimate) -> Self {
        let band = y.interval.map(|interval| [interval.low, interval.high]);
        Self { band, ..Self::exact(x, y.estimate) }
    }
}

const LINE: f64 = 19.0;
const BOTTOM: f64 = 52.0;
const TOP: f64 = 34.0;

impl Curves {
    /// Lines over two logarithmic axes.
    pub fn logarithmic(x_title: &str, y_title: &str, lines: Vec<Line>) -> Self {
        let (x_title, y_title, scale) = (x_title.into(), y_title.into(), Scale::Log);
        Self {
            x_title,
            y_title,
            x_scale: scale,
            x_names: vec![],
            y_scale: scale,
            lines,
            level: None,
            highest: None,
            diagonal: None,
        }
    }

    /// Height of the drawing where it is `width` wide.
    pub(super) fn height(&self, width: f64) -> f64 {
        let names = if has_room(width) { 0.0 } else { self.lines.len() as f64 * LINE + 8.0 };
        self.plot_height(width) + names
    }

    /// Height of the axes with their titles: names beside them have a line each.
    fn plot_height(&self, width: f64) -> f64 {
        let names = self.lines.len() as f64 * LINE + TOP + BOTTOM;
        if has_room(width) { (0.5 * width).min(430.0).max(names) } else { 0.8 * width }
    }

    pub(super) fn draw(&self, canvas: &Canvas, width: f64) {
        let (height, beside) = (self.plot_height(width), has_room(width));
        let labels: Vec<String> = self.lines.iter().map(|line| line.label.clone()).collect();
        let (names, colours): (Vec<String>, _) = (self.lines.iter().map(Line::name).collect(), colours(&labels));
        let widest = |names: &mut dyn Iterator<Item = &String>| {
            names.map(|name| canvas::width_of(name, canvas::SMALL)).fold(0.0, f64::max)
        };
        let [x_range, y_range] = self.ranges();
        let trial = Axis::new(self.y_scale, y_range, [height - BOTTOM, TOP]);
        let left = widest(&mut trial.ticks_up().iter().map(|(_, text)| text)) + 12.0;
        // The last name on the axis stands in the middle below the last value.
        let last = 0.5 * widest(&mut self.x_names.iter()) + 2.0;
        let beside_axes = if beside { widest(&mut names.iter()) + 20.0 } else { 12.0 };
        let right = width - beside_axes.max(last);
        let (x, y) = (Axis::new(self.x_scale, x_range, [left, right]), trial);

        canvas.text(&self.y_title, [2.0, 10.0], canvas::SMALL, MIDDLE.light, Side::Left);
        for (tick, text) in y.ticks_up() {
            let at = y.place(tick);
            canvas.line(&[[left, at], [right, at]], FAINT.light, 1.0);
            canvas.text(&text, [left - 8.0, at], canvas::SMALL, MIDDLE.light, Side::Right);
        }
        let ticks = if self.x_names.is_empty() { x.ticks_across() } else { x.names_across(&self.x_names) };
        for (tick, text) in ticks {
            let at = x.place(tick);
            canvas.line(&[[at, height - BOTTOM], [at, height - BOTTOM + 5.0]], MIDDLE.light, 1.0);
            canvas.centred(&text, [at, height - BOTTOM + 16.0], canvas::SMALL, MIDDLE.light, width);
        }
        canvas.line(&[[left, height - BOTTOM], [right, height - BOTTOM]], MIDDLE.light, 1.0);
        let below = [(left + right) * 0.5, height - 12.0];
        canvas.centred(&self.x_title, below, canvas::SMALL, MIDDLE.light, width);

        if let Some((level, meaning)) = &self.level {
            let at = y.place(*level);
            canvas.line(&[[left, at], [right, at]], INK.light, 1.0);
            canvas.text(meaning, [left + 6.0, at - 10.0], canvas::SMALL, INK.light, Side::Left);
        }
        if let Some(meaning) = &self.diagonal {
            let (from, to) = (x_range[0].max(y_range[0]), x_range[1].min(y_range[1]));
            let end = [x.place(to), y.place(to)];
            canvas.line(&[[x.place(from), y.place(from)], end], MIDDLE.light, 1.5);
            canvas.text(meaning, [end[0] - 10.0, end[1] + 4.0], canvas::SMALL, MIDDLE.light, Side::Right);
        }
        for (line, &colour) in self.lines.iter().zip(&colours) {
            draw_line(canvas, line, colour, &self.x_names, x, y);
        }
        if beside {
            self.names_beside(canvas, &colours, right + 10.0, y, [TOP, height - BOTTOM]);
        } else {
            for (i, (name, &colour)) in names.iter().zip(&colours).enumerate() {
                let at = height + (i as f64 + 0.5) * LINE;
                canvas.line(&[[left, at], [left + 22.0, at]], colour, 3.0);
                canvas.text(name, [left + 30.0, at], canvas::SMALL, colour, Side::Left);
            }
        }
    }

    /// Names at the heights at which the lines end, moved apart where they would touch.
    fn names_beside(&self, canvas: &Canvas, colours: &[Colour], x: f64, y: Axis, frame: [f64; 2]) {
        let mut ends: Vec<(f64, usize)> = self
            .lines
            .iter()
            .enumerate()
            .filter_map(|(i, line)| Some((y.place(line.points.last()?.y).clamp(frame[0], frame[1]), i)))
            .collect();
        ends.sort_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
        let heights = apart(&ends.iter().map(|(at, _)| *at).collect::<Vec<_>>(), LINE, frame);
        for ((_, i), at) in ends.into_iter().zip(heights) {
            canvas.text(&self.lines[i].name(), [x, at], canvas::SMALL, colours[i], Side::Left);
        }
    }

    fn ranges(&self) -> [[f64; 2]; 2] {
        let points = || self.lines.iter().flat_map(|line| &line.points);
        let level = self.level.as_ref().map(|(level, _)| *level);
        let highest = self.highest.unwrap_or(f64::INFINITY);
        // Bands may be so wide that nothing else would be seen: they do not make room for themselves.
        let y = padded(self.y_scale, &mut points().map(|p| p.y.min(highest)).chain(level), 0.08);
        match self.x_names.len() {
            0 => [padded(self.x_scale, &mut points().map(|p| p.x), 0.02), y],
            names => [[0.5, names as f64 + 0.5], y],
        }
    }
}

/// Whether names stand at the ends of lines; else they stand below.
fn has_room(width: f64) -> bool {
    width >= 560.0
}

/// The range of values with some room at both ends; from zero where a linear scale comes near it.
fn padded(scale: Scale, values: &mut dyn Iterator<Item = f64>, room: f64) -> [f64; 2] {
    let (low, high) = values.fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), v| (l.min(v), h.max(v)));
    if low > high {
        return [1.0, 10.0];
    }
    match scale {
        Scale::Log => {
            let high = high.max(1.5 * low);
            let factor = libm::pow(high / low, room);
            [low / factor, high * factor]
        }
        Scale::Linear => {
            let low = if low > 0.0 && low < 0.5 * high { 0.0 } else { low };
            let span = if high > low { high - low } else { 1.0 };
            [if low == 0.0 { 0.0 } else { low - room * span }, high + room * span]
        }
    }
}

/// Sorted places, moved as little as this simple way can so that neighbours are `gap` apart and all within `frame`.
fn apart(places: &[f64], gap: f64, frame: [f64; 2]) -> Vec<f64> {
    let mut moved: Vec<f64> = vec![];
    for &place in places {
        let least = moved.last().map_or(frame[0], |last| last + gap);
        moved.push(place.max(least));
    }
    let mut limit = frame[1];
    for place in moved.iter_mut().rev() {
        *place = place.min(limit);
        limit = *place - gap;
    }
    moved
}

fn draw_line(canvas: &Canvas, line: &Line, colour: Colour, x_names: &[String], x: Axis, y: Axis) {
    let bands: Vec<(f64, [f64; 2])> = line.points.iter().filter_map(|p| Some((x.place(p.x), p.band?))).collect();
    let [bottom, top] = y.places();
    let within = |value: f64| y.place(value).clamp(top.min(bottom), bottom.max(top));
    let side = |end: usize| bands.iter().map(|(at, band)| [*at, within(band[end])]).collect::<Vec<_>>();
    if bands.len() > 1 {
        canvas.band(&side(0), &side(1), colour);
    }
    // Neighbours within the picture are joined.
    let seen = |p: &CurvePoint| (top.min(bottom) - 0.5..=top.max(bottom) + 0.5).contains(&y.place(p.y));
    for run in line.points.chunk_by(|a, b| seen(a) == seen(b)).filter(|run| seen(&run[0])) {
        let places: Vec<[f64; 2]> = run.iter().map(|p| [x.place(p.x), y.place(p.y)]).collect();
        for (point, place) in run.iter().zip(&places) {
            let value =
                point.band.map_or(Estimate::exact(point.y), |[low, high]| Estimate::between(point.y, low, high));
            let name = x_names.get((point.x as usize).saturating_sub(1));
            let at = name.map_or_else(|| figures(point.x), String::clone);
            canvas.tip_at(*place, format!("{} at {at}: {}", line.label, interval(value)));
        }
        if line.mark != Mark::Dots {
            canvas.line(&places, colour, 2.0);
        }
        for (_, place) in run.iter().zip(&places).filter(|(point, _)| point.is_marked) {
            canvas.ring(*place, 7.0, colour);
        }
        if line.mark != Mark::Line {
            places.into_iter().for_each(|place| canvas.dot(place, 3.0, colour, true));
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_are_moved_apart_and_stay_inside() {
        assert_eq!(apart(&[10.0, 50.0], 20.0, [0.0, 100.0]), [10.0, 50.0]);
        assert_eq!(apart(&[10.0, 12.0, 14.0], 20.0, [0.0, 100.0]), [10.0, 30.0, 50.0]);
        assert_eq!(apart(&[95.0, 97.0, 99.0], 20.0, [0.0, 100.0]), [60.0, 80.0, 100.0]);
    }

    #[test]
    fn names_stand_for_numbers_and_rings_about_marked_points() {
        let names: Vec<String> = (1..=40).map(|n| format!("c0ffe{n:02}")).collect();
        let svg = |marked: usize| {
            let point = |n: usize| CurvePoint { is_marked: n == marked, ..CurvePoint::exact(n as f64, 2.0) };
            let curves = Curves::logarithmic("commit", "", vec![Line::new("tree", Mark::Both, (1..=40).map(point))]);
            let curves = Curves { x_scale: Scale::Linear, x_names: names.clone(), ..curves };
            canvas::svg([360.0, curves.height(360.0)], |canvas| curves.draw(canvas, 360.0))
        };
        let plain = svg(0);
        // The last one is always there, others where there is room; a pointer is told each.
        assert!(plain.contains("\nc0ffe40\n") && !plain.contains("\nc0ffe39\n"), "{plain}");
        assert!(plain.contains("tree at c0ffe39: 2.00"), "{plain}");
        let circles = |svg: &str| svg.matches("<circle").count();
        assert_eq!(circles(&svg(7)), circles(&plain) + 1, "its outline alone, which hides nothing");
    }

    #[test]
    fn names_on_the_axis_do_not_touch() {
        let names: Vec<String> = (1..=200).map(|n| format!("c0ff{n:03}")).collect();
        let points = (1..=200).map(|n| CurvePoint::exact(f64::from(n), 2.0));
        let curves = Curves::logarithmic("commit", "", vec![Line::new("tree", Mark::Both, points)]);
        let curves = Curves { x_scale: Scale::Linear, x_names: names.clone(), ..curves };
        let svg = canvas::svg([360.0, curves.height(360.0)], |canvas| curves.draw(canvas, 360.0));
        let middle = |name: &String| {
            let (before, _) = svg.split_once(&format!("\n{name}\n"))?;
            let (_, text) = before.rsplit_once("<text x=\"")?;
            text.split('"').next()?.parse::<f64>().ok()
        };
        let middles: Vec<f64> = names.iter().filter_map(middle).collect();
        // Two pixels a unit.
        let width = 2.0 * canvas::width_of(&names[0], canvas::SMALL);
        let are_apart = middles.windows(2).all(|pair| pair[1] - pair[0] > width);
        assert!(middles.len() > 2 && are_apart, "{width}: {middles:?}");
    }

    #[test]
    fn there_is_a_line_for_each_name() {
        let line = |i: usize| Line::new(&format!("tree {i}"), Mark::Dots, []);
        let of = |lines: usize| Curves::logarithmic("", "", (0..lines).map(line).collect());
        assert_eq!(of(3).height(800.0), 400.0);
        assert!(of(30).height(800.0) - TOP - BOTTOM >= 30.0 * LINE);
    }

    #[test]
    fn a_linear_axis_begins_at_zero_where_that_is_near() {
        assert_eq!(padded(Scale::Linear, &mut [1.0, 10.0].into_iter(), 0.1), [0.0, 11.0]);
        assert_eq!(padded(Scale::Linear, &mut [9.0, 10.0].into_iter(), 0.1), [8.9, 10.1]);
        assert_eq!(padded(Scale::Log, &mut std::iter::empty(), 0.1), [1.0, 10.0]);
    }
}
