//! What the speed of the SAH tree is due to.

use crate::report::document::{Art, Block, Figure};
use crate::report::{Statement, Table};

use super::design::Factor;
use super::{Attribution, headlines, tables};
use crate::report::number::figures;
use crate::report::plot::{Bar, Bars, Chart};
use crate::report::words::{interval, listed, scene_name};

const PARTS: [Factor; 3] = [Factor::Stop, Factor::Plane, Factor::Traversal];

/// The scenes that the question is about.
pub const HARD: [&str; 3] = ["Dragon", "Lucy", "Sponza"];

/// Those of the hard scenes first.
fn sorted(results: &[Attribution]) -> Vec<Attribution> {
    let mut results = results.to_vec();
    results.sort_by_key(|r| HARD.iter().position(|name| is(r, name)).unwrap_or(HARD.len()));
    results
}

fn is(result: &Attribution, name: &str) -> bool {
    result.scene == scene_name(name, result.stand_in)
}

/// The results of the hard scenes with their names, of the real mesh where it was measured.
pub fn hard(results: &[Attribution]) -> Vec<(&'static str, Attribution)> {
    let of = |name: &&'static str| {
        let forms = results.iter().filter(|r| is(r, name) && r.workload == "primary");
        Some((*name, forms.min_by_key(|r| r.stand_in)?.clone()))
    };
    HARD.iter().filter_map(of).collect()
}

/// One sentence for each hard scene.
pub fn sentences(results: &[Attribution]) -> Vec<String> {
    let hard: Vec<Attribution> = hard(results).into_iter().map(|(_, r)| r).collect();
    // The first note says what the columns mean.
    headlines(&hard).notes.into_iter().skip(1).collect()
}

/// Which of the three gives most of the speedup on the hard scenes, and whether the plane alone would have done.
pub fn statements(results: &[Attribution]) -> Vec<Statement> {
    let hard: Vec<Attribution> = hard(results).into_iter().map(|(_, r)| r).collect();
    if hard.is_empty() {
        return vec![];
    }
    let times = |r: &Attribution, factor: Factor| r.time.parts[factor as usize].times;
    let scenes = listed(&hard.iter().map(|r| r.scene.as_str()).collect::<Vec<_>>());
    let told = |factor: Factor| listed(&hard.iter().map(|r| interval(times(r, factor))).collect::<Vec<_>>());
    // The first of all scenes: its interval lies above the others' there.
    let first = PARTS.into_iter().find(|&factor| {
        let above = |r: &Attribution, other: Factor| times(r, factor).low() > times(r, other).high();
        hard.iter().all(|r| PARTS.into_iter().all(|other| other == factor || above(r, other)))
    });
    let most = match first {
        Some(factor) => {
            format!("On {scenes} most of the speedup is due to the {}: it gives {} times", factor.name(), told(factor))
        }
        None => format!("On {scenes} no one of the three gives most of the speedup everywhere"),
    };
    let others: Vec<String> = PARTS
        .into_iter()
        .filter(|&factor| Some(factor) != first)
        .map(|factor| format!("the {} {} times", factor.name(), told(factor)))
        .collect();
    vec![Statement::new("parts", format!("{most}; {}.", listed(&others)))]
}

pub fn blocks(results: &[Attribution], command: &str) -> Vec<Block> {
    let results = sorted(results);
    let mut blocks = vec![
        Block::Text(
            "One kind of tree in every combination of six planes, three stop rules and two traversals. From the report's \
             tree to the SAH tree three things are switched; each is credited with its gain, averaged over all orders of \
             switching, so that the parts multiply to the whole."
                .into(),
        ),
        Block::figure(figure(&results, command)),
        Block::table(headlines(&results), command),
    ];
    for r in &results {
        let inner = tables(r).into_iter().map(|table| Block::table(table, command)).collect();
        blocks.push(Block::Fold(format!("{}: all trees, main effects and interactions", r.scene), inner));
    }
    blocks
}

/// The speedup of each scene as a product.
pub fn bars(results: &[Attribution]) -> Bars {
    let row = |r: &Attribution| {
        let factors = PARTS.map(|factor| r.time.parts[factor as usize].times.estimate);
        (r.scene.clone(), Bar::Product(factors.into(), r.time.whole))
    };
    let parts = PARTS.map(|factor| factor.name().to_owned());
    Bars::of_products("times as fast as the report's tree", parts.into(), results.iter().map(row))
}

fn figure(results: &[Attribution], command: &str) -> Figure {
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
        art: Art::Chart(Chart::Bars(bars(results))),
        data: Table::of_texts("", ["scene", "whole", "stop rule", "plane", "traversal"], data.collect()),
    }
}
