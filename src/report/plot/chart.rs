//! All kinds of charts in one type.

use super::{Bars, Curves, Scatter, Tradeoff};

/// Default width of a drawing, in its units.
pub const WIDTH: f64 = 900.0;

#[derive(Clone, Debug, PartialEq)]
pub enum Chart {
    Bars(Bars),
    Curves(Curves),
    /// Always 800 units wide, because labels stand everywhere.
    Scatter(Scatter),
    Tradeoff(Tradeoff),
}
