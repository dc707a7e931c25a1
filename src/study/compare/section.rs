//! The findings, tables and figures of a comparison.

use super::means::mean_table;
use super::table::{legend, nothing_measured, refusals, scene_table};
use super::{Reference, details, tradeoff};
use crate::builtin::{BUILTIN, Builtin};
use crate::report::number::count;
use crate::report::plot::{Bar, BarGroup, Bars, Chart};
use crate::report::words::{distinct, each_once, interval, listed, slug};
use crate::report::{Art, Block, Cell, Figure, Finding, Table};
use crate::request::{BRUTE_FORCE, REPORT_TREE, SAH_TREE, known_defect};
use crate::study::epoch::Structure;
use crate::study::kendall::{kendall, mean_of_scenes};
use crate::study::measurement::{Measurement, of_scene, trace_noise};
use crate::study::{Dataset, SceneEpochs};

pub fn checked(all: &[Measurement]) -> Option<Finding> {
    let sums = |is: &dyn Fn(&&Measurement) -> bool| {
        let own = all.iter().filter(is).map(|r| [r.wrong_hits, r.checked_rays]);
        own.fold([0, 0], |sums, own| [sums[0] + own[0] as u64, sums[1] + own[1] as u64])
    };
    let of = |label: &String| {
        let [errors, rays] = sums(&|r| r.label == *label);
        (errors > 0).then(|| format!("{label} ({} of {} checked rays)", count(errors), count(rays)))
    };
    let erring = listed(&distinct(all.iter().map(|r| &r.label)).iter().filter_map(of).collect::<Vec<_>>());
    let erring = match &erring[..] {
        "" => String::new(),
        erring => format!(" Not timed in the cells with wrong hits: {erring}."),
    };
    let sums = sums(&|r| r.declined.is_none() && known_defect(&r.structure).is_none());
    let [wrong, rays] = sums.map(count);
    let sentence = format!(
        "Wrong hits: {wrong} in {rays} rays checked by another tree, brute force and exact arithmetic (known defects \
         excluded).{erring}"
    );
    (sums[1] > 0).then(|| Finding::new("checked", sentence))
}

/// Kendall's tau of SAH cost and time per ray, for structures of different families.
///
/// The mean is over the built-in scenes, because the claim is about them. `None` if a built-in scene is missing.
pub fn tau(all: &[Measurement]) -> Option<Finding> {
    if !BUILTIN.iter().all(|builtin| all.iter().any(|r| r.scene == builtin.name)) {
        return None;
    }
    let timed = all.iter().filter(|r| r.structure != BRUTE_FORCE && r.trace_ns.is_some());
    let timed: Vec<&Measurement> = timed.filter(|r| Builtin::find(&r.scene).is_ok()).collect();
    let groups = each_once(timed.iter().map(|r| (&r.scene, &r.scene_hash, &r.workload)));
    let taus = groups.into_iter().filter_map(|group| {
        let own = timed.iter().filter(|r| (&r.scene, &r.scene_hash, &r.workload) == group);
        let known = own.filter_map(|r| Some((family(&r.structure), (r.shape.sah_cost?, r.trace_ns? / r.rays as f64))));
        let (families, pairs): (Vec<&str>, Vec<(f64, f64)>) = known.unzip();
        Some((group.0.as_str(), kendall(&pairs, |i, j| families[i] != families[j])?))
    });
    Some(Finding::number("tau", mean_of_scenes(taus)?))
}

/// Structures of one family have the same type of cells and nodes.
fn family(structure: &str) -> &str {
    match structure {
        REPORT_TREE | SAH_TREE => "binary kd-tree",
        "sah-kd-wide" | "sah-kd-tight" => "wide kd-tree",
        other => other,
    }
}

pub fn refused<'a>(scene: &SceneEpochs<'a>) -> Vec<&'a Structure> {
    scene.epochs[0].structures.iter().filter(|own| own.refused.is_some() && !own.is_twin()).collect()
}

/// The maximum number of bar charts that are not folded.
const UNFOLDED_SCENES: usize = 3;

pub fn blocks(dataset: &Dataset, references: &[Reference], wide: bool) -> Vec<Block> {
    let shown = if wide { references } else { &references[references.len().saturating_sub(1)..] };
    let (mut blocks, mut scenes, mut all_refused) = (vec![], vec![], vec![]);
    for scene in dataset.scenes() {
        let (own, refused) = (of_scene(&scene), refused(&scene));
        if !own.is_empty() {
            blocks.push(Block::Table(scene_table(&own, shown, &refused, wide)));
        } else if !refused.is_empty() {
            blocks.push(Block::Table(nothing_measured(&scene.epochs[0].title(), &refused)));
        }
        all_refused.extend(refused);
        scenes.extend(Some(own).filter(|own| !own.is_empty()));
    }
    let all = scenes.concat();
    let mut notes = refusals(&all_refused);
    if let Some(first) = all.first() {
        let means = (scenes.len() > 1).then(|| mean_table(&all, shown));
        blocks.extend(means.filter(Table::has_values).map(Block::from));
        let columns = if wide { details::legend(&first.workload) } else { vec![] };
        notes.splice(0..0, legend(&all, shown).into_iter().chain(columns));
    }
    blocks.extend(notes.into_iter().map(Block::Note));

    scenes.sort_by_key(|scene| std::cmp::Reverse(scene[0].triangles));
    blocks.extend(tradeoff::figure(&scenes).map(Block::figure));
    let mut figures: Vec<Block> = scenes.iter().map(|scene| Block::figure(bars(scene))).collect();
    let others = figures.split_off(figures.len().min(UNFOLDED_SCENES));
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

fn bars(all: &[Measurement]) -> Figure {
    let noise = trace_noise(all);
    let mut labels = distinct(all.iter().map(|r| &r.label));
    let units = [REPORT_TREE, BRUTE_FORCE].map(String::from);
    let unit = units.into_iter().find(|unit| labels.contains(unit)).unwrap_or_else(|| labels[0].clone());
    // A bar of brute force would hide the differences between faster structures.
    labels.retain(|label| unit == BRUTE_FORCE || label != BRUTE_FORCE);
    let workloads = distinct(all.iter().map(|r| &r.workload));
    let reference = Reference::Structure(unit.clone());
    let bar = |workload: &String, label: &String| {
        let missing = match all.iter().find(|r| r.workload == *workload && r.label == *label) {
            None => "not measured",
            Some(own) if own.declined.is_some() => "declined",
            Some(own) if own.is_disqualified() => "wrong hits",
            Some(own) => match Reference::ratio(&reference.pairs(all, [own]), &noise) {
                Some(ratio) => return Bar::Of(ratio),
                None => "not timed",
            },
        };
        Bar::Missing(missing.into())
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
            "{name}, {} triangles: speed as a multiple of {unit} on the same rays; longer is faster. Whiskers are 95 % \
             intervals. The axis is logarithmic.",
            count(all[0].triangles as u64)
        ),
        alt: format!("Bar chart for {name}. Fastest against {unit} by workload: {fastest}."),
        data,
        art: Art::Chart(Chart::Bars(Bars { x_title: format!("speedup over {unit}"), labels, parts: vec![], groups })),
    }
}
