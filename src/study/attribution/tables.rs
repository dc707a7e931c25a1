//! The results as a chart and tables.

use super::design::{Factor, Treatment};
use super::effects;
use super::findings::{HARD, PARTS, range};
use super::result::{Attribution, Split};
use crate::report::number::{count, figures};
use crate::report::plot::{Bar, Bars, Chart};
use crate::report::{Art, Block, Cell, Figure, Table};
use crate::study::epoch::RayCounts;

pub fn blocks(results: &[Attribution]) -> Vec<Block> {
    if results.is_empty() {
        return vec![];
    }
    let mut sorted: Vec<&Attribution> = results.iter().collect();
    sorted.sort_by_key(|r| HARD.iter().position(|name| r.first().scene == *name).unwrap_or(HARD.len()));
    let mut blocks = vec![
        Block::Text(
            "One kind of tree in every combination of six planes, three stop rules and two traversals. From the \
             report's tree to the SAH tree three things are switched; each is credited with its gain, averaged over \
             all orders of switching, so that the parts multiply to the whole."
                .into(),
        ),
        Block::figure(figure(&sorted)),
        headlines(&sorted).into(),
    ];
    let fold = |r: &Attribution| {
        Block::Fold(format!("{}: counts and all trees", r.first().title()), vec![splits(r).into(), of_scene(r).into()])
    };
    blocks.extend(sorted.into_iter().map(fold));
    blocks
}

/// The speedup of each scene as a product.
fn figure(results: &[&Attribution]) -> Figure {
    let parts = |r: &Attribution| PARTS.map(|factor| r.time().part(factor).times.estimate);
    let bar = |r: &&Attribution| (r.first().title(), Bar::Product(parts(r).into(), r.time().whole));
    let told = |r: &&Attribution| {
        let own = PARTS.iter().zip(parts(r)).map(|(part, x)| format!("{} {}", part.name(), figures(x)));
        let own: Vec<String> = own.collect();
        format!("{}: {} times faster, {}", r.first().title(), figures(r.time().whole.estimate), own.join(", "))
    };
    Figure {
        id: "attribution".into(),
        caption: "How many times faster the SAH tree is than the report's, and the factors whose product that is. The \
                  axis is logarithmic: lengths add up to the whole. Factors below 1 stand to the left. The line below \
                  a bar is the 95 % interval of the whole."
            .into(),
        alt: format!("Stacked bar chart. {}.", results.iter().map(told).collect::<Vec<_>>().join("; ")),
        art: Art::Chart(Chart::Bars(Bars::of_products(
            "times as fast as the report's tree",
            PARTS.map(|factor| factor.name().to_owned()).into(),
            results.iter().map(bar),
        ))),
        data: headlines(results),
    }
}

/// One row for each scene: the answer.
fn headlines(results: &[&Attribution]) -> Table {
    let part = |r: &Attribution, factor| Cell::from(r.time().part(factor).times);
    let table = Table::of(
        "Speedup of the SAH tree, and what it is due to",
        results,
        &[
            ("scene", &|r| r.first().title().into()),
            ("whole", &|r| r.time().whole.into()),
            ("plane", &|r| part(r, Factor::Plane)),
            ("stop rule", &|r| part(r, Factor::Stop)),
            ("traversal", &|r| part(r, Factor::Traversal)),
            ("plane alone", &|r| r.plane_alone().into()),
        ],
    );
    let note = "whole: how many times faster the SAH tree is than the report's; the three parts multiply to it. plane \
                alone: exact SAH against the report's plane where both stop at 8 triangles, as far as planes divide \
                them, and have plane intervals. [95 %: of another run of the same plan]";
    table.noted(vec![note.into()]).explained()
}

