//! The comparison on several machines, side by side: places and ratios of each, and never a ratio between them.

use std::cmp::Reverse;
use std::collections::BTreeSet;

use crate::measure::Estimate;
use crate::page::machines::OfMachine;
use crate::page::runs::Runs;
use crate::report::document::{Art, Block, Figure, Section};
use crate::report::number::plural;
use crate::report::plot::{Bar, BarGroup, Bars, Chart};
use crate::report::words::{command_line, distinct, explained, interval, listed};
use crate::report::{Cell, Record, Table};
use crate::study::compare::{Rank, Ranked, Ranks, ranks, ratio_cell};

const TITLE: &str = "Do other machines rank the structures alike?";

/// Why a table has no column for it.
const NO_RATIO: &str = "No number relates one machine to another: samples of different machines are not of the same rounds, so that \
                        their ratio would hold clock rates, memory and load, and nothing of the structures.";

/// A time: hashes of scene and rays, and the structure.
type Case<'a> = (&'a str, &'a str, &'a str);

/// What machines make of the cases in which all of them have a time.
struct Shared {
    /// `M1: AMD EPYC, avx512, 1 thread`, one for each machine.
    legend: Vec<String>,
    ranks: Vec<Ranks>,
    /// Of each machine the structures that give wrong answers in some case.
    erring: Vec<Vec<String>>,
}

/// The structures that give wrong answers in some case.
fn erring(one: &OfMachine) -> Vec<String> {
    distinct(one.compared.records.iter().filter(|record| record.is_disqualified()).map(|record| &record.label))
}

/// Nothing where all was compared on one machine.
pub fn section(runs: &Runs) -> Option<Section> {
    let all: Vec<&OfMachine> = runs.machines.iter().filter(|one| !one.compared.records.is_empty()).collect();
    if all.len() < 2 {
        return None;
    }
    let commands = all.iter().flat_map(|one| &one.compared.records).map(|r| command_line(&r.provenance.command));
    let commands: Vec<String> = commands.collect();
    let command = distinct(commands.iter()).join("\n");

    // Several machines, with as many times beside each other as there can be: of all of them, one could leave nothing.
    let sets = all.iter().rev().map(|&first| sharing(first, &all));
    let (machines, common) =
        sets.max_by_key(|(machines, common)| (machines.len() > 1, machines.len() * common.len()))?;
    let ranks = machines.iter().map(|one| ranks(&of_cases(one, machines[0], &common)));
    let ranks = ranks.collect::<Option<Vec<Ranks>>>().filter(|ranks| ranks.len() > 1);
    let mut blocks = match ranks {
        Some(ranks) => {
            let legend = machines.iter().enumerate().map(|(i, one)| format!("{}: {}", name(i), one.machine)).collect();
            let over = format!(
                "Over {} of scene, rays and structure with a time on every machine, the same meshes and rays by their \
                 hashes.{}",
                plural(common.len(), "case"),
                left_out(&machines, common.len())
            );
            let erring = machines.iter().map(|one| erring(one)).collect();
            Shared { legend, ranks, erring }.blocks(&over, &command)
        }
        None => vec![Block::Text(format!(
            "These runs compared on {}, with no two structures that two of them have timed on the same rays, so that \
             nothing is side by side here.{}",
            named(&all),
            left_out(&all, 0)
        ))],
    };
    let is_apart = |one: &&OfMachine| machines.iter().all(|shown| shown.machine != one.machine);
    let apart: Vec<&OfMachine> = all.iter().copied().filter(is_apart).collect();
    if machines.len() > 1 && !apart.is_empty() {
        let apart = named(&apart);
        blocks.push(Block::Note(format!("Not beside them, for they have too few cases in common: {apart}.")));
    }
    blocks.push(Block::Note(format!(
        "What else this page says of the comparison is of one machine alone: {}.",
        all[0].machine
    )));
    Some(Section { id: "machines", title: TITLE, blocks })
}

/// `first` and the machines that can stand beside it, and the cases in which all of these have a time. Those that share the most with
/// it come before those that would keep them out.
fn sharing<'a>(first: &'a OfMachine, all: &[&'a OfMachine]) -> (Vec<&'a OfMachine>, BTreeSet<Case<'a>>) {
    let mut common = timed(first);
    let others = all.iter().copied().filter(|one| one.machine != first.machine);
    let mut others: Vec<(&OfMachine, BTreeSet<Case>)> = others.map(|one| (one, timed(one))).collect();
    others.sort_by_key(|(_, own)| Reverse(own.intersection(&common).count()));
    let mut machines = vec![first];
    for (one, own) in others {
        let shared: BTreeSet<Case> = own.intersection(&common).copied().collect();
        // One that timed a few of the cases would leave only these of all others.
        let is_enough = 2 * shared.len() >= common.len();
        if is_enough && [first, one].iter().all(|own| ranks(&of_cases(own, first, &shared)).is_some()) {
            machines.push(one);
            common = shared;
        }
    }
    (machines, common)
}

