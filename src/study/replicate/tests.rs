//! Tables from epochs whose truth is known.

use super::original::SWEEP;
use super::*;
use crate::accel::Query;
use crate::study::epoch::Rays as Timed;
use crate::study::epoch::tests::{example, rays};

/// Three epochs of a scene whose structures take these nanoseconds for each of 1000 rays, in rounds of which one is slow.
fn epochs(scene: &str, stand_in: bool, times: &[u64]) -> Vec<Epoch> {
    let one = |number: usize| {
        let ns: Vec<Vec<u64>> = times.iter().map(|t| [1000, 1300, 1000].map(|round| round * t).into()).collect();
        let labels: Vec<String> = (0..times.len()).map(|i| format!("tree {i}")).collect();
        let structures: Vec<(&str, u64, &[u64])> =
            labels.iter().zip(&ns).map(|(label, ns)| (label.as_str(), 2_000_000_000, &ns[..])).collect();
        let mut epoch = example(scene, 100, number, &structures);
        for (structure, ns) in epoch.structures.iter_mut().zip(&ns) {
            let shadow = Timed { query: Query::Any, all: 500, ns: ns.clone(), ..rays("image-shadow") };
            structure.rays.push(shadow);
        }
        Epoch { stand_in, ..epoch }
    };
    (0..3).map(one).collect()
}

fn add(result: &mut Replication, add: fn(&mut Replication, &[&Epoch]), epochs: &[Epoch]) {
    add(result, &epochs.iter().collect::<Vec<_>>());
}

#[test]
fn the_conclusion_is_the_mean_of_the_hard_scenes() {
    let mut result = Replication::default();
    add(&mut result, Replication::add_hard, &epochs("Dragon", true, &[800, 100, 800]));
    add(&mut result, Replication::add_hard, &epochs("Lucy", false, &[200, 100, 200]));
    let whole = result.conclusion.sah_over_median.unwrap();
    assert!((whole.estimate - 4.0).abs() < 1e-9 && (result.hard[0].sah_over_median.estimate - 8.0).abs() < 1e-9);
    assert_eq!((result.conclusion.scenes.len(), result.stand_ins.join(" ")), (2, "Dragon".into()));
    // 1000 and 500 rays at 0.8 microseconds.
    let tree = &result.hard[0].tree;
    assert!((tree.seconds - 1.2e-3).abs() < 1e-9 && (tree.t_prime.estimate - 8e-9).abs() < 1e-15, "{tree:?}");
    assert!((result.hard[0].tree_build_s - 2.0).abs() < 1e-12);
    assert!(tables(&result).iter().all(|t| t.rows.iter().all(|row| row.len() == t.columns.len())));
}

#[test]
fn the_conclusion_is_of_the_epochs_that_all_hard_scenes_have() {
    let mut result = Replication::default();
    add(&mut result, Replication::add_hard, &epochs("Dragon", true, &[800, 100, 800])[..2]);
    add(&mut result, Replication::add_hard, &epochs("Lucy", false, &[200, 100, 200])[..1]);
    let whole = result.conclusion.sah_over_median.unwrap();
    assert!((whole.estimate - 4.0).abs() < 1e-9 && whole.interval.is_none(), "{whole:?}");
}

#[test]
fn what_is_said_of_the_hard_scenes_is_what_was_found() {
    let told = |tree: u64, sah: u64, twin: u64| {
        let mut result = Replication::default();
        add(&mut result, Replication::add_hard, &epochs("Dragon", false, &[tree, sah, twin]));
        super::statements::statements(&result).remove(0).sentence
    };
    assert!(told(800, 100, 800).starts_with("Primary rays are faster with"), "{}", told(800, 100, 800));
    assert!(told(100, 800, 100).starts_with("Primary rays are slower with"), "{}", told(100, 800, 100));
    assert!(told(101, 100, 180).contains("cannot be told"), "{}", told(101, 100, 180));
}

#[test]
fn a_tree_that_twins_cannot_tell_apart_has_a_wider_interval() {
    let ratio = |twin: u64| {
        let mut result = Replication::default();
        add(&mut result, Replication::add_hard, &epochs("Sponza", false, &[800, 100, twin]));
        let whole = result.hard[0].sah_over_median;
        whole.high().unwrap() / whole.low().unwrap()
    };
    // Both runs have the noise of one A/A ratio in three epochs: t is 4.303.
    let expected = 2.0 * 4.3027 * libm::sqrt(2.0) * libm::log(1.05);
    assert!(ratio(800) < 1.0 + 1e-9 && (libm::log(ratio(840)) / expected - 1.0).abs() < 1e-4, "{}", ratio(840));
}

#[test]
fn an_easy_scene_has_its_improvement_and_its_sweep() {
    let mut result = Replication::default();
    let mut times = vec![900, 10];
    times.extend([110, 120, 130, 140, 300, 150, 300]);
    add(&mut result, Replication::add_main, &epochs("Torus", false, &times));
    let main = &result.main[0];
    assert!((main.improvement.estimate - 3.0).abs() < 1e-9 && main.improvement.is_above(2.9));
    assert_eq!(result.parameters.len(), SWEEP.len());
    assert!((result.parameters[0].seconds / main.tree.seconds - 110.0 / 300.0).abs() < 1e-9);
    assert_eq!((result.rays[0].total, result.rays[0].shadow, result.rays[0].mirror), (1500, 500, 0));
    assert!(tables(&result).iter().all(|t| t.rows.iter().all(|row| row.len() == t.columns.len())));
}
