//! Charts as data: bars, curves and scatter plots.

use crate::measure::Estimate;
use crate::report::words::distinct;

/// Default width of a drawing, in units of two pixels.
pub const WIDTH: f64 = 900.0;

#[derive(Clone, Debug, PartialEq)]
pub enum Chart {
    Bars(Bars),
    Curves(Curves),
    /// Always 800 units wide, to leave space for labels between the points.
    Scatter(Scatter),
}

/// Speedups as groups of bars with intervals. Every bar starts at 1 on a logarithmic axis. All groups have the same
/// axis, and the same labels in the same order. A bar may be split into the factors of a product.
#[derive(Clone, Debug, PartialEq)]
pub struct Bars {
    pub x_title: String,
    /// Names of the bars, the same in every group. The name determines the colour of the bar.
    pub labels: Vec<String>,
    /// Names of the factors of the bars; empty if the bars have no factors.
    pub parts: Vec<String>,
    pub groups: Vec<BarGroup>,
}

#[derive(Clone, Debug, PartialEq)]
pub struct BarGroup {
    /// May be empty.
    pub title: String,
    pub bars: Vec<Bar>,
}

/// One bar. All numbers are positive.
#[derive(Clone, Debug, PartialEq)]
pub enum Bar {
    Of(Estimate),
    /// One factor for each of [`Bars::parts`], and the product.
    Product(Vec<f64>, Estimate),
    /// The reason why there is no bar, in a word or two; may be empty.
    Missing(String),
}

impl Bar {
    pub fn value(&self) -> Option<Estimate> {
        match self {
            Self::Of(value) | Self::Product(_, value) => Some(*value),
            Self::Missing(_) => None,
        }
    }
}

impl Bars {
    /// One group of products without a heading; `parts` names the factors.
    pub fn of_products(x_title: &str, parts: Vec<String>, rows: impl IntoIterator<Item = (String, Bar)>) -> Self {
        let (labels, bars) = rows.into_iter().unzip();
        let group = BarGroup { title: String::new(), bars };
        Self { x_title: x_title.into(), labels, parts, groups: vec![group] }
    }
}

/// Lines through points on two logarithmic axes: a power law is a straight line.
#[derive(Clone, Debug, PartialEq)]
pub struct Curves {
    pub x_title: String,
    pub y_title: String,
    pub lines: Vec<Line>,
}

/// A line through points, from left to right.
#[derive(Clone, Debug, PartialEq)]
pub struct Line {
    /// The name of the line. It determines the colour.
    pub label: String,
    /// The text after the label in the legend.
    pub note: String,
    /// Both coordinates are positive.
    pub points: Vec<(f64, f64)>,
}

/// Points on two logarithmic axes, with the Pareto front.
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
    /// Whether only an upper bound of `y` is known: then an arrow points down from the point.
    pub is_bound: bool,
    /// Whether the point is on the Pareto front. Points of the front are filled, and a line joins them.
    pub is_front: bool,
    /// The text beside the point.
    pub label: String,
    /// The name of the point's group. It determines the colour.
    pub group: String,
}

/// The maximum number of points that are all labelled. With more points, only the front is labelled.
pub const LABELLED: usize = 20;

impl Scatter {
    /// The distinct groups, in the order of their first points.
    pub fn groups(&self) -> Vec<String> {
        distinct(self.points.iter().map(|point| &point.group))
    }
}
