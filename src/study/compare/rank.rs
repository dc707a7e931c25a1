//! Ranks structures by mean speed.

use super::reference::{Reference, speed};
use crate::measure::{AaNoise, Estimate};
use crate::report::Finding;
use crate::report::number::plural;
use crate::report::words::{each_once, interval, listed, slug};
use crate::request::is_external;
use crate::study::measurement::{Measurement, trace_noise};
use crate::triangle::{EdgeF64, Exact, MollerTrumboreF64, TriangleTest};

/// The key of the finding that names the fastest structure.
pub const FASTEST: &str = "fastest";

/// The triangle tests that are exact or in double precision.
const PRECISE: [&str; 3] = [Exact::NAME, MollerTrumboreF64::NAME, EdgeF64::NAME];

/// A scene and a workload.
type Cell<'a> = (&'a str, &'a str);

/// Ranked structures have a time in more than half of the reference's cells. A structure with fewer times would reduce
/// the common cells.
pub struct Ranking<'a> {
    all: &'a [Measurement],
    noise: AaNoise,
    reference: &'a Reference,
    /// The cells in which every ranked structure has a time.
    cells: Vec<Cell<'a>>,
    /// Sorted by decreasing speed.
    ranked: Vec<Ranked<'a>>,
}

/// A structure and its speed relative to the reference.
struct Ranked<'a> {
    label: &'a str,
    /// One measurement of the structure.
    example: &'a Measurement,
    speed: Option<Estimate>,
}

/// `None` if the structure has no time in the cell.
fn find<'a>(all: &'a [Measurement], label: &str, (scene, workload): Cell) -> Option<&'a Measurement> {
    let is = |own: &&Measurement| own.label == label && own.scene == scene && own.workload == workload;
    all.iter().find(is).filter(|own| own.mrays_per_s.is_some())
}

