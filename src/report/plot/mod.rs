//! Charts as data: bars, curves and scatter plots. The feature `page` adds their drawings as SVG.

mod chart;
#[cfg(feature = "page")]
mod drawing;

pub use chart::{Bar, BarGroup, Bars, Chart, Curves, LABELLED, Line, Point, Scatter, WIDTH};
#[cfg(feature = "page")]
pub use drawing::{palette, tick_text};
