//! Checks the study `attribution` on datasets with known speedups.

use super::design::{CELLS, Factor, TWINS};
use super::result::{Attribution, results};
use super::*;
use crate::measure::RandomOrder;
use crate::report::words::each_once;
use crate::request::TWIN;
use crate::study::Measured;
use crate::study::case::tests::example as case;
use crate::study::dataset::tests::dataset;
use crate::study::epoch::{Epoch, RayCounts, tests};

const STOP: f64 = 8.0;
const PLANE: f64 = 1.5;
const TRAVERSAL: f64 = 1.25;
/// The additional speedup of trees with the SAH plane and the SAH stop rule.
const TOGETHER: f64 = 2.0;

fn factor(cell: Treatment) -> f64 {
    let Treatment([plane, stop, traversal]) = cell;
    let gains =
        [(plane == 5, PLANE), (stop == 2, STOP), (traversal == 1, TRAVERSAL), (plane == 5 && stop == 2, TOGETHER)];
    gains.into_iter().filter(|(has, _)| *has).map(|(_, gain)| gain).product()
}

fn measured(scene: &str, epochs: usize, noise: f64) -> Vec<Measured> {
    let mut random = RandomOrder::new(3);
    let cells: Vec<Treatment> = Treatment::all().chain(TWINS).collect();
    let mut uniform = move || random.below(1 << 20) as f64 / f64::from(1 << 20);
    let mut of = |number: usize| {
        let slow: Vec<f64> = (0..3).map(|_| 1.0 + uniform() / 3.0).collect();
        let labels: Vec<String> = cells.iter().map(|cell| cell.spec("exact")).collect();
        let structures: Vec<(&str, u64, &[u64])> = labels.iter().map(|label| (&label[..], 1000, &[][..])).collect();
        let mut epoch = Epoch { stand_in: true, ..tests::example(scene, 100, number, &structures) };
        for (tree, &cell) in epoch.structures.iter_mut().zip(&cells) {
            let placed = 1.0 + noise * (uniform() - 0.5);
            if !tree.is_twin() {
                tree.role = cell.role();
            }
            tree.shape.sah_cost = Some(20.0 / factor(cell));
            let rays = &mut tree.rays[0];
            rays.ns = slow.iter().map(|slow| (4e8 / factor(cell) * placed * slow) as u64).collect();
            let tests = Some((24_000_000.0 / factor(cell)) as u64);
            let counts = rays.counts.filter(|_| number == 0);
            rays.counts = counts.map(|counts| RayCounts { tests, steps: Some(5000), ..counts });
        }
        let mut case = case(scene, number, &[]);
        case.scene.stand_in = true;
        Measured { case, epoch }
    };
    (0..epochs).map(&mut of).collect()
}

fn real(measured: Vec<Measured>) -> impl Iterator<Item = Measured> {
    measured.into_iter().map(|mut own| {
        own.case.scene.stand_in = false;
        own.epoch.stand_in = false;
        own
    })
}

fn report(measured: Vec<Measured>) -> Report {
    super::report(&dataset(measured), &STUDY.defaults())
}

fn of_one<T>(measured: Vec<Measured>, of: impl Fn(&Attribution) -> T) -> T {
    let dataset = dataset(measured);
    let results = results(&dataset);
    assert_eq!(results.len(), 1);
    of(&results[0])
}

#[test]
fn the_split_is_the_one_put_in_and_multiplies_to_the_whole() {
    for (epochs, noise) in [(2, 0.02), (5, 0.02), (3, 0.0)] {
        of_one(measured("Dragon", epochs, noise), |r| {
            let whole = r.whole();
            let half = libm::sqrt(TOGETHER);
            let mut product = 1.0;
            for (factor, truth) in Factor::ALL.into_iter().zip([PLANE * half, STOP * half, TRAVERSAL]) {
                let (part, [least, most]) = (r.part(factor), r.range(factor));
                assert!(noise == 0.0 || part.holds(truth), "{} of {epochs} epochs: {part:?}", factor.name());
                assert!(least <= part.estimate && part.estimate <= most);
                product *= part.estimate;
            }
            assert!((product / whole.estimate - 1.0).abs() < 1e-12);
            if noise > 0.0 {
                return assert!(whole.holds(STOP * PLANE * TRAVERSAL * TOGETHER), "{whole:?}");
            }
            let [least, most] = r.range(Factor::Stop);
            for (found, truth) in [
                (whole.estimate, 30.0),
                (least, STOP),
                (most, STOP * TOGETHER),
                (r.plane_alone().estimate, PLANE),
                (r.first().counts.tests_per_ray().unwrap(), 24_000.0),
                (libm::exp(r.noise.log().unwrap()), 1.0),
            ] {
                assert!((found / truth - 1.0).abs() < 1e-5, "{found} {truth}");
            }
        });
    }
}

