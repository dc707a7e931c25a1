//! Where a KD-tree overtakes a BVH.

use serde::{Deserialize, Serialize};

use super::curve::{Crossing, Curve};
use crate::measure::{AaNoise, Estimate, Rerun};
use crate::report::words::distinct;
use crate::study::epoch::{Epoch, Line, lines, middles, twins};

/// The KD-tree and the BVH of a pair. In the second and third the node, the leaf and the walk are the same and only the
/// way to divide the triangles differs; the first are the textbook tree and the BVH from outside. All over one triangle
/// test.
pub const PAIRS: [[&str; 2]; 3] = [
    ["sah-kd:test=moller-trumbore", "obvhs-bvh2"],
    ["sah-kd-wide:test=moller-trumbore", "sah-bvh:test=moller-trumbore"],
    ["sah-kd-tight:test=moller-trumbore", "sah-bvh:test=moller-trumbore"],
];

/// One epoch of one member of the family.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct MemberEpoch {
    pub layers: u32,
    /// Of each kind of rays of the epoch's, by name.
    pub complexity: Vec<(String, f64)>,
    pub epoch: Epoch,
}

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
    /// The ratio of times grows like this power of the depth complexity: below 0 the KD-tree gains. Nothing of fewer
    /// than three members.
    pub trend: Option<Estimate>,
}

/// One pair on one member of the family.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Member {
    pub layers: u32,
    /// Surfaces that a ray would meet if none stopped it, on average.
    pub complexity: f64,
    /// Time of the KD-tree as a multiple of the BVH's.
    pub ratio: Estimate,
    pub kd_ns_per_ray: f64,
    pub bvh_ns_per_ray: f64,
}

/// The races of all pairs.
pub fn result(cases: &[MemberEpoch]) -> Vec<Race> {
    let lines = lines(cases.iter().map(|case| &case.epoch));
    let noise = twins(cases.iter().map(|case| &case.epoch)).trace;
    let workloads = distinct(lines.iter().map(|line| &line.workload));
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
            let (kd, bvh) = (kd.on_rays_of(bvh)?, bvh.on_rays_of(kd)?);
            let ratios = middles(&kd.log_ratios(&bvh)?);
            Some(Entry { layers: case.layers, complexity: *complexity, kd, bvh, ratios })
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
                races.push(race(kd, bvh, workload, &entries, &noise));
            }
        }
    }
    races
}

struct Entry {
    layers: u32,
    complexity: f64,
    /// Both on the rays of the one that is timed on fewer.
    kd: Line,
    bvh: Line,
    /// ln time of the KD-tree over that of the BVH.
    ratios: Vec<f64>,
}

fn race(kd: String, bvh: String, workload: &str, entries: &[Entry], noise: &AaNoise) -> Race {
    let member = |entry: &Entry| Member {
        layers: entry.layers,
        complexity: entry.complexity,
        ratio: Rerun::of(&entry.ratios, noise.of_ratio()).expect("a line has epochs").ratio(),
        kd_ns_per_ray: entry.kd.ns_per_ray(),
        bvh_ns_per_ray: entry.bvh.ns_per_ray(),
    };
    let points = entries.iter().map(|entry| (libm::log(entry.complexity), entry.ratios.clone())).collect();
    let curve = Curve::new(points, noise);
    Race {
        kd,
        bvh,
        workload: workload.into(),
        members: entries.iter().map(member).collect(),
        crossings: curve.crossings(),
        trend: curve.trend(),
    }
}
