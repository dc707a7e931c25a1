//! Draws charts with plotters.

mod axes;
mod bars;
mod canvas;
mod chart;
pub mod palette;
mod scatter;
#[cfg(test)]
mod tests;

pub use axes::tick_text;