impl<'a> Ranking<'a> {
    /// `None` if fewer than two structures are ranked or no common cell exists.
    pub fn of(all: &'a [Measurement], reference: &'a Reference) -> Option<Self> {
        let related = all.iter().filter(|own| reference.rival(all, own).is_some());
        let mut cells: Vec<Cell> = each_once(related.map(|own| (own.scene.as_str(), own.workload.as_str())));
        let has_time = |label: &str, cell: &Cell| find(all, label, *cell).is_some();
        let mut labels: Vec<&str> = each_once(all.iter().map(|own| own.label.as_str()));
        labels.retain(|label| 2 * cells.iter().filter(|cell| has_time(label, cell)).count() > cells.len());
        cells.retain(|cell| labels.iter().all(|label| has_time(label, cell)));
        if labels.len() < 2 || cells.is_empty() {
            return None;
        }

        let noise = trace_noise(all);
        let row = |label: &'a str| {
            let own: Vec<&Measurement> = cells.iter().filter_map(|cell| find(all, label, *cell)).collect();
            let example = own[0];
            Ranked { label, example, speed: Reference::ratio(&reference.pairs(all, own), &noise) }
        };
        let mut ranked: Vec<Ranked> = labels.into_iter().map(row).collect();
        let speed = |row: &Ranked| row.speed.map_or(0.0, |speed| speed.estimate);
        ranked.sort_by(|a, b| speed(b).total_cmp(&speed(a)));
        Some(Self { all, noise, reference, cells, ranked })
    }

    pub fn findings(&self) -> Vec<Finding> {
        let is_precise = |row: &&Ranked| PRECISE.contains(&row.example.triangle_test.as_str());
        let (precise, single): (Vec<&Ranked>, Vec<&Ranked>) = self.ranked.iter().partition(is_precise);
        // Wrong hits do not remove a structure from the ranking `single`.
        let errs = |row: &&Ranked| self.all.iter().any(|own| own.label == row.label && own.is_disqualified());
        let right: Vec<&Ranked> = precise.iter().copied().filter(|row| !errs(row)).collect();
        let ranks = [
            ("right", "with exact or f64 triangle tests and no wrong hits", &right),
            ("single", "in single precision", &single),
        ];
        let firsts = ranks.into_iter().filter_map(|(key, words, rows)| self.first(key, words, rows));
        let (firsts, fastest): (Vec<Finding>, Vec<Finding>) = firsts.unzip();
        let firsts = firsts.into_iter().enumerate();
        let mut found: Vec<Finding> = firsts.map(|(i, own)| if i > 0 { own.detail() } else { own }).collect();
        found.extend(self.cost(&precise, &single).map(Finding::detail));
        found.extend(self.ranked.iter().filter(|row| !errs(row)).filter_map(|row| self.speed_finding(row)));
        // Only one finding has the key `FASTEST`. A structure with a precise test takes precedence.
        found.extend(fastest.into_iter().next());
        found
    }

    /// `None` for built-in structures and the reference.
    fn speed_finding(&self, row: &Ranked) -> Option<Finding> {
        let value = row.speed.filter(|value| {
            *value != Estimate::exact(1.0) && is_external(&row.example.structure, &row.example.triangle_test)
        })?;
        let (label, times, reference) = (row.label, interval(value), self.reference.words());
        let sentence = format!("{label} traces {times} times as many rays per second as {reference}.");
        Some(Finding::new(format!("speed-{}", slug(label)), sentence).with_value(value))
    }

    /// The geometric mean of (speed of `one` / speed of `other`) over the cells.
    fn ratio(&self, one: &str, other: &str) -> Option<Estimate> {
        let pair = |cell: &Cell| find(self.all, one, *cell).zip(find(self.all, other, *cell));
        speed(self.cells.iter().map(pair).collect::<Option<Vec<_>>>()?, &self.noise)
    }

    /// Returns two findings about the fastest structure. The second finding has the key `FASTEST`.
    fn first(&self, key: &str, words: &str, rows: &[&Ranked]) -> Option<(Finding, Finding)> {
        let (first, others) = rows.split_first()?;
        let value = first.speed?;
        // The correction for multiple comparisons counts one comparison per structure in `others`.
        let is_indistinguishable = |row: &&&Ranked| {
            self.ratio(first.label, row.label).is_some_and(|ratio| ratio.ratio_among(others.len()).holds(1.0))
        };
        let level: Vec<&str> = others.iter().filter(is_indistinguishable).map(|row| row.label).collect();
        let is_undecided = rows.iter().any(|row| row.speed.is_some_and(|speed| speed.interval.is_none()));
        let (label, n) = (first.label, level.len());
        let (names, level) = match level[..] {
            _ if is_undecided => {
                (format!("{label} (one epoch)"), "; one epoch gives no interval, so the ranking is undecided".into())
            }
            [] => (label.to_owned(), String::new()),
            [other] => (format!("{label} or {other}"), format!("; {other} is not distinguishable from the fastest")),
            [..] => {
                let names = if n < 4 { listed(&level) } else { format!("{n} others") };
                (format!("{label} or {n} others"), format!("; {names} are not distinguishable from the fastest"))
            }
        };
        let (reference, times) = (self.reference.words(), interval(value));
        let advantage = match () {
            () if value == Estimate::exact(1.0) => "it is itself the reference".to_owned(),
            () if value.holds(1.0) => {
                format!("it is not distinguishable from {reference}: {times} times as many rays per second")
            }
            () => format!("it traces {times} times as many rays per second as {reference}"),
        };
        let (ranked, over) = (plural(rows.len(), "structure"), plural(self.cells.len(), "common cell"));
        let sentence = format!(
            "Of {ranked} {words}, {label} has the highest mean speed over {over} (scene and workload): {advantage}{level}."
        );
        Some((Finding::new(key, sentence).with_value(value), Finding::named(FASTEST, names)))
    }

    /// Time with a precise test / time in single precision.
    ///
    /// The two structures of a ratio differ only in the triangle test.
    fn cost(&self, precise: &[&Ranked<'a>], single: &[&Ranked<'a>]) -> Option<Finding> {
        let kind = |row: &Ranked<'a>| (&row.example.structure, &row.example.config);
        let cost = |right: &&Ranked<'a>| {
            let single = single.iter().find(|row| kind(row) == kind(right))?;
            Some((right.example, self.ratio(single.label, right.label)?))
        };
        let plain = precise.iter().filter(|row| !row.label.contains(':'));
        let mut costs: Vec<(&Measurement, Estimate)> = plain.filter_map(cost).collect();
        costs.sort_by(|a, b| a.1.estimate.total_cmp(&b.1.estimate));
        let cost_of = |(right, cost): &(&Measurement, Estimate)| format!("{} ({})", interval(*cost), right.structure);
        let range = match &costs[..] {
            [] => return None,
            [one] => cost_of(one),
            [least, .., most] => format!("{} to {}", cost_of(least), cost_of(most)),
        };
        let test = &costs[0].0.triangle_test;
        let sentence =
            format!("Structures take {range} times as long with the {test} triangle test as in single precision.");
        Some(Finding::new("cost", sentence))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::study::measurement::tests::example;

    fn record(scene: &str, label: &str, ns: f64) -> Measurement {
        let default = if label.starts_with("obvhs") { "native" } else { "exact" };
        let test = label.split("test=").nth(1).map_or(default, |keys| keys.split(',').next().unwrap());
        Measurement {
            scene: scene.into(),
            triangle_test: test.into(),
            config: label.contains("batch=packets").into(),
            mrays_per_s: Some(1e3 / ns),
            ..example(label, "primary", &[1.0, 1.01, 0.99, 1.02, 1.0].map(|f| f * ns), 5)
        }
    }

    #[test]
    fn structures_are_ranked_over_the_cells_that_all_of_them_have() {
        let single = ["fast:test=moller-trumbore,batch=packets", "fast:test=moller-trumbore", "obvhs-bvh2"];
        let times = [("slow", 4.0), ("fast", 1.0), (single[0], 0.4), (single[1], 0.8), (single[2], 2.0)];
        let mut all: Vec<Measurement> = vec![];
        for scene in ["a", "b", "c"] {
            all.extend(times.map(|(label, ns)| record(scene, label, ns)));
        }
        // Structure `slow` has no time in scene a. Structure `rare` has a time only in scene a.
        all[0].mrays_per_s = None;
        all.push(record("a", "rare", 1.0));
        let reference = Reference::of(&all, None).pop().unwrap();
        let ranking = Ranking::of(&all, &reference).unwrap();
        assert_eq!(ranking.cells, [("b", "primary"), ("c", "primary")]);
        let labels: Vec<&str> = ranking.ranked.iter().map(|row| row.label).collect();
        assert_eq!(labels, [single[0], single[1], "fast", single[2], "slow"]);
        let speed = ranking.ranked[2].speed.unwrap();
        assert!((speed.estimate - 2.0).abs() < 1e-9, "{speed:?}");

        let findings = ranking.findings();
        let sentences: Vec<&str> = findings.iter().map(|finding| finding.sentence.as_str()).collect();
        let first = "Of 2 structures with exact or f64 triangle tests and no wrong hits, fast has the highest mean \
                     speed over 2 common cells";
        assert!(sentences[0].starts_with(first), "{sentences:?}");
        assert!(sentences[0].contains("traces 2.00") && !sentences[0].contains("distinguishable"), "{sentences:?}");
        assert!(
            sentences[1].starts_with(&format!("Of 3 structures in single precision, {} has", single[0])),
            "{sentences:?}"
        );
        // The ratio 1.25 compares two structures without packets.
        assert!(sentences[2].contains("exact") && sentences[2].contains("1.25"), "{sentences:?}");
        assert_eq!(findings.last().and_then(|finding| finding.name.as_deref()), Some("fast"));
        // Wrong hits in scene c remove `fast` from the ranking of correct structures.
        let mut erring = all.clone();
        erring.iter_mut().filter(|r| r.label == "fast" && r.scene == "c").for_each(|r| {
            (r.mrays_per_s, r.wrong_hits, r.checked_rays) = (None, 2, 9);
        });
        erring.push(record("b", "rare", 1.0));
        let sentence = Ranking::of(&erring, &reference).unwrap().findings().remove(0).sentence;
        assert!(!sentence.contains("fast has the highest"), "{sentence}");
        assert!(Ranking::of(&all[..1], &reference).is_none());
    }
}
