//! Charts as data: bars, curves and scatter plots. The feature `page` adds SVG drawings of charts.

mod chart;
#[cfg(feature = "page")]
mod drawing;

pub use chart::{Bar, BarGroup, Bars, Chart, Curves, LABELLED, Line, Point, Scatter, WIDTH};
#[cfg(feature = "page")]
pub use drawing::{palette, tick_text};
