//! Where a KD-tree overtakes a BVH.

use serde::Serialize;

use super::{Case, PAIRS};
use crate::measure::Interval;
use crate::study::epoch::{Draws, Line, centre, lines};
use crate::study::fit;

/// One pair on one kind of rays, over the family.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Race {
    /// The KD-tree, as chosen.
    pub kd: String,
    /// The BVH, as chosen.
    pub bvh: String,
    pub workload: String,
    /// By growing depth complexity.
    pub members: Vec<Member>,
    /// Every place where the ratio of times crosses 1, by growing depth complexity.
    pub crossings: Vec<Crossing>,
    /// The ratio of times grows like this power of the depth complexity: below 0 the KD-tree gains. Nothing of fewer than three
    /// members.
    pub trend: Option<Interval>,
}

/// One pair on one member of the family.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Member {
    pub layers: u32,
    /// Surfaces that a ray would meet if none stopped it, on average.
    pub complexity: f64,
    /// Time of the KD-tree as a multiple of the BVH's.
    pub ratio: Interval,
    pub kd_ns_per_ray: f64,
    pub bvh_ns_per_ray: f64,
}

/// A place where one overtakes the other.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Crossing {
    /// Depth complexity, between two members on a line between logarithms.
    pub complexity: Interval,
    /// Whether the KD-tree is the faster one beyond.
    pub kd_wins_beyond: bool,
    /// Share of the draws that cross in this direction between the neighbours of this crossing: below 0.95 it may not be there.
    pub found: f64,
}

/// The races of all pairs. Intervals are for another run: from epochs and rounds drawn, the same for both of a pair.
pub fn result(cases: &[Case], seed: u64) -> Vec<Race> {
    let lines = lines(cases.iter().map(|case| &case.epoch));
    let mut workloads: Vec<&str> = vec![];
    for line in &lines {
        if !workloads.contains(&line.workload.as_str()) {
            workloads.push(&line.workload);
        }
    }
    let of = |[kd, bvh]: [&str; 2], workload: &str| -> Vec<Entry> {
        let find = |scene: &str, spec: &str| {
            lines.iter().find(|line| line.scene == scene && line.workload == workload && line.structure == spec)
        };
        let mut scenes: Vec<&str> = lines.iter().map(|line| line.scene.as_str()).collect();
        scenes.dedup();
        let entry = |scene: &str| {
            let (kd, bvh) = (find(scene, kd)?, find(scene, bvh)?);
            let case = cases.iter().find(|case| case.epoch.scene == scene)?;
            let (_, complexity) = case.complexity.iter().find(|(name, _)| name == workload)?;
            Some(Entry { layers: case.layers, complexity: *complexity, kd, bvh, ratios: kd.log_ratios(bvh)? })
        };
        let mut entries: Vec<Entry> = scenes.into_iter().filter_map(entry).filter(|e| e.complexity > 0.0).collect();
        entries.sort_by(|a, b| a.complexity.total_cmp(&b.complexity));
        entries
    };
    let mut races = vec![];
    for pair in PAIRS {
        for workload in &workloads {
            let entries = of(pair, workload);
            if let Some(first) = entries.first() {
                let (kd, bvh) = (first.kd.structure.clone(), first.bvh.structure.clone());
                races.push(race(kd, bvh, workload, &entries, seed));
            }
        }
    }
    races
}

/// One member of the family before anything is drawn.
struct Entry<'a> {
    layers: u32,
    complexity: f64,
    kd: &'a Line,
    bvh: &'a Line,
    /// ln time of the KD-tree over that of the BVH.
    ratios: Vec<Vec<f64>>,
}

