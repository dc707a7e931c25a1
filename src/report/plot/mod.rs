//! Charts as data: bars, curves and scatter plots. With the feature `page` they are drawn as SVG of the requested
//! width: text keeps its size on a narrow screen.

mod chart;
#[cfg(feature = "page")]
mod drawing;

pub use chart::{Bar, BarGroup, Bars, Chart, Curves, LABELLED, Line, Point, Scatter, WIDTH};
#[cfg(feature = "page")]
pub use drawing::{palette, tick_text};
