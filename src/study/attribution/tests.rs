//! From journals whose truth is known to the answer.

use super::design::{CELLS, Factor, Treatment};
use super::*;
use crate::measure::RandomOrder;
use crate::study::epoch::tests;
use crate::study::epoch::{Epoch, RayCounts, Shape};

/// How many times faster each factor makes the tree, and what the plane gives more once the stop rule is the SAH's.
const STOP: f64 = 8.0;
const PLANE: f64 = 1.5;
const TRAVERSAL: f64 = 1.25;
const TOGETHER: f64 = 2.0;

fn factor(cell: Treatment) -> f64 {
    let Treatment([plane, stop, traversal]) = cell;
    let mut times = 1.0;
    times *= if plane == 5 { PLANE } else { 1.0 };
    times *= if stop == 2 { STOP } else { 1.0 };
    times *= if traversal == 1 { TRAVERSAL } else { 1.0 };
    times * if plane == 5 && stop == 2 { TOGETHER } else { 1.0 }
}

/// A scene of `epochs` epochs; times vary by up to `noise` with the epoch, and whole rounds by a third.
pub fn cases(epochs: usize, noise: f64) -> Vec<Epoch> {
    let mut random = RandomOrder::new(3);
    let cells: Vec<Treatment> = Treatment::all().into_iter().chain([Treatment::REPORT, Treatment::SAH]).collect();
    let mut uniform = move || random.below(1 << 20) as f64 / f64::from(1 << 20);
    let mut of = |number: usize| {
        let slow: Vec<f64> = (0..3).map(|_| 1.0 + uniform() / 3.0).collect();
        let labels: Vec<String> = cells.iter().map(|cell| cell.spec("exact")).collect();
        let structures: Vec<(&str, u64, &[u64])> = labels.iter().map(|label| (&label[..], 1000, &[][..])).collect();
        let mut epoch = Epoch { stand_in: true, ..tests::example("Dragon", 100, number, &structures) };
        for (tree, &cell) in epoch.structures.iter_mut().zip(&cells) {
            let placed = 1.0 + noise * (uniform() - 0.5);
            tree.shape = Shape { references: 300, sah_cost: Some(20.0 / factor(cell)), ..tree.shape.clone() };
            let rays = &mut tree.rays[0];
            rays.ns = slow.iter().map(|slow| (4e8 / factor(cell) * placed * slow) as u64).collect();
            let tests = Some((24_000_000.0 / factor(cell)) as u64);
            let counts = rays.counts.filter(|_| number == 0);
            rays.counts = counts.map(|counts| RayCounts { tests, steps: Some(5000), ..counts });
        }
        epoch
    };
    (0..epochs).map(&mut of).collect()
}

fn one(cases: &[Epoch]) -> Attribution {
    let mut results = result(cases);
    assert_eq!(results.len(), 1);
    results.remove(0)
}

/// The result of a scene without noise.
pub(in crate::study) fn example() -> Attribution {
    one(&cases(3, 0.0))
}

#[test]
fn the_split_is_the_one_put_in_and_multiplies_to_the_whole() {
    for epochs in [2, 5] {
        let result = one(&cases(epochs, 0.02));
        let whole = STOP * PLANE * TRAVERSAL * TOGETHER;
        assert!(result.time.whole.holds(whole), "{:?}", result.time.whole);
        let half = libm::sqrt(TOGETHER);
        for (part, truth) in result.time.parts.iter().zip([PLANE * half, STOP * half, TRAVERSAL]) {
            assert!(part.times.holds(truth), "{} of {epochs} epochs: {part:?}", part.factor);
            assert!(part.least <= part.times.estimate && part.times.estimate <= part.most);
        }
        let product: f64 = result.time.parts.iter().map(|part| part.times.estimate).product();
        assert!((product / result.time.whole.estimate - 1.0).abs() < 1e-12);
    }
}

#[test]
fn without_noise_every_figure_is_exact() {
    let result = one(&cases(3, 0.0));
    let close = |a: f64, b: f64| assert!((a / b - 1.0).abs() < 1e-5, "{a} {b}");
    close(result.time.whole.estimate, 30.0);
    close(result.tests.whole.estimate, 30.0);
    close(result.steps.whole.estimate, 1.0);
    let stop = &result.time.parts[Factor::Stop as usize];
    close(stop.least, STOP);
    close(stop.most, STOP * TOGETHER);
    close(result.plane_alone.estimate, PLANE);
    close(result.cells[CELLS - 1].speedup.estimate, 30.0);
    close(result.cells[0].tests_per_ray, 24_000.0);
    close(result.cells[0].duplication, 3.0);
    assert!(result.aa_noise < 1.0 + 1e-5);
    let shares: f64 = result.terms.iter().map(|term| term.time.estimate).sum();
    close(shares, 1.0);
    // No factor but plane and stop rule work together.
    close(1.0 + result.terms[5].time.estimate, 1.0);
    assert!(result.terms[3].time.estimate > 1e-3);
}

#[test]
fn intervals_are_as_wide_as_the_noise() {
    let width = |noise: f64| {
        let whole = one(&cases(5, noise)).time.whole;
        whole.high().unwrap() / whole.low().unwrap()
    };
    assert!(width(0.1) > width(0.01) && width(0.01) > 1.0 && width(0.1) < 1.4, "{} {}", width(0.1), width(0.01));
}

#[test]
fn the_sentence_names_the_parts_and_the_stand_in() {
    let result = one(&cases(3, 0.0));
    let table = headlines(std::slice::from_ref(&result));
    let sentence = table.notes.last().unwrap();
    let parts = ["30.0-fold speedup on Dragon (stand-in)", "stop rule gives 11.3", "plane 2.12", "traversal 1.25"];
    assert!(parts.iter().all(|part| sentence.contains(part)), "{sentence}");
    assert!(sentence.contains("8.00 to 16.0"), "{sentence}");
    let tables = tables(&result);
    assert!(tables.iter().all(|table| table.rows.iter().all(|row| row.len() == table.columns.len())));
    assert_eq!(tables[0].rows.len(), CELLS);
    assert_eq!(rows(&[result]).len(), CELLS);
}

#[test]
fn real_meshes_and_stand_ins_are_apart_and_a_scene_without_its_first_epoch_is_left_out() {
    let mut both = cases(2, 0.0);
    let real = |epoch: &Epoch| Epoch { stand_in: false, scene_hash: "22".into(), ..epoch.clone() };
    both.extend(cases(2, 0.0).iter().map(real));
    let names: Vec<String> = result(&both).into_iter().map(|result| result.scene).collect();
    assert_eq!(names, ["Dragon (stand-in)", "Dragon"]);
    assert!(result(&both[1..2]).is_empty() && result(&[]).is_empty());
}
