//! The only file that draws with plotters: lines, dots and text in the units of the picture.

use std::cell::RefCell;
use std::sync::Once;

use plotters::coord::Shift;
use plotters::drawing::{DrawingArea, IntoDrawingArea};
use plotters::element::{Circle, PathElement, Polygon, Text};
use plotters::prelude::{BitMapBackend, DrawingBackend, SVGBackend};
use plotters::style::text_anchor::{HPos, Pos, VPos};
use plotters::style::{Color, FontStyle, IntoFont, ShapeStyle, TextStyle, register_font};

use super::palette::{Colour, PAPER};

use crate::render::Picture;

/// Width of a picture in its own units, where nothing else is asked for.
pub const WIDTH: f64 = 800.0;

/// Pixels a unit.
const SCALE: f64 = 2.0;

/// Sizes of text, in units, from the top of the highest letter to the bottom of the lowest.
pub const HEAD: f64 = 20.0;
pub const BODY: f64 = 17.0;
pub const SMALL: f64 = 16.0;

/// Where text stands, seen from its point.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Side {
    /// The text begins at the point.
    Left,
    Centre,
    /// The text ends at the point.
    Right,
}

/// What is drawn on.
pub struct Canvas<'a> {
    area: &'a dyn Surface,
    /// What a pointer is told, in the order in which it is drawn: later ones are on top.
    tips: RefCell<Vec<Tip>>,
}

/// A place and what is there.
struct Tip {
    min: [f64; 2],
    max: [f64; 2],
    text: String,
}

/// A drawing area without the type of its backend.
trait Surface {
    fn line(&self, points: Vec<(i32, i32)>, style: ShapeStyle);
    fn circle(&self, centre: (i32, i32), radius: i32, style: ShapeStyle);
    fn polygon(&self, points: Vec<(i32, i32)>, style: ShapeStyle);
    fn text(&self, text: &str, at: (i32, i32), style: TextStyle);
}

/// Memory takes every stroke, and the font is there: nothing can fail.
impl<B: DrawingBackend> Surface for DrawingArea<B, Shift> {
    fn line(&self, points: Vec<(i32, i32)>, style: ShapeStyle) {
        self.draw(&PathElement::new(points, style)).expect(DRAWN);
    }

    fn circle(&self, centre: (i32, i32), radius: i32, style: ShapeStyle) {
        self.draw(&Circle::new(centre, radius, style)).expect(DRAWN);
    }

    fn polygon(&self, points: Vec<(i32, i32)>, style: ShapeStyle) {
        self.draw(&Polygon::new(points, style)).expect(DRAWN);
    }

    fn text(&self, text: &str, at: (i32, i32), style: TextStyle) {
        self.draw(&Text::new(text, at, style)).expect(DRAWN);
    }
}

const DRAWN: &str = "memory takes every stroke, and the font is registered";

/// Name of the font: in an SVG, what the viewer takes for it; elsewhere the font that comes with the program.
const FONT: &str = "sans-serif";

/// The system's fonts are not asked: the same picture everywhere. Ubuntu Light is under the Ubuntu Font Licence.
fn register() {
    static ONCE: Once = Once::new();
    ONCE.call_once(|| {
        let registered = register_font(FONT, FontStyle::Normal, epaint_default_fonts::UBUNTU_LIGHT);
        assert!(registered.is_ok(), "the font that comes with the program is a font");
    });
}

fn pixels(units: f64) -> i32 {
    (units * SCALE).round() as i32
}

/// The text of an SVG file, `width` and `height` large, with what `draw` draws.
pub fn svg([width, height]: [f64; 2], draw: impl FnOnce(&Canvas)) -> String {
    register();
    let mut text = String::new();
    let tips;
    {
        let size = (pixels(width) as u32, pixels(height) as u32);
        let area = SVGBackend::with_string(&mut text, size).into_drawing_area();
        area.fill(&PAPER.light).expect(DRAWN);
        let canvas = Canvas { area: &area, tips: RefCell::default() };
        draw(&canvas);
        tips = canvas.tips.take();
        area.present().expect(DRAWN);
    }
    let end = text.rfind("</svg>").unwrap_or(text.len());
    text.insert_str(end, &tips.iter().map(Tip::svg).collect::<String>());
    text
}

/// The bytes of a PNG file, `width` and `height` large, with what `draw` draws.
pub fn png([width, height]: [f64; 2], draw: impl FnOnce(&Canvas)) -> Vec<u8> {
    register();
    let size = [pixels(width) as u32, pixels(height) as u32];
    let mut bytes = vec![255; size[0] as usize * size[1] as usize * 3];
    {
        let area = BitMapBackend::with_buffer(&mut bytes, size.into()).into_drawing_area();
        draw(&Canvas { area: &area, tips: RefCell::default() });
        area.present().expect(DRAWN);
    }
    let (colours, _) = bytes.as_chunks::<3>();
    Picture::new(size, colours.to_vec()).png()
}

