//! Charts as data: bars, curves and scatter plots.

use crate::measure::Estimate;
use crate::report::words::distinct;

/// Default width of a drawing, in units of two pixels.
pub const WIDTH: f64 = 900.0;

#[derive(Clone, Debug, PartialEq)]
pub enum Chart {
    Bars(Bars),
    Curves(Curves),
    Scatter(Scatter),
}

/// Groups of bars along a logarithmic axis. Every bar starts at 1.
#[derive(Clone, Debug, PartialEq)]
pub struct Bars {
    pub x_title: String,
    /// Names of the bars in every group.
    pub labels: Vec<String>,
    /// Names of the factors of each [`Bar::Product`].
    pub parts: Vec<String>,
    pub groups: Vec<BarGroup>,
}

#[derive(Clone, Debug, PartialEq)]
pub struct BarGroup {
    /// May be empty.
    pub title: String,
    pub bars: Vec<Bar>,
}

/// All numbers of a bar are positive.
#[derive(Clone, Debug, PartialEq)]
pub enum Bar {
    Of(Estimate),
    /// One factor for each name in [`Bars::parts`], and the product.
    Product(Vec<f64>, Estimate),
    /// The reason why the bar is missing. The reason may be empty.
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

/// A line plot with two logarithmic axes.
#[derive(Clone, Debug, PartialEq)]
pub struct Curves {
    pub x_title: String,
    pub y_title: String,
    pub lines: Vec<Line>,
}

#[derive(Clone, Debug, PartialEq)]
pub struct Line {
    /// The colour of the line depends on the label.
    pub label: String,
    /// The text after the label in the legend.
    pub note: String,
    /// Points (x, y) with positive coordinates, sorted by x.
    pub points: Vec<(f64, f64)>,
}

/// A scatter plot with two logarithmic axes.
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
    /// The colour of the point depends on the group.
    pub group: String,
}

/// If a scatter plot has more than `LABELLED` points, only the points on the Pareto front have labels.
pub const LABELLED: usize = 20;

impl Scatter {
    pub fn groups(&self) -> Vec<String> {
        distinct(self.points.iter().map(|point| &point.group))
    }
}
