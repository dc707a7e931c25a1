//! What a table relates speeds to.

use super::cells::speed;
use crate::measure::{AaNoise, Estimate};
use crate::report::words::interval;
use crate::report::{Cell, Record};
use crate::study::reference_structures::{REPORT_TREE, is_reference};

/// The other side of a column of ratios.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Reference {
    /// The structure of this label.
    Structure(String),
    /// The BVH of obvhs that is the fastest on the same scene and rays.
    Obvhs,
}

impl Reference {
    /// The one that is `named`; else the report's tree and obvhs, of these what was measured; else the first structure.
    pub fn of(records: &[Record], named: Option<&str>) -> Vec<Self> {
        if let Some(label) = named {
            return vec![Self::Structure(label.into())];
        }
        let mut found = vec![];
        if records.iter().any(|r| r.label == REPORT_TREE) {
            found.push(Self::Structure(REPORT_TREE.into()));
        }
        if records.iter().any(is_reference) {
            found.push(Self::Obvhs);
        }
        if found.is_empty() {
            found.extend(records.first().map(|first| Self::Structure(first.label.clone())));
        }
        found
    }

    /// As columns name it: `median`, `obvhs` or a label.
    pub fn name(&self) -> &str {
        match self {
            Self::Structure(label) if label == REPORT_TREE => "median",
            Self::Structure(label) => label,
            Self::Obvhs => "obvhs",
        }
    }

    /// As sentences name it.
    pub fn words(&self) -> String {
        match self {
            Self::Structure(label) if label == REPORT_TREE => format!("the report's tree, {label}"),
            Self::Structure(label) => label.clone(),
            Self::Obvhs => "the better BVH of obvhs".into(),
        }
    }

    /// What the case `of` is related to: the same scene and rays. Nothing where that has no time.
    pub fn rival<'a>(&self, records: &'a [Record], of: &Record) -> Option<&'a Record> {
        let is = |r: &&Record| match self {
            Self::Structure(label) => r.label == *label,
            Self::Obvhs => is_reference(r),
        };
        let same = records.iter().filter(|r| r.scene == of.scene && r.workload == of.workload);
        let timed = same.filter(is).filter(|r| r.mrays_per_s.is_some());
        timed.max_by(|a, b| a.mrays_per_s.partial_cmp(&b.mrays_per_s).expect("numbers"))
    }

    /// The cases `of` with what they are related to: those of which both have a time.
    pub fn pairs<'a>(
        &self,
        records: &'a [Record],
        of: impl IntoIterator<Item = &'a Record>,
    ) -> Vec<(&'a Record, &'a Record)> {
        let timed = of.into_iter().filter(|r| r.mrays_per_s.is_some());
        timed.filter_map(|r| Some((r, self.rival(records, r)?))).collect()
    }

    /// The geometric mean of how many times faster the first of each pair is; a structure against itself has no
    /// interval. `noise` as in [`speed`].
    pub fn ratio(pairs: &[(&Record, &Record)], noise: &AaNoise) -> Option<Estimate> {
        let own = !pairs.is_empty() && pairs.iter().all(|(own, other)| own.label == other.label);
        if own {
            return Some(Estimate::exact(1.0));
        }
        speed(pairs.iter().copied(), noise)
    }
}

/// A ratio with its interval, and a sign where it is not distinguishable from 1.
pub fn cell(ratio: Option<Estimate>) -> Cell {
    let Some(ratio) = ratio else { return Cell::blank() };
    let same = ratio != Estimate::exact(1.0) && ratio.holds(1.0);
    format!("{}{}", interval(ratio), if same { " =" } else { "" }).into()
}
