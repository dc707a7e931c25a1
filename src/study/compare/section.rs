//! Speed of all structures: bars with intervals against the report's tree, tables beside.

use super::{Reference, details_legend, legend, mean_table, ranks, scene_table, speed, tradeoff, twins};
use crate::measure::Estimate;
use crate::report::document::{Art, Block, Figure};
use crate::report::number::count;
use crate::report::plot::{Bar, BarGroup, Bars, Chart};
use crate::report::words::{command_line, distinct, interval, listed, scene_name, slug};
use crate::report::{Record, Statement, Table};
use crate::study::{BRUTE_FORCE, REPORT_TREE, documented_defect};

/// The fastest structure of each rank, what right answers cost, and how many answers were checked.
pub fn statements(records: &[Record]) -> Vec<Statement> {
    let mut statements = ranks(records).map_or(vec![], |ranks| ranks.statements(records));
    let is_own = |r: &&Record| r.declined.is_none() && documented_defect(&r.structure).is_none();
    let own = || records.iter().filter(is_own);
    let wrong: usize = own().map(|r| r.structure_errors).sum();
    let rays: usize = own().map(|r| r.checked_rays).sum();
    if rays > 0 {
        let wrong = if wrong == 0 { "none".into() } else { count(wrong as u64) };
        statements.push(Statement::new(
            "checked",
            format!(
                "Of {} answers of structures without documented defects, held against brute force over the same triangle test, \
                 {wrong} is wrong.",
                count(rays as u64)
            ),
        ));
    }
    statements
}

/// The meshes that the builders and layouts of our trees were tuned on; `papers/TUNING.md` has what was tried.
const TUNED_ON: [&str; 6] = ["kitchen", "sponza-nave", "dragon-scan", "bunny", "lucy-scan", "engine"];

/// Whom a rank may favour.
pub fn bias() -> String {
    format!(
        "Builders and layouts of our eight-wide trees were tuned on the meshes {}, and on Dragon and Lucy in other sizes. Neither obvhs \
         nor any other peer was tuned by us.",
        listed(&TUNED_ON)
    )
}

/// Scenes shown at once; the others are folded.
const OPEN: usize = 3;

pub fn blocks(records: &[Record], command: &str) -> Vec<Block> {
    let scenes = distinct(records.iter().map(|record| &record.scene));
    let mut blocks = vec![Block::Text(
        "Every structure answers the same rays, in samples that are interleaved in random order; wrong answers get no time. \
         Bars compare with the report's tree on the same scene and the same rays, kind by kind: they are medians of paired \
         samples, with the interval that holds the ratio of another run, as little disturbed, in 95 % of cases."
            .into(),
    )];
    let references = Reference::of(records, None);
    let ranks = ranks(records).map_or(vec![], |ranks| ranks.tables(records));
    let is_ranked = !ranks.is_empty();
    blocks.extend(ranks.into_iter().map(|table| Block::table(table, command)));
    if is_ranked {
        blocks.push(Block::Note(format!("We are judges in our own cause. {}", bias())));
    }
    let means = mean_table(records, &references);
    if means.says_something() {
        blocks.push(Block::table(means, command));
    }
    let of = |scene: &String| records.iter().filter(|r| r.scene == *scene).cloned().collect::<Vec<_>>();
    // The largest scenes are what the question is about.
    let mut order: Vec<Vec<Record>> = scenes.iter().map(of).collect();
    order.sort_by_key(|records| std::cmp::Reverse(records[0].triangles));
    blocks.extend(tradeoff::figure(&order, &references, command).map(Block::figure));
    let rest = order.split_off(order.len().min(OPEN));
    blocks.extend(order.iter().flat_map(|records| of_scene(records)));
    let legends = details_legend(&records[0].workload).into_iter().chain(legend(records, &references));
    blocks.extend(legends.map(Block::Note));
    if !rest.is_empty() {
        let name = format!("The other {} scenes", rest.len());
        blocks.push(Block::Fold(name, rest.iter().flat_map(|records| of_scene(records)).collect()));
    }
    blocks
}

