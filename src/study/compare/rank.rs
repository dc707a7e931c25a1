//! One rank of all structures, and the counts that explain it.

use super::reference::{Reference, cell, speed};
use crate::measure::{Estimate, geometric_mean};
use crate::report::number::plural;
use crate::report::words::{distinct, each_once, interval, listed};
use crate::report::{Finding, Table, Tone};
use crate::study::measurement::{Measurement, trace_noise};
use crate::triangle::{EdgeF64, Exact, MollerTrumboreF64, TriangleTest};

/// The key of the finding that is a label.
pub const FASTEST: &str = "fastest";

/// The triangle tests in double precision and beyond. All others round in single precision.
const PRECISE: [&str; 3] = [Exact::NAME, MollerTrumboreF64::NAME, EdgeF64::NAME];

/// Structures of one kind of triangle test by falling speed.
#[derive(Clone, Debug, PartialEq)]
pub struct Rank {
    pub rows: Vec<Ranked>,
    /// Structures that lack a time in half of the cells or more, with the number of cells in which they have one.
    pub unranked: Vec<(String, usize)>,
}

/// A structure and what explains its place, over the common cells.
#[derive(Clone, Debug, PartialEq)]
pub struct Ranked {
    pub label: String,
    /// Times as fast as the reference, geometric mean.
    pub speed: Option<Estimate>,
    /// For each ray, geometric mean of one more than the count, less one; nothing where the structure does not tell.
    pub tests: Option<f64>,
    pub steps: Option<f64>,
    /// Machine instructions for each ray, where they are counted.
    pub instructions: Option<f64>,
    /// Branches that the processor predicted wrongly, for each ray, where they are counted.
    pub branch_misses: Option<f64>,
    pub bytes_per_triangle: Option<f64>,
}

/// Both ranks over the same cells.
#[derive(Clone, Debug, PartialEq)]
pub struct Ranks {
    pub precise: Rank,
    pub single: Rank,
    pub reference: Reference,
    /// Scene and workload of each common cell, and how many cells there are in all.
    pub cells: Vec<(String, String)>,
    pub all_cells: usize,
}

/// The ranks of `all`, relative to `reference`. Nothing of fewer than two structures.
pub fn ranks(all: &[Measurement], reference: Option<&Reference>) -> Option<Ranks> {
    let reference = reference?.clone();
    let labels = distinct(all.iter().map(|r| &r.label));
    let related = all.iter().filter(|r| reference.rival(all, r).is_some());
    let cells = each_once(related.map(|r| (r.scene.clone(), r.workload.clone())));
    let find = |label: &str, (scene, workload): &(String, String)| {
        let is = |r: &&Measurement| r.label == label && r.scene == *scene && r.workload == *workload;
        all.iter().find(is).filter(|r| r.mrays_per_s.is_some())
    };
    let timed = |label: &str| cells.iter().filter(|cell| find(label, cell).is_some()).count();
    let (ranked, unranked): (Vec<&String>, Vec<&String>) =
        labels.iter().partition(|label| 2 * timed(label.as_str()) > cells.len());
    let common: Vec<(String, String)> =
        cells.iter().filter(|cell| ranked.iter().all(|label| find(label, cell).is_some())).cloned().collect();
    if ranked.len() < 2 || common.is_empty() {
        return None;
    }

    let noise = trace_noise(all);
    let of = |label: &str| {
        let own: Vec<&Measurement> = common.iter().filter_map(|cell| find(label, cell)).collect();
        let pairs = reference.pairs(all, own.iter().copied());
        let middle = |value: &dyn Fn(&Measurement) -> Option<f64>| {
            let values: Option<Vec<f64>> = own.iter().map(|r| value(r)).collect();
            middle(&values?)
        };
        Ranked {
            label: label.into(),
            speed: Reference::ratio(&pairs, &noise),
            tests: middle(&|r| r.tests_per_ray),
            steps: middle(&|r| r.steps_per_ray),
            instructions: middle(&|r| r.instructions_per_ray),
            branch_misses: middle(&|r| r.branch_misses_per_ray),
            bytes_per_triangle: middle(&|r| Some(r.shape.bytes as f64 / r.triangles.max(1) as f64)),
        }
    };
    let is_precise = |label: &str| all.iter().any(|r| r.label == label && PRECISE.contains(&r.triangle_test.as_str()));
    let rank = |precise: bool| {
        let mut rows: Vec<Ranked> =
            ranked.iter().filter(|label| is_precise(label) == precise).map(|label| of(label)).collect();
        let speed = |row: &Ranked| row.speed.map_or(0.0, |speed| speed.estimate);
        rows.sort_by(|a, b| speed(b).total_cmp(&speed(a)));
        let unranked = unranked.iter().filter(|label| is_precise(label) == precise);
        Rank { rows, unranked: unranked.map(|label| ((*label).clone(), timed(label))).collect() }
    };
    let (precise, single) = (rank(true), rank(false));
    Some(Ranks { precise, single, reference, cells: common, all_cells: cells.len() })
}

