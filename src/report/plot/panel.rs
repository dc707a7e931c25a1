//! One panel: frame, axes, the front, points and their labels.

use super::canvas::{self, Canvas, Side, WIDTH};
use super::labels::{Rect, place};
use super::palette::{self, Colour};
use super::scale::{Axis, Scale, power, rounded};
use super::{LABELLED, Panel, Point};
use crate::report::number::{count, figures};

const PAPER: Colour = palette::PAPER.light;
const INK: Colour = palette::INK.light;
const MIDDLE: Colour = palette::MIDDLE.light;
const FAINT: Colour = palette::FAINT.light;

/// Height of a panel with its titles.
pub const HEIGHT: f64 = 440.0;

/// Where the frame of the axes begins.
pub const LEFT: f64 = 84.0;
const RIGHT: f64 = WIDTH - 16.0;
const TOP: f64 = 52.0;
const BOTTOM: f64 = HEIGHT - 56.0;

const RADIUS: f64 = 5.0;

/// Length of the arrow below a bound.
const ARROW: f64 = 22.0;

/// Height of a label.
const LINE: f64 = 16.0;

/// Draws a panel whose highest line is at `top`; `colours` are those of the groups.
pub fn draw(panel: &Panel, colours: &[Colour], canvas: &Canvas, top: f64) {
    let frame = Rect { min: [LEFT, top + TOP], max: [RIGHT, top + BOTTOM] };
    canvas.text(&panel.title, [16.0, top + 12.0], canvas::HEAD, INK, Side::Left);
    canvas.text(&panel.y_title, [16.0, top + 36.0], canvas::BODY, INK, Side::Left);
    let middle = (frame.min[0] + frame.max[0]) * 0.5;
    canvas.text(&panel.x_title, [middle, frame.max[1] + 38.0], canvas::BODY, INK, Side::Centre);
    if panel.points.is_empty() {
        canvas.text("nothing to show", [middle, (frame.min[1] + frame.max[1]) * 0.5], canvas::BODY, INK, Side::Centre);
        return;
    }

    let (x, y) = axes(&panel.points, frame);
    grid(canvas, x, y, frame);
    let places: Vec<[f64; 2]> = panel.points.iter().map(|p| [x.place(p.x), y.place(p.y)]).collect();
    front(panel, canvas, &places, frame);
    labels(panel, colours, canvas, &places, frame);
    marks(panel, colours, canvas, &places);
}

/// Axes with room around all points: on the right for a label, below for the arrows of bounds.
fn axes(points: &[Point], frame: Rect) -> (Axis, Axis) {
    let least = |value: fn(&Point) -> f64| points.iter().map(value).fold(f64::INFINITY, f64::min);
    let most = |value: fn(&Point) -> f64| points.iter().map(value).fold(0.0, f64::max);
    let (fast, slow) = (least(|p| p.x), most(|p| p.x));
    let spread = (slow / fast).max(1.6);
    let x = Axis::new(
        Scale::Log,
        [fast / libm::pow(spread, 0.12), slow * libm::pow(spread, 0.22)],
        [frame.min[0], frame.max[0]],
    );
    // A third of a decade stays free below the lowest point and above the highest, and there are at least two decades.
    let low = libm::floor(libm::log10(least(|p| p.y)) - 0.34);
    let high = libm::ceil(libm::log10(most(|p| p.y)) + 0.34).min(0.0).max(low + 2.0);
    (x, Axis::new(Scale::Log, [power(low as i32), 1.3 * power(high as i32)], [frame.max[1], frame.min[1]]))
}

fn grid(canvas: &Canvas, x: Axis, y: Axis, frame: Rect) {
    for tick in x.round_values() {
        let at = x.place(tick);
        canvas.line(&[[at, frame.min[1]], [at, frame.max[1]]], FAINT, 1.0);
        canvas.text(&plain(tick), [at, frame.max[1] + 14.0], canvas::BODY, INK, Side::Centre);
    }
    for tick in y.round_values().into_iter().filter(|&tick| libm::log10(tick).fract().abs() < 1e-9) {
        let at = y.place(tick);
        canvas.line(&[[frame.min[0], at], [frame.max[0], at]], FAINT, 1.0);
        canvas.text(&format!("{} %", plain(tick * 100.0)), [frame.min[0] - 8.0, at], canvas::BODY, INK, Side::Right);
    }
    let [left, top] = frame.min;
    canvas.line(&[[left, top], [left, frame.max[1]], [frame.max[0], frame.max[1]]], INK, 1.5);
}

