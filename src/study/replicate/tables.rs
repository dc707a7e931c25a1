//! The study as tables.

use super::findings::order;
use super::original::SWEEP;
use super::replication::{BRUTE, Replicated, SAH, Times, mean};
use crate::report::{Cell, Table, Value};

const SAMPLED: &str = "~ a part of the rays was timed and stands for all.";

/// The tables in the order of the report, then its conclusion.
pub fn tables(main: &[Replicated], hard: &[Replicated]) -> Vec<Table> {
    let all =
        [rays(main.iter().chain(hard)), seconds(main), t_primes(main), settings(main), on_hard(hard), conclusion(hard)];
    all.into_iter().filter(Table::says_something).collect()
}

fn rays<'a>(all: impl Iterator<Item = &'a Replicated>) -> Table {
    let difference = |own: &Replicated| Value::Difference(own.total() as i64 - own.report.rays as i64);
    Table::of(
        "Rays of a 512 x 512 picture",
        all,
        &[
            ("scene", &|own: &&Replicated| own.title.as_str().into()),
            ("primary", &|own| own.primary.into()),
            ("mirror", &|own| own.mirror.into()),
            ("shadow", &|own| own.shadow.into()),
            ("total", &|own| own.total().into()),
            ("report", &|own| own.report.rays.into()),
            ("difference", &|own| difference(own).into()),
        ],
    )
    .noted(vec![
        "Hard scenes: primary rays alone, as in the report. Starters has creatures of our own, and so its own rays."
            .into(),
        "Secondary rays start where a triangle test in single precision finds a hit, as in the report's program."
            .into(),
    ])
}

/// Seconds, marked where a part of the rays stands for all.
fn cell(times: Option<&Times>) -> Cell {
    times.map(|times| Cell::from(times.seconds).sampled(times.sampled)).into()
}

fn t_prime(times: Option<&Times>) -> Cell {
    times.map(|times| times.t_prime.estimate).into()
}

fn seconds(main: &[Replicated]) -> Table {
    let table = Table::of(
        "Seconds of all rays, construction left out",
        main,
        &[
            ("scene", &|own| own.title.as_str().into()),
            ("triangles", &|own| own.triangles.into()),
            ("median-kd", &|own| cell(own.tree())),
            ("report", &|own| own.report.tree_s.into()),
            ("brute-force", &|own| cell(own.times(BRUTE))),
            ("report", &|own| own.report.brute_s.into()),
            ("improvement [95%]", &|own| own.improvement.into()),
            ("report", &|own| own.report.improvement.into()),
            ("sah-kd", &|own| cell(own.times(SAH))),
        ],
    );
    let mut notes = vec![format!("improvement: brute-force / median-kd. {SAMPLED}")];
    notes.extend(order(main).and_then(|(_, reversed)| reversed));
    table.noted(notes).explained()
}

fn t_primes(main: &[Replicated]) -> Table {
    Table::of(
        "t' = seconds / (rays x triangles)",
        main,
        &[
            ("scene", &|own| own.title.as_str().into()),
            ("median-kd", &|own| t_prime(own.tree())),
            ("report", &|own| own.report.t_prime(own.report.tree_s).into()),
            ("brute-force", &|own| t_prime(own.times(BRUTE))),
            ("report", &|own| own.report.brute_s.map(|seconds| own.report.t_prime(seconds)).into()),
            ("sah-kd", &|own| t_prime(own.times(SAH))),
        ],
    )
}

fn settings(main: &[Replicated]) -> Table {
    let columns = ["L / T"].into_iter().chain(main.iter().map(|own| own.title.as_str()));
    let mut rows = vec![];
    for setting in &SWEEP {
        let ours = main.iter().map(|own| cell(own.times(&setting.role())));
        let theirs = main.iter().map(|own| setting.of(own.report.scene).into());
        rows.push(std::iter::once(Cell::from(setting.role())).chain(ours).collect());
        rows.push(std::iter::once(Cell::from("  report")).chain(theirs).collect());
    }
    Table::new("Seconds of median-kd with other settings", columns, rows).noted(vec![
        "L: leaf limit; T: match threshold. The report's columns Teapot and Torus, swapped in print, stand right."
            .into(),
    ])
}

