//! Markets as tables for people.

use super::{Market, Pair, Payoff};
use crate::report::number::{count, duration};
use crate::report::words::{ONE_EPOCH, explained};
use crate::report::{Cell, Table, Tone};

/// What the columns mean.
pub const LEGEND: [&str; 2] = [
    "Each cell: rays after which the structure of its row, which takes longer to build, is ahead of that of its column, with the 95 % \
     interval for another run; k, M and G are thousands, millions and thousands of millions. A picture of 512 x 512 pixels has 262k \
     primary rays.",
    "Build and rays on one thread, the builders that use several included, unless --threads says otherwise. A slow structure is timed on \
     fewer rays than the others; a pair is compared on the same ones.",
];

/// That of one scene and kind of rays.
pub fn table(market: &Market) -> Table {
    let names: Vec<&str> = market.offers.iter().map(|offer| offer.structure.as_str()).collect();
    let mut columns: Vec<String> = ["structure", "build", "time a ray"].map(String::from).into();
    columns.extend(names[..names.len().saturating_sub(1)].iter().map(|name| format!("over {name}")));
    let fastest = market.offers.iter().map(|offer| offer.ns_per_ray).fold(f64::INFINITY, f64::min);
    let rows = market.offers.iter().map(|offer| {
        let tone = if offer.ns_per_ray == fastest { Tone::Best } else { Tone::Plain };
        let mut row = vec![
            offer.structure.as_str().into(),
            duration(offer.build_ns).into(),
            Cell::from(duration(offer.ns_per_ray)).with(tone),
        ];
        for cheap in &names[..names.len().saturating_sub(1)] {
            let pair = market.pairs.iter().find(|pair| pair.cheap == **cheap && pair.dear == offer.structure);
            row.push(pair.map(cell).into());
        }
        row
    });
    let best = market.best.iter().map(|stretch| match stretch.from {
        0.0 => stretch.structure.clone(),
        from => format!("from {} rays {}", Payoff::Rays(from).words(), stretch.structure),
    });
    explained(Table {
        title: format!("{}: {} triangles, {} rays", market.scene, count(market.triangles as u64), market.workload),
        columns,
        rows: rows.collect(),
        notes: vec![format!("Done first, build included: {}.", best.collect::<Vec<_>>().join(", "))],
    })
}

fn cell(pair: &Pair) -> String {
    let rays = pair.rays.words();
    match [pair.low, pair.high].map(|end| end.map(Payoff::words)) {
        [Some(low), Some(high)] if low == high => rays,
        [Some(low), Some(high)] => format!("{rays} [{low}, {high}]"),
        _ => format!("{rays} {ONE_EPOCH}"),
    }
}
