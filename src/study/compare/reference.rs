//! The reference of a table, and speeds relative to the reference.

use crate::measure::{AaNoise, Estimate, Rerun, cut_to_shared_epochs, epoch_values, mean};
use crate::registry::is_named;
use crate::request::REPORT_TREE;
use crate::study::measurement::{Measurement, is_native_obvhs};

/// The geometric mean of (speed of the first measurement / speed of the second measurement) over `pairs`.
///
/// The mean uses all epochs of each pair. The interval uses only the epochs that all pairs have.
/// `None` if a pair is not comparable.
pub fn speed<'a>(
    pairs: impl IntoIterator<Item = (&'a Measurement, &'a Measurement)>,
    noise: &AaNoise,
) -> Option<Estimate> {
    let cells = pairs.into_iter().map(|(own, other)| own.speed_against(other));
    let mut cells: Vec<_> = cells.collect::<Option<_>>()?;
    let of_cell = |cell: &Vec<Vec<f64>>| Some(mean(&epoch_values(std::slice::from_ref(cell))?));
    let centre = mean(&cells.iter().map(of_cell).collect::<Option<Vec<f64>>>()?);
    // Scenes may differ in their number of epochs.
    cut_to_shared_epochs(&mut cells);
    Some(Rerun::of(&epoch_values(&cells)?, noise.of_mean(cells.len()))?.around(centre).ratio())
}

/// The reference of a column of ratios.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Reference {
    Structure(String),
    /// The fastest obvhs BVH on each scene and workload.
    Obvhs,
}

impl Reference {
    pub fn of(all: &[Measurement], named: Option<&str>) -> Vec<Self> {
        if let Some(spec) = named {
            let known = all.iter().map(|own| own.label.as_str()).find(|label| is_named(label, spec));
            return vec![Self::Structure(known.unwrap_or(spec).into())];
        }
        let mut found = vec![];
        found.extend(all.iter().any(|own| own.label == REPORT_TREE).then(|| Self::Structure(REPORT_TREE.into())));
        found.extend(all.iter().any(is_native_obvhs).then_some(Self::Obvhs));
        if found.is_empty() {
            found.extend(all.first().map(|first| Self::Structure(first.label.clone())));
        }
        found
    }

    pub fn name(&self) -> &str {
        match self {
            Self::Structure(label) if label == REPORT_TREE => "median",
            Self::Structure(label) => label,
            Self::Obvhs => "obvhs",
        }
    }

    pub fn words(&self) -> String {
        match self {
            Self::Structure(label) if label == REPORT_TREE => format!("the report's tree, {label}"),
            Self::Structure(label) => label.clone(),
            Self::Obvhs => "each cell's faster obvhs BVH".into(),
        }
    }

    /// Returns the reference's measurement for the same scene and workload as `of`.
    pub fn rival<'a>(&self, all: &'a [Measurement], of: &Measurement) -> Option<&'a Measurement> {
        let is = |own: &&Measurement| match self {
            Self::Structure(label) => own.label == *label,
            Self::Obvhs => is_native_obvhs(own),
        };
        let same = all.iter().filter(|own| own.scene == of.scene && own.workload == of.workload);
        let timed = same.filter(is).filter(|own| own.mrays_per_s.is_some());
        timed.max_by(|a, b| a.mrays_per_s.partial_cmp(&b.mrays_per_s).expect("numbers"))
    }

    /// Pairs each measurement in `of` with its `rival`. Each measurement of a pair has a time.
    pub fn pairs<'a>(
        &self,
        all: &'a [Measurement],
        of: impl IntoIterator<Item = &'a Measurement>,
    ) -> Vec<(&'a Measurement, &'a Measurement)> {
        let timed = of.into_iter().filter(|own| own.mrays_per_s.is_some());
        timed.filter_map(|own| Some((own, self.rival(all, own)?))).collect()
    }

    /// Like `speed`, but exactly 1 if every structure is paired with itself.
    pub fn ratio(pairs: &[(&Measurement, &Measurement)], noise: &AaNoise) -> Option<Estimate> {
        let is_itself = !pairs.is_empty() && pairs.iter().all(|(own, other)| own.label == other.label);
        if is_itself { Some(Estimate::exact(1.0)) } else { speed(pairs.iter().copied(), noise) }
    }
}
