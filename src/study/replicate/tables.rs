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

fn rays(result: &Replication) -> Table {
    let difference = |r: &super::Rays| match r.total as i64 - r.report as i64 {
        0 => "0".into(),
        difference => format!("{difference:+}"),
    };
    Table::of(
        "Rays of a 512 x 512 picture",
        &result.rays,
        &[
            ("scene", &|r| r.scene.as_str().into()),
            ("primary", &|r| count(r.primary).into()),
            ("mirror", &|r| count(r.mirror).into()),
            ("shadow", &|r| count(r.shadow).into()),
            ("total", &|r| count(r.total).into()),
            ("report", &|r| count(r.report).into()),
            ("difference", &|r| difference(r).into()),
        ],
    )
    .noted(vec![
        "Hard scenes: primary rays alone, as in the report. Starters has creatures of our own, and so its own rays."
            .into(),
    ])
}

fn seconds(result: &Replication) -> Table {
    let table = Table::of(
        "Seconds of all rays, construction left out",
        &result.main,
        &[
            ("scene", &|m| m.scene.as_str().into()),
            ("triangles", &|m| count(m.triangles as u64).into()),
            ("median-kd", &|m| marked(&m.tree).into()),
            ("report", &|m| figures(m.report_tree_s).into()),
            ("brute-force", &|m| marked(&m.brute_force).into()),
            ("report", &|m| figures(m.report_brute_force_s).into()),
            ("improvement [95%]", &|m| interval(m.improvement).into()),
            ("report", &|m| figures(m.report_improvement).into()),
            ("sah-kd", &|m| marked(&m.sah).into()),
        ],
    );
    explained(
        table.noted(vec![
            "improvement: brute-force / median-kd. ~ a part of the rays was timed and stands for all.".into(),
        ]),
    )
}

fn t_primes(result: &Replication) -> Table {
    Table::of(
        "t' = seconds / (rays x triangles)",
        &result.main,
        &[
            ("scene", &|m| m.scene.as_str().into()),
            ("median-kd", &|m| figures(m.tree.t_prime.estimate).into()),
            ("report", &|m| figures(m.report_tree_t_prime).into()),
            ("brute-force", &|m| figures(m.brute_force.t_prime.estimate).into()),
            ("report", &|m| figures(m.report_brute_force_t_prime).into()),
            ("sah-kd", &|m| figures(m.sah.t_prime.estimate).into()),
        ],
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
    Table::of(
        "Hard scenes: seconds of the primary rays, and of the construction",
        &result.hard,
        &[
            ("scene", &|h| scene_name(&h.scene, h.stand_in).into()),
            ("triangles", &|h| count(h.triangles as u64).into()),
            ("median-kd", &|h| marked(&h.tree).into()),
            ("report", &|h| figures(h.report_tree_s).into()),
            ("t'", &|h| figures(h.tree.t_prime.estimate).into()),
            ("report", &|h| figures(h.report_tree_t_prime).into()),
            ("build", &|h| figures(h.tree_build_s).into()),
            ("report", &|h| figures(h.report_tree_build_s).into()),
            ("sah-kd", &|h| marked(&h.sah).into()),
            ("build", &|h| figures(h.sah_build_s).into()),
        ],
    )
    .noted(vec!["~ a part of the rays was timed and stands for all.".into()])
}

fn conclusion(result: &Replication) -> Table {
    let mut rows: Vec<[String; 2]> =
        result.hard.iter().map(|h| [h.scene.clone(), interval(h.sah_over_median)]).collect();
    if let Some(mean) = &result.conclusion.sah_over_median {
        rows.push([format!("geometric mean of {}", result.conclusion.scenes.join(", ")), interval(*mean)]);
    }
    let title = "The report's conclusion: how much faster is sah-kd than median-kd on the hard scenes?";
    explained(Table::of_texts(title, ["scene", "times faster [95%]"], rows).noted(vec![
        "Times of one round divided, their median in each epoch, geometric mean over the epochs, with the interval that holds that of \
         another run, as little disturbed, in 95 % of cases."
            .into(),
    ]))
}

fn marked(seconds: &Seconds) -> String {
    figures_marked(seconds.seconds, seconds.extrapolated)
}

fn figures_marked(seconds: f64, extrapolated: bool) -> String {
    format!("{}{}", if extrapolated { "~" } else { "" }, figures(seconds))
}
