//! Points on two logarithmic axes, with the border that nothing passes.

use std::collections::BTreeMap;

use plotters::element::{Circle, Polygon, Rectangle};
use plotters::prelude::DrawingBackend;
use plotters::style::Color;
use plotters::style::text_anchor::HPos;

use super::axes::{GAP, legend, legend_room, log_log, padded};
use super::canvas::{Area, Canvas, DrawResult, HEAD, Place, TEXT, text_style, width_of};
use super::labels::{Corners, place};
use super::palette::{Colour, INK, MIDDLE, PAPER, colours};
use crate::report::number::figures;
use crate::report::words::distinct;

/// Panels, one below the other, with one legend.
#[derive(Clone, Debug, PartialEq)]
pub struct Scatter {
    pub panels: Vec<Panel>,
    /// Lines at the foot.
    pub notes: Vec<String>,
}

/// Points over one pair of axes.
#[derive(Clone, Debug, PartialEq)]
pub struct Panel {
    /// May be empty.
    pub title: String,
    pub x_title: String,
    pub y_title: String,
    pub points: Vec<Point>,
}

/// A point. Both coordinates are positive and finite.
#[derive(Clone, Debug, PartialEq)]
pub struct Point {
    pub x: f64,
    pub y: f64,
    /// Whether nothing but an upper bound is known of `y`: then an arrow points down from it.
    pub is_bound: bool,
    /// Whether no other point is better in both: these are filled, and a line joins them.
    pub is_front: bool,
    /// Stands beside the point.
    pub label: String,
    /// What its colour means; structures have their colours.
    pub group: String,
}

/// Points of a panel that are all labelled; where there are more, those of the front alone are.
pub const LABELLED: usize = 20;

/// Height of a panel, where the drawing is not narrow, and of each note.
const PANEL: i32 = 880;
const NOTE: i32 = 40;

const RADIUS: i32 = 10;

/// Length of the arrow below a bound.
const ARROW: i32 = 44;

/// Height of the title of a panel.
const TITLE: i32 = 64;

impl Scatter {
    fn points(&self) -> impl Iterator<Item = &Point> {
        self.panels.iter().flat_map(|panel| &panel.points)
    }

    /// What there are colours for.
    pub fn groups(&self) -> Vec<String> {
        distinct(self.points().map(|point| &point.group))
    }

    /// Names of the colours; none where labels say the same.
    fn names(&self) -> Vec<String> {
        if self.points().all(|point| point.label == point.group) { vec![] } else { self.groups() }
    }

    fn panels_height(&self, width: i32) -> i32 {
        self.panels.len() as i32 * PANEL.min(width)
    }

    /// Height of the drawing without its notes.
    fn foot(&self, width: i32) -> i32 {
        let [_, below] = legend_room(&self.names(), width);
        self.panels_height(width) + below
    }

    /// Height of the drawing where it is `width` wide.
    pub fn height(&self, width: i32) -> i32 {
        self.foot(width) + self.notes.len() as i32 * NOTE + GAP
    }

    pub fn draw<B: DrawingBackend>(&self, canvas: &Canvas<B>, width: i32) -> DrawResult<B> {
        let (groups, foot) = (self.groups(), self.foot(width));
        let colours = colours(&groups);
        for (row, note) in self.notes.iter().enumerate() {
            canvas.text(note, (GAP, foot + row as i32 * NOTE + NOTE / 2), INK.light, HPos::Left)?;
        }
        let (area, _) = canvas.area.split_vertically(foot);
        let area = legend(&area, &self.names(), &colours)?;
        let colours: BTreeMap<&str, Colour> = groups.iter().map(String::as_str).zip(colours).collect();
        for (panel, area) in self.panels.iter().zip(area.split_evenly((self.panels.len(), 1))) {
            panel.draw(canvas, &area, &colours)?;
        }
        Ok(())
    }
}

impl Panel {
    fn draw<B: DrawingBackend>(
        &self,
        canvas: &Canvas<B>,
        area: &Area<B>,
        colours: &BTreeMap<&str, Colour>,
    ) -> DrawResult<B> {
        let top = if self.title.is_empty() { GAP } else { TITLE };
        area.draw_text(&self.title, &text_style(HEAD, INK.light), (GAP, 8))?;
        if self.points.is_empty() {
            let middle = area.get_pixel_range();
            let middle = ((middle.0.start + middle.0.end) / 2, (middle.1.start + middle.1.end) / 2);
            return canvas.text("nothing to show", middle, INK.light, HPos::Center);
        }
        // Room on the right for a label, below for the arrows of bounds.
        let x_ends = padded(self.points.iter().map(|point| point.x), [0.1, 0.2]);
        let y_ends = padded(self.points.iter().map(|point| point.y), [0.15, 0.1]);
        let axes = log_log(area, top, [&self.x_title, &self.y_title], [x_ends, y_ends])?;
        let places: Vec<Place> = self.points.iter().map(|point| axes.backend_coord(&(point.x, point.y))).collect();
        let (x, y) = axes.plotting_area().get_pixel_range();
        self.draw_front(canvas, &places, x.end)?;
        self.draw_labels(canvas, colours, &places, [(x.start, y.start), (x.end, y.end)])?;
        self.draw_points(canvas, colours, &places)
    }

