//! The measures as tables for people.

use super::{Measures, RayMeasures};
use crate::accel::Histogram;
use crate::report::number::{bytes, count, figures};
use crate::report::{Cell, Table};
use crate::study::Refused;
use crate::study::grouped::grouped;

/// What the columns mean.
pub const LEGEND: [&str; 4] = [
    "references: (leaf, triangle) pairs; x: those for each triangle; mean and largest: references of a leaf that is not empty. SAH: \
     expected cost of a random line, EPO: end-point overlap, what a ray pays for boxes that hold its end and not its triangle; both \
     in triangle tests, a node costing 1.2.",
    "tests: triangles tested, steps: nodes and leaves entered, leaves and empty: those of them that are leaves, and empty ones, all \
     for each ray. x minimum: tests as a multiple of the fewest possible, which are one for each ray that hits and none for the \
     others.",
    "branch misses: branches that the processor predicts wrongly, for each ray, where processor and kernel count them; all other \
     columns are the same on every machine.",
    "Bars: the number of leaves by size and by depth, each from the least to the largest that occurs.",
];

/// The tables of one scene: what the structures are, how they look, and what each kind of rays costs.
pub fn tables(measures: &[Measures], refused: &[Refused]) -> Vec<Table> {
    let Some(first) = measures.first() else {
        return vec![Table {
            title: "Every structure is refused.".into(),
            notes: refusals(refused),
            ..Table::default()
        }];
    };
    let mut tables = vec![trees(first, measures, refused), looks(measures)];
    let rays = measures.iter().flat_map(|one| &one.rays);
    let kinds = grouped(rays, |a, b| a.workload == b.workload);
    tables.extend(kinds.into_iter().map(|kind| of_rays(first, kind[0], measures)));
    tables
}

fn refusals(refused: &[Refused]) -> Vec<String> {
    refused.iter().map(|one| format!("{} refused: {}.", one.label, one.reason)).collect()
}

fn known(x: Option<f64>) -> Cell {
    x.map(figures).into()
}

fn trees(first: &Measures, measures: &[Measures], refused: &[Refused]) -> Table {
    let number = |n: usize| Cell::from(count(n as u64));
    let stand_in = if first.stand_in { ", stand-in" } else { "" };
    Table::of(
        format!("{}: {} triangles{stand_in}", first.scene, count(first.triangles as u64)),
        measures,
        &[
            ("structure", &|one| one.structure.as_str().into()),
            ("inner", &|one| number(one.tree.inner_nodes)),
            ("leaves", &|one| number(one.tree.leaves)),
            ("empty", &|one| number(one.tree.empty_leaves)),
            ("references", &|one| number(one.tree.references)),
            ("x", &|one| known(one.tree.duplication)),
            ("mean", &|one| known(one.tree.mean_leaf)),
            ("largest", &|one| number(one.tree.largest_leaf)),
            ("depth", &|one| number(one.tree.depth)),
            ("SAH", &|one| known(one.tree.sah_cost)),
            ("EPO", &|one| known(one.tree.end_point_overlap)),
            ("memory", &|one| bytes(one.tree.bytes).into()),
        ],
    )
    .noted(refusals(refused))
}

fn of_rays(first: &Measures, kind: &RayMeasures, measures: &[Measures]) -> Table {
    let is_of_kind = |rays: &&RayMeasures| rays.workload == kind.workload;
    let asked = measures.iter().filter_map(|one| Some((&one.structure, one.rays.iter().find(is_of_kind)?)));
    let (rays, hit) = (count(kind.rays as u64), figures(kind.hit_rate * 100.0));
    Table::of(
        format!("{}, {} rays ({}): {rays}, of which {hit} % hit", first.scene, kind.workload, kind.query.name()),
        asked,
        &[
            ("structure", &|(structure, _)| structure.as_str().into()),
            ("tests", &|(_, rays)| known(rays.tests_per_ray)),
            ("steps", &|(_, rays)| known(rays.steps_per_ray)),
            ("leaves", &|(_, rays)| known(rays.leaf_steps_per_ray)),
            ("empty", &|(_, rays)| known(rays.empty_leaf_steps_per_ray)),
            ("x minimum", &|(_, rays)| known(rays.tests_over_minimum)),
            ("branch misses", &|(_, rays)| known(rays.branch_misses_per_ray)),
        ],
    )
    .without_blank_columns()
}

/// Bars of a row of bars, at most.
const BARS: usize = 32;

