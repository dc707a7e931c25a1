//! Lines through points over two logarithmic axes: a power is a straight line.

#[derive(Clone, Debug, PartialEq)]
pub struct Curves {
    pub x_title: String,
    pub y_title: String,
    pub lines: Vec<Line>,
}

/// A line through points, from left to right.
#[derive(Clone, Debug, PartialEq)]
pub struct Line {
    /// Structures have fixed colours.
    pub label: String,
    /// The text behind it.
    pub note: String,
    /// Both coordinates are positive.
    pub points: Vec<(f64, f64)>,
}
