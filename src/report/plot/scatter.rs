//! Points on two logarithmic axes, with the border that nothing passes.

use plotters::element::{Circle, Polygon, Rectangle};
use plotters::prelude::DrawingBackend;
use plotters::style::text_anchor::{HPos, Pos, VPos};
use plotters::style::Color;

use super::axes::{self, GAP, Labels, axes, height_with_legend, left_of, legend, padded, tick_text};
use super::canvas::{Area, Canvas, DrawResult, HEAD, Place, TEXT, text_style, width_of};
use super::labels::{Rect, place};
use super::palette::{Colour, INK, MIDDLE, PAPER, colours};
use crate::report::number::figures;

/// Panels, one below the other, with one legend.
#[derive(Clone, Debug, PartialEq)]
pub struct Scatter {
    pub panels: Vec<Panel>,
    /// The colours: names of the groups that points belong to; structures have their colours.
    pub groups: Vec<String>,
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
    /// Stands beside the point; may be empty.
    pub label: String,
    /// Index into the groups of the figure.
    pub group: usize,
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
    fn panels_height(&self, width: i32) -> i32 {
        self.panels.len() as i32 * PANEL.min(width)
    }

    /// Height of the drawing where it is `width` wide.
    pub fn height(&self, width: i32) -> i32 {
        let panels = height_with_legend(self.panels_height(width), self.groups.len(), width);
        panels + self.notes.len() as i32 * NOTE + GAP
    }

    pub fn draw<B: DrawingBackend>(&self, canvas: &Canvas<B>, width: i32) -> DrawResult<B> {
        let colours = colours(&self.groups);
        let entries: Vec<(String, Colour)> = self.groups.iter().cloned().zip(colours.iter().copied()).collect();
        let foot = self.height(width) - self.notes.len() as i32 * NOTE - GAP;
        for (row, note) in self.notes.iter().enumerate() {
            canvas.text(note, (GAP, foot + row as i32 * NOTE + NOTE / 2), INK.light, HPos::Left)?;
        }
        let (area, _) = canvas.area.split_vertically(foot);
        let (area, _) = legend(&area, &entries)?.split_vertically(self.panels_height(width));
        for (panel, area) in self.panels.iter().zip(area.split_evenly((self.panels.len(), 1))) {
            panel.draw(canvas, &area, &colours)?;
        }
        Ok(())
    }
}

