//! All kinds of charts behind one name.

use super::{Bars, Curves, Scatter, Tradeoff};

/// Width of drawings that stand alone, in their units.
pub const WIDTH: f64 = 900.0;

#[derive(Clone, Debug, PartialEq)]
pub enum Chart {
    Bars(Bars),
    Curves(Curves),
    /// Always as wide as it is, 800: labels stand all over.
    Scatter(Scatter),
    Tradeoff(Tradeoff),
}
