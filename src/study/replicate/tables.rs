//! The study as tables.

use super::findings::order;
use super::original::{MainRow, SWEEP, t_prime};
use super::replication::{Hard, Main, Replicated, Replication, Seconds};
use crate::report::words::explained;
use crate::report::{Cell, Table, Value};

const SAMPLED: &str = "~ a part of the rays was timed and stands for all.";

/// The tables in the order of the report, then its conclusion.
pub fn tables(answer: &Replication) -> Vec<Table> {
    let mut tables = vec![];
    if !answer.main.is_empty() || !answer.hard.is_empty() {
        tables.push(rays(answer));
    }
    if !answer.main.is_empty() {
        tables.extend([seconds(answer), t_primes(answer), settings(answer)]);
    }
    if !answer.hard.is_empty() {
        tables.extend([hard(answer), conclusion(answer)]);
    }
    tables
}

fn rays(answer: &Replication) -> Table {
    Table::of(
        "Rays of a 512 x 512 picture",
        answer.scenes(),
        &[
            ("scene", &|(scene, _)| scene.title.as_str().into()),
            ("primary", &|(scene, _)| scene.primary.into()),
            ("mirror", &|(scene, _)| scene.mirror.into()),
            ("shadow", &|(scene, _)| scene.shadow.into()),
            ("total", &|(scene, _)| scene.total().into()),
            ("report", &|(_, report)| (*report).into()),
            ("difference", &|(scene, report)| Value::Difference(scene.total() as i64 - *report as i64).into()),
        ],
    )
    .noted(vec![
        "Hard scenes: primary rays alone, as in the report. Starters has creatures of our own, and so its own rays."
            .into(),
        "Secondary rays start where a triangle test in single precision finds a hit, as in the report's program."
            .into(),
    ])
}

fn seconds(answer: &Replication) -> Table {
    let table = Table::of(
        "Seconds of all rays, construction left out",
        &answer.main,
        &[
            ("scene", &|m| m.scene.title.as_str().into()),
            ("triangles", &|m| m.scene.triangles.into()),
            ("median-kd", &|m| m.scene.tree.cell()),
            ("report", &|m| m.report.tree_s.into()),
            ("brute-force", &|m| m.brute_force.cell()),
            ("report", &|m| m.report.brute_s.into()),
            ("improvement [95%]", &|m| m.improvement.into()),
            ("report", &|m| m.report.improvement.into()),
            ("sah-kd", &|m| m.scene.sah.cell()),
        ],
    );
    let mut notes = vec![format!("improvement: brute-force / median-kd. {SAMPLED}")];
    notes.extend(order(answer).and_then(|(_, reversed)| reversed));
    explained(table.noted(notes))
}

fn t_primes(answer: &Replication) -> Table {
    Table::of(
        "t' = seconds / (rays x triangles)",
        &answer.main,
        &[
            ("scene", &|m| m.scene.title.as_str().into()),
            ("median-kd", &|m| m.scene.tree.t_prime.estimate.into()),
            ("report", &|m| of_report(m.report, m.report.tree_s).into()),
            ("brute-force", &|m| m.brute_force.t_prime.estimate.into()),
            ("report", &|m| of_report(m.report, m.report.brute_s).into()),
            ("sah-kd", &|m| m.scene.sah.t_prime.estimate.into()),
        ],
    )
}

fn of_report(row: &MainRow, seconds: f64) -> f64 {
    t_prime(seconds, row.rays, row.triangles)
}

fn settings(answer: &Replication) -> Table {
    let columns = ["L / T"].into_iter().chain(answer.main.iter().map(|main| main.scene.title.as_str()));
    let mut rows = vec![];
    for (i, setting) in SWEEP.iter().enumerate() {
        let ours = answer.main.iter().map(|main| main.sweep[i].cell());
        let theirs = answer.main.iter().map(|main| setting.of(main.report.scene).into());
        rows.push(std::iter::once(Cell::from(setting.role())).chain(ours).collect());
        rows.push(std::iter::once(Cell::from("  report")).chain(theirs).collect());
    }
    Table::new("Seconds of median-kd with other settings", columns, rows).noted(vec![
        "L: leaf limit; T: match threshold. The report's columns Teapot and Torus, swapped in print, stand right."
            .into(),
    ])
}

