//! From what was measured to what pays.

use serde::Serialize;

use super::{Payoff, interval};
use crate::study::epoch::{Epoch, Line, Twins, lines, twins};
use crate::study::grouped::grouped;

/// What pays on one kind of rays of one scene.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Market {
    pub scene: String,
    pub triangles: usize,
    pub workload: String,
    /// By growing time of the build.
    pub offers: Vec<Offer>,
    /// Every pair, the cheaper build first.
    pub pairs: Vec<Pair>,
    /// Which structure is done first with its build and so many rays, from no ray upward.
    pub best: Vec<Stretch>,
}

/// What a structure costs.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Offer {
    /// As chosen.
    pub structure: String,
    pub build_ns: f64,
    /// On all rays that it is timed on.
    pub ns_per_ray: f64,
}

/// Two structures, of which one takes longer to build, both on the rays of the one that is timed on fewer.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Pair {
    pub cheap: String,
    pub dear: String,
    /// Nanoseconds of the build of each, and of a ray.
    pub costs: [(f64, f64); 2],
    /// Rays after which the dear one is ahead.
    pub rays: Payoff,
    /// The ends of the 95 % interval of that for another run; nothing with a single epoch.
    pub low: Option<Payoff>,
    pub high: Option<Payoff>,
}

/// Numbers of rays for which one structure is the best.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Stretch {
    pub structure: String,
    /// From so many rays.
    pub from: f64,
}

impl Market {
    /// What the build of a structure and so many rays take, as a multiple of what the quickest takes for the same rays:
    /// at least 1.
    pub fn slowdown(&self, structure: &str, rays: f64) -> f64 {
        self.pairs.iter().filter_map(|pair| pair.slowdown(structure, rays)).fold(1.0, f64::max)
    }
}

impl Pair {
    /// Likewise, as a multiple of what the other one of the pair takes. Nothing of a structure that is none of the two.
    fn slowdown(&self, structure: &str, rays: f64) -> Option<f64> {
        let [cheap, dear] = self.costs.map(|(build_ns, ns_per_ray)| build_ns + rays * ns_per_ray);
        match () {
            () if structure == self.cheap => Some(cheap / dear),
            () if structure == self.dear => Some(dear / cheap),
            () => None,
        }
    }
}

/// Every scene and kind of rays.
pub fn result(epochs: &[Epoch]) -> Vec<Market> {
    let twins = twins(epochs);
    let groups = grouped(lines(epochs), |a, b| a.scene_hash == b.scene_hash && a.workload == b.workload);
    groups.into_iter().map(|group| market(group, &twins)).collect()
}

fn market(mut lines: Vec<Line>, twins: &Twins) -> Market {
    lines.sort_by(|a, b| a.build_ns().total_cmp(&b.build_ns()));
    let offers: Vec<Offer> = lines
        .iter()
        .map(|line| Offer {
            structure: line.structure.clone(),
            build_ns: line.build_ns(),
            ns_per_ray: line.ns_per_ray(),
        })
        .collect();
    let mut pairs = vec![];
    for (i, dear) in lines.iter().enumerate() {
        pairs.extend(lines[..i].iter().filter_map(|cheap| pair(cheap, dear, twins)));
    }
    let first = &lines[0];
    let best = best(&first.structure, &pairs);
    Market {
        scene: first.scene.clone(),
        triangles: first.triangles,
        workload: first.workload.clone(),
        offers,
        pairs,
        best,
    }
}

/// Nothing where the two were not timed on the same rays.
fn pair(cheap: &Line, dear: &Line, twins: &Twins) -> Option<Pair> {
    let [cheap, dear] = &[cheap.on_rays_of(dear)?, dear.on_rays_of(cheap)?];
    let costs = [cheap, dear].map(|line| (line.build_ns(), line.ns_per_ray()));
    let rays = Payoff::of(costs[0], costs[1]);
    let [low, high] = interval::interval(cheap, dear, rays, twins).map_or([None; 2], |ends| ends.map(Some));
    Some(Pair { cheap: cheap.structure.clone(), dear: dear.structure.clone(), costs, rays, low, high })
}

/// The lower envelope of build + rays * time, from the structure `first` on, whose build takes the least, of all
/// `pairs` in the order of their dear builds.
pub(super) fn best(first: &str, pairs: &[Pair]) -> Vec<Stretch> {
    let mut best = vec![Stretch { structure: first.into(), from: 0.0 }];
    loop {
        let now = &best[best.len() - 1];
        // Who is next to overtake; of several at once the one with the dearest build is the fastest.
        let ahead = pairs.iter().rev().filter(|pair| pair.cheap == now.structure && pair.rays < Payoff::Never);
        let next = ahead.min_by(|a, b| a.rays.partial_cmp(&b.rays).expect("numbers"));
        let Some(next) = next else { return best };
        let from = if let Payoff::Rays(rays) = next.rays { rays.max(now.from) } else { now.from };
        best.push(Stretch { structure: next.dear.clone(), from });
    }
}

/// One pair, for tables that machines read.
#[derive(Clone, Debug, Serialize)]
pub struct Row<'a> {
    pub scene: &'a str,
    pub triangles: usize,
    pub workload: &'a str,
    pub cheap: &'a str,
    pub dear: &'a str,
    /// A number of rays, `at once` or `never`.
    pub rays: String,
    /// Likewise, or empty with a single epoch.
    pub low: String,
    pub high: String,
}

/// All pairs.
pub fn rows(markets: &[Market]) -> Vec<Row<'_>> {
    let mut rows = vec![];
    for Market { scene, triangles, workload, pairs, .. } in markets {
        rows.extend(pairs.iter().map(|pair| Row {
            scene,
            triangles: *triangles,
            workload,
            cheap: &pair.cheap,
            dear: &pair.dear,
            rays: pair.rays.plain(),
            low: pair.low.map_or(String::new(), Payoff::plain),
            high: pair.high.map_or(String::new(), Payoff::plain),
        }));
    }
    rows
}
