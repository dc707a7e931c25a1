//! The tables of the study `replicate`.

use super::original::SWEEP;
use super::replication::{BRUTE, Replicated, SAH, TREE};
use crate::report::{Cell, Table, Value};

/// `all` is `main` followed by `hard`.
pub fn tables(all: &[Replicated], main: &[Replicated], hard: &[Replicated]) -> Vec<Table> {
    let note = "~: extrapolated from a subset of the rays. improvement: brute-force / median-kd; times faster: \
                median-kd / sah-kd; both from times of one round.";
    let easy = table("Seconds for all rays, without construction", main, &SECONDS).noted([note]);
    let note = "~: extrapolated from a subset of the rays. times faster: median-kd / sah-kd, from times of one round.";
    let hard = table("Hard scenes: seconds for the primary rays, without construction", hard, &SECONDS).noted([note]);
    let t_primes = table("t' = seconds / (rays x triangles)", all, &T_PRIMES);
    let all = [rays(all), easy, t_primes, settings(main), hard];
    all.into_iter().filter(Table::has_values).map(Table::with_interval_note).collect()
}

fn rays(all: &[Replicated]) -> Table {
    let difference = |own: &Replicated| Value::Difference(own.total() as i64 - own.report.rays as i64);
    Table::of(
        "Rays of a 512 x 512 picture",
        all,
        &[
            ("scene", &|own| own.first().title().into()),
            ("primary", &|own| own.rays()[0].into()),
            ("mirror", &|own| own.rays()[1].into()),
            ("shadow", &|own| own.rays()[2].into()),
            ("total", &|own| own.total().into()),
            ("report", &|own| own.report.rays.into()),
            ("difference", &|own| difference(own).into()),
        ],
    )
    .noted([
        "Hard scenes: primary rays only, as in the report. Starters uses our own creatures, so its rays differ.",
        "Secondary rays start at the hits of a single-precision triangle test, as in the report's program.",
    ])
}

fn seconds(own: &Replicated, role: &str) -> Cell {
    let seconds = own.seconds(role).map(|seconds| seconds.estimate);
    Cell::from(seconds).sampled(own.is_sampled(role) == Some(true))
}

/// The heading, the CSV name and the cell function of a column.
type ReplicatedColumn = (&'static str, &'static str, fn(&Replicated) -> Cell);

const SECONDS: [ReplicatedColumn; 12] = [
    ("triangles", "triangles", |own| own.first().triangles.into()),
    ("median-kd", "tree_seconds", |own| seconds(own, TREE)),
    ("report", "report_tree_s", |own| own.report.tree_s.into()),
    ("brute-force", "brute_force_seconds", |own| seconds(own, BRUTE)),
    ("report", "report_brute_force_s", |own| own.report.brute_s.into()),
    ("improvement [95%]", "improvement", |own| own.improvement().into()),
    ("report", "report_improvement", |own| own.report.improvement.into()),
    ("sah-kd", "sah_seconds", |own| seconds(own, SAH)),
    ("times faster [95%]", "sah_over_median", |own| own.faster().into()),
    ("build: median-kd", "tree_build_s", |own| own.build_s(TREE).into()),
    ("report", "report_tree_build_s", |own| own.report.build_s.into()),
    ("build: sah-kd", "sah_build_s", |own| own.build_s(SAH).into()),
];

const T_PRIMES: [ReplicatedColumn; 5] = [
    ("median-kd", "tree_t_prime", |own| own.t_prime(TREE).into()),
    ("report", "report_tree_t_prime", |own| own.report.t_prime(own.report.tree_s).into()),
    ("brute-force", "brute_force_t_prime", |own| own.t_prime(BRUTE).into()),
    ("report", "report_brute_force_t_prime", |own| own.report.brute_s.map(|s| own.report.t_prime(s)).into()),
    ("sah-kd", "sah_t_prime", |own| own.t_prime(SAH).into()),
];

fn table(title: &str, scenes: &[Replicated], columns: &[ReplicatedColumn]) -> Table {
    let mut table = Table::of(title, scenes, &[("scene", &|own| own.first().title().into())]);
    columns.iter().for_each(|(name, _, cell)| table.push_column(*name, scenes.iter().map(cell)));
    table.without_empty_columns()
}

fn settings(main: &[Replicated]) -> Table {
    let mut table = table("Seconds of median-kd with other settings", main, &[]);
    for setting in &SWEEP {
        table.push_column(setting.role(), main.iter().map(|own| seconds(own, &setting.role())));
        table.push_column("report", main.iter().map(|own| setting.of(own.report.scene).into()));
    }
    let note = "Leaf limit / match threshold. The report's figures of Teapot and Torus are swapped in print and corrected \
                here.";
    table.noted([note])
}

pub fn data(all: &[Replicated]) -> Table {
    let mut table = rays(all).without_columns(&["difference"]);
    SECONDS.iter().chain(&T_PRIMES).for_each(|(_, name, cell)| table.push_column(*name, all.iter().map(cell)));
    table.push_column("brute_force_build_s", all.iter().map(|own| own.build_s(BRUTE).into()));
    for (name, role) in [("tree", TREE), ("brute_force", BRUTE), ("sah", SAH)] {
        table.push_column(format!("{name}_sampled"), all.iter().map(|own| own.is_sampled(role).into()));
    }
    for setting in &SWEEP {
        let name = format!("seconds_{}_{}", setting.leaf, setting.threshold);
        table.push_column(name, all.iter().map(|own| seconds(own, &setting.role())));
    }
    table
}
