//! What a page shows of a comparison: bars with intervals against the report's tree, tables beside.

use std::collections::BTreeMap;

use super::table::{legend, refusals, scene_table};
use super::{Reference, by_scene, details, means, nothing_measured, rank, tradeoff};
use crate::report::number::count;
use crate::report::plot::{Bar, BarGroup, Bars, Chart};
use crate::report::words::{distinct, each_once, interval, listed, slug};
use crate::report::{Art, Block, Cell, Figure, Finding, Table};
use crate::request::{BRUTE_FORCE, REPORT_TREE, SAH_TREE, known_defect};
use crate::scene::{BUILTIN, Builtin};
use crate::study::kendall::{kendall, mean};
use crate::study::measurement::{Measurement, UntimedStructure, trace_noise};

/// How many answers were checked and how many of them are wrong, and whose.
pub fn checked(all: &[Measurement]) -> Option<Finding> {
    let is_own = |r: &&Measurement| r.declined.is_none() && known_defect(&r.structure).is_none();
    let own = || all.iter().filter(is_own);
    let wrong: usize = own().map(|r| r.structure_errors).sum();
    let rays: usize = own().map(|r| r.checked_rays).sum();
    let of = |label: &String| {
        let own = || all.iter().filter(|r| r.label == *label);
        let errors: usize = own().map(|r| r.structure_errors).sum();
        let checked: usize = own().map(|r| r.checked_rays).sum();
        (errors > 0).then(|| format!("{label} ({} of {} checked rays)", count(errors as u64), count(checked as u64)))
    };
    let erring: Vec<String> = distinct(all.iter().map(|r| &r.label)).iter().filter_map(of).collect();
    let erring =
        if erring.is_empty() { String::new() } else { format!(" Wrong answers, and so no time: {}.", listed(&erring)) };
    let wrong = if wrong == 0 { "none".into() } else { count(wrong as u64) };
    let sentence = format!(
        "Of {} answers of structures without known defects, held against brute force over the same triangle test, {wrong} is \
         wrong.{erring}",
        count(rays as u64)
    );
    (rays > 0).then(|| Finding::new("checked", sentence))
}

/// Kendall's tau of SAH cost and time over couples of different families, the mean of the built-in scenes: nothing was
/// expected of others. Nothing where one of them is missing.
pub fn tau(all: &[Measurement]) -> Option<Finding> {
    let has = |name: &str| all.iter().any(|r| r.scene == name);
    if !BUILTIN.iter().all(|builtin| has(builtin.name)) {
        return None;
    }
    let is_asked =
        |r: &&Measurement| r.structure != BRUTE_FORCE && r.trace_ns.is_some() && Builtin::find(&r.scene).is_ok();
    let timed: Vec<&Measurement> = all.iter().filter(is_asked).collect();
    // Trees of a scene are the same whatever the rays, and a stand-in is built after the real mesh: taus of one scene are
    // not independent, and count as their mean.
    let mut scenes: BTreeMap<&str, Vec<f64>> = BTreeMap::new();
    for (hash, workload) in each_once(timed.iter().map(|r| (&r.scene_hash, &r.workload))) {
        let group: Vec<&&Measurement> =
            timed.iter().filter(|r| (&r.scene_hash, &r.workload) == (hash, workload)).collect();
        let known =
            group.iter().filter_map(|r| Some((family(&r.structure), (r.shape.sah_cost?, r.trace_ns? / r.rays as f64))));
        let known: Vec<(&str, (f64, f64))> = known.collect();
        let pairs: Vec<(f64, f64)> = known.iter().map(|(_, pair)| *pair).collect();
        if let Some(tau) = kendall(&pairs, |i, j| known[i].0 != known[j].0) {
            scenes.entry(&group[0].scene).or_default().push(tau);
        }
    }
    let means: Vec<f64> = scenes.values().map(|taus| taus.iter().sum::<f64>() / taus.len() as f64).collect();
    Some(Finding::number("tau", mean(&means)?))
}

/// What a structure has in common with those whose cells and nodes are of the same kind.
fn family(structure: &str) -> &str {
    match structure {
        REPORT_TREE | SAH_TREE => "binary kd-tree",
        "sah-kd-wide" | "sah-kd-tight" => "wide kd-tree",
        other => other,
    }
}

/// The meshes that the builders and layouts of our trees were tuned on; `papers/TUNING.md` has what was tried.
const TUNED_ON: [&str; 6] = ["kitchen", "Sponza", "Dragon", "Lucy", "bunny", "engine"];

/// Where our figures may be biased.
pub fn bias() -> String {
    format!(
        "The builders and layouts of our trees were tuned on {} (papers/TUNING.md has what was tried); neither the defaults of obvhs \
         nor any other peer was tuned by us.",
        listed(&TUNED_ON)
    )
}

/// Scenes shown at once on a page; the figures of the others are folded.
const OPEN: usize = 3;