fn on_hard(hard: &[Replicated]) -> Table {
    let build = |times: Option<&Times>| Cell::from(times.map(|times| times.build_s));
    Table::of(
        "Hard scenes: seconds of the primary rays, and of the construction",
        hard,
        &[
            ("scene", &|own| own.title.as_str().into()),
            ("triangles", &|own| own.triangles.into()),
            ("median-kd", &|own| cell(own.tree())),
            ("report", &|own| own.report.tree_s.into()),
            ("t'", &|own| t_prime(own.tree())),
            ("report", &|own| own.report.t_prime(own.report.tree_s).into()),
            ("build", &|own| build(own.tree())),
            ("report", &|own| own.report.build_s.into()),
            ("sah-kd", &|own| cell(own.times(SAH))),
            ("build", &|own| build(own.times(SAH))),
        ],
    )
    .noted(vec![SAMPLED.into()])
}

fn conclusion(hard: &[Replicated]) -> Table {
    let mut rows: Vec<Vec<Cell>> = hard.iter().map(|own| vec![own.title.as_str().into(), own.faster.into()]).collect();
    let names: Vec<&str> = hard.iter().map(|own| own.title.as_str()).collect();
    rows.extend(mean(hard).map(|mean| vec![format!("geometric mean of {}", names.join(", ")).into(), mean.into()]));
    let title = "The report's conclusion: how much faster is sah-kd than median-kd on the hard scenes?";
    Table::new(title, ["scene", "times faster [95%]"], rows)
        .noted(vec![
        "Times of one round divided, their median in each epoch, geometric mean over the epochs, with the interval \
         that holds that of another run, as little disturbed, in 95 % of cases."
            .into(),
    ])
        .explained()
}

/// One row for each scene.
pub fn data<'a>(all: impl Iterator<Item = &'a Replicated> + Clone) -> Table {
    let mut table = Table::of(
        "",
        all.clone(),
        &[
            ("scene", &|own: &&Replicated| own.title.as_str().into()),
            ("triangles", &|own| own.triangles.into()),
            ("primary", &|own| own.primary.into()),
            ("mirror", &|own| own.mirror.into()),
            ("shadow", &|own| own.shadow.into()),
            ("total", &|own| own.total().into()),
            ("report", &|own| own.report.rays.into()),
            ("improvement", &|own| own.improvement.into()),
            ("sah_over_median", &|own| own.faster.into()),
            ("report_tree_s", &|own| own.report.tree_s.into()),
            ("report_brute_force_s", &|own| own.report.brute_s.into()),
            ("report_improvement", &|own| own.report.improvement.into()),
            ("report_tree_build_s", &|own| own.report.build_s.into()),
        ],
    );
    let mut add = |name: String, of: &dyn Fn(&Replicated) -> Cell| {
        table.columns.push(name);
        table.rows.iter_mut().zip(all.clone()).for_each(|(row, own)| row.push(of(own)));
    };
    for setting in &SWEEP {
        let seconds = |own: &Replicated| own.times(&setting.role()).map(|times| times.seconds).into();
        add(format!("seconds_{}_{}", setting.leaf, setting.threshold), &seconds);
    }
    type Of = fn(&Replicated) -> Option<&Times>;
    let of: [(&str, Of); 3] =
        [("tree", Replicated::tree), ("brute_force", |own| own.times(BRUTE)), ("sah", |own| own.times(SAH))];
    for (name, of) in of {
        add(format!("{name}_seconds"), &|own| of(own).map(|times| times.seconds).into());
        add(format!("{name}_t_prime"), &|own| of(own).map(|times| times.t_prime).into());
        add(format!("{name}_sampled"), &|own| of(own).map(|times| times.sampled).into());
        add(format!("{name}_build_s"), &|own| of(own).map(|times| times.build_s).into());
    }
    table
}
