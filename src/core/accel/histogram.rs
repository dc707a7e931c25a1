//! How often each value occurs.

use std::collections::BTreeMap;

use serde::{Deserialize, Serialize};

/// Exact numbers of occurrences, value by value; serialised as pairs of a value and its number, the least value first.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(into = "Vec<(usize, usize)>", from = "Vec<(usize, usize)>")]
pub struct Histogram(BTreeMap<usize, usize>);

impl Histogram {
    /// Counts `value` once more.
    pub fn add(&mut self, value: usize) {
        *self.0.entry(value).or_default() += 1;
    }

    /// The values that occur, the least first, each with how often.
    pub fn iter(&self) -> impl Iterator<Item = (usize, usize)> + '_ {
        self.0.iter().map(|(&value, &times)| (value, times))
    }

    /// Occurrences of all values together.
    pub fn total(&self) -> usize {
        self.0.values().sum()
    }

    /// The largest value that occurs; nothing of nothing.
    pub fn largest(&self) -> Option<usize> {
        self.0.last_key_value().map(|(&value, _)| value)
    }
}

impl From<Histogram> for Vec<(usize, usize)> {
    fn from(histogram: Histogram) -> Self {
        histogram.0.into_iter().collect()
    }
}

impl From<Vec<(usize, usize)>> for Histogram {
    fn from(pairs: Vec<(usize, usize)>) -> Self {
        Self(pairs.into_iter().collect())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn values_are_counted_in_order_and_read_back() {
        let mut histogram = Histogram::default();
        assert_eq!((histogram.largest(), histogram.total()), (None, 0));
        [4, 0, 4, 7].into_iter().for_each(|value| histogram.add(value));
        assert_eq!(histogram.iter().collect::<Vec<_>>(), [(0, 1), (4, 2), (7, 1)]);
        assert_eq!((histogram.largest(), histogram.total()), (Some(7), 4));
        let text = serde_json::to_string(&histogram).unwrap();
        assert_eq!(text, "[[0,1],[4,2],[7,1]]");
        assert_eq!(serde_json::from_str::<Histogram>(&text).unwrap(), histogram);
    }
}
