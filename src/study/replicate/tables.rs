//! The study as tables for people.

use super::original::SWEEP;
use super::{Replication, Seconds};
use crate::report::number::{count, figures};
use crate::report::words::{explained, interval, scene_name};
use crate::report::{Cell, Table};

/// The tables in the order of the report, then its conclusion.
pub fn tables(result: &Replication) -> Vec<Table> {
    let mut tables = vec![rays(result)];
    if !result.main.is_empty() {
        tables.extend([seconds(result), t_primes(result), parameters(result)]);
    }
    if !result.hard.is_empty() {
        tables.extend([hard(result), conclusion(result)]);
    }
    tables
}

fn table<const N: usize>(title: &str, columns: [&str; N], rows: Vec<[String; N]>, notes: &[&str]) -> Table {
    explained(Table::of_texts(title, columns, rows).noted(notes.iter().map(|note| (*note).into()).collect()))
}

fn rays(result: &Replication) -> Table {
    let rows = result.rays.iter().map(|r| {
        let difference = r.total as i64 - r.report as i64;
        let difference = if difference == 0 { "0".into() } else { format!("{difference:+}") };
        [
            r.scene.clone(),
            count(r.primary),
            count(r.mirror),
            count(r.shadow),
            count(r.total),
            count(r.report),
            difference,
        ]
    });
    table(
        "Rays of a 512 x 512 picture",
        ["scene", "primary", "mirror", "shadow", "total", "report", "difference"],
        rows.collect(),
        &["Hard scenes: primary rays alone, as in the report. Starters has creatures of our own, and so its own rays."],
    )
}

fn seconds(result: &Replication) -> Table {
    let rows = result.main.iter().map(|m| {
        [
            m.scene.clone(),
            count(m.triangles as u64),
            marked(&m.tree),
            figures(m.report_tree_s),
            marked(&m.brute_force),
            figures(m.report_brute_force_s),
            interval(m.improvement),
            figures(m.report_improvement),
            marked(&m.sah),
        ]
    });
    table(
        "Seconds of all rays, construction left out",
        ["scene", "triangles", "median-kd", "report", "brute-force", "report", "improvement [95%]", "report", "sah-kd"],
        rows.collect(),
        &["improvement: brute-force / median-kd. ~ a part of the rays was timed and stands for all."],
    )
}

fn t_primes(result: &Replication) -> Table {
    let rows = result.main.iter().map(|m| {
        let t_primes = [
            m.tree.t_prime.estimate,
            m.report_tree_t_prime,
            m.brute_force.t_prime.estimate,
            m.report_brute_force_t_prime,
            m.sah.t_prime.estimate,
        ];
        let [a, b, c, d, e] = t_primes.map(figures);
        [m.scene.clone(), a, b, c, d, e]
    });
    table(
        "t' = seconds / (rays x triangles)",
        ["scene", "median-kd", "report", "brute-force", "report", "sah-kd"],
        rows.collect(),
        &[],
    )
}

fn parameters(result: &Replication) -> Table {
    let scenes: Vec<&str> = result.main.iter().map(|m| m.scene.as_str()).collect();
    let mut columns = vec!["L / T".to_owned()];
    columns.extend(scenes.iter().map(|s| (*s).to_owned()));
    let mut rows = vec![];
    for setting in &SWEEP {
        let name = format!("{} / {}", setting.leaf, setting.threshold);
        let of = |scene: &str| {
            let same =
                |s: &&super::Setting| s.scene == scene && s.leaf == setting.leaf && s.threshold == setting.threshold;
            result.parameters.iter().find(same)
        };
        let ours = |scene: &&str| of(scene).map(|s| figures_marked(s.seconds, s.extrapolated)).into();
        let theirs = |scene: &&str| of(scene).map(|s| figures(s.report_s)).into();
        rows.push(std::iter::once(Cell::from(name)).chain(scenes.iter().map(ours)).collect());
        rows.push(std::iter::once(Cell::from("  report")).chain(scenes.iter().map(theirs)).collect());
    }
    Table {
        title: "Seconds of median-kd with other parameters".into(),
        columns,
        rows,
        notes: vec![
            "L: leaf limit; T: match threshold. Its columns Teapot and Torus, swapped in print, stand right.".into(),
        ],
    }
}

fn hard(result: &Replication) -> Table {
    let rows = result.hard.iter().map(|h| {
        [
            scene_name(&h.scene, h.stand_in),
            count(h.triangles as u64),
            marked(&h.tree),
            figures(h.report_tree_s),
            figures(h.tree.t_prime.estimate),
            figures(h.report_tree_t_prime),
            figures(h.tree_build_s),
            figures(h.report_tree_build_s),
            marked(&h.sah),
            figures(h.sah_build_s),
        ]
    });
    table(
        "Hard scenes: seconds of the primary rays, and of the construction",
        ["scene", "triangles", "median-kd", "report", "t'", "report", "build", "report", "sah-kd", "build"],
        rows.collect(),
        &["~ a part of the rays was timed and stands for all."],
    )
}

fn conclusion(result: &Replication) -> Table {
    let mut rows: Vec<[String; 2]> =
        result.hard.iter().map(|h| [h.scene.clone(), interval(h.sah_over_median)]).collect();
    if let Some(mean) = &result.conclusion.sah_over_median {
        rows.push([format!("geometric mean of {}", result.conclusion.scenes.join(", ")), interval(*mean)]);
    }
    table(
        "The report's conclusion: how much faster is sah-kd than median-kd on the hard scenes?",
        ["scene", "times faster [95%]"],
        rows,
        &[
            "Times of one round divided, their median in each epoch, geometric mean over the epochs, with the interval that holds that of another run in 95 % of cases.",
        ],
    )
}

fn marked(seconds: &Seconds) -> String {
    figures_marked(seconds.seconds, seconds.extrapolated)
}

fn figures_marked(seconds: f64, extrapolated: bool) -> String {
    format!("{}{}", if extrapolated { "~" } else { "" }, figures(seconds))
}
