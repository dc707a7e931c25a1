//! The reference of a table, and ratios between measurements with their intervals.

use crate::measure::{AaNoise, Estimate, Rerun, cut_to_shared_epochs, epoch_values, mean};
use crate::registry::is_named;
use crate::request::REPORT_TREE;
use crate::study::measurement::{Measurement, is_native_obvhs};

/// The geometric mean of (speed of the first structure / speed of the second) over the pairs. The mean uses all epochs
/// of each pair. The interval uses only the epochs that all pairs have. `None` if a measurement has no time, or the
/// samples of a pair are not from the same rounds.
pub fn speed<'a>(
    pairs: impl IntoIterator<Item = (&'a Measurement, &'a Measurement)>,
    noise: &AaNoise,
) -> Option<Estimate> {
    let cells = pairs.into_iter().map(|(own, other)| own.speed_against(other));
    let mut cells: Vec<_> = cells.collect::<Option<_>>()?;
    let of_cell = |cell: &Vec<Vec<f64>>| Some(mean(&epoch_values(std::slice::from_ref(cell))?));
    let centre = mean(&cells.iter().map(of_cell).collect::<Option<Vec<f64>>>()?);
    // Scenes have different numbers of epochs if time ran out.
    cut_to_shared_epochs(&mut cells);
    Some(Rerun::of(&epoch_values(&cells)?, noise.of_mean(cells.len()))?.around(centre).ratio())
}

/// The reference of a column of ratios.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Reference {
    Structure(String),
    /// The fastest obvhs BVH on the same scene and rays.
    Obvhs,
}

impl Reference {
    /// By default, returns the report's tree and obvhs if measured, or else the first structure.
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

    /// The measurement of the reference on the scene and workload of `of`.
    pub fn rival<'a>(&self, all: &'a [Measurement], of: &Measurement) -> Option<&'a Measurement> {
        let is = |own: &&Measurement| match self {
            Self::Structure(label) => own.label == *label,
            Self::Obvhs => is_native_obvhs(own),
        };
        let same = all.iter().filter(|own| own.scene == of.scene && own.workload == of.workload);
        let timed = same.filter(is).filter(|own| own.mrays_per_s.is_some());
        timed.max_by(|a, b| a.mrays_per_s.partial_cmp(&b.mrays_per_s).expect("numbers"))
    }

    /// Each measurement in `of` with its reference, if both have a time.
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
