//! The results as a chart and tables.

use super::design::{Factor, Treatment};
use super::findings::{HARD, split};
use super::result::{Attribution, gain};
use crate::report::plot::{Bar, Bars, Chart};
use crate::report::{Art, Block, Cell, Figure, Table};
use crate::study::measurement::{Measurement, push_columns};

pub fn blocks(results: &[Attribution]) -> Vec<Block> {
    if results.is_empty() {
        return vec![];
    }
    let mut sorted: Vec<&Attribution> = results.iter().collect();
    sorted.sort_by_key(|r| HARD.iter().position(|name| r.first().scene == *name).unwrap_or(HARD.len()));
    let text = "The study builds one type of tree in every combination of six rules for split planes, three stop rules \
                and two traversals. The report's tree and the SAH tree differ in these three choices. The factor of a \
                choice is the geometric mean of its gains over all orders in which the three can be exchanged (its \
                Shapley value), so the three factors multiply to the whole speedup. A factor below 1 is a slowdown.";
    vec![
        Block::Text(text.into()),
        Block::figure(figure(&sorted)),
        headlines(&sorted).into(),
        Block::Fold("All trees".into(), vec![trees(results).into()]),
    ]
}

fn figure(results: &[&Attribution]) -> Figure {
    let bar = |r: &&Attribution| {
        let parts = Factor::ALL.map(|factor| r.part(factor).estimate);
        (r.first().scene_title(), Bar::Product(parts.into(), r.whole()))
    };
    let sentences: Vec<String> = results.iter().map(|r| split(r).sentence).collect();
    Figure {
        id: "attribution".into(),
        caption: "Speedup of the SAH tree over the report's tree, as a product of factors. The axis is logarithmic: \
                  lengths add up to the whole. Factors below 1 extend to the left. The line below a bar is the 95 % \
                  interval of the whole."
            .into(),
        alt: format!("Stacked bar chart. {}", sentences.join(" ")),
        art: Art::Chart(Chart::Bars(Bars::of_products(
            "speedup over the report's tree",
            Factor::ALL.map(|factor| factor.name().to_owned()).into(),
            results.iter().map(bar),
        ))),
        data: headlines(results),
    }
}

fn headlines(results: &[&Attribution]) -> Table {
    let table = Table::of(
        "Speedup of the SAH tree and its factors",
        results,
        &[
            ("scene", &|r| r.first().scene_title().into()),
            ("whole", &|r| r.whole().into()),
            ("plane", &|r| r.part(Factor::Plane).into()),
            ("stop rule", &|r| r.part(Factor::Stop).into()),
            ("traversal", &|r| r.part(Factor::Traversal).into()),
            ("plane alone", &|r| r.plane_alone().into()),
        ],
    );
    let note = "whole: speedup of the SAH tree over the report's tree; the three factors multiply to it. plane alone: \
                speedup of the exact SAH split plane over the report's split plane, if both trees split nodes of more \
                than 8 triangles (unless no plane separates the triangles) and both use the traversal \"plane intervals\", \
                which clips the ray interval at each split plane. Intervals are 95 % prediction intervals for a rerun.";
    let noise = results.first().and_then(|r| r.noise.log()).unwrap_or(0.0);
    let noise = format!("A/A noise of all scenes: a factor of {:.3}.", libm::exp(noise));
    table.noted(vec![note.into(), noise]).with_interval_note()
}

pub fn trees(results: &[Attribution]) -> Table {
    let is_sampled = |r: &Attribution| r.epochs[0].common_rays(&r.first().workload) < r.first().workload_rays;
    let of_scene = |r| Treatment::all().map(move |cell| (r, cell));
    let mut table = Table::of(
        "All trees",
        results.iter().flat_map(of_scene),
        &[
            ("plane", &|(_, cell)| cell.levels()[Factor::Plane as usize].0.into()),
            ("stop", &|(_, cell)| cell.levels()[Factor::Stop as usize].0.into()),
            ("traversal", &|(_, cell)| cell.levels()[Factor::Traversal as usize].0.into()),
            ("mrays_per_s", &|(r, cell)| (1e3 / r.ns_per_ray(*cell)).into()),
            ("ns_per_ray", &|(r, cell)| Cell::from(r.ns_per_ray(*cell)).sampled(is_sampled(r))),
            ("sampled", &|(r, _)| is_sampled(r).into()),
            ("speedup", &|(r, cell)| r.speedup(&gain(Treatment::REPORT, *cell)).into()),
        ],
    );
    let names = ["scene", "triangles", "stand_in", "structure", "label", "workload", "tests_per_ray", "steps_per_ray"];
    let shape = ["references_per_triangle", "sah_cost", "depth", "bytes", "build_ns"];
    let trees: Vec<&Measurement> = results.iter().flat_map(|r| &r.trees).collect();
    push_columns(&mut table, &[&names[..], &shape].concat(), &trees);
    table
        .noted(["speedup: over the report's tree, the first row. ~: timed on a subset of the rays."])
        .with_interval_note()
}
