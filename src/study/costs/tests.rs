use super::*;
use crate::study::epoch::tests::example;

/// Scenes on which a structure of `name` takes 50 + 4 steps + 2 tests nanoseconds a ray, times `off` and its inverse in turn.
fn epochs(name: &str, off: f64) -> Vec<Epoch> {
    let places =
        [(1.0, 2.0), (10.0, 3.0), (40.0, 5.0), (5.0, 300.0), (100.0, 1000.0), (2.0, 0.5), (30.0, 90.0), (8.0, 20.0)];
    let one = |(i, (steps, tests)): (usize, (f64, f64))| {
        let factor = if i % 2 == 0 { off } else { 1.0 / off };
        let ns = ((50.0 + 4.0 * steps + 2.0 * tests) * factor * 1e3) as u64;
        let mut epoch = example(&format!("scene {i}"), 100, 0, &[(name, 1, &[ns; 3])]);
        let counts = epoch.structures[0].rays[0].counts.as_mut().unwrap();
        (counts.steps, counts.tests) = (Some((steps * 1e3) as u64), Some((tests * 1e3) as u64));
        epoch
    };
    places.into_iter().enumerate().map(one).collect()
}

#[test]
fn a_family_has_the_costs_that_its_times_are_made_of() {
    let families = result(&epochs("sah-kd", 1.0), 1);
    let names: Vec<&str> = families.iter().map(|family| family.family.as_str()).collect();
    assert_eq!(names, ["all", "binary KD-tree"]);
    for family in &families {
        for (found, expected) in [(family.ray_ns, 50.0), (family.step_ns, 4.0), (family.test_ns, 2.0)] {
            assert!((found.estimate / expected - 1.0).abs() < 1e-3, "{found:?}");
        }
        assert!((family.steps_per_test.unwrap().estimate - 2.0).abs() < 1e-3);
        assert!(family.r_squared > 0.9999 && family.worst_factor < 1.001, "{family:?}");
    }
    assert_eq!(tables(&families).len(), 2);
    assert_eq!(rows(&families).len(), 16);
}

#[test]
fn noise_is_seen_in_the_intervals_and_the_factors() {
    let families = result(&epochs("sah-bvh", 1.1), 1);
    let family = &families[1];
    assert_eq!(family.family, "eight-wide tree");
    for (found, expected) in [(family.step_ns, 4.0), (family.test_ns, 2.0)] {
        assert!(found.low < expected && expected < found.high, "{found:?}");
    }
    assert!((1.03..1.25).contains(&family.worst_factor) && family.typical_factor <= family.worst_factor, "{family:?}");
    assert!(family.r_squared < 0.9999);
}

#[test]
fn few_cases_and_unknown_counts_tell_nothing() {
    let mut few = epochs("sah-kd", 1.0);
    few.truncate(5);
    assert!(result(&few, 1).is_empty());
    assert_eq!(tables(&[]).len(), 1);
    let mut unknown = epochs("peer", 1.0);
    unknown.iter_mut().for_each(|epoch| epoch.structures[0].rays[0].counts.as_mut().unwrap().steps = None);
    assert!(result(&unknown, 1).is_empty());
}
