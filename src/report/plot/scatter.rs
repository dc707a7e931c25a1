//! Points on two logarithmic axes, with the Pareto front.

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
    /// Whether only an upper bound of `y` is known: then an arrow points down from it.
    pub is_bound: bool,
    /// Whether no other point is better in both: such points are filled, and a line joins them.
    pub is_front: bool,
    /// The text beside the point.
    pub label: String,
    /// The meaning of its colour; structures have fixed colours.
    pub group: String,
}

/// The maximum number of points that are all labelled; with more points only the front has labels.
pub const LABELLED: usize = 20;

impl Scatter {
    /// The groups with a colour.
    pub fn groups(&self) -> Vec<String> {
        distinct(self.points.iter().map(|point| &point.group))
    }
}
