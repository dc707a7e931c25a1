//! Bars with intervals on one logarithmic axis that starts at 1: speedups. A bar may consist of the factors of a
//! product, whose lengths add up to the whole.

use crate::measure::Estimate;

/// Groups of bars that share labels, order and axis.
#[derive(Clone, Debug, PartialEq)]
pub struct Bars {
    pub x_title: String,
    /// Names of the bars of every group; structures have fixed colours.
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
    /// One factor per part, and the whole.
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
    /// Bars of products with factors of these names, without a heading.
    pub fn of_products(x_title: &str, parts: Vec<String>, rows: impl IntoIterator<Item = (String, Bar)>) -> Self {
        let (labels, bars) = rows.into_iter().unzip();
        let group = BarGroup { title: String::new(), bars };
        Self { x_title: x_title.into(), labels, parts, groups: vec![group] }
    }
}