impl Panel {
    fn draw<B: DrawingBackend>(&self, canvas: &Canvas<B>, area: &Area<B>, colours: &[Colour]) -> DrawResult<B> {
        let top = if self.title.is_empty() { GAP } else { TITLE };
        area.draw_text(&self.title, &text_style(HEAD, INK.light).pos(Pos::new(HPos::Left, VPos::Top)), (GAP, 8))?;
        let (width, height) = area.dim_in_pixel();
        if self.points.is_empty() {
            let (x, y) = area.get_base_pixel();
            let middle = (x + width as i32 / 2, y + height as i32 / 2);
            return canvas.text("nothing to show", middle, INK.light, HPos::Center);
        }
        // Room on the right for a label, below for the arrows of bounds.
        let y_ends = padded(self.points.iter().map(|point| point.y), [0.15, 0.1]);
        let y = axes::upward(y_ends, height as i32 - top - axes::BOTTOM);
        let left = left_of(&y);
        let x_ends = padded(self.points.iter().map(|point| point.x), [0.1, 0.2]);
        let x = axes::across(x_ends, width as i32 - left - GAP);
        let text = |value: &f64| tick_text(*value);
        let (x_title, y_title) = (&self.x_title, &self.y_title);
        let chart =
            axes(area, (x, y), &Labels { x_title, y_title, x: &text, y: &text, left, top, right: GAP })?;
        let places: Vec<Place> = self.points.iter().map(|point| chart.backend_coord(&(point.x, point.y))).collect();
        let (x_range, y_range) = chart.plotting_area().get_pixel_range();
        let frame = [(x_range.start, y_range.start), (x_range.end, y_range.end)];
        self.draw_front(canvas, &places, x_range.end)?;
        self.draw_labels(canvas, colours, &places, frame)?;
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

    fn draw_points<B: DrawingBackend>(&self, canvas: &Canvas<B>, colours: &[Colour], places: &[Place]) -> DrawResult<B> {
        // What is on the front is drawn last, so that it is on top.
        for front in [false, true] {
            for (point, &(x, y)) in self.points.iter().zip(places).filter(|(point, _)| point.is_front == front) {
                let colour = colours[point.group];
                if point.is_bound {
                    canvas.line(&[(x, y), (x, y + ARROW - 8)], colour, 4)?;
                    let (tip, wings) = (y + ARROW, y + ARROW - 14);
                    canvas.area.draw(&Polygon::new([(x - 9, wings), (x + 9, wings), (x, tip)], colour.filled()))?;
                }
                let inside = if front { colour } else { PAPER.light };
                canvas.area.draw(&Circle::new((x, y), RADIUS, inside.filled()))?;
                canvas.area.draw(&Circle::new((x, y), RADIUS, colour.stroke_width(4)))?;
                let bound = if point.is_bound { "at most " } else { "" };
                let name = if point.label.is_empty() { &self.groups[point.group] } else { &point.label };
                let told = [point.x, point.y].map(figures);
                let told = format!("{name}: {bound}{} {}; {} {}", told[1], self.y_title, told[0], self.x_title);
                canvas.tip_at((x, y), told);
            }
        }
        Ok(())
    }

    fn draw_labels<B: DrawingBackend>(
        &self,
        canvas: &Canvas<B>,
        colours: &[Colour],
        places: &[Place],
        frame: [Place; 2],
    ) -> DrawResult<B> {
        // Those of the front choose first; among too many points nobody would find what belongs to a label.
        let all = self.points.len() <= LABELLED;
        let is_labelled = |point: &Point| !point.label.is_empty() && (all || point.is_front);
        let mut labelled: Vec<(&Point, [f64; 2])> = self.points.iter().zip(places.iter().map(|&p| float(p))).collect();
        labelled.retain(|(point, _)| is_labelled(point));
        labelled.sort_by_key(|(point, _)| !point.is_front);
        let around = f64::from(RADIUS) + 4.0;
        let obstacles: Vec<Rect> = self
            .points
            .iter()
            .zip(places)
            .map(|(point, &place)| {
                let [x, y] = float(place);
                let below = if point.is_bound { f64::from(ARROW) + 4.0 } else { around };
                Rect { min: [x - around, y - around], max: [x + around, y + below] }
            })
            .collect();
        let size = |point: &Point| [f64::from(width_of(&point.label, TEXT)), f64::from(TEXT)];
        let sizes: Vec<[f64; 2]> = labelled.iter().map(|(point, _)| size(point)).collect();
        let points: Vec<[f64; 2]> = labelled.iter().map(|(_, place)| *place).collect();
        let [min, max] = frame.map(float);
        let inner = Rect { min: [min[0] + 12.0, min[1]], max: [max[0] - 4.0, max[1] - 8.0] };
        let placed = place(&points, &sizes, &obstacles, inner);
        // A label that had to go elsewhere is tied to its point.
        for (rect, point) in placed.iter().zip(&points).filter(|(rect, point)| rect.distance(**point) > 36.0) {
            let end = std::array::from_fn(|axis| point[axis].clamp(rect.min[axis], rect.max[axis]));
            canvas.line(&[pixel(*point), pixel(end)], MIDDLE.light, 2)?;
        }
        for ((point, _), rect) in labelled.iter().zip(placed) {
            // What is under a label must not cross it.
            let corners = [rect.min, rect.max].map(pixel);
            canvas.area.draw(&Rectangle::new(corners, PAPER.light.filled()))?;
            let middle = pixel([rect.min[0], 0.5 * (rect.min[1] + rect.max[1])]);
            canvas.text(&point.label, middle, colours[point.group], HPos::Left)?;
        }
        Ok(())
    }
}

fn float((x, y): Place) -> [f64; 2] {
    [f64::from(x), f64::from(y)]
}

fn pixel([x, y]: [f64; 2]) -> Place {
    (x.round() as i32, y.round() as i32)
}
