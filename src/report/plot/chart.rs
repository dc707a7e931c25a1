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

/// Groups of bars on one logarithmic axis. Every bar starts at 1.
#[derive(Clone, Debug, PartialEq)]
pub struct Bars {
    pub x_title: String,
    /// Names of the bars, equal in all groups. The name determines the colour.
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

/// All numbers are positive.
#[derive(Clone, Debug, PartialEq)]
pub enum Bar {
    Of(Estimate),
    /// One factor for each of [`Bars::parts`], and the product.
    Product(Vec<f64>, Estimate),
    /// The reason why the bar is missing; may be empty.
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
    pub fn of_products(x_title: &str, parts: Vec<String>, rows: impl IntoIterator<Item = (String, Bar)>) -> Self {
        let (labels, bars) = rows.into_iter().unzip();
        let group = BarGroup { title: String::new(), bars };
        Self { x_title: x_title.into(), labels, parts, groups: vec![group] }
    }
}

/// Lines through points on two logarithmic axes.
#[derive(Clone, Debug, PartialEq)]
pub struct Curves {
    pub x_title: String,
    pub y_title: String,
    pub lines: Vec<Line>,
}

#[derive(Clone, Debug, PartialEq)]
pub struct Line {
    /// The label determines the colour.
    pub label: String,
    /// The text after the label in the legend.
    pub note: String,
    /// Points from left to right. Both coordinates are positive.
    pub points: Vec<(f64, f64)>,
}

/// Points on two logarithmic axes.
#[derive(Clone, Debug, PartialEq)]
pub struct Scatter {
    pub x_title: String,
    pub y_title: String,
    pub points: Vec<Point>,
}

/// Both coordinates are positive and finite.
#[derive(Clone, Debug, PartialEq)]
pub struct Point {
    pub x: f64,
    pub y: f64,
    /// Whether `y` is only an upper bound.
    pub is_bound: bool,
    /// Whether the point is on the Pareto front.
    pub is_front: bool,
    pub label: String,
    /// The group determines the colour.
    pub group: String,
}

/// The maximum number of points that are all labelled. With more points, only the Pareto front is labelled.
pub const LABELLED: usize = 20;

impl Scatter {
    pub fn groups(&self) -> Vec<String> {
        distinct(self.points.iter().map(|point| &point.group))
    }
}