/// In how many cells a structure gives wrong answers.
fn wrong_cells(all: &[Measurement], label: &str) -> usize {
    all.iter().filter(|record| record.label == label && record.is_disqualified()).count()
}

/// The geometric mean of counts, each one more than it is, less one: of small scenes some are 0.
fn middle(counts: &[f64]) -> Option<f64> {
    let more: Vec<f64> = counts.iter().map(|count| count + 1.0).collect();
    Some(geometric_mean(&more)? - 1.0)
}

impl Ranks {
    /// A table for each rank that has rows.
    pub fn tables(&self, all: &[Measurement]) -> Vec<Table> {
        let scenes = all.iter().filter(|r| self.cells.iter().any(|(scene, _)| *scene == r.scene));
        let scenes: Vec<String> = scenes.map(Measurement::scene_title).collect();
        let scenes = distinct(scenes.iter());
        let over = format!(
            "Geometric means over the {} of scene and workload in which every structure of both tables has a time, of {}: {}.",
            plural(self.cells.len(), "cell"),
            self.all_cells,
            scenes.join(", ")
        );
        let titled = [
            ("Rank with right answers: triangle tests in double precision or exact", &self.precise),
            ("Rank in single precision", &self.single),
        ];
        let tables = titled.into_iter().filter(|(_, rank)| !rank.rows.is_empty());
        tables.map(|(title, rank)| self.table(all, title, rank, &over)).collect()
    }

    fn table(&self, all: &[Measurement], title: &str, rank: &Rank, over: &str) -> Table {
        let best = self.right(all, rank).first().map(|row| row.label.clone());
        let tone = |row: &Ranked| if Some(&row.label) == best.as_ref() { Tone::Best } else { Tone::Plain };
        let speed = format!("x {}", self.reference.name());
        let table = Table::of(
            title,
            &rank.rows,
            &[
                ("structure", &|row| row.label.as_str().into()),
                (&speed, &|row| cell(row.speed).with(tone(row))),
                ("tests", &|row| row.tests.into()),
                ("steps", &|row| row.steps.into()),
                ("instructions", &|row| row.instructions.into()),
                ("branch misses", &|row| row.branch_misses.into()),
                ("bytes a triangle", &|row| row.bytes_per_triangle.into()),
            ],
        );
        let mut notes = vec![
            over.to_owned(),
            format!(
                "x {}: times as fast as {} on the same rays, with the 95 % interval for a rerun. Counts are for each ray: geometric \
                 means of one more than the count, less one. \
                 =: not distinguishable from 1.",
                self.reference.name(),
                self.reference.words()
            ),
        ];
        notes.extend(rank.rows.iter().filter_map(|row| {
            let wrong = wrong_cells(all, &row.label);
            (wrong > 0).then(|| {
                format!(
                    "{} gives wrong answers in {}, which the means leave out for all.",
                    row.label,
                    plural(wrong, "cell")
                )
            })
        }));
        let left: Vec<String> =
            rank.unranked.iter().map(|(label, n)| format!("{label} ({n} of {} cells)", self.all_cells)).collect();
        if !left.is_empty() {
            notes.push(format!("Not ranked, without a time in half of the cells or more: {}.", listed(&left)));
        }
        table.noted(notes).without_empty_columns().explained()
    }