fn command(records: &[Record]) -> String {
    let commands = records.iter().map(|r| command_line(&r.provenance.command)).collect::<Vec<_>>();
    distinct(commands.iter()).join("\n")
}

fn of_scene(records: &[Record]) -> Vec<Block> {
    let first = &records[0];
    let noise = twins(records);
    let labels = distinct(records.iter().map(|r| &r.label));
    let has = |label: &str| labels.iter().any(|l| l == label);
    let baseline = [REPORT_TREE, BRUTE_FORCE].into_iter().find(|label| has(label)).unwrap_or(&labels[0]).to_owned();
    // Where it is the unit itself, brute force is so far away that it hides what lies between the others.
    let labels: Vec<String> =
        labels.into_iter().filter(|label| baseline == BRUTE_FORCE || label != BRUTE_FORCE).collect();
    let workloads = distinct(records.iter().map(|r| &r.workload));
    let find =
        |workload: &String, label: &String| records.iter().find(|r| r.workload == *workload && r.label == *label);
    let bar = |workload: &String, label: &String| {
        let Some(record) = find(workload, label) else { return Bar::Missing("not measured".into()) };
        match (record.trace_ns, find(workload, &baseline)) {
            _ if record.declined.is_some() => Bar::Missing("declined".into()),
            (None, _) if record.is_disqualified() => Bar::Missing("wrong answers".into()),
            (Some(_), Some(baseline)) if baseline.trace_ns.is_some() => {
                // A structure is as fast as itself, without doubt.
                let own = record.label == baseline.label;
                let ratio = if own { Some(Estimate::exact(1.0)) } else { speed([(record, baseline)], &noise) };
                ratio.map_or(Bar::Missing("no pairs".into()), Bar::Of)
            }
            _ => Bar::Missing("not timed".into()),
        }
    };
    let groups: Vec<BarGroup> = workloads
        .iter()
        .map(|workload| BarGroup {
            title: format!("{workload} rays"),
            bars: labels.iter().map(|label| bar(workload, label)).collect(),
        })
        .collect();

    let name = scene_name(&first.scene, first.stand_in);
    let data = data(&labels, &groups, &workloads);
    let figure = Figure {
        id: format!("speed-{}", slug(&first.scene)),
        caption: format!(
            "{name}, {} triangles: speed as a multiple of {baseline}, longer is faster. Whiskers are 95 % intervals; \
             the axis is logarithmic.",
            count(first.triangles as u64)
        ),
        alt: alt(&name, &labels, &groups, &baseline),
        command: command(records),
        art: Art::Chart(Chart::Bars(Bars {
            x_title: format!("times as fast as {baseline}"),
            labels,
            parts: vec![],
            groups,
        })),
        data,
    };
    vec![
        Block::figure(figure),
        Block::table(ratios_first(scene_table(records, &Reference::of(records, None), &[])), &command(records)),
    ]
}

/// The table with its ratios behind the names, where a page that is not wide shows them, too.
fn ratios_first(mut table: Table) -> Table {
    let mut order: Vec<usize> = (0..table.columns.len()).collect();
    order.sort_by_key(|&i| (i > 0, !table.columns[i].starts_with("x ")));
    table.columns = order.iter().map(|&i| table.columns[i].clone()).collect();
    for row in &mut table.rows {
        *row = order.iter().map(|&i| row[i].clone()).collect();
    }
    table
}

fn data(labels: &[String], groups: &[BarGroup], workloads: &[String]) -> Table {
    let row = |(i, label): (usize, &String)| {
        let cell = |group: &BarGroup| match &group.bars[i] {
            Bar::Of(value) | Bar::Product(_, value) => interval(*value),
            Bar::Missing(why) => why.clone(),
        };
        std::iter::once(label.clone()).chain(groups.iter().map(cell)).map(Into::into).collect()
    };
    Table {
        title: String::new(),
        columns: std::iter::once("structure".to_owned()).chain(workloads.iter().cloned()).collect(),
        rows: labels.iter().enumerate().map(row).collect(),
        notes: vec![],
    }
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
    format!(
        "Bar chart for {name}. Fastest against {baseline} by kind of rays: {}.",
        best.collect::<Vec<_>>().join("; ")
    )
}
