//! Every structure that the registry offers, held to the contract on every mesh of the suite and every kind of ray.

use std::time::Instant;
use std::collections::BTreeMap;
use sahara::registry::{Choice, Registry};
use sahara::structures::{BruteForce, KdConfig, KdTree};
use sahara::triangle::MollerTrumbore;
use sahara::validate::conformance::{Subject, answers, counting, findings, shapes};
use sahara::validate::degenerate_meshes;

sahara::conformance!(brute_force, BruteForce<MollerTrumbore>, Default::default(), lowest_id);
sahara::conformance!(median_kd, KdTree<MollerTrumbore>, KdConfig::REPORT, lowest_id);
sahara::conformance!(sah_kd, KdTree<MollerTrumbore>, KdConfig::SAH, lowest_id);

/// Configurations that differ in what they build or how they walk.
const OURS: [&str; 20] = [
    "brute-force",
    "brute-force:test=rt-triangle",
    "median-kd",
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
    "sah-kd",
    "sah-kd:traversal=child-boxes",
    "sah-kd:mailbox=true",
    "sah-kd:empty_bonus=0",
    "sah-kd:intersection_cost=50",
    "sah-kd:intersection_cost=50,duplication=1",
    "sah-kd:plane=vertex-median",
];

fn subject<'a>(choice: &'a Choice, lowest_id: bool) -> Subject<'a> {
    Subject {
        name: format!("{} over {}", choice.label, choice.triangle_test()),
        triangle_test: choice.triangle_test(),
        lowest_id,
        build: Box::new(|mesh| choice.build(mesh)),
    }
}

#[test]
fn every_configuration_of_ours_is_right() {
    let registry = Registry::builtin();
    for spec in OURS {
        let s = Instant::now();
        let choice = registry.choose(spec).unwrap();
        let subject = subject(&choice, true);
        if let Err(e) = answers(&subject, &degenerate_meshes(), 200) { println!("ANS {e}"); }
        if let Err(e) = counting(&subject, &degenerate_meshes(), 20) { println!("COUNT {e}"); }
        if let Err(e) = shapes(&subject, &degenerate_meshes()) { println!("SHAPE {e}"); }
        println!("{spec} {:?}", s.elapsed());
    }
}
#[test]
fn obvhs() {
    let registry = Registry::builtin();
    for name in ["obvhs-bvh2", "obvhs-cwbvh"] {
    for preset in ["fastest","very-fast","fast","medium","slow","very-slow"] {
        let s = Instant::now();
        let choice = registry.choose(&format!("{name}:preset={preset}")).unwrap();
        let subject = subject(&choice, false);
        let mut by: BTreeMap<&str, u64> = Default::default();
        for f in findings(&subject, &degenerate_meshes(), 50).unwrap() { 
            *by.entry(f.stratum.name()).or_default() += f.validation.errors();
        }
        println!("{by:?}");
        if let Err(e) = counting(&subject, &degenerate_meshes(), 20) { println!("COUNT {e}"); }
        if let Err(e) = shapes(&subject, &degenerate_meshes()) { println!("SHAPE {e}"); }
        println!("{name} {preset} {:?}", s.elapsed());
    }}
}
