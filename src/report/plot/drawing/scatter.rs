//! Draws scatter plots.

use plotters::element::{Circle, Polygon, Rectangle};
use plotters::style::Color;
use plotters::style::text_anchor::HPos;

use super::axes::{legend, legend_height, log_log, padded};
use super::canvas::{Area, DrawResult, Place, TEXT, line, text, width_of};
use super::palette::{Colour, MIDDLE, PAPER, colours};
use crate::report::plot::chart::{LABELLED, Point, Scatter};

const RADIUS: i32 = 10;

const ARROW: i32 = 44;

struct Dot<'a> {
    point: &'a Point,
    place: Place,
    colour: Colour,
}

impl Scatter {
    /// The legend is empty if the label of every point equals the group of the point.
    fn names(&self) -> Vec<String> {
        let is_said = self.points.iter().all(|point| point.label == point.group);
        if is_said { vec![] } else { self.groups() }
    }

    pub fn height(&self, width: i32) -> i32 {
        width.min(880) + legend_height(&self.names())
    }

    pub fn draw(&self, whole: &Area) -> DrawResult {
        let area = legend(whole, &self.names(), &colours(&self.groups()))?;
        // Reserve space on the right side for labels and at the bottom for arrows.
        let x_ends = padded(self.points.iter().map(|point| point.x), [0.1, 0.2]);
        let y_ends = padded(self.points.iter().map(|point| point.y), [0.15, 0.1]);
        let axes = log_log(&area, [&self.x_title, &self.y_title], [x_ends, y_ends])?;
        let groups: Vec<String> = self.points.iter().map(|point| point.group.clone()).collect();
        let dot = |(point, colour)| Dot { point, place: axes.backend_coord(&(point.x, point.y)), colour };
        let mut dots: Vec<Dot> = self.points.iter().zip(colours(&groups)).map(dot).collect();
        dots.sort_by_key(|dot| !dot.point.is_front);

        let (x, y) = axes.plotting_area().get_pixel_range();
        let front = front(&dots, x.end);
        line(whole, &front, MIDDLE.light, 4)?;
        let obstacles: Vec<Corners> = dots.iter().map(Dot::corners).collect();
        let is_shown = |dot: &&Dot| dots.len() <= LABELLED || dot.point.is_front;
        let labelled: Vec<&Dot> = dots.iter().filter(is_shown).collect();
        draw_labels(whole, &labelled, &obstacles, [(x.start + 12, y.start), (x.end - 4, y.end - 8)])?;
        // Points on the Pareto front cover all other points.
        dots.iter().rev().try_for_each(|dot| dot.draw(whole))
    }
}

impl Dot<'_> {
    /// The box around the point and the arrow.
    fn corners(&self) -> Corners {
        let ((x, y), around) = (self.place, RADIUS + 4);
        let below = if self.point.is_bound { ARROW + 4 } else { around };
        [(x - around, y - around), (x + around, y + below)]
    }

    fn draw(&self, area: &Area) -> DrawResult {
        let Self { point, place: (x, y), colour } = *self;
        if point.is_bound {
            let (tip, wings) = (y + ARROW, y + ARROW - 14);
            line(area, &[(x, y), (x, wings)], colour, 4)?;
            area.draw(&Polygon::new([(x - 9, wings), (x + 9, wings), (x, tip)], colour.filled()))?;
        }
        let inside = if point.is_front { colour } else { PAPER.light };
        area.draw(&Circle::new((x, y), RADIUS, inside.filled()))?;
        area.draw(&Circle::new((x, y), RADIUS, colour.stroke_width(4)))
    }
}

/// The Pareto front as a staircase. `end` is the right end of the horizontal axis in pixels.
fn front(dots: &[Dot], end: i32) -> Vec<Place> {
    let mut front: Vec<Place> = dots.iter().filter(|dot| dot.point.is_front).map(|dot| dot.place).collect();
    front.sort_unstable();
    let ends = front.iter().map(|place| place.0).skip(1).chain([end]);
    front.iter().zip(ends).flat_map(|(&(x, y), end)| [(x, y), (end, y)]).collect()
}

fn draw_labels(area: &Area, dots: &[&Dot], obstacles: &[Corners], frame: Corners) -> DrawResult {
    let widths = dots.iter().map(|dot| (dot.place, width_of(&dot.point.label)));
    let boxes = place(&widths.collect::<Vec<_>>(), TEXT, obstacles, frame);
    for (dot, [min, max]) in dots.iter().zip(&boxes) {
        // Draw a line from the point to a distant label.
        let (x, y) = dot.place;
        let end = (x.clamp(min.0, max.0), y.clamp(min.1, max.1));
        if (end.0 - x).abs().max((end.1 - y).abs()) > 36 {
            line(area, &[(x, y), end], MIDDLE.light, 2)?;
        }
    }
    for (dot, [min, max]) in dots.iter().zip(boxes) {
        // Hide the lines behind a label.
        area.draw(&Rectangle::new([min, max], PAPER.light.filled()))?;
        text(area, &dot.point.label, (min.0, (min.1 + max.1) / 2), dot.colour, HPos::Left)?;
    }
    Ok(())
}

/// The top left and the bottom right corner of a box.
pub type Corners = [Place; 2];

fn overlap(a: &Corners, b: &Corners) -> bool {
    a[0].0 < b[1].0 && b[0].0 < a[1].0 && a[0].1 < b[1].1 && b[0].1 < a[1].1
}

fn is_inside(a: &Corners, b: &Corners) -> bool {
    a[0].0 >= b[0].0 && a[0].1 >= b[0].1 && a[1].0 <= b[1].0 && a[1].1 <= b[1].1
}

const LABEL_GAP: i32 = 22;

/// The boxes of the labels. `points` has the position of each point and the width of each label. Each label gets the
/// first free candidate box inside `frame`. If no candidate is free, the label may cover another label.
pub fn place(points: &[(Place, i32)], height: i32, obstacles: &[Corners], frame: Corners) -> Vec<Corners> {
    let mut taken = obstacles.to_vec();
    for &((x, y), width) in points {
        let steps = (0..40).flat_map(|i| [-i, i]).map(|i| i * height / 2);
        let lefts =
            [x + LABEL_GAP, x - LABEL_GAP - width, x + LABEL_GAP + 60, x - LABEL_GAP - 60 - width, x - width / 2];
        let corners = |left: i32, step: i32| [(left, y + step - height / 2), (left + width, y + step + height / 2)];
        let mut places = steps.flat_map(|step| lefts.map(|left| corners(left, step)));
        let is_free = |place: &Corners| is_inside(place, &frame) && !taken.iter().any(|other| overlap(place, other));
        let free = places.find(is_free).unwrap_or(corners(lefts[0], 0));
        taken.push(free);
    }
    taken.split_off(obstacles.len())
}

#[cfg(test)]
mod tests {
    use super::*;

    const FRAME: Corners = [(0, 0), (1600, 800)];

    #[test]
    fn labels_of_points_in_a_heap_do_not_cover_each_other() {
        let points: Vec<(Place, i32)> = (0..24).map(|i| ((800 + 2 * (i % 5), 400 + 2 * (i / 5)), 240)).collect();
        let obstacles: Vec<Corners> = points.iter().map(|&((x, y), _)| [(x - 12, y - 12), (x + 12, y + 12)]).collect();
        let placed = place(&points, 30, &obstacles, FRAME);
        for (i, label) in placed.iter().enumerate() {
            assert!(is_inside(label, &FRAME));
            assert!(placed[..i].iter().chain(&obstacles).all(|other| !overlap(label, other)), "{i}: {label:?}");
        }
    }
}
