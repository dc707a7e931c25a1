//! The report of a comparison: findings, then tables and figures.

use super::means::mean_table;
use super::table::{legend, nothing_measured, refusals, scene_table};
use super::{Reference, details, tradeoff};
use crate::report::number::count;
use crate::report::plot::{Bar, BarGroup, Bars, Chart};
use crate::report::words::{distinct, each_once, interval, listed, slug};
use crate::report::{Art, Block, Cell, Figure, Finding, Table};
use crate::request::{BRUTE_FORCE, REPORT_TREE, SAH_TREE, known_defect};
use crate::scene::{BUILTIN, Builtin};
use crate::study::Dataset;
use crate::study::epoch::Structure;
use crate::study::kendall::{kendall, mean_of_scenes};
use crate::study::measurement::{Measurement, of_scene, trace_noise};

/// The number of checked rays and of wrong hits, and the structures with wrong hits.
pub fn checked(all: &[Measurement]) -> Option<Finding> {
    let sum = |is: &dyn Fn(&&Measurement) -> bool| {
        let own = || all.iter().filter(is);
        (own().map(|r| r.wrong_hits).sum::<usize>() as u64, own().map(|r| r.checked_rays).sum::<usize>() as u64)
    };
    let of = |label: &String| {
        let (errors, rays) = sum(&|r| r.label == *label);
        (errors > 0).then(|| format!("{label} ({} of {} checked rays)", count(errors), count(rays)))
    };
    let erring: Vec<String> = distinct(all.iter().map(|r| &r.label)).iter().filter_map(of).collect();
    let erring = match &erring[..] {
        [] => String::new(),
        erring => format!(" Not timed in the cells with wrong hits: {}.", listed(erring)),
    };
    let (wrong, rays) = sum(&|r| r.declined.is_none() && known_defect(&r.structure).is_none());
    let sentence = format!(
        "Wrong hits: {} in {} rays checked by another tree, brute force and exact arithmetic (known defects \
         excluded).{erring}",
        count(wrong),
        count(rays)
    );
    (rays > 0).then(|| Finding::new("checked", sentence))
}

/// Kendall's tau of SAH cost and time over couples of different families, the mean of the built-in scenes, which the
/// claim is about. `None` if one of them is missing.
pub fn tau(all: &[Measurement]) -> Option<Finding> {
    let has = |name: &str| all.iter().any(|r| r.scene == name);
    if !BUILTIN.iter().all(|builtin| has(builtin.name)) {
        return None;
    }
    let is_asked =
        |r: &&Measurement| r.structure != BRUTE_FORCE && r.trace_ns.is_some() && Builtin::find(&r.scene).is_ok();
    let timed: Vec<&Measurement> = all.iter().filter(is_asked).collect();
    let groups = each_once(timed.iter().map(|r| (&r.scene, &r.scene_hash, &r.workload)));
    let taus = groups.into_iter().filter_map(|group| {
        let own = timed.iter().filter(|r| (&r.scene, &r.scene_hash, &r.workload) == group);
        let known = own.filter_map(|r| Some((family(&r.structure), (r.shape.sah_cost?, r.trace_ns? / r.rays as f64))));
        let (families, pairs): (Vec<&str>, Vec<(f64, f64)>) = known.unzip();
        Some((group.0.as_str(), kendall(&pairs, |i, j| families[i] != families[j])?))
    });
    Some(Finding::number("tau", mean_of_scenes(taus)?))
}

/// The name shared by all structures with the same kind of cells and nodes.
fn family(structure: &str) -> &str {
    match structure {
        REPORT_TREE | SAH_TREE => "binary kd-tree",
        "sah-kd-wide" | "sah-kd-tight" => "wide kd-tree",
        other => other,
    }
}

/// The number of scenes that a page shows unfolded; the figures of all others are folded.
const OPEN: usize = 3;