/// All blocks. The terminal prints the tables of scenes, in full where they are `wide`, then the means and the ranks.
pub fn blocks(all: &[Measurement], refused: &[UntimedStructure], references: &[Reference], wide: bool) -> Vec<Block> {
    let last = &references[references.len().saturating_sub(1)..];
    let mut blocks = vec![];
    let titles = each_once(all.iter().map(Measurement::scene_title).chain(refused.iter().map(|own| own.scene.clone())));
    let mut scenes = by_scene(all);
    for title in &titles {
        let own: Vec<UntimedStructure> = refused.iter().filter(|own| own.scene == *title).cloned().collect();
        let scene = scenes.iter().find(|scene| scene[0].scene_title() == *title);
        blocks.push(Block::from(match scene {
            Some(scene) if wide => scene_table(scene, references, &own, true),
            Some(scene) => scene_table(scene, last, &own, false),
            None => nothing_measured(title, &own),
        }));
    }
    if all.is_empty() {
        blocks.extend(refusals(refused).into_iter().map(Block::Note));
        return blocks;
    }
    let several = scenes.len() > 1;
    let means = several.then(|| means::mean_table(all, if wide { references } else { last }));
    blocks.extend(means.filter(Table::says_something).map(Block::from));
    blocks.extend(legend(all, if wide { references } else { last }).into_iter().map(Block::Note));
    let columns = || details::legend(&all[0].workload).into_iter().map(Block::Note);
    if wide {
        blocks.extend(columns());
    }
    blocks.extend(refusals(refused).into_iter().map(Block::Note));

    let ranks = rank::ranks(all, references.last()).map_or(vec![], |ranks| ranks.tables(all));
    if !ranks.is_empty() {
        let bias = Block::Note(format!("We are judges in our own cause. {}", bias()));
        let name = "Ranks over all scenes and workloads".to_owned();
        blocks.push(Block::Fold(name, ranks.into_iter().map(Block::from).chain([bias]).collect()));
    }
    // The largest scenes are what the question is about.
    scenes.sort_by_key(|scene| std::cmp::Reverse(scene[0].triangles));
    blocks.extend(tradeoff::figure(&scenes, references).map(Block::figure));
    let rest = scenes.split_off(scenes.len().min(OPEN));
    blocks.extend(scenes.iter().map(|scene| Block::figure(bars(scene))));
    if !rest.is_empty() {
        let figures = rest.iter().map(|scene| Block::figure(bars(scene))).collect();
        blocks.push(Block::Fold(format!("Figures of the other {} scenes", rest.len()), figures));
    }
    if !wide {
        let tables = scenes.iter().chain(&rest).map(|scene| scene_table(scene, references, &[], true).into());
        blocks.push(Block::Fold("All columns".into(), tables.chain(columns()).collect()));
    }
    blocks
}

/// Speed as a multiple of the report's tree, kind by kind.
fn bars(all: &[Measurement]) -> Figure {
    let noise = trace_noise(all);
    let labels = distinct(all.iter().map(|r| &r.label));
    let has = |label: &str| labels.iter().any(|l| l == label);
    let baseline = [REPORT_TREE, BRUTE_FORCE].into_iter().find(|label| has(label)).unwrap_or(&labels[0]).to_owned();
    // Where it is the unit itself, brute force is so far away that it hides what lies between the others.
    let labels: Vec<String> =
        labels.into_iter().filter(|label| baseline == BRUTE_FORCE || label != BRUTE_FORCE).collect();
    let workloads = distinct(all.iter().map(|r| &r.workload));
    let find = |workload: &String, label: &String| all.iter().find(|r| r.workload == *workload && r.label == *label);
    let bar = |workload: &String, label: &String| {
        let Some(own) = find(workload, label) else { return Bar::Missing("not measured".into()) };
        match (own.trace_ns, find(workload, &baseline)) {
            _ if own.declined.is_some() => Bar::Missing("declined".into()),
            (None, _) if own.is_disqualified() => Bar::Missing("wrong answers".into()),
            (Some(_), Some(baseline)) if baseline.trace_ns.is_some() => {
                Reference::ratio(&[(own, baseline)], &noise).map_or(Bar::Missing("no pairs".into()), Bar::Of)
            }
            _ => Bar::Missing("not timed".into()),
        }
    };
    let group = |workload: &String| BarGroup {
        title: format!("{workload} rays"),
        bars: labels.iter().map(|label| bar(workload, label)).collect(),
    };
    let groups: Vec<BarGroup> = workloads.iter().map(group).collect();
    let name = all[0].scene_title();
    Figure {
        id: format!("speed-{}", slug(&all[0].scene)),
        caption: format!(
            "{name}, {} triangles: speed as a multiple of {baseline} on the same rays, longer is faster. Whiskers are 95 % intervals; \
             the axis is logarithmic.",
            count(all[0].triangles as u64)
        ),
        alt: alt(&name, &labels, &groups, &baseline),
        data: data(&labels, &groups, &workloads),
        art: Art::Chart(Chart::Bars(Bars {
            x_title: format!("times as fast as {baseline}"),
            labels,
            parts: vec![],
            groups,
        })),
    }
}

fn data(labels: &[String], groups: &[BarGroup], workloads: &[String]) -> Table {
    let row = |(i, label): (usize, &String)| {
        let cell = |group: &BarGroup| match &group.bars[i] {
            Bar::Of(value) | Bar::Product(_, value) => Cell::from(*value),
            Bar::Missing(why) => Cell::from(why),
        };
        std::iter::once(Cell::from(label)).chain(groups.iter().map(cell)).collect()
    };
    let columns = std::iter::once("structure").chain(workloads.iter().map(String::as_str));
    Table::new("", columns, labels.iter().enumerate().map(row))
}

fn alt(name: &str, labels: &[String], groups: &[BarGroup], baseline: &str) -> String {
    let best = groups.iter().filter_map(|group| {
        let values = group.bars.iter().zip(labels).filter_map(|(bar, label)| match bar {
            Bar::Of(value) | Bar::Product(_, value) => Some((value, label)),
            Bar::Missing(_) => None,
        });
        let (value, label) = values.max_by(|a, b| a.0.estimate.total_cmp(&b.0.estimate))?;
        Some(format!("{}: {label}, {}", group.title, interval(*value)))
    });
    format!("Bar chart for {name}. Fastest against {baseline} by workload: {}.", best.collect::<Vec<_>>().join("; "))
}
