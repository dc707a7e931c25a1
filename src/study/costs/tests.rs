use super::result::costs;
use super::*;
use crate::measure::RandomOrder;
use crate::study::epoch::tests::example;

const PLACES: [(f64, f64); 8] =
    [(1.0, 2.0), (10.0, 3.0), (40.0, 5.0), (5.0, 300.0), (100.0, 1000.0), (2.0, 0.5), (30.0, 90.0), (8.0, 20.0)];

/// Scenes on which a structure of `name` takes 50 + 4 steps + 2 blocks nanoseconds a ray, times `off` and its inverse
/// in turn. Blocks hold from one triangle to eight.
fn epochs(name: &str, off: f64) -> Vec<Epoch> {
    let one = |(i, (steps, blocks)): (usize, (f64, f64))| {
        let factor = if i % 2 == 0 { off } else { 1.0 / off };
        case(&format!("scene {i}"), name, (50.0 + 4.0 * steps + 2.0 * blocks) * factor, steps, blocks, i % 8 + 1)
    };
    PLACES.into_iter().enumerate().map(one).collect()
}

fn case(scene: &str, name: &str, ns: f64, steps: f64, blocks: f64, held: usize) -> Epoch {
    let mut epoch = example(scene, 100, 0, &[(name, 1, &[(ns * 1e3) as u64; 3])]);
    let counts = epoch.structures[0].rays[0].counts.as_mut().unwrap();
    counts.steps = Some((steps * 1e3) as u64);
    counts.blocks = Some((blocks * 1e3) as u64);
    counts.tests = Some((blocks * 1e3) as u64 * held as u64);
    epoch
}

#[test]
fn a_family_has_the_costs_that_its_times_are_made_of_however_full_blocks_are() {
    let families = result(&epochs("sah-kd", 1.0));
    let names: Vec<&str> = families.iter().map(|family| family.family.as_str()).collect();
    assert_eq!(names, ["all", "binary KD-tree"]);
    for family in &families {
        for (found, expected) in [(family.ray_ns, 50.0), (family.step_ns, 4.0), (family.block_ns, 2.0)] {
            assert!((found.estimate / expected - 1.0).abs() < 1e-3, "{found:?}");
        }
        assert!((family.steps_per_block.unwrap().estimate - 0.5).abs() < 1e-3);
        let [known, foreseen] = [family.known, family.foreseen].map(Option::unwrap);
        assert!(family.r_squared > 0.9999 && known.worst < 1.001 && foreseen.worst < 1.01, "{family:?}");
        assert_eq!(family.scenes, 8);
    }
    assert_eq!(tables(&families).len(), 2);
    assert_eq!(CostsStudy::data(&families)[0].rows.len(), 16);
}

#[test]
fn noise_is_seen_in_the_intervals_and_more_on_a_scene_that_was_left_out() {
    let families = result(&epochs("sah-bvh", 1.1));
    let family = &families[1];
    assert_eq!(family.family, "eight-wide tree");
    assert!(family.step_ns.holds(4.0) && family.block_ns.holds(2.0), "{family:?}");
    let [known, foreseen] = [family.known, family.foreseen].map(Option::unwrap);
    assert!((1.03..1.25).contains(&known.worst) && known.median <= known.worst, "{known:?}");
    assert!(foreseen.median > known.median && foreseen.worst > known.worst, "{known:?} {foreseen:?}");
    assert!(family.r_squared < 0.9999);
}

#[test]
fn few_cases_and_unknown_counts_tell_nothing() {
    let mut few = epochs("sah-kd", 1.0);
    few.truncate(5);
    assert!(result(&few).is_empty());
    assert_eq!(tables(&[]).len(), 1);
    let mut unknown = epochs("peer", 1.0);
    unknown.iter_mut().for_each(|epoch| epoch.structures[0].rays[0].counts.as_mut().unwrap().steps = None);
    assert!(result(&unknown).is_empty());
}

#[test]
fn of_one_scene_there_is_no_interval_and_nothing_is_left_out() {
    let epochs: Vec<Epoch> = epochs("sah-kd", 1.1)
        .into_iter()
        .enumerate()
        .map(|(i, epoch)| Epoch { scene: "a".into(), stand_in: i < 4, ..epoch })
        .collect();
    // A stand-in is no other scene.
    let family = &result(&epochs)[1];
    assert_eq!((family.scenes, family.block_ns.interval, family.foreseen), (1, None, None));
    let table = &tables(std::slice::from_ref(family))[0];
    assert!(table.notes.iter().any(|note| note.starts_with("Without an interval: of one scene")), "{table:?}");
}

/// Eight scenes of four cases; each scene has a luck of a tenth that all its cases share, and each case a hundredth of
/// its own.
fn run(random: &mut RandomOrder) -> Family {
    let mut normal = || random.normal();
    let mut observations = vec![];
    for scene in 0..8 {
        let luck = 0.1 * normal();
        for &(steps_per_ray, blocks_per_ray) in &PLACES[1..5] {
            let ns = 50.0 + 4.0 * steps_per_ray + 20.0 * blocks_per_ray;
            observations.push(Observation {
                scene: format!("scene {scene}"),
                structure: "sah-bvh".into(),
                workload: "primary".into(),
                ns_per_ray: ns * libm::exp(luck + 0.01 * normal()),
                steps_per_ray,
                blocks_per_ray,
                tests_per_ray: 8.0 * blocks_per_ray,
                predicted_ns: 0.0,
                foreseen_ns: None,
            });
        }
    }
    costs("eight-wide tree", observations).unwrap()
}

#[test]
fn costs_found_on_other_scenes_lie_within_the_intervals() {
    const PAIRS: u64 = 1500;
    let mut held = [0; 2];
    for seed in 0..PAIRS {
        let mut random = RandomOrder::new(seed);
        let [first, second] = [(); 2].map(|()| run(&mut random));
        held[0] += u32::from(first.block_ns.holds(second.block_ns.estimate));
        held[1] += u32::from(first.step_ns.holds(second.step_ns.estimate));
    }
    for held in held {
        let share = f64::from(held) * 100.0 / PAIRS as f64;
        assert!((93.0..=97.0).contains(&share), "{share:.1} %");
    }
}