    /// The rows of a rank without one that gives wrong answers in some cell: in single precision some do by their nature, and stay.
    fn right<'a>(&self, all: &[Measurement], rank: &'a Rank) -> Vec<&'a Ranked> {
        let is_right = |row: &&Ranked| *rank == self.single || wrong_cells(all, &row.label) == 0;
        rank.rows.iter().filter(is_right).collect()
    }

    /// The fastest of each rank, and what right answers cost.
    pub fn findings(&self, all: &[Measurement]) -> Vec<Finding> {
        let ranks = [("right", "with right answers", &self.precise), ("single", "in single precision", &self.single)];
        let firsts = ranks.into_iter().filter_map(|(key, words, rank)| self.first(all, key, words, rank));
        let (mut found, fastest): (Vec<Finding>, Vec<Finding>) = firsts.map(|[told, label]| (told, label)).unzip();
        found.extend(self.cost(all));
        // What is right is the fastest, if anything is.
        found.extend(fastest.into_iter().next());
        found
    }

    /// How many times faster `one` is than `other`, over the common cells.
    fn ratio(&self, all: &[Measurement], one: &str, other: &str) -> Option<Estimate> {
        let find = |label: &str, (scene, workload): &(String, String)| {
            all.iter().find(|r| r.label == label && r.scene == *scene && r.workload == *workload)
        };
        let pairs: Option<Vec<_>> = self.cells.iter().map(|cell| find(one, cell).zip(find(other, cell))).collect();
        speed(pairs?, &trace_noise(all))
    }

    /// Who is the fastest of a rank and by how much, and its label alone.
    fn first(&self, all: &[Measurement], key: &str, words: &str, rank: &Rank) -> Option<[Finding; 2]> {
        let rows = self.right(all, rank);
        let first = *rows.first()?;
        let value = first.speed?;
        // All others are looked at: one of them would too easily seem slower by chance.
        let looks = rows.len() - 1;
        let is_level = |row: &&&Ranked| {
            self.ratio(all, &first.label, &row.label).is_some_and(|ratio| ratio.ratio_among(looks).holds(1.0))
        };
        let level: Vec<&str> = rows[1..].iter().filter(is_level).map(|row| row.label.as_str()).collect();
        let is_undecided = rows.iter().any(|row| row.speed.is_some_and(|speed| speed.interval.is_none()));
        let names = match level[..] {
            _ if is_undecided => format!("{} (one epoch)", first.label),
            [] => first.label.clone(),
            [other] => format!("{} or {other}", first.label),
            _ => format!("{} or {} others", first.label, level.len()),
        };
        let level = match level.len() {
            _ if is_undecided => "; one epoch decides nothing".into(),
            0 => String::new(),
            1 => format!("; {} is level with it", level[0]),
            2 | 3 => format!("; {} are level with it", listed(&level)),
            n => format!("; {n} others are level with it"),
        };
        let (reference, times) = (self.reference.words(), interval(value));
        let told = match () {
            () if value == Estimate::exact(1.0) => "it is that which the others are related to".to_owned(),
            () if value.holds(1.0) => format!("it is level with {reference}, {times} times as many rays a second"),
            () => format!("it answers {times} times as many rays a second as {reference}"),
        };
        let (ranked, over) = (plural(rows.len(), "structure"), plural(self.cells.len(), "cell"));
        let sentence = format!(
            "Of {ranked} {words}, {} is the fastest over {over} of scene and kind of rays: {told}{level}.",
            first.label
        );
        Some([Finding::new(key, sentence).of(value), Finding::named(FASTEST, names)])
    }

    /// Times over the default triangle test as multiples of those in single precision, structure by structure with the same keys.
    fn cost(&self, all: &[Measurement]) -> Option<Finding> {
        let of = |row: &Ranked| all.iter().find(|r| r.label == row.label);
        let mut costs: Vec<(&Measurement, Estimate)> = vec![];
        for right in self.precise.rows.iter().filter(|row| !row.label.contains(':')).filter_map(of) {
            let is_same = |r: &&Measurement| r.structure == right.structure && r.config == right.config;
            let single = self.single.rows.iter().filter_map(of).find(is_same);
            let cost = single.and_then(|single| self.ratio(all, &single.label, &right.label));
            costs.extend(cost.map(|cost| (right, cost)));
        }
        costs.sort_by(|a, b| a.1.estimate.total_cmp(&b.1.estimate));
        let told = |(right, cost): &(&Measurement, Estimate)| format!("{} ({})", interval(*cost), right.structure);
        let told = match &costs[..] {
            [] => return None,
            [one] => told(one),
            [least, .., most] => format!("{} to {}", told(least), told(most)),
        };
        let test = &costs[0].0.triangle_test;
        Some(Finding::new(
            "cost",
            format!(
                "Over the triangle test {test} the same structures take {told} times as long as in single precision."
            ),
        ))
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
            tests_per_ray: Some(ns),
            ..example(label, "primary", &[1.0, 1.01, 0.99, 1.02, 1.0].map(|f| f * ns), 5)
        }
    }

    fn reference(all: &[Measurement]) -> Option<Reference> {
        Reference::of(all, None).pop()
    }

    #[test]
    fn structures_are_ranked_over_the_cells_that_all_of_them_have() {
        let single = ["fast:test=moller-trumbore,batch=packets", "fast:test=moller-trumbore", "obvhs-bvh2"];
        let times = [("slow", 4.0), ("fast", 1.0), (single[0], 0.4), (single[1], 0.8), (single[2], 2.0)];
        let mut all: Vec<Measurement> = vec![];
        for scene in ["a", "b", "c"] {
            all.extend(times.map(|(label, ns)| record(scene, label, ns)));
        }
        // No time in one of three cells, and one that has hardly any.
        all[0].mrays_per_s = None;
        all.push(record("a", "rare", 1.0));
        let ranks = ranks(&all, reference(&all).as_ref()).unwrap();
        assert_eq!((ranks.cells.len(), ranks.all_cells), (2, 3));
        let labels = |rank: &Rank| rank.rows.iter().map(|row| row.label.clone()).collect::<Vec<_>>();
        assert_eq!(labels(&ranks.precise), ["fast", "slow"]);
        assert_eq!(labels(&ranks.single), single);
        assert_eq!(ranks.precise.unranked, [("rare".to_owned(), 1)]);
        let speed = ranks.precise.rows[0].speed.unwrap();
        assert!((speed.estimate - 2.0).abs() < 1e-9, "{speed:?}");
        assert!((ranks.precise.rows[1].tests.unwrap() - 4.0).abs() < 1e-9);

        let told: Vec<String> = ranks.findings(&all).into_iter().map(|finding| finding.sentence).collect();
        assert!(
            told[0].starts_with("Of 2 structures with right answers, fast is the fastest over 2 cells"),
            "{told:?}"
        );
        assert!(told[0].contains("answers 2.00") && !told[0].contains("level"), "{told:?}");
        // Of the same keys: packets of the one are not held against single rays of the other.
        assert_eq!(ranks.findings(&all).last().and_then(|finding| finding.name.clone()).as_deref(), Some("fast"));
        assert!(told[2].contains("exact") && told[2].contains("1.25"), "{told:?}");
        // What errs somewhere is no right one, and the table says so.
        let mut erring = all.clone();
        erring.iter_mut().filter(|r| r.label == "fast" && r.scene == "c").for_each(|r| {
            (r.mrays_per_s, r.structure_errors, r.checked_rays) = (None, 2, 9);
        });
        erring.push(record("b", "rare", 1.0));
        let ranks = super::ranks(&erring, reference(&erring).as_ref()).unwrap();
        let told = ranks.findings(&erring).remove(0).sentence;
        assert!(!told.contains("fast is the fastest"), "{told}");
        let notes = ranks.tables(&erring)[0].notes.concat();
        assert!(notes.contains("fast gives wrong answers in 1 cell, which the means leave out for all."), "{notes}");
        let columns = |all: &[Measurement]| -> Vec<Vec<String>> {
            super::ranks(all, reference(all).as_ref())
                .unwrap()
                .tables(all)
                .into_iter()
                .map(|table| table.columns)
                .collect()
        };
        let shown = ["structure", "x obvhs", "tests", "steps", "bytes a triangle"];
        assert_eq!(columns(&all), [shown, shown]);
        all.iter_mut().for_each(|record| record.branch_misses_per_ray = Some(0.5));
        let shown = ["structure", "x obvhs", "tests", "steps", "branch misses", "bytes a triangle"];
        assert_eq!(columns(&all), [shown, shown]);
        assert!(super::ranks(&all[..1], reference(&all[..1]).as_ref()).is_none());
    }
}
