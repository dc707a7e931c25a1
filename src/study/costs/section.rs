//! What a step and a block of triangles cost on this machine, and how well counts predict times.

use super::table::LEGEND;
use super::{Family, Observation, tables};
use crate::report::Table;
use crate::report::document::{Art, Block, Figure};
use crate::report::number::figures;
use crate::report::plot::{Chart, CurvePoint, Curves, Line, Mark};
use crate::report::words::{bare, distinct};

pub fn blocks(families: &[Family], command: &str) -> Vec<Block> {
    let mut blocks = vec![Block::Text(
        "The surface area heuristic predicts time from two costs: of a traversal step, K_T, and of testing a block of \
         triangles at once, K_B. Regression of measured times on counts finds them for this machine, and how far they \
         can be trusted."
            .into(),
    )];
    // Each structure's own family predicts it; `all` is the first.
    if families.len() > 1 {
        blocks.push(Block::figure(figure(&families[1..], command)));
    }
    blocks.extend(tables(families).into_iter().map(|table| Block::table(table, command)));
    blocks.extend(LEGEND.map(|words| Block::Note(words.into())));
    blocks
}

fn figure(families: &[Family], command: &str) -> Figure {
    let all: Vec<&Observation> = families.iter().flat_map(|family| &family.observations).collect();
    let predicted = |o: &Observation| o.foreseen_ns.unwrap_or(o.predicted_ns);
    let dots = |structure: &String| {
        let own = all.iter().filter(|o| bare(&o.structure) == *structure && predicted(o) > 0.0);
        Line::new(structure, Mark::Dots, own.map(|o| CurvePoint::exact(predicted(o), o.ns_per_ray)))
    };
    // Without keys: those of one family differ little, and eyes tell few colours apart.
    let names: Vec<String> = all.iter().map(|o| bare(&o.structure).into()).collect();
    let structures = distinct(names.iter());
    let rows = all.iter().map(|o| {
        let [measured, predicted] = [o.ns_per_ray, predicted(o)].map(figures);
        [o.structure.clone(), o.scene.clone(), o.workload.clone(), measured, predicted]
    });
    let told = families.iter().map(|family| {
        let off = family
            .foreseen
            .or(family.known)
            .map_or(String::new(), |off| format!(", off by {:.2} at the median", off.median));
        format!("{}: {} cases{off}", family.family, family.observations.len())
    });
    let dots = structures.iter().map(dots).collect();
    let axes = ["predicted nanoseconds a ray", "measured nanoseconds a ray"];
    let curves = Curves { diagonal: Some("as predicted".into()), ..Curves::logarithmic(axes[0], axes[1], dots) };
    Figure {
        id: "costs".into(),
        caption: "Measured against predicted time of a ray, each structure by the costs of its family on the other scenes. On \
                  the line the prediction is exact; both axes are logarithmic."
            .into(),
        alt: format!("Scatter plot. {}.", told.collect::<Vec<_>>().join("; ")),
        command: command.into(),
        art: Art::Chart(Chart::Curves(curves)),
        data: Table::of_texts("", ["structure", "scene", "rays", "measured ns", "predicted ns"], rows.collect()),
    }
}