fn looks(measures: &[Measures]) -> Table {
    let rows = measures.iter().map(|one| {
        let mut row = vec![Cell::from(one.structure.as_str())];
        for histogram in [&one.tree.leaf_sizes, &one.tree.leaf_depths] {
            let bins = bins(histogram, BARS);
            row.push(range(&bins).map_or(Cell::blank(), Cell::from));
            row.push(bars(&bins).into());
        }
        row
    });
    Table::new(
        format!("{}: leaves by size and by depth", measures[0].scene),
        ["structure", "sizes", "leaves", "depths", "leaves"],
        rows,
    )
}

/// Values from the first to the last, and how many leaves have one of them.
struct Bin {
    first: usize,
    last: usize,
    leaves: usize,
}

/// At most `limit` bins of equal width, from the least value to the largest.
fn bins(histogram: &Histogram, limit: usize) -> Vec<Bin> {
    let Some((least, largest)) = histogram.iter().next().map(|(least, _)| least).zip(histogram.largest()) else {
        return vec![];
    };
    let width = (largest - least + 1).div_ceil(limit);
    let mut bins: Vec<Bin> = (least..=largest)
        .step_by(width)
        .map(|first| Bin { first, last: (first + width - 1).min(largest), leaves: 0 })
        .collect();
    for (value, times) in histogram.iter() {
        bins[(value - least) / width].leaves += times;
    }
    bins
}

fn range(bins: &[Bin]) -> Option<String> {
    let (first, last) = (bins.first()?.first, bins.last()?.last);
    Some(if first == last { count(first as u64) } else { format!("{} to {}", count(first as u64), count(last as u64)) })
}

/// One character a bin, the higher the more leaves; blank where there is none.
fn bars(bins: &[Bin]) -> String {
    const HEIGHTS: [char; 8] = ['▁', '▂', '▃', '▄', '▅', '▆', '▇', '█'];
    let most = bins.iter().map(|bin| bin.leaves).max().unwrap_or(0);
    let bar = |bin: &Bin| match bin.leaves {
        0 => ' ',
        leaves => HEIGHTS[(leaves * HEIGHTS.len()).div_ceil(most) - 1],
    };
    bins.iter().map(bar).collect()
}

/// Rows of a table of one histogram, at most, and characters of its longest bar.
const ROWS: usize = 24;
const LONGEST: usize = 40;

/// Two tables for each structure: its leaves by size and by depth, in numbers.
pub fn histogram_tables(measures: &[Measures]) -> Vec<Table> {
    let both = |one: &Measures| {
        let of = |what: &str, histogram: &Histogram| {
            let bins = bins(histogram, ROWS);
            let most = bins.iter().map(|bin| bin.leaves).max().unwrap_or(0);
            let rows = bins.iter().map(|bin| {
                let share = bin.leaves as f64 / histogram.total() as f64;
                let bar = "#".repeat((bin.leaves * LONGEST).div_ceil(most));
                let value = range(std::slice::from_ref(bin)).expect("there is a bin");
                // The bar begins at the left of its column.
                let cells =
                    [value, count(bin.leaves as u64), format!("{:.1} %", share * 100.0), format!("{bar:<LONGEST$}")];
                cells.map(Cell::from).into()
            });
            Table::new(
                format!("{}, {}: leaves by {what}", one.scene, one.structure),
                [what, "leaves", "share", ""],
                rows,
            )
        };
        [of("size", &one.tree.leaf_sizes), of("depth", &one.tree.leaf_depths)]
    };
    measures.iter().flat_map(both).filter(|table| !table.rows.is_empty()).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn histogram(values: &[(usize, usize)]) -> Histogram {
        Histogram::from(values.to_vec())
    }

    #[test]
    fn bars_are_as_high_as_leaves_are_many() {
        let bins = bins(&histogram(&[(2, 1), (3, 8), (5, 4)]), BARS);
        assert_eq!(bars(&bins), "▁█ ▄");
        assert_eq!(range(&bins).unwrap(), "2 to 5");
        assert_eq!((bars(&[]), range(&[])), (String::new(), None));
    }

    #[test]
    fn many_values_share_bins_and_none_is_lost() {
        let values: Vec<(usize, usize)> = (0..101).map(|value| (value, value)).collect();
        let bins = bins(&histogram(&values), 24);
        assert!(bins.len() <= 24, "{}", bins.len());
        assert_eq!(bins.iter().map(|bin| bin.leaves).sum::<usize>(), 5050);
        assert!(bins.windows(2).all(|pair| pair[0].last + 1 == pair[1].first));
        assert_eq!(bins.last().unwrap().last, 100);
    }
}