/// The records of a machine of these cases, in the order of the first machine, so that all have the same reference.
fn of_cases(one: &OfMachine, first: &OfMachine, cases: &BTreeSet<Case>) -> Vec<Record> {
    let order = first.compared.records.iter().map(case).filter(|case| cases.contains(case));
    let find = |asked: Case| one.compared.records.iter().find(|record| case(record) == asked);
    order.filter_map(find).cloned().collect()
}

/// What is said of cases of `machines` of which so many are common.
fn left_out(machines: &[&OfMachine], common: usize) -> String {
    let some: BTreeSet<Case> = machines.iter().flat_map(|one| timed(one)).collect();
    match some.len() - common {
        0 => String::new(),
        n => format!(" Left out: {} that some machine has no time of.", plural(n, "case")),
    }
}

/// Machines as sentences name them.
fn named(machines: &[&OfMachine]) -> String {
    listed(&machines.iter().map(|one| one.machine.to_string()).collect::<Vec<_>>())
}

/// As columns name a machine.
fn name(index: usize) -> String {
    format!("M{}", index + 1)
}

fn case(record: &Record) -> Case<'_> {
    (&record.scene_hash, &record.workload_hash, &record.label)
}

/// The cases in which a machine has a time.
fn timed(one: &OfMachine) -> BTreeSet<Case<'_>> {
    one.compared.records.iter().filter(|record| record.mrays_per_s.is_some()).map(case).collect()
}

/// One of the two ranks of a page.
struct Kind {
    /// In a sentence.
    words: &'static str,
    /// Above its table.
    title: &'static str,
    of: fn(&Ranks) -> &Rank,
}

const KINDS: [Kind; 2] = [
    Kind { words: "with right answers", title: "Right answers, machine by machine", of: |ranks| &ranks.precise },
    Kind { words: "in single precision", title: "Single precision, machine by machine", of: |ranks| &ranks.single },
];

impl Shared {
    fn blocks(&self, over: &str, command: &str) -> Vec<Block> {
        let mut blocks = vec![Block::Text(self.sentence())];
        let mut notes = vec![
            format!(
                "{}. #: place. x {}: times as fast as {} on the same machine and rays, with the 95 % interval for a rerun. =: not \
                 distinguishable from 1.",
                self.legend.join("; "),
                self.ranks[0].reference.name(),
                self.ranks[0].reference.words()
            ),
            over.to_owned(),
        ];
        let unranked: Vec<&str> = KINDS
            .iter()
            .flat_map(|kind| &(kind.of)(&self.ranks[0]).unranked)
            .map(|(label, _)| label.as_str())
            .collect();
        if !unranked.is_empty() {
            notes.push(format!(
                "Not ranked, without a time in half of these scenes and rays or more: {}.",
                listed(&unranked)
            ));
        }
        notes.push(NO_RATIO.into());
        for kind in KINDS.iter().filter(|kind| !(kind.of)(&self.ranks[0]).rows.is_empty()) {
            blocks.push(Block::table(self.table(kind, &notes), command));
        }
        blocks.push(Block::figure(self.figure(command)));
        blocks
    }

    /// A row of each structure, in the order of the first machine.
    fn table(&self, kind: &Kind, notes: &[String]) -> Table {
        let reference = self.ranks[0].reference.name();
        let columns =
            (0..self.ranks.len()).flat_map(|i| [format!("{} #", name(i)), format!("{} x {reference}", name(i))]);
        let columns = std::iter::once("structure".to_owned()).chain(columns).collect();
        let row = |first: &Ranked| {
            let cells = self.ranks.iter().flat_map(|ranks| {
                let rows = &(kind.of)(ranks).rows;
                match rows.iter().position(|row| row.label == first.label) {
                    Some(place) => [(place + 1).to_string().into(), ratio_cell(rows[place].speed)],
                    None => [Cell::blank(), Cell::blank()],
                }
            });
            std::iter::once(Cell::from(first.label.as_str())).chain(cells).collect()
        };
        let rows = (kind.of)(&self.ranks[0]).rows.iter().map(row).collect();
        explained(Table { title: kind.title.into(), columns, rows, notes: notes.to_vec() })
    }

