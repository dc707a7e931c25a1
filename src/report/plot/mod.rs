//! Charts as SVG: bars, curves and scatter plots, of the width that is asked
//! for, so that text keeps its size on a narrow screen.

mod axes;
mod bars;
mod canvas;
mod chart;
mod curves;
mod labels;
pub mod palette;
mod scatter;
mod tradeoff;

pub use axes::tick_text;
pub use bars::{Bar, BarGroup, Bars};
pub use chart::{Chart, WIDTH};
pub use curves::{Curves, Line};
pub use scatter::{LABELLED, Point, Scatter};
pub use tradeoff::{Tradeoff, TradeoffCase, TradeoffPoint};

#[cfg(test)]
mod tests;
