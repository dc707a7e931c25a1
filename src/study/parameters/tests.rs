//! From journals whose truth is known to verdicts.

use super::*;
use crate::measure::RandomOrder;
use crate::study::epoch::tests::{example, rays};
use crate::study::epoch::{Epoch, RayCounts, Rays};
use crate::study::replicate::original::SWEEP;

/// `epochs` epochs of a scene where the first setting takes `slower` times the default's time, the others the same.
fn cases(scene: &str, epochs: usize, slower: f64, noise: f64) -> Vec<Epoch> {
    let mut random = RandomOrder::new(scene.len() as u64);
    let mut uniform = move || random.below(1 << 20) as f64 / f64::from(1 << 20) - 0.5;
    let mut of = |number: usize| {
        let slow: Vec<f64> = (0..3).map(|_| 1.2 + 0.4 * uniform()).collect();
        let same = scene == "Cube";
        let labels: Vec<String> = (0..=SWEEP.len()).map(|i| i.to_string()).collect();
        let structures: Vec<(&str, u64, &[u64])> = labels.iter().map(|label| (&label[..], 10, &[][..])).collect();
        let mut epoch = example(scene, 12, number, &structures);
        for (i, tree) in epoch.structures.iter_mut().enumerate() {
            let times = if i == 0 { slower } else { 1.0 } * (1.0 + noise * uniform());
            let ns: Vec<u64> = slow.iter().map(|slow| (1e8 * times * slow) as u64).collect();
            let rays = |workload, all, tests| {
                let own = rays(workload);
                let counts = own.counts.filter(|_| number == 0);
                let counts = counts.map(|counts| RayCounts { rays: all, tests: Some(tests), ..counts });
                Rays { all, rays: 50, ns: ns.clone(), counts, ..own }
            };
            tree.rays = vec![rays("image", 100, 1000), rays("image-shadow", 50, if same { 0 } else { i as u64 })];
        }
        epoch
    };
    (0..epochs).map(&mut of).collect()
}

fn verdicts(result: &Parameters) -> Vec<Difference> {
    result.settings.iter().map(|setting| setting.verdict).collect()
}

#[test]
fn a_large_difference_is_real_and_noise_is_not() {
    let result = result(&cases("Teapot", 5, 1.3, 0.01));
    assert_eq!(verdicts(&result)[0], Difference::Slower);
    assert_eq!(verdicts(&result)[default_row()], Difference::Default);
    assert_eq!(result.settings.len(), SWEEP.len());
    assert!(verdicts(&result).iter().filter(|&&v| v == Difference::NotShown).count() == 4, "{:?}", verdicts(&result));
    let slower = result.settings[0].times.unwrap();
    assert!(slower.holds(1.3), "{slower:?}");
    assert_eq!(result.settings[0].report_s, SWEEP[0].seconds[3]);
}

#[test]
fn a_difference_within_the_aa_noise_is_not_shown() {
    // The twin of the default differs from it by more than the first setting does.
    let mut cases = cases("Teapot", 5, 1.02, 0.0);
    for epoch in &mut cases {
        let twin = epoch.structures.last_mut().unwrap();
        twin.rays.iter_mut().for_each(|rays| rays.ns.iter_mut().for_each(|ns| *ns = *ns * 104 / 100));
    }
    let result = result(&cases);
    assert!(result.aa_noise > 1.035 && verdicts(&result)[0] == Difference::NotShown, "{result:?}");
}

#[test]
fn more_looks_ask_for_more() {
    // Alone the difference is beyond chance, among all comparisons of five scenes it is not.
    let alone = result(&cases("Sphere", 5, 1.03, 0.02));
    let probability = alone.settings[0].probability.unwrap();
    assert!((0.0005..0.01).contains(&probability), "choose a difference that shows the correction: {probability}");
    let mut many = cases("Sphere", 5, 1.03, 0.02);
    for scene in ["Torus", "Teapot", "Billards", "Cornellbox", "Infinitycandy", "Metallic", "Starters"] {
        many.extend(cases(scene, 5, 1.0, 0.02));
    }
    let many = result(&many);
    assert_eq!((alone.comparisons, many.comparisons), (5, 40));
    let sphere = many.settings.iter().find(|s| s.scene == "Sphere").unwrap();
    assert_eq!(sphere.verdict, Difference::NotShown);
}

#[test]
fn the_control_is_one_tree_and_says_how_noisy_it_is() {
    let result = result(&cases("Cube", 3, 1.0, 0.02));
    assert_eq!(verdicts(&result).iter().filter(|&&v| v == Difference::SameTree).count(), 5);
    assert_eq!(result.comparisons, 0);
    let table = tables(&result).remove(0);
    assert!(table.rows.iter().all(|row| row.len() == table.columns.len()));
    // 0.543 s against 0.484 s.
    assert!(table.notes.iter().any(|note| note.contains("up to 12.2 % in the report")), "{:?}", table.notes);
}

#[test]
fn one_epoch_shows_nothing_and_no_epoch_is_empty() {
    let one = result(&cases("Teapot", 1, 1.3, 0.01));
    assert!(tables(&one)[0].notes.iter().any(|note| note.contains("One epoch")));
    let none = result(&[]);
    assert!(none.settings.is_empty() && tables(&none)[0].rows.is_empty());
}
