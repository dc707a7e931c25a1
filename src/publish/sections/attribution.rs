//! What the speed of the SAH tree is due to.

use crate::publish::document::{Art, Block, Figure, Section};
use crate::publish::runs::Runs;
use crate::publish::words::table;
use crate::report::number::figures;
use crate::report::plot::{Chart, Stack, StackRow};
use crate::report::words::{interval, scene_name};
use crate::study::attribution::design::Factor;
use crate::study::attribution::{Attribution, headlines, tables};

/// The parts in the order in which they are told.
const PARTS: [Factor; 3] = [Factor::Stop, Factor::Plane, Factor::Traversal];

/// The scenes that the question is about.
const HARD: [&str; 3] = ["Dragon", "Lucy", "Sponza"];

/// The results, those of the hard scenes first.
pub fn results(runs: &Runs) -> Vec<Attribution> {
    let Some(study) = &runs.attribution else { return vec![] };
    let mut results = study.result.clone();
    results.sort_by_key(|r| HARD.iter().position(|name| is(r, name)).unwrap_or(HARD.len()));
    results
}

fn is(result: &Attribution, name: &str) -> bool {
    result.scene == scene_name(name, result.stand_in)
}

/// The results of the hard scenes with their names, of the real mesh where it was measured.
pub fn hard(runs: &Runs) -> Vec<(&'static str, Attribution)> {
    let results = results(runs);
    let of = |name: &&'static str| {
        let forms = results.iter().filter(|r| is(r, name) && r.workload == "primary");
        Some((*name, forms.min_by_key(|r| r.stand_in)?.clone()))
    };
    HARD.iter().filter_map(of).collect()
}

/// One sentence for each hard scene.
pub fn sentences(runs: &Runs) -> Vec<String> {
    let hard: Vec<Attribution> = hard(runs).into_iter().map(|(_, r)| r).collect();
    // The first note says what the columns mean.
    headlines(&hard).notes.into_iter().skip(1).collect()
}

pub fn section(runs: &Runs) -> Section {
    let mut blocks = vec![];
    let results = results(runs);
    match runs.attribution.as_ref().filter(|_| !results.is_empty()) {
        None => blocks.push(Block::missing(
            "What the stop rule, the split plane and the traversal give",
            "sahara study attribution",
        )),
        Some(study) => {
            let command = study.command();
            blocks.push(Block::Text(
                "One kind of tree in every combination of six planes, three stop rules and two traversals. From the report's \
                 tree to the SAH tree three things are switched; each is credited with its gain, averaged over all orders of \
                 switching, so that the parts multiply to the whole."
                    .into(),
            ));
            blocks.push(Block::Figure(figure(&results, &command)));
            blocks.push(Block::table(headlines(&results), &command));
            for r in &results {
                let inner = tables(r).into_iter().map(|table| Block::table(table, &command)).collect();
                blocks.push(Block::Fold(format!("{}: all trees, main effects and interactions", r.scene), inner));
            }
        }
    }
    Section { id: "attribution", title: "What is the speed due to?", blocks }
}

fn figure(results: &[Attribution], command: &str) -> Figure {
    let row = |r: &Attribution| StackRow {
        label: r.scene.clone(),
        factors: PARTS.map(|factor| r.time.parts[factor as usize].times.estimate).into(),
        total: r.time.whole,
    };
    let data = results.iter().map(|r| {
        let [stop, plane, traversal] = PARTS.map(|factor| interval(r.time.parts[factor as usize].times));
        [r.scene.clone(), interval(r.time.whole), stop, plane, traversal]
    });
    let told = results.iter().map(|r| {
        let [stop, plane, traversal] = PARTS.map(|factor| figures(r.time.parts[factor as usize].times.estimate));
        let whole = figures(r.time.whole.estimate);
        format!("{}: {whole} times faster, stop rule {stop}, plane {plane}, traversal {traversal}", r.scene)
    });
    Figure {
        id: "attribution".into(),
        caption: "How many times faster the SAH tree is than the report's, and the factors whose product that is. The axis is \
                  logarithmic: lengths add up to the whole. Factors below 1 stand to the left. The line below a bar is the 95 % \
                  interval of the whole."
            .into(),
        alt: format!("Stacked bar chart. {}.", told.collect::<Vec<_>>().join("; ")),
        command: command.into(),
        art: Art::Chart(Chart::Stack(Stack {
            x_title: "times as fast as the report's tree".into(),
            parts: PARTS.map(|factor| factor.name().to_owned()).into(),
            rows: results.iter().map(row).collect(),
        })),
        data: table("", ["scene", "whole", "stop rule", "plane", "traversal"], data.collect()),
    }
}