impl Tip {
    fn svg(&self) -> String {
        let [[x, y], [right, bottom]] = [at(&self.min), at(&self.max)].map(|(x, y)| [x, y]);
        let text = self.text.replace('&', "&amp;").replace('<', "&lt;");
        let (width, height) = (right - x, bottom - y);
        format!(
            "<rect class=\"tip\" x=\"{x}\" y=\"{y}\" width=\"{width}\" height=\"{height}\" fill=\"none\" pointer-events=\"all\">\
             <title>{text}</title></rect>\n"
        )
    }
}

impl Canvas<'_> {
    /// A line `width` wide through `points`.
    pub fn line(&self, points: &[[f64; 2]], colour: Colour, width: f64) {
        self.area.line(points.iter().map(at).collect(), colour.stroke_width(pixels(width) as u32));
    }

    /// A disc, or a circle with white in it.
    pub fn dot(&self, centre: [f64; 2], radius: f64, colour: Colour, filled: bool) {
        let inside = if filled { colour } else { PAPER.light };
        self.area.circle(at(&centre), pixels(radius), inside.filled());
        self.ring(centre, radius, colour);
    }

    /// A circle with nothing in it.
    pub fn ring(&self, centre: [f64; 2], radius: f64, colour: Colour) {
        self.area.circle(at(&centre), pixels(radius), colour.stroke_width(pixels(2.0) as u32));
    }

    /// What a pointer between two corners is told. Pictures of pixels do not have it.
    pub fn tip(&self, min: [f64; 2], max: [f64; 2], text: String) {
        self.tips.borrow_mut().push(Tip { min, max, text });
    }

    /// As [`tip`](Self::tip), about a point.
    pub fn tip_at(&self, [x, y]: [f64; 2], text: String) {
        const REACH: f64 = 8.0;
        self.tip([x - REACH, y - REACH], [x + REACH, y + REACH], text);
    }

    /// An arrow down from `from`.
    pub fn arrow(&self, from: [f64; 2], length: f64, colour: Colour) {
        let [x, y] = from;
        self.line(&[from, [x, y + length - 4.0]], colour, 2.0);
        let tip = [[x - 4.5, y + length - 7.0], [x + 4.5, y + length - 7.0], [x, y + length]];
        self.area.polygon(tip.iter().map(at).collect(), colour.filled());
    }

    /// A rectangle between two corners.
    pub fn rect(&self, min: [f64; 2], max: [f64; 2], colour: Colour) {
        let corners = [min, [max[0], min[1]], max, [min[0], max[1]]];
        self.area.polygon(corners.iter().map(at).collect(), colour.filled());
    }

    /// What is between two lines of as many points, so pale that what is under it is seen.
    pub fn band(&self, low: &[[f64; 2]], high: &[[f64; 2]], colour: Colour) {
        let outline: Vec<(i32, i32)> = low.iter().chain(high.iter().rev()).map(at).collect();
        self.area.polygon(outline, colour.mix(0.18).filled());
    }

    /// One line of text, centred at `x` unless it would leave what is `width` wide.
    pub fn centred(&self, text: &str, [x, y]: [f64; 2], size: f64, colour: Colour, width: f64) {
        let half = 0.5 * width_of(text, size) + 2.0;
        self.text(text, [x.min(width - half).max(half), y], size, colour, Side::Centre);
    }

    /// One line of text, its middle at the height of `point`.
    pub fn text(&self, text: &str, point: [f64; 2], size: f64, colour: Colour, side: Side) {
        let horizontal = match side {
            Side::Left => HPos::Left,
            Side::Centre => HPos::Center,
            Side::Right => HPos::Right,
        };
        let style = TextStyle::from((FONT, size * SCALE).into_font()).color(&colour);
        self.area.text(text, at(&point), style.pos(Pos::new(horizontal, VPos::Center)));
    }
}

/// Width of a line of text; somewhat more than it takes, since the viewer of an SVG has a font of its own.
pub fn width_of(text: &str, size: f64) -> f64 {
    register();
    let (width, _) = (FONT, size * SCALE).into_font().box_size(text).expect(DRAWN);
    1.06 * f64::from(width) / SCALE
}

fn at(point: &[f64; 2]) -> (i32, i32) {
    (pixels(point[0]), pixels(point[1]))
}
