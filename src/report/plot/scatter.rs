//! Points on two logarithmic axes, with the border that nothing passes.

use crate::report::words::distinct;

#[derive(Clone, Debug, PartialEq)]
pub struct Scatter {
    pub x_title: String,
    pub y_title: String,
    pub points: Vec<Point>,
}

/// A point. Both coordinates are positive and finite.
#[derive(Clone, Debug, PartialEq)]
pub struct Point {
    pub x: f64,
    pub y: f64,
    /// Whether nothing but an upper bound is known of `y`: then an arrow points down from it.
    pub is_bound: bool,
    /// Whether no other point is better in both: these are filled, and a line joins them.
    pub is_front: bool,
    /// Stands beside the point.
    pub label: String,
    /// What its colour means; structures have their colours.
    pub group: String,
}

/// Points that are all labelled; where there are more, those of the front alone are.
pub const LABELLED: usize = 20;

impl Scatter {
    /// What there are colours for.
    pub fn groups(&self) -> Vec<String> {
        distinct(self.points.iter().map(|point| &point.group))
    }
}