/// The same split for counts, and by the order of switching.
fn splits(r: &Attribution) -> Table {
    let row = |(name, split): (&str, Split)| -> Vec<Cell> {
        let parts = Factor::ALL.map(|factor| split.part(factor));
        let parts = parts.map(|part| Cell::from(part.times).noted(range(part)));
        [name.into(), split.whole.into()].into_iter().chain(parts).collect()
    };
    let (tests, steps) = (r.counted(RayCounts::tests_per_ray), r.counted(RayCounts::steps_per_ray));
    let rows = [("time", r.time()), ("tests", tests), ("steps", steps)].map(row);
    let columns = ["times less", "whole"].into_iter().chain(Factor::ALL.map(Factor::name));
    let title = format!("{}: from the report's tree to the SAH tree", r.first().title());
    let note = "The parts are geometric means over all orders of switching the factors (Shapley). In parentheses: the \
                least and the most over those orders.";
    Table::new(title, columns, rows).noted(vec![note.into()]).explained()
}

/// All trees of one scene.
fn of_scene(r: &Attribution) -> Table {
    let (first, rays) = (r.first(), &r.tree(Treatment::REPORT).rays[0]);
    let noise = libm::exp(r.noise.log().unwrap_or(0.0));
    let note = format!(
        "{} epochs of {} samples. speedup: over the report's tree, the first. ns_per_ray ~: on a part of the rays. A/A \
         noise of all scenes: a factor of {noise:.3}.",
        r.epochs.len(),
        rays.ns.len(),
    );
    let title = format!("{}: {} triangles, {} rays", first.title(), count(first.triangles as u64), rays.workload);
    let left_out = [
        &["scene", "triangles", "stand_in", "structure", "label", "workload"][..],
        &["mrays_per_s", "sampled", "depth", "bytes", "build_ns"],
    ];
    Table { title, ..trees([r]) }.without_columns(&left_out.concat()).noted(vec![note]).explained()
}

/// One row for each tree of each scene.
pub fn trees<'a>(results: impl IntoIterator<Item = &'a Attribution<'a>>) -> Table {
    let level = |cell: &Treatment, factor: Factor| cell.names()[factor as usize].into();
    let is_sampled = |r: &Attribution| r.first().common_rays(r.workload()) < r.tree(Treatment::REPORT).rays[0].all;
    let references = |r: &Attribution, cell| r.tree(cell).shape.references as f64 / r.first().triangles.max(1) as f64;
    Table::of(
        "",
        results.into_iter().flat_map(|r| Treatment::all().into_iter().map(move |cell| (r, cell))),
        &[
            ("plane", &|(_, cell)| level(cell, Factor::Plane)),
            ("stop", &|(_, cell)| level(cell, Factor::Stop)),
            ("traversal", &|(_, cell)| level(cell, Factor::Traversal)),
            ("scene", &|(r, _)| r.first().scene.as_str().into()),
            ("triangles", &|(r, _)| r.first().triangles.into()),
            ("stand_in", &|(r, _)| r.first().stand_in.into()),
            ("structure", &|&(r, cell)| r.tree(cell).name.as_str().into()),
            ("label", &|&(r, cell)| r.tree(cell).label.as_str().into()),
            ("workload", &|(r, _)| r.workload().into()),
            ("mrays_per_s", &|&(r, cell)| (1e3 / r.ns_per_ray(cell)).into()),
            ("ns_per_ray", &|&(r, cell)| Cell::from(r.ns_per_ray(cell)).sampled(is_sampled(r))),
            ("sampled", &|(r, _)| is_sampled(r).into()),
            ("speedup", &|&(r, cell)| r.speedup(&effects::gain(Treatment::REPORT, cell)).into()),
            ("tests_per_ray", &|&(r, cell)| r.counts(cell).tests_per_ray().into()),
            ("steps_per_ray", &|&(r, cell)| r.counts(cell).steps_per_ray().into()),
            ("references_per_triangle", &|&(r, cell)| references(r, cell).into()),
            ("sah_cost", &|&(r, cell)| r.tree(cell).shape.sah_cost.into()),
            ("depth", &|&(r, cell)| r.tree(cell).shape.depth.into()),
            ("bytes", &|&(r, cell)| r.tree(cell).shape.bytes.into()),
            ("build_ns", &|&(r, cell)| r.tree(cell).build_ns.into()),
        ],
    )
}