    /// The border of what is reached: a stair through the points of the front.
    fn draw_front<B: DrawingBackend>(&self, canvas: &Canvas<B>, places: &[Place], end: i32) -> DrawResult<B> {
        let front = self.points.iter().zip(places).filter(|(point, _)| point.is_front);
        let mut front: Vec<Place> = front.map(|(_, place)| *place).collect();
        front.sort_unstable();
        let heights = front.iter().map(|place| place.1);
        // Each step goes on to the next point, the last one to the end of the axis.
        let ends = front.iter().map(|place| place.0).skip(1).chain([end]);
        let steps: Vec<Place> = front.iter().copied().zip(ends.zip(heights)).flat_map(|(a, b)| [a, b]).collect();
        canvas.line(&steps, MIDDLE.light, 4)
    }

    fn draw_points<B: DrawingBackend>(
        &self,
        canvas: &Canvas<B>,
        colours: &BTreeMap<&str, Colour>,
        places: &[Place],
    ) -> DrawResult<B> {
        // What is on the front is drawn last, so that it is on top.
        for front in [false, true] {
            for (point, &(x, y)) in self.points.iter().zip(places).filter(|(point, _)| point.is_front == front) {
                let colour = colours[&*point.group];
                if point.is_bound {
                    canvas.line(&[(x, y), (x, y + ARROW - 8)], colour, 4)?;
                    let (tip, wings) = (y + ARROW, y + ARROW - 14);
                    canvas.area.draw(&Polygon::new([(x - 9, wings), (x + 9, wings), (x, tip)], colour.filled()))?;
                }
                let inside = if front { colour } else { PAPER.light };
                canvas.area.draw(&Circle::new((x, y), RADIUS, inside.filled()))?;
                canvas.area.draw(&Circle::new((x, y), RADIUS, colour.stroke_width(4)))?;
                let bound = if point.is_bound { "at most " } else { "" };
                let told = [point.x, point.y].map(figures);
                let told =
                    format!("{}: {bound}{}, {}; {}, {}", point.label, told[1], self.y_title, told[0], self.x_title);
                canvas.tip_at((x, y), told);
            }
        }
        Ok(())
    }

    fn draw_labels<B: DrawingBackend>(
        &self,
        canvas: &Canvas<B>,
        colours: &BTreeMap<&str, Colour>,
        places: &[Place],
        frame: [Place; 2],
    ) -> DrawResult<B> {
        // Those of the front choose first; among too many points nobody would find what belongs to a label.
        let all = self.points.len() <= LABELLED;
        let is_labelled = |point: &Point| all || point.is_front;
        let mut labelled: Vec<(&Point, Place)> = self.points.iter().zip(places.iter().copied()).collect();
        labelled.retain(|(point, _)| is_labelled(point));
        labelled.sort_by_key(|(point, _)| !point.is_front);
        let obstacle = |(point, &(x, y)): (&Point, &Place)| {
            let around = RADIUS + 4;
            let below = if point.is_bound { ARROW + 4 } else { around };
            [(x - around, y - around), (x + around, y + below)]
        };
        let obstacles: Vec<Corners> = self.points.iter().zip(places).map(obstacle).collect();
        let widths: Vec<(Place, i32)> =
            labelled.iter().map(|(point, place)| (*place, width_of(&point.label, TEXT))).collect();
        let inner = [(frame[0].0 + 12, frame[0].1), (frame[1].0 - 4, frame[1].1 - 8)];
        let boxes = place(&widths, TEXT, &obstacles, inner);
        for ((_, (x, y)), [min, max]) in labelled.iter().zip(&boxes) {
            // A label that had to go elsewhere is tied to its point.
            let end = ((*x).clamp(min.0, max.0), (*y).clamp(min.1, max.1));
            if (end.0 - x).abs().max((end.1 - y).abs()) > 36 {
                canvas.line(&[(*x, *y), end], MIDDLE.light, 2)?;
            }
        }
        for ((point, _), [min, max]) in labelled.iter().zip(boxes) {
            // What is under a label must not cross it.
            canvas.area.draw(&Rectangle::new([min, max], PAPER.light.filled()))?;
            canvas.text(&point.label, (min.0, (min.1 + max.1) / 2), colours[&*point.group], HPos::Left)?;
        }
        Ok(())
    }
}
