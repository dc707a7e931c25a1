//! All kinds of plots behind one name.

use super::canvas::{self, Canvas, WIDTH};
use super::{Bars, Curves, Figure, Scatter, Stack};

/// A plot of any kind.
#[derive(Clone, Debug, PartialEq)]
pub enum Chart {
    Bars(Bars),
    Curves(Curves),
    Stack(Stack),
    Scatter(Scatter),
    /// Points with labels; always as wide as it is, 800.
    Points(Figure),
}

impl Chart {
    /// The width it has where it is to be `width` wide.
    fn width(&self, width: f64) -> f64 {
        if matches!(self, Self::Points(_)) { WIDTH } else { width }
    }

    fn height(&self, width: f64) -> f64 {
        match self {
            Self::Bars(bars) => bars.height(width),
            Self::Curves(curves) => curves.height(width),
            Self::Stack(stack) => stack.height(width),
            Self::Scatter(scatter) => scatter.curves().height(width),
            Self::Points(figure) => figure.height(),
        }
    }

    fn draw(&self, canvas: &Canvas, width: f64) {
        match self {
            Self::Bars(bars) => bars.draw(canvas, width),
            Self::Curves(curves) => curves.draw(canvas, width),
            Self::Stack(stack) => stack.draw(canvas, width),
            Self::Scatter(scatter) => scatter.curves().draw(canvas, width),
            Self::Points(figure) => figure.draw(canvas),
        }
    }

    /// The text of an SVG file, `width` units wide if it can be; a unit is half as long as one of the file's view box.
    pub fn svg(&self, width: f64) -> String {
        let width = self.width(width);
        canvas::svg([width, self.height(width)], |canvas| self.draw(canvas, width))
    }

    /// The bytes of a PNG file of two pixels a unit.
    pub fn png(&self, width: f64) -> Vec<u8> {
        let width = self.width(width);
        canvas::png([width, self.height(width)], |canvas| self.draw(canvas, width))
    }
}
