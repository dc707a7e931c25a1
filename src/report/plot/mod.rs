//! Charts as data: bars, curves and scatter plots. With the feature `page` they are drawn as SVG of the requested
//! width: text keeps its size on a narrow screen.

mod bars;
mod chart;
mod curves;
#[cfg(feature = "page")]
mod drawing;
mod scatter;
mod tradeoff;

pub use bars::{Bar, BarGroup, Bars};
pub use chart::{Chart, WIDTH};
pub use curves::{Curves, Line};
#[cfg(feature = "page")]
pub use drawing::{palette, tick_text};
pub use scatter::{LABELLED, Point, Scatter};
pub use tradeoff::{Tradeoff, TradeoffCase, TradeoffPoint};
