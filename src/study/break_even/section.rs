//! After how many rays a dearer build pays.

use super::table::{LEGEND, table};
use super::{Market, Offer};
use crate::report::Table;
use crate::report::document::{Art, Block, Figure};
use crate::report::number::{count, duration};
use crate::report::plot::{Chart, CurvePoint, Curves, Line, Mark};
use crate::report::words::slug;

/// Scenes and kinds of rays shown at once; the others are folded.
const OPEN: usize = 2;

pub fn blocks(markets: &[Market], command: &str) -> Vec<Block> {
    let mut markets = markets.to_vec();
    markets.sort_by_key(|market| (market.workload != "primary", std::cmp::Reverse(market.triangles)));
    let mut blocks = vec![Block::Text(
        "A better tree takes longer to build. The lines show build and rays together, as a multiple of what the quickest \
         structure takes for the same rays: where a line touches 1 the structure is the best choice."
            .into(),
    )];
    let one = |market: &Market| [Block::figure(figure(market, command)), Block::table(table(market), command)];
    let rest = markets.split_off(markets.len().min(OPEN));
    blocks.extend(markets.iter().flat_map(one));
    blocks.extend(LEGEND.map(|words| Block::Note(words.into())));
    if !rest.is_empty() {
        let name = format!("The other {} scenes and kinds of rays", rest.len());
        blocks.push(Block::Fold(name, rest.iter().flat_map(one).collect()));
    }
    blocks
}

/// Numbers of rays, as powers of ten, between which lines are drawn, in steps of a tenth.
const TENTHS: std::ops::RangeInclusive<i32> = 20..=90;

/// What takes longer than this, as a multiple of the quickest, is beyond the picture.
const HIGHEST: f64 = 20.0;

fn figure(market: &Market, command: &str) -> Figure {
    let rays: Vec<f64> = TENTHS.map(|tenth| libm::pow(10.0, f64::from(tenth) / 10.0)).collect();
    let line = |offer: &Offer| {
        let points = rays.iter().map(|&rays| CurvePoint::exact(rays, market.slowdown(&offer.structure, rays)));
        Line::new(&offer.structure, Mark::Line, points)
    };
    let rows = market.offers.iter().map(|o| [o.structure.clone(), duration(o.build_ns), duration(o.ns_per_ray)]);
    let best: Vec<String> = market
        .best
        .iter()
        .map(|stretch| match stretch.from {
            0.0 => format!("{} at once", stretch.structure),
            from => format!("{} from {} rays", stretch.structure, count(from.round() as u64)),
        })
        .collect();
    Figure {
        id: format!("break-even-{}-{}", slug(&market.scene), slug(&market.workload)),
        caption: format!(
            "{}, {} triangles, {} rays: build and rays together, as a multiple of the quickest; lower is better. Done first: {}.",
            market.scene,
            count(market.triangles as u64),
            market.workload,
            best.join(", ")
        ),
        alt: format!("Line chart over the number of rays. Quickest, build included: {}.", best.join(", ")),
        command: command.into(),
        art: Art::Chart(Chart::Curves(Curves {
            highest: Some(HIGHEST),
            ..Curves::logarithmic(
                "rays",
                "times as long as the quickest, build included",
                market.offers.iter().map(line).collect(),
            )
        })),
        data: Table::of_texts("", ["structure", "build", "time of a ray, on all rays of its own"], rows.collect()),
    }
}