#[test]
fn the_sentences_name_the_parts_and_the_stand_in() {
    let own = report(measured("Dragon", 3, 0.0));
    let sentence = |key| &own.finding(key).unwrap().sentence;
    let split = "Dragon (stand-in): the speedup of 30.0 is the product of split plane 2.12, stop rule 11.3 and traversal \
                 1.25; in the six orders in which the three can be exchanged, their gains are 1.50 to 3.00, 8.00 to \
                 16.0 and 1.25 to 1.25.";
    assert_eq!(sentence("split-dragon"), split);
    let parts = "On Dragon (stand-in) most of the speedup is due to the stop rule. The factors: split plane 2.12 \
                 [2.12, 2.12]; stop rule 11.3 [11.3, 11.3]; traversal 1.25 [1.25, 1.25].";
    assert_eq!(sentence("parts"), parts);
    assert_eq!((own.data.rows.len(), own.tables().count()), (CELLS, 1));
    assert!(own.finding("gain-dragon").is_none() && report(vec![]).blocks.is_empty());
}

#[test]
fn claims_are_judged_by_real_meshes_where_they_are_there() {
    let mut all = measured("Dragon", 3, 0.0);
    all.extend(measured("Sponza", 3, 0.0));
    let value = |report: &Report, key: &str| report.finding(key).and_then(|finding| finding.value);
    let stand_ins = report(all.clone());
    assert!(value(&stand_ins, "gain-dragon").unwrap().holds(1.0) && value(&stand_ins, "gain-lucy").is_none());
    assert_eq!(value(&stand_ins, "tau").unwrap().estimate, 1.0);
    let outcomes: Vec<_> = stand_ins.verdicts.iter().map(|verdict| verdict.outcome.name()).collect();
    assert_eq!(outcomes[..4], ["confirmed", "confirmed", "not measured", "not measured"]);
    // The real mesh of one scene is not compared with the stand-in of another scene.
    all.extend(real(measured("Dragon", 3, 0.0)));
    let both = report(all.clone());
    let headlines = both.tables().next().unwrap();
    let scenes: Vec<String> = headlines.rows.iter().map(|row| row[0].text()).collect();
    assert_eq!(scenes, ["Dragon (stand-in)", "Dragon", "Sponza (stand-in)"]);
    assert!(both.finding("split-dragon").unwrap().sentence.starts_with("Dragon: "));
    assert_eq!(value(&both, "gain-dragon").unwrap().estimate, value(&stand_ins, "gain-dragon").unwrap().estimate);
    all[0].epoch.structures[1].role = "of another design".into();
    assert!(results(&dataset(all[..1].to_vec())).is_empty());
}

#[test]
fn a_plan_has_a_role_for_every_cell_and_a_twin_of_both_ends() {
    let words = ["torus", "--epochs", "2", "--test", "moller-trumbore"].map(String::from);
    let plan = (STUDY.plan)(&STUDY.matches(&words).unwrap(), &Registry::builtin()).unwrap();
    let case = &plan.cases[0];
    assert!(plan.cases.len() == 2 && case.settings.whole && case.structures.len() == CELLS + 2);
    let roles: Vec<&str> = case.structures.iter().map(|structure| structure.role.as_str()).collect();
    assert_eq!([roles[CELLS - 1], roles[CELLS], roles[CELLS + 1]], ["SAH exact / SAH / plane intervals", TWIN, TWIN]);
    assert!(case.structures.iter().all(|structure| structure.spec.contains("moller-trumbore")));
    let specs = each_once(case.structures.iter().map(|structure| &structure.spec));
    assert_eq!(specs.len(), CELLS, "every cell is another tree");
    let words = ["--test", "nonsense"].map(String::from);
    assert!((STUDY.plan)(&STUDY.matches(&words).unwrap(), &Registry::builtin()).is_err());
}