/// All blocks. The terminal prints the tables of scenes, with all columns if `wide`, then the means.
pub fn blocks(dataset: &Dataset, references: &[Reference], wide: bool) -> Vec<Block> {
    let shown = if wide { references } else { &references[references.len().saturating_sub(1)..] };
    let (mut blocks, mut scenes, mut all_refused) = (vec![], vec![], vec![]);
    for scene in dataset.scenes() {
        let (own, first) = (of_scene(&scene), scene.epochs[0]);
        let refused: Vec<&Structure> =
            first.structures.iter().filter(|own| own.refused.is_some() && !own.is_twin()).collect();
        if !own.is_empty() {
            blocks.push(Block::Table(scene_table(&own, shown, &refused, wide)));
        } else if !refused.is_empty() {
            blocks.push(Block::Table(nothing_measured(&first.title(), &refused)));
        }
        all_refused.extend(refused);
        scenes.extend(Some(own).filter(|own| !own.is_empty()));
    }
    let all = scenes.concat();
    let mut notes = refusals(&all_refused);
    if let Some(first) = all.first() {
        let means = (scenes.len() > 1).then(|| mean_table(&all, shown));
        blocks.extend(means.filter(Table::says_something).map(Block::from));
        let columns = if wide { details::legend(&first.workload) } else { vec![] };
        notes.splice(0..0, legend(&all, shown).into_iter().chain(columns));
    }
    blocks.extend(notes.into_iter().map(Block::Note));

    // The question is about the largest scenes: they come first.
    scenes.sort_by_key(|scene| std::cmp::Reverse(scene[0].triangles));
    blocks.extend(tradeoff::figure(&scenes, references).map(Block::figure));
    let mut figures: Vec<Block> = scenes.iter().map(|scene| Block::figure(bars(scene))).collect();
    let others = figures.split_off(figures.len().min(OPEN));
    blocks.extend(figures);
    if !others.is_empty() {
        blocks.push(Block::Fold(format!("Figures of the other {} scenes", others.len()), others));
    }
    if let Some(first) = all.first().filter(|_| !wide) {
        let tables = scenes.iter().map(|scene| scene_table(scene, references, &[], true).into());
        let columns = details::legend(&first.workload).into_iter().map(Block::Note);
        blocks.push(Block::Fold("All columns".into(), tables.chain(columns).collect()));
    }
    blocks
}

/// Speed as a multiple of the report's tree, by workload.
fn bars(all: &[Measurement]) -> Figure {
    let noise = trace_noise(all);
    let mut labels = distinct(all.iter().map(|r| &r.label));
    let units = [REPORT_TREE, BRUTE_FORCE].map(String::from);
    let unit = units.into_iter().find(|unit| labels.contains(unit)).unwrap_or_else(|| labels[0].clone());
    // Leave out brute force unless it is the reference: it is so far away that it hides the differences between all
    // others.
    labels.retain(|label| unit == BRUTE_FORCE || label != BRUTE_FORCE);
    let workloads = distinct(all.iter().map(|r| &r.workload));
    let reference = Reference::Structure(unit.clone());
    let bar = |workload: &String, label: &String| {
        let ratio = |own| Reference::ratio(&reference.pairs(all, [own]), &noise);
        match all.iter().find(|r| r.workload == *workload && r.label == *label) {
            None => Bar::Missing("not measured".into()),
            Some(own) if own.declined.is_some() => Bar::Missing("declined".into()),
            Some(own) if own.is_disqualified() => Bar::Missing("wrong hits".into()),
            Some(own) => ratio(own).map_or(Bar::Missing("not timed".into()), Bar::Of),
        }
    };
    let group = |workload: &String| BarGroup {
        title: format!("{workload} rays"),
        bars: labels.iter().map(|label| bar(workload, label)).collect(),
    };
    let groups: Vec<BarGroup> = workloads.iter().map(group).collect();

    let mut data = Table::of("", &labels, &[("structure", &|label| (*label).into())]);
    for (workload, group) in workloads.iter().zip(&groups) {
        let cell = |bar: &Bar| if let Bar::Missing(why) = bar { Cell::from(why) } else { bar.value().into() };
        data.push_column(workload, group.bars.iter().map(cell));
    }
    let fastest = groups.iter().filter_map(|group| {
        let values = group.bars.iter().zip(&labels).filter_map(|(bar, label)| Some((bar.value()?, label)));
        let (value, label) = values.max_by(|a, b| a.0.estimate.total_cmp(&b.0.estimate))?;
        Some(format!("{}: {label}, {}", group.title, interval(value)))
    });
    let fastest = fastest.collect::<Vec<_>>().join("; ");
    let name = all[0].scene_title();
    Figure {
        id: format!("speed-{}", slug(&all[0].scene)),
        caption: format!(
            "{name}, {} triangles: speed as a multiple of {unit} on the same rays; longer is faster. Whiskers are 95 % intervals. \
             The axis is logarithmic.",
            count(all[0].triangles as u64)
        ),
        alt: format!("Bar chart for {name}. Fastest against {unit} by workload: {fastest}."),
        data,
        art: Art::Chart(Chart::Bars(Bars { x_title: format!("speedup over {unit}"), labels, parts: vec![], groups })),
    }
}
