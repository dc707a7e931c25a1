use std::sync::Arc;

use glam::Vec3;

use super::*;
use crate::accel::Accel;
use crate::brute_force::BruteForce;
use crate::geometry::{Mesh, Ray};
use crate::measure::Part;
use crate::study::epoch::tests::example;
use crate::triangle::MollerTrumbore;

/// Members whose KD-tree takes (depth / crossing)^power times as long as the BVH, with noise that alternates.
fn family(crossing: f64, power: f64, noise: f64) -> Vec<MemberEpoch> {
    let mut cases = vec![];
    for (i, layers) in [1u32, 4, 16, 64].into_iter().enumerate() {
        let depth = f64::from(layers) / 2.0;
        for epoch in 0..3 {
            let off = noise * [1.0, -1.0, 0.0][(epoch + i) % 3];
            let kd = (1e7 * libm::pow(depth / crossing, power) * libm::exp(off)) as u64;
            let structures: [(&str, u64, &[u64]); 2] =
                [(PAIRS[0][0], 1, &[kd, kd, kd]), (PAIRS[0][1], 1, &[10_000_000; 3])];
            let epoch = example(&format!("{layers} layers"), 100, epoch, &structures);
            cases.push(MemberEpoch { layers, complexity: vec![("primary".into(), depth)], epoch });
        }
    }
    cases
}

#[test]
fn the_crossing_is_found_where_it_is() {
    let races = result(&family(5.0, -0.5, 0.02));
    assert_eq!(races.len(), 1, "pairs that were not measured have no race");
    let race = &races[0];
    assert_eq!(race.members.iter().map(|member| member.layers).collect::<Vec<_>>(), [1, 4, 16, 64]);
    let [crossing] = &race.crossings[..] else { panic!("{race:?}") };
    assert!(crossing.kd_wins_beyond && crossing.is_sure(), "{crossing:?}");
    assert!((crossing.complexity.estimate / 5.0 - 1.0).abs() < 0.1, "{crossing:?}");
    assert!(crossing.complexity.holds(5.0), "{crossing:?}");
    let trend = race.trend.unwrap();
    assert!((trend.estimate + 0.5).abs() < 0.02 && trend.is_below(0.0), "{trend:?}");
    assert!((race.members[0].ratio.estimate - libm::sqrt(10.0)).abs() < 0.1);
    assert_eq!(tables(&races).len(), 2);
}

#[test]
fn who_never_overtakes_has_no_crossing() {
    for (crossing, winner) in [(1000.0, "never: obvhs-bvh2"), (0.01, "never: sah-kd")] {
        let races = result(&family(crossing, -0.5, 0.02));
        assert!(races[0].crossings.is_empty());
        let answer = &tables(&races)[0].rows[0][4].text;
        assert!(answer.starts_with(winner), "{answer}");
    }
}

#[test]
fn a_crossing_within_the_noise_is_not_named() {
    // The ratio hardly moves and the noise is twenty times as large.
    let races = result(&family(5.0, -0.005, 0.1));
    assert!(races[0].crossings.iter().all(|crossing| !crossing.is_sure()), "{races:?}");
    assert!(!tables(&races)[0].rows[0][4].text.is_empty());
}

#[test]
fn a_ratio_and_the_times_beside_it_are_of_the_same_rays() {
    let mut cases = family(5.0, -0.5, 0.02);
    for case in &mut cases {
        let [kd, bvh] = &mut case.epoch.structures[..] else { panic!("a KD-tree and a BVH") };
        // The KD-tree is timed on ten rays, on which the BVH takes three times as long.
        let kd = &mut kd.rays[0];
        kd.rays = 10;
        kd.ns.iter_mut().for_each(|ns| *ns /= 100);
        bvh.rays[0].parts = vec![Part { rays: 10, ns: vec![300_000; 3] }];
    }
    let races = result(&cases);
    assert_eq!(races[0].members.len(), 4);
    for member in &races[0].members {
        let ratio = member.kd_ns_per_ray / member.bvh_ns_per_ray;
        assert!((ratio / member.ratio.estimate - 1.0).abs() < 1e-9, "{member:?}");
    }
}

#[test]
fn every_primary_ray_of_a_member_passes_all_layers() {
    use crate::kdtree::{KdConfig, KdTree};
    use crate::scene::{Sampling, Workload, WorkloadKind};
    for root in [1, 6] {
        let scene = member(root).unwrap();
        let tree = KdTree::<MollerTrumbore>::build(&scene.mesh, &KdConfig::SAH).unwrap();
        let of = |kind| {
            let workload = Workload::new(&scene, kind, &Sampling::some(&scene, 1600, 1), &tree);
            complexity(&tree, &workload.rays).unwrap()
        };
        // A quarter of the layers, and of that a standard deviation of 0.011 for a single one.
        let layers = f64::from(root * root);
        let share = of(WorkloadKind::Primary) / layers;
        assert!((share - 0.25).abs() < 0.045, "{layers} layers: {share}");
        // What a primary ray has passed, a shadow ray has not.
        assert!(of(WorkloadKind::Shadow) < of(WorkloadKind::Primary));
    }
}

#[test]
fn depth_complexity_counts_surfaces_within_the_interval() {
    // Three squares one behind another, at z = 0, 1 and 2.
    let mut points = vec![];
    let mut triangles = vec![];
    for z in 0..3 {
        let first = points.len() as u32;
        points.extend([(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)].map(|(x, y)| Vec3::new(x, y, z as f32)));
        triangles.extend([[first, first + 1, first + 2], [first, first + 2, first + 3]]);
    }
    let mesh = Arc::new(Mesh::new(points, triangles).unwrap());
    let accel = BruteForce::<MollerTrumbore>::build(&mesh, &Default::default()).unwrap();
    let through = Ray::new(Vec3::new(0.3, 0.2, -1.0), Vec3::Z);
    let beside = Ray::new(Vec3::new(3.0, 0.2, -1.0), Vec3::Z);
    assert_eq!(complexity(&accel, &[through, beside]), Some(1.5));
    assert_eq!(complexity(&accel, &[through.until(2.5)]), Some(2.0));
    assert_eq!(complexity(&accel, &[]), None);
}