fn hard(answer: &Replication) -> Table {
    Table::of(
        "Hard scenes: seconds of the primary rays, and of the construction",
        &answer.hard,
        &[
            ("scene", &|h| h.scene.title.as_str().into()),
            ("triangles", &|h| h.scene.triangles.into()),
            ("median-kd", &|h| h.scene.tree.cell()),
            ("report", &|h| h.report.tree_s.into()),
            ("t'", &|h| h.scene.tree.t_prime.estimate.into()),
            ("report", &|h| t_prime(h.report.tree_s, h.report.rays, h.report.triangles).into()),
            ("build", &|h| h.tree_build_s.into()),
            ("report", &|h| h.report.build_s.into()),
            ("sah-kd", &|h| h.scene.sah.cell()),
            ("build", &|h| h.sah_build_s.into()),
        ],
    )
    .noted(vec![SAMPLED.into()])
}

fn conclusion(answer: &Replication) -> Table {
    let row = |name: String, faster| vec![Cell::from(name), Cell::from(faster)];
    let mut rows: Vec<Vec<Cell>> = answer.hard.iter().map(|h| row(h.scene.title.clone(), Some(h.faster))).collect();
    let names: Vec<&str> = answer.hard.iter().map(|hard| hard.scene.title.as_str()).collect();
    rows.push(row(format!("geometric mean of {}", names.join(", ")), answer.faster));
    let title = "The report's conclusion: how much faster is sah-kd than median-kd on the hard scenes?";
    explained(Table::new(title, ["scene", "times faster [95%]"], rows).noted(vec![
        "Times of one round divided, their median in each epoch, geometric mean over the epochs, with the interval that \
         holds that of another run, as little disturbed, in 95 % of cases."
            .into(),
    ]))
}

/// One row for each scene.
pub fn data(answer: &Replication) -> Table {
    type Row<'a> = (&'a Replicated, u64, Option<&'a Main>, Option<&'a Hard>);
    let main = answer.main.iter().map(|own| (&own.scene, own.report.rays, Some(own), None));
    let hard = answer.hard.iter().map(|own| (&own.scene, own.report.rays, None, Some(own)));
    let mut table = Table::of(
        "",
        main.chain(hard),
        &[
            ("scene", &|(scene, ..): &Row| scene.title.as_str().into()),
            ("triangles", &|(scene, ..)| scene.triangles.into()),
            ("primary", &|(scene, ..)| scene.primary.into()),
            ("mirror", &|(scene, ..)| scene.mirror.into()),
            ("shadow", &|(scene, ..)| scene.shadow.into()),
            ("total", &|(scene, ..)| scene.total().into()),
            ("report", &|(_, report, ..)| (*report).into()),
            ("tree_seconds", &|(scene, ..)| scene.tree.seconds.into()),
            ("tree_t_prime", &|(scene, ..)| scene.tree.t_prime.into()),
            ("tree_sampled", &|(scene, ..)| scene.tree.sampled.into()),
            ("sah_seconds", &|(scene, ..)| scene.sah.seconds.into()),
            ("sah_t_prime", &|(scene, ..)| scene.sah.t_prime.into()),
            ("sah_sampled", &|(scene, ..)| scene.sah.sampled.into()),
            ("brute_force_seconds", &|(_, _, main, _)| main.map(|main| main.brute_force.seconds).into()),
            ("brute_force_t_prime", &|(_, _, main, _)| main.map(|main| main.brute_force.t_prime).into()),
            ("brute_force_sampled", &|(_, _, main, _)| main.map(|main| main.brute_force.sampled).into()),
            ("improvement", &|(_, _, main, _)| main.map(|main| main.improvement).into()),
            ("tests_per_ray_and_triangle", &|(_, _, main, _)| main.and_then(|main| main.tests[0]).into()),
            ("tree_build_s", &|(.., hard)| hard.map(|hard| hard.tree_build_s).into()),
            ("sah_build_s", &|(.., hard)| hard.map(|hard| hard.sah_build_s).into()),
            ("times_faster", &|(.., hard)| hard.map(|hard| hard.faster).into()),
            ("report_tree_s", &|(_, _, main, hard)| {
                main.map(|main| main.report.tree_s).or(hard.map(|hard| hard.report.tree_s)).into()
            }),
            ("report_brute_force_s", &|(_, _, main, _)| main.map(|main| main.report.brute_s).into()),
            ("report_improvement", &|(_, _, main, _)| main.map(|main| main.report.improvement).into()),
            ("report_build_s", &|(.., hard)| hard.map(|hard| hard.report.build_s).into()),
        ],
    );
    for (i, setting) in SWEEP.iter().enumerate() {
        table.columns.push(format!("seconds_{}_{}", setting.leaf, setting.threshold));
        let seconds =
            answer.main.iter().map(|main| Some(main.sweep[i].seconds)).chain(answer.hard.iter().map(|_| None));
        table.rows.iter_mut().zip(seconds).for_each(|(row, seconds)| row.push(seconds.into()));
    }
    table
}

impl Seconds {
    fn cell(&self) -> Cell {
        Cell::from(self.seconds).sampled(self.sampled)
    }
}