/// A round number without an exponent, thousands apart: `0.001`, `20`, `5,000`.
fn plain(value: f64) -> String {
    if value >= 1000.0 { count(value.round() as u64) } else { rounded(value).to_string() }
}

/// The border of what is reached: a stair through the points of the front.
fn front(panel: &Panel, canvas: &Canvas, places: &[[f64; 2]], frame: Rect) {
    let mut steps: Vec<[f64; 2]> =
        panel.points.iter().zip(places).filter(|(point, _)| point.is_front).map(|(_, place)| *place).collect();
    steps.sort_unstable_by(|a, b| a[0].total_cmp(&b[0]));
    let (Some(first), Some(last)) = (steps.first().copied(), steps.last().copied()) else { return };
    let mut line = vec![[first[0], frame.min[1]]];
    for place in steps {
        if let Some(&[_, height]) = line.last().filter(|_| line.len() > 1) {
            line.push([place[0], height]);
        }
        line.push(place);
    }
    line.push([frame.max[0], last[1]]);
    canvas.line(&line, MIDDLE, 2.0);
}

fn marks(panel: &Panel, colours: &[Colour], canvas: &Canvas, places: &[[f64; 2]]) {
    // What is on the front is drawn last, so that it is on top.
    for front in [false, true] {
        for (point, place) in panel.points.iter().zip(places).filter(|(point, _)| point.is_front == front) {
            let colour = colours[point.group];
            if point.is_bound {
                canvas.arrow(*place, ARROW, colour);
            }
            canvas.dot(*place, RADIUS, colour, front);
            let bound = if point.is_bound { "at most " } else { "" };
            let [x, y] = [point.x, 100.0 * point.y].map(figures);
            let told = format!("{}: {bound}{y} %; {}: {x}", point.label, panel.x_title);
            canvas.tip_at(*place, told);
        }
    }
}

fn labels(panel: &Panel, colours: &[Colour], canvas: &Canvas, places: &[[f64; 2]], frame: Rect) {
    // Those of the front choose first; among too many points nobody would find what belongs to a label.
    let all = panel.points.len() <= LABELLED;
    let mut order: Vec<usize> = (0..places.len()).filter(|&i| all || panel.points[i].is_front).collect();
    order.sort_by_key(|&i| !panel.points[i].is_front);
    let obstacles: Vec<Rect> = panel
        .points
        .iter()
        .zip(places)
        .map(|(point, &[x, y])| {
            let below = if point.is_bound { ARROW } else { RADIUS };
            Rect { min: [x - RADIUS - 2.0, y - RADIUS - 2.0], max: [x + RADIUS + 2.0, y + below + 2.0] }
        })
        .collect();
    let of = |i: &usize| &panel.points[*i];
    let sizes: Vec<[f64; 2]> = order.iter().map(|i| [canvas::width_of(&of(i).label, canvas::SMALL), LINE]).collect();
    let points: Vec<[f64; 2]> = order.iter().map(|&i| places[i]).collect();
    let inner = Rect { min: [frame.min[0] + 6.0, frame.min[1]], max: [frame.max[0] - 2.0, frame.max[1] - 4.0] };
    let placed = place(&points, &sizes, &obstacles, inner);
    // A label that had to go elsewhere is tied to its point.
    for (rect, point) in placed.iter().zip(&points).filter(|(rect, point)| rect.distance(**point) > 18.0) {
        let middle = [(rect.min[0] + rect.max[0]) * 0.5, (rect.min[1] + rect.max[1]) * 0.5];
        let end =
            std::array::from_fn(|axis| point[axis].clamp(rect.min[axis], rect.max[axis]) * 0.9 + middle[axis] * 0.1);
        canvas.line(&[*point, end], MIDDLE, 0.75);
    }
    for (i, rect) in order.iter().zip(placed) {
        let middle = (rect.min[1] + rect.max[1]) * 0.5;
        // What is under a label must not cross it.
        canvas.rect([rect.min[0] - 1.0, rect.min[1] + 1.0], [rect.max[0] - 1.0, rect.max[1] - 1.0], PAPER);
        canvas.text(&of(i).label, [rect.min[0], middle], canvas::SMALL, colours[of(i).group], Side::Left);
    }
}
