//! KD-tree against BVH by depth complexity.

use super::{Race, tables, verdict};
use crate::report::document::{Art, Block, Figure};
use crate::report::number::figures;
use crate::report::plot::{Chart, CurvePoint, Curves, Line, Mark};
use crate::report::words::{bare, distinct, interval, slug};
use crate::report::{Statement, Table};

const PRIMARY: &str = "primary";

/// One sentence for each race on primary rays; on those that there are, without them.
pub fn statements(races: &[Race]) -> Vec<Statement> {
    let of = |race: &Race| {
        let (first, last) = race.members.first().zip(race.members.last())?;
        let (kd, bvh) = (bare(&race.kd), bare(&race.bvh));
        let sentence = format!(
            "On {} rays {kd} takes {} times the time of {bvh} at a depth complexity of {} and {} times at {}; where one overtakes \
             the other: {}.",
            race.workload,
            interval(first.ratio),
            figures(first.complexity),
            interval(last.ratio),
            figures(last.complexity),
            verdict(race)
        );
        Some(Statement::new(&format!("{kd}-{bvh}-{}", slug(&race.workload)), sentence).of(last.ratio))
    };
    let has_primary = races.iter().any(|race| race.workload == PRIMARY);
    races.iter().filter(|race| !has_primary || race.workload == PRIMARY).filter_map(of).collect()
}

pub fn blocks(races: &[Race], command: &str) -> Vec<Block> {
    let mut blocks = vec![Block::Text(
        "A family of scenes with always the same number of triangles, from one layer of perforated sheets to hundreds: the \
         more layers, the more surfaces a ray would meet if none stopped it."
            .into(),
    )];
    for workload in distinct(races.iter().map(|race| &race.workload)) {
        let of: Vec<&Race> = races.iter().filter(|race| race.workload == workload).collect();
        blocks.push(Block::figure(figure(&of, command)));
    }
    let mut tables = tables(races).into_iter();
    blocks.extend(tables.next().map(|answers| Block::table(answers, command)));
    let rest = tables.map(|table| Block::table(table, command)).collect();
    blocks.push(Block::Fold("All ratios".into(), rest));
    blocks
}

fn figure(races: &[&Race], command: &str) -> Figure {
    let pair = |race: &Race| format!("{} / {}", bare(&race.kd), bare(&race.bvh));
    let line = |race: &&Race| {
        Line::new(&pair(race), Mark::Both, race.members.iter().map(|m| CurvePoint::of(m.complexity, m.ratio)))
    };
    let rows = races.iter().flat_map(|race| {
        let pair = pair(race);
        race.members.iter().map(move |m| [pair.clone(), m.layers.to_string(), figures(m.complexity), interval(m.ratio)])
    });
    let told = races.iter().filter_map(|race| {
        let (first, last) = race.members.first().zip(race.members.last())?;
        let (pair, [from, to]) = (pair(race), [first, last].map(|m| interval(m.ratio)));
        Some(format!(
            "{pair}: {from} at depth complexity {}, {to} at {}",
            figures(first.complexity),
            figures(last.complexity)
        ))
    });
    let workload = races.first().map_or("", |race| race.workload.as_str());
    Figure {
        id: format!("crossover-{}", slug(workload)),
        caption: format!(
            "{workload} rays: time of the KD-tree over that of the BVH; below 1 the KD-tree is faster. Bands are 95 % intervals for \
             another run."
        ),
        alt: format!("Line chart over depth complexity. {}.", told.collect::<Vec<_>>().join("; ")),
        command: command.into(),
        art: Art::Chart(Chart::Curves(Curves {
            level: Some((1.0, "equal".into())),
            ..Curves::logarithmic(
                "depth complexity: surfaces on a ray",
                "time of the KD-tree / time of the BVH",
                races.iter().map(line).collect(),
            )
        })),
        data: Table::of_texts("", ["pair", "layers", "depth complexity", "ratio"], rows.collect()),
    }
}