fn race(kd: String, bvh: String, workload: &str, entries: &[Entry], seed: u64) -> Race {
    let depths: Vec<f64> = entries.iter().map(|entry| libm::log(entry.complexity)).collect();
    let own: Vec<f64> = entries.iter().map(|entry| centre(&entry.ratios)).collect();
    let mut draws = Draws::new(seed);
    let drawn: Vec<Vec<f64>> = (0..fit::DRAWS)
        .map(|_| entries.iter().map(|entry| draws.draw(&entry.ratios).centre(&entry.ratios)).collect())
        .collect();

    let members = entries.iter().enumerate().map(|(i, entry)| {
        let ratio = fit::percentiles(own[i], drawn.iter().map(|draw| draw[i]).collect()).expect("there are draws");
        Member {
            layers: entry.layers,
            complexity: entry.complexity,
            ratio: exp(ratio),
            kd_ns_per_ray: entry.kd.ns_per_ray(),
            bvh_ns_per_ray: entry.bvh.ns_per_ray(),
        }
    });
    Race {
        kd,
        bvh,
        workload: workload.into(),
        members: members.collect(),
        crossings: crossings(&depths, &own, &drawn),
        trend: trend(&depths, &own, &drawn),
    }
}

fn exp(x: Interval) -> Interval {
    Interval { estimate: libm::exp(x.estimate), low: libm::exp(x.low), high: libm::exp(x.high) }
}

/// Where the broken line through the logarithms of the ratios crosses 0, as logarithms of the depth, each with whether it falls.
fn zeros(depths: &[f64], ratios: &[f64]) -> Vec<(f64, bool)> {
    let mut zeros = vec![];
    for i in 1..depths.len() {
        let (before, after) = (ratios[i - 1], ratios[i]);
        if (before > 0.0) != (after > 0.0) {
            let share = before / (before - after);
            zeros.push((depths[i - 1] + (depths[i] - depths[i - 1]) * share, before > 0.0));
        }
    }
    zeros
}

/// The crossings of our own line, each with those of the draws that are nearer to it than to its neighbours.
fn crossings(depths: &[f64], own: &[f64], drawn: &[Vec<f64>]) -> Vec<Crossing> {
    let zeros_of_draws: Vec<Vec<(f64, bool)>> = drawn.iter().map(|draw| zeros(depths, draw)).collect();
    let own = zeros(depths, own);
    let nearest = |at: f64, falls: bool, zeros: &[(f64, bool)]| {
        let alike = zeros.iter().filter(|(_, other)| *other == falls).map(|(zero, _)| *zero);
        let nearest = alike.min_by(|a, b| (a - at).abs().total_cmp(&(b - at).abs()))?;
        let mine = |other: &(f64, bool)| (nearest - at).abs() <= (nearest - other.0).abs();
        own.iter().all(mine).then_some(nearest)
    };
    let crossing = |&(at, falls): &(f64, bool)| {
        let found: Vec<f64> = zeros_of_draws.iter().filter_map(|zeros| nearest(at, falls, zeros)).collect();
        let share = found.len() as f64 / drawn.len() as f64;
        let complexity = fit::percentiles(at, found).unwrap_or(Interval { estimate: at, low: at, high: at });
        Crossing { complexity: exp(complexity), kd_wins_beyond: falls, found: share }
    };
    own.iter().map(crossing).collect()
}

/// The slope of the ratio over the depth, both as logarithms; the wider of the draws and Student's t on what is left over.
fn trend(depths: &[f64], own: &[f64], drawn: &[Vec<f64>]) -> Option<Interval> {
    let points = |ratios: &[f64]| -> Vec<(f64, f64)> { depths.iter().copied().zip(ratios.iter().copied()).collect() };
    let half = fit::slope_error(&points(own))?;
    let slope = |ratios: &[f64]| fit::line(&points(ratios)).map(|(_, slope)| slope);
    let estimate = slope(own)?;
    let slopes = fit::percentiles(estimate, drawn.iter().filter_map(|draw| slope(draw)).collect())?;
    Some(Interval { estimate, low: slopes.low.min(estimate - half), high: slopes.high.max(estimate + half) })
}

/// One pair on one member, for tables that machines read.
#[derive(Clone, Debug, Serialize)]
pub struct Row<'a> {
    pub kd: &'a str,
    pub bvh: &'a str,
    pub workload: &'a str,
    #[serde(flatten)]
    pub member: &'a Member,
}

/// All members of all races.
pub fn rows(races: &[Race]) -> Vec<Row<'_>> {
    let mut rows = vec![];
    for Race { kd, bvh, workload, members, .. } in races {
        rows.extend(members.iter().map(|member| Row { kd, bvh, workload, member }));
    }
    rows
}
