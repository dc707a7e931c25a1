//! Every structure that the registry offers, held to the contract on every mesh of the suite and every kind of ray.

use std::sync::Arc;

use sahara::geometry::Mesh;
use sahara::registry::{Choice, Registry};
use sahara::scene::{BUILTIN, Difficulty};
use sahara::structures::{BruteForce, KdConfig, KdTree, Partition, WideConfig, WideTree};
use sahara::triangle::MollerTrumbore;
use sahara::validate::conformance::{Subject, answers, counting, shapes};
use sahara::validate::degenerate_meshes;

sahara::conformance!(brute_force, BruteForce<MollerTrumbore>, Default::default(), lowest_id);
sahara::conformance!(median_kd, KdTree<MollerTrumbore>, KdConfig::REPORT, lowest_id);
sahara::conformance!(sah_kd, KdTree<MollerTrumbore>, KdConfig::SAH, lowest_id);
sahara::conformance!(sah_kd_wide, WideTree<MollerTrumbore>, WideConfig::new(Partition::Cells), lowest_id);
sahara::conformance!(sah_kd_tight, WideTree<MollerTrumbore>, WideConfig::new(Partition::Tight), lowest_id);
sahara::conformance!(sah_hybrid, WideTree<MollerTrumbore>, WideConfig::new(Partition::Hybrid), lowest_id);
sahara::conformance!(sah_bvh, WideTree<MollerTrumbore>, WideConfig::new(Partition::Objects), lowest_id);

/// Configurations that differ in what they build or how they walk. `exit=first-leaf` is left out: it is wrong by design.
const OURS: [&str; 28] = [
    "brute-force:test=rt-triangle",
    "median-kd:leaf=1",
    "median-kd:leaf=1,threshold=1",
    "median-kd:leaf=2,limit=at-most,threshold=1",
    "median-kd:leaf=4,axis=longest,threshold=1",
    "median-kd:leaf=4,count=child",
    "median-kd:leaf=4,median=mean,threshold=1",
    "median-kd:leaf=4,median=welded,threshold=1",
    "median-kd:leaf=4,equal=below,threshold=1",
    "median-kd:leaf=4,mailbox=true,threshold=1",
    "median-kd:leaf=4,traversal=plane-intervals,threshold=1",
    "sah-kd:traversal=child-boxes",
    "sah-kd:mailbox=true",
    "sah-kd:empty_bonus=0",
    "sah-kd:intersection_cost=50",
    "sah-kd:intersection_cost=50,duplication=1",
    "sah-kd:intersection_cost=0.1",
    "sah-kd:plane=vertex-median",
    "sah-kd-wide:block_cost=50",
    "sah-kd-wide:block_cost=0.01",
    "sah-kd-tight:quality=fast",
    "sah-kd-tight:quality=high,duplication=1",
    "sah-hybrid:quality=fast,block_cost=50",
    "sah-hybrid:quality=high",
    "sah-bvh:quality=fast,block_cost=0.01",
    "sah-bvh:quality=high",
    "sah-kd-tight:packets=true",
    "sah-hybrid:packets=true",
];

const TREES: [&str; 6] = ["median-kd", "sah-kd", "sah-kd-wide", "sah-kd-tight", "sah-hybrid", "sah-bvh"];

fn subject(choice: &Choice, lowest_id: bool) -> Subject {
    Subject { name: format!("{} over {}", choice.label, choice.triangle_test()), lowest_id, ..choice.subject() }
}

fn passes(outcome: Result<(), String>) {
    if let Err(report) = outcome {
        panic!("{report}");
    }
}

#[test]
fn every_configuration_of_ours_is_right() {
    let (registry, meshes) = (Registry::builtin(), degenerate_meshes());
    for spec in OURS {
        let choice = registry.choose(spec).unwrap();
        let subject = subject(&choice, true);
        passes(answers(&subject, &meshes, 60));
        passes(counting(&subject, &meshes, 10));
        passes(shapes(&subject, &meshes));
    }
}

/// The built-in scenes, with real-world sizes and materials that split them.
fn scenes(hard: bool) -> Vec<(String, Arc<Mesh>)> {
    let wanted = BUILTIN.iter().filter(|builtin| (builtin.difficulty == Difficulty::Hard) == hard);
    wanted.map(|b| (b.name.to_string(), b.scene(None).expect("a built-in scene is whole").mesh)).collect()
}

#[test]
fn every_configuration_of_ours_is_right_on_the_small_scenes() {
    let (registry, meshes) = (Registry::builtin(), scenes(false));
    for spec in OURS.iter().chain(&TREES) {
        passes(answers(&subject(&registry.choose(spec).unwrap(), true), &meshes, 60));
    }
}

#[test]
fn our_trees_are_right_on_the_hard_scenes() {
    let (registry, meshes) = (Registry::builtin(), scenes(true));
    for spec in TREES {
        passes(answers(&subject(&registry.choose(spec).unwrap(), true), &meshes, 60));
    }
}

/// What the baseline answers wrongly is in `tests/findings.rs`; what it counts and how it looks is sound. Structures with
/// conventions of their own are peers: `tests/peers.rs`.
#[test]
fn everything_offered_counts_and_has_a_possible_shape() {
    let (registry, meshes) = (Registry::builtin(), degenerate_meshes());
    let presets = ["fastest", "very-fast", "fast", "medium", "slow", "very-slow"];
    let presets = presets.iter().flat_map(|p| ["obvhs-bvh2", "obvhs-cwbvh"].map(|s| format!("{s}:preset={p}")));
    let choices = registry.all().into_iter().chain(presets.map(|spec| registry.choose(&spec).unwrap()));
    for choice in choices.filter(|choice| choice.entry.conventions.is_empty()) {
        let subject = subject(&choice, false);
        passes(counting(&subject, &meshes, 10));
        passes(shapes(&subject, &meshes));
    }
}
