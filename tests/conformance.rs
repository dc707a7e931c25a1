//! Checks structures on degenerate meshes and on scenes.

use std::fs;
use std::path::Path;
use std::thread;

use sahara::accel::Capabilities;
use sahara::brute_force::BruteForce;
use sahara::builtin::{BUILTIN, Builtin, Difficulty};
use sahara::bvh8::{Bvh8, Bvh8Config, Partition};
use sahara::kdtree::{KdConfig, KdTree};
use sahara::registry::{Choice, Registry};
use sahara::scene::Scene;
use sahara::triangle::MollerTrumbore;
use sahara::validate::conformance::{Named, Subject, answers, counting, shapes};
use sahara::validate::degenerate_meshes;

sahara::conformance!(brute_force, BruteForce<MollerTrumbore>, Default::default(), lowest_id);
sahara::conformance!(median_kd, KdTree<MollerTrumbore>, KdConfig::REPORT, lowest_id);
sahara::conformance!(sah_kd, KdTree<MollerTrumbore>, KdConfig::SAH, lowest_id);
sahara::conformance!(sah_kd_wide, Bvh8<MollerTrumbore>, Bvh8Config::new(Partition::Cells), lowest_id);
sahara::conformance!(sah_kd_tight, Bvh8<MollerTrumbore>, Bvh8Config::new(Partition::Tight), lowest_id);
sahara::conformance!(sah_hybrid, Bvh8<MollerTrumbore>, Bvh8Config::new(Partition::Hybrid), lowest_id);
sahara::conformance!(sah_bvh, Bvh8<MollerTrumbore>, Bvh8Config::new(Partition::Objects), lowest_id);

/// Configurations to check. The option `exit=first-leaf` is absent, because its hits are wrong by design.
const OURS: [&str; 36] = [
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
    "sah-kd:plane=vertex-median,stop=report,threshold=1,leaf=4",
    "sah-kd:plane=spatial-median,axis=longest",
    "sah-kd:plane=spatial-median,axis=longest,stop=leaf,leaf=4",
    "sah-kd:plane=centroid-median,median=mean,stop=leaf,leaf=4",
    "sah-kd:plane=sah-binned,traversal=child-boxes",
    "sah-kd:plane=sah-binned,stop=leaf,leaf=1",
    "sah-kd-wide:block_cost=50",
    "sah-kd-wide:block_cost=0.01",
    "sah-kd-wide:quality=fast",
    "sah-kd-wide:quality=high",
    "sah-kd-tight:quality=fast",
    "sah-kd-tight:quality=high,duplication=1",
    "sah-hybrid:quality=fast,block_cost=50",
    "sah-hybrid:quality=high",
    "sah-bvh:quality=fast,block_cost=0.01",
    "sah-bvh:quality=high",
    "sah-kd-tight:batch=packets",
    "sah-hybrid:batch=packets",
];

pub const TREES: [&str; 6] = ["median-kd", "sah-kd", "sah-kd-wide", "sah-kd-tight", "sah-hybrid", "sah-bvh"];

fn subject(choice: &Choice, lowest_id: bool) -> Subject {
    Subject { name: format!("{} over {}", choice.label, choice.triangle_test()), lowest_id, ..choice.subject() }
}

pub fn passes(outcome: Result<(), String>) {
    outcome.unwrap_or_else(|report| panic!("{report}"));
}

fn are_right(specs: &[&str], meshes: &[Named], count: usize) {
    let registry = Registry::builtin();
    let check = |spec: &&str| passes(answers(&subject(&registry.choose(spec).unwrap(), true), meshes, count));
    // Run the checks outside rayon's pool, because builds need the threads of the pool.
    thread::scope(|scope| {
        specs.chunks(specs.len().div_ceil(2)).for_each(|half| drop(scope.spawn(|| half.iter().for_each(check))));
    });
}

#[test]
#[ignore = "a minute and a half; the default configurations are tested above"]
fn every_configuration_of_ours_is_right() {
    let (registry, degenerate) = (Registry::builtin(), degenerate_meshes());
    are_right(&OURS, &degenerate, 60);
    for spec in OURS {
        let subject = subject(&registry.choose(spec).unwrap(), true);
        passes(counting(&subject, &degenerate, 10));
        passes(shapes(&subject, &degenerate));
    }
    let small = BUILTIN.iter().filter(|scene| scene.difficulty != Difficulty::Hard);
    let named = |scene: &Builtin| (scene.name.to_string(), scene.scene(None).expect("built-in scenes are valid").mesh);
    are_right(&OURS, &small.map(named).collect::<Vec<_>>(), 60);
    are_right(&TREES, &BUILTIN.iter().map(named).collect::<Vec<_>>(), 60);
}

#[test]
fn our_trees_are_right_where_surfaces_coincide() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("scenes/coincident");
    let files = fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path());
    let meshes: Vec<_> = files.map(|file| Scene::read(&file, None).unwrap()).map(|s| (s.name, s.mesh)).collect();
    assert_eq!(meshes.len(), 6);
    are_right(&TREES, &meshes, 12);
}

/// Checks only counts and shapes, because obvhs has wrong hits.
#[test]
#[ignore = "a minute"]
fn everything_offered_counts_and_has_a_possible_shape() {
    let (registry, meshes) = (Registry::builtin(), degenerate_meshes());
    let presets = ["fastest", "very-fast", "fast", "medium", "slow", "very-slow"];
    let presets = presets.iter().flat_map(|p| ["obvhs-bvh2", "obvhs-cwbvh"].map(|s| format!("{s}:preset={p}")));
    let choices = registry.all().into_iter().chain(presets.map(|spec| registry.choose(&spec).unwrap()));
    let whole = |choice: &Choice| choice.entry.conventions.is_empty() && choice.entry.capabilities == Capabilities::ALL;
    for choice in choices.filter(whole) {
        let subject = subject(&choice, false);
        passes(counting(&subject, &meshes, 10));
        passes(shapes(&subject, &meshes));
    }
}

#[test]
fn counting_and_loading_change_no_hit_of_any_structure() {
    let registry = Registry::builtin();
    let others = ["sah-kd-tight:batch=packets", "embree:packet=16", "embree-robust:packet=16,rays=coherent"];
    let others = others.iter().filter_map(|spec| registry.choose(spec).ok());
    let mut meshes = degenerate_meshes();
    meshes.retain(|(name, _)| name == "box of a grid" || name == "only without area");
    assert_eq!(meshes.len(), 2);
    for choice in registry.all().into_iter().chain(others).filter(|choice| choice.entry.absence().is_none()) {
        passes(counting(&subject(&choice, false), &meshes, 37));
    }
}
