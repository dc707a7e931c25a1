//! What all charts draw with: areas of an SVG file, and text in the one font.
//!
//! Lengths are pixels, two for each unit of width that a chart is asked for: pictures are sharp where they are shown
//! smaller.

use std::io;
use std::sync::Once;

use plotters::coord::Shift;
use plotters::drawing::{DrawingArea, DrawingAreaErrorKind};
use plotters::element::PathElement;
use plotters::prelude::SVGBackend;
use plotters::style::text_anchor::{HPos, Pos, VPos};
use plotters::style::{Color, FontStyle, IntoFont, TextStyle, register_font};

use super::palette::Colour;

pub type Area<'a> = DrawingArea<SVGBackend<'a>, Shift>;

pub type DrawResult<T = ()> = Result<T, DrawingAreaErrorKind<io::Error>>;

/// A place in pixels, from the top left corner of the drawing.
pub type Place = (i32, i32);

/// Size of text, from the top of the highest letter to the bottom of the lowest.
pub const TEXT: i32 = 32;

/// Name of the font: in an SVG, what the viewer takes for it; elsewhere the font that comes with the program.
const FONT: &str = "sans-serif";

/// The system's fonts are not asked: the same picture everywhere. Ubuntu Light is under the Ubuntu Font Licence.
pub fn register() {
    static ONCE: Once = Once::new();
    ONCE.call_once(|| {
        let registered = register_font(FONT, FontStyle::Normal, epaint_default_fonts::UBUNTU_LIGHT);
        assert!(registered.is_ok(), "the font that comes with the program is a font");
    });
}

pub fn text_style(colour: Colour) -> TextStyle<'static> {
    TextStyle { color: colour.to_backend_color(), ..(FONT, TEXT).into_font().into() }
}

/// Width of a line of text; somewhat more than it takes, since the viewer of an SVG has a font of its own.
pub fn width_of(text: &str) -> i32 {
    register();
    let (width, _) = (FONT, TEXT).into_font().box_size(text).expect("the font is registered");
    (1.06 * f64::from(width)) as i32
}

pub fn widest<'a>(texts: impl IntoIterator<Item = &'a String>) -> i32 {
    texts.into_iter().map(|text| width_of(text)).max().unwrap_or(0)
}

/// Draws a line of text, which begins, has its middle or ends at `place`, at half its height.
pub fn text(area: &Area, text: &str, place: Place, colour: Colour, side: HPos) -> DrawResult {
    area.draw_text(text, &text_style(colour).pos(Pos::new(side, VPos::Center)), place)
}

pub fn line(area: &Area, points: &[Place], colour: Colour, width: u32) -> DrawResult {
    area.draw(&PathElement::new(points, colour.stroke_width(width)))
}
