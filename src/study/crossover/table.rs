//! The races as tables for people.

use super::{Crossing, Race};
use crate::report::number::{count, figures};
use crate::report::words::{bare, distinct, explained, interval, written};
use crate::report::{Cell, Table, Tone};

/// The answer first, then for each kind of rays the ratios along the family.
pub fn tables(races: &[Race]) -> Vec<Table> {
    let workloads = distinct(races.iter().map(|race| &race.workload));
    let of = |workload: &str| -> Vec<&Race> { races.iter().filter(|race| race.workload == workload).collect() };
    let mut tables = vec![answers(races)];
    tables.extend(workloads.into_iter().map(|workload| ratios(&workload, &of(&workload))));
    tables
}

/// What a race says, in words: who is ahead, or where it changes.
pub(super) fn verdict(race: &Race) -> String {
    let sure: Vec<&Crossing> = race.crossings.iter().filter(|crossing| crossing.is_sure()).collect();
    match (race.crossings.is_empty(), &sure[..]) {
        (true, _) if race.members.iter().all(|m| m.ratio.is_below(1.0)) => {
            format!("never: {} throughout", bare(&race.kd))
        }
        (true, _) if race.members.iter().all(|m| m.ratio.is_above(1.0)) => {
            format!("never: {} throughout", bare(&race.bvh))
        }
        (true, _) => "too close to tell".into(),
        (false, []) => "too close to tell".into(),
        (false, sure) => {
            let one = |crossing: &&Crossing| {
                let winner = if crossing.kd_wins_beyond { &race.kd } else { &race.bvh };
                format!("{}: then {}", interval(crossing.complexity), bare(winner))
            };
            sure.iter().map(one).collect::<Vec<_>>().join("; ")
        }
    }
}

fn answers(races: &[Race]) -> Table {
    let rows = races.iter().map(|race| {
        let ends = race.members.first().zip(race.members.last());
        let (from, to) = ends.map_or((Cell::blank(), Cell::blank()), |(first, last)| {
            (interval(first.ratio).into(), interval(last.ratio).into())
        });
        let trend = race.trend.map(|x| written(x, |x| format!("{x:.2}"))).into();
        let pair = format!("{} / {}, {}", bare(&race.kd), bare(&race.bvh), race.workload);
        vec![pair.into(), from, to, trend, verdict(race).into()]
    });
    let columns = ["pair, rays", "first member", "last member", "power", "crosses 1 at a depth complexity of"];
    let title = "Does a KD-tree overtake a BVH where rays would meet more surfaces?";
    explained(Table::new(title, columns, rows).noted(vec![
            "Ratios are the KD-tree's time over the BVH's: below 1 the KD-tree is faster. power: the ratio grows like this power of \
             the depth complexity. 95 % intervals for another run; a crossing is named where one is surely ahead before it \
             and the other beyond, all members considered."
                .into(),
            "Depth complexity: surfaces that a ray would meet if none stopped it, measured. All members have the same \
             number of triangles."
                .into(),
        ]))
}

fn ratios(workload: &str, races: &[&Race]) -> Table {
    let mut columns = vec!["layers".to_owned(), "depth complexity".into()];
    columns.extend(races.iter().flat_map(|race| {
        let pair = format!("{} / {}", bare(&race.kd), bare(&race.bvh));
        [pair, "ns a ray".into()]
    }));
    let longest = races.iter().max_by_key(|race| race.members.len());
    let rows = longest.map_or(&[][..], |race| &race.members[..]).iter().map(|member| {
        let mut row: Vec<Cell> = vec![count(member.layers.into()).into(), figures(member.complexity).into()];
        for race in races {
            let own = race.members.iter().find(|own| own.layers == member.layers);
            row.push(own.map_or(Cell::blank(), |own| {
                let tone = if own.ratio.is_below(1.0) { Tone::Best } else { Tone::Plain };
                Cell::from(interval(own.ratio)).with(tone)
            }));
            row.push(own.map_or(Cell::blank(), |own| {
                format!("{} / {}", figures(own.kd_ns_per_ray), figures(own.bvh_ns_per_ray)).into()
            }));
        }
        row
    });
    explained(Table { title: format!("{workload} rays"), columns, rows: rows.collect(), notes: vec![] })
}