    /// Who is first on the machine `i` in a rank: with right answers none that errs.
    fn first<'a>(&self, i: usize, ranks: &'a Ranks, kind: &Kind) -> Option<&'a Ranked> {
        let rank = (kind.of)(ranks);
        let errs = |row: &Ranked| *rank == ranks.precise && self.erring[i].contains(&row.label);
        rank.rows.iter().find(|row| !errs(row))
    }

    /// Who is first on each machine, and which ratios differ between them.
    fn sentence(&self) -> String {
        let first = |kind: &Kind| {
            let firsts = self.ranks.iter().enumerate();
            let firsts = firsts.filter_map(|(i, ranks)| Some((self.first(i, ranks, kind)?.label.clone(), name(i))));
            let firsts: Vec<(String, String)> = firsts.collect();
            let told = distinct(firsts.iter().map(|(label, _)| label)).into_iter().map(|label| {
                let on: Vec<&String> = firsts.iter().filter(|own| own.0 == label).map(|own| &own.1).collect();
                format!("{label} on {}", listed(&on))
            });
            let told: Vec<String> = told.collect();
            (!told.is_empty()).then(|| format!("The fastest {}: {}.", kind.words, told.join("; ")))
        };
        let mut sentences: Vec<String> = KINDS.iter().filter_map(first).collect();
        let known = self.labels().into_iter().filter_map(|label| Some((label, self.is_apart(label)?)));
        let known: Vec<(&str, bool)> = known.collect();
        let apart: Vec<&str> = known.iter().filter(|(_, apart)| *apart).map(|(label, _)| *label).collect();
        let all = plural(known.len(), "structure");
        sentences.push(match (known.len(), apart.len()) {
            (0, _) => {
                "Whether ratios differ between machines is not known: one of them measured a single epoch.".into()
            }
            (_, 0) => format!("Of {all} none has a ratio whose intervals lie apart on two machines."),
            (_, n) => {
                let has = if n == 1 { "has" } else { "have" };
                format!("Of {all} {n} {has} ratios whose intervals lie apart on two machines: {}.", listed(&apart))
            }
        });
        sentences.join(" ")
    }

    /// Structures of both ranks, in the order of the first machine.
    fn labels(&self) -> Vec<&str> {
        KINDS.iter().flat_map(|kind| &(kind.of)(&self.ranks[0]).rows).map(|row| row.label.as_str()).collect()
    }

    /// The ratio of a structure on each machine.
    fn ratios(&self, label: &str) -> Vec<Option<Estimate>> {
        let of = |ranks: &Ranks| {
            let mut rows = ranks.precise.rows.iter().chain(&ranks.single.rows);
            rows.find(|row| row.label == label)?.speed
        };
        self.ranks.iter().map(of).collect()
    }

    /// Whether the intervals of a structure have no point in common on two machines; nothing where one is not known, and of the
    /// reference itself.
    fn is_apart(&self, label: &str) -> Option<bool> {
        let ratios = self.ratios(label).into_iter().collect::<Option<Vec<Estimate>>>()?;
        if ratios.iter().all(|ratio| *ratio == Estimate::exact(1.0)) {
            return None;
        }
        let intervals = ratios.iter().map(|ratio| ratio.interval).collect::<Option<Vec<_>>>()?;
        let low = intervals.iter().map(|interval| interval.low).fold(0.0, f64::max);
        let high = intervals.iter().map(|interval| interval.high).fold(f64::INFINITY, f64::min);
        Some(low > high)
    }

    fn figure(&self, command: &str) -> Figure {
        let labels: Vec<String> = self.labels().into_iter().map(String::from).collect();
        let bar = |ratio: Option<Estimate>| ratio.map_or(Bar::Missing("no pairs".into()), Bar::Of);
        let ratios: Vec<Vec<Option<Estimate>>> = labels.iter().map(|label| self.ratios(label)).collect();
        let groups = (0..self.ranks.len()).map(|machine| BarGroup {
            title: name(machine),
            bars: ratios.iter().map(|own| bar(own[machine])).collect(),
        });
        let columns = std::iter::once("structure".to_owned()).chain(self.legend.iter().cloned()).collect();
        let row = |(label, own): (&String, &Vec<Option<Estimate>>)| {
            let cells = own.iter().map(|ratio| ratio.map_or(Cell::blank(), |ratio| interval(ratio).into()));
            std::iter::once(Cell::from(label.as_str())).chain(cells).collect()
        };
        let rows = labels.iter().zip(&ratios).map(row).collect();
        let reference = self.ranks[0].reference.words();
        Figure {
            id: "machines".into(),
            caption: format!(
                "Speed as a multiple of {reference} on the same machine, longer is faster: {}. Whiskers are 95 % intervals; the axis is \
                 logarithmic.",
                self.legend.join("; ")
            ),
            alt: format!("Bar chart, a group of bars for each of {} machines. {}", self.ranks.len(), self.sentence()),
            command: command.into(),
            art: Art::Chart(Chart::Bars(Bars {
                x_title: format!("times as fast as {}", self.ranks[0].reference.name()),
                reference: 1.0,
                labels,
                groups: groups.collect(),
            })),
            data: Table { title: String::new(), columns, rows, notes: vec![] },
        }
    }
}
