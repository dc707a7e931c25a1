//! Drawing primitives of all charts.
//!
//! Lengths are in pixels of the SVG's view box.

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

/// A point in pixels, relative to the top left corner of an [`Area`].
pub type Place = (i32, i32);

/// Height of a line of text.
pub const TEXT: i32 = 32;

/// The program that displays the SVG chooses the font. Text is measured with the embedded font.
const FONT: &str = "sans-serif";

/// Registers the embedded font. With this font, layouts are equal on all systems. Ubuntu Light has the Ubuntu Font
/// Licence.
pub fn register() {
    static ONCE: Once = Once::new();
    ONCE.call_once(|| {
        let registered = register_font(FONT, FontStyle::Normal, epaint_default_fonts::UBUNTU_LIGHT);
        assert!(registered.is_ok(), "the embedded font is valid");
    });
}

pub fn text_style(colour: Colour) -> TextStyle<'static> {
    TextStyle { color: colour.to_backend_color(), ..(FONT, TEXT).into_font().into() }
}

/// The width of a line of text plus 6 %. The displayed font may be wider than the embedded font.
pub fn width_of(text: &str) -> i32 {
    register();
    let (width, _) = (FONT, TEXT).into_font().box_size(text).expect("the font is registered");
    (1.06 * f64::from(width)) as i32
}

pub fn widest<'a>(texts: impl IntoIterator<Item = &'a String>) -> i32 {
    texts.into_iter().map(|text| width_of(text)).max().unwrap_or(0)
}

/// The vertical middle of the text is at `place`. With `HPos::Left`, the left end of the text is at `place`.
pub fn text(area: &Area, text: &str, place: Place, colour: Colour, side: HPos) -> DrawResult {
    area.draw_text(text, &text_style(colour).pos(Pos::new(side, VPos::Center)), place)
}

pub fn line(area: &Area, points: &[Place], colour: Colour, width: u32) -> DrawResult {
    area.draw(&PathElement::new(points, colour.stroke_width(width)))
}
