//! Epochs of a scene, measured each by itself, as one measurement: a pure function of what was measured.
//!
//! Epoch 0 alone is held against brute force and counted: what it found holds for all of them, and without it there is
//! no answer. What epochs have in common says that they are of one measurement: the rays, how many of them are timed
//! and how often, and the answers to them.

use super::{Epoch, Rays, Structure};
use crate::registry::RUNNER;
use crate::report::words::listed;
use crate::study::StudyError;
use crate::study::error::ANSWERS;

/// Cases that answers can be made from, and why others are none of them.
#[derive(Debug)]
pub struct Joined<C> {
    /// In the order in which they were given.
    pub cases: Vec<C>,
    /// What ends a scene: its cases are left out.
    pub failures: Vec<StudyError>,
    /// Scenes that are not checked, a sentence each: their cases are left out.
    pub unchecked: Vec<String>,
}

/// Joins the epochs of each scene. `epoch` gives the epoch that a case is, and the number of its series where a scene
/// has several; cases that are none are as they were. With `whole` a scene is left out in which a structure lacks a
/// time.
pub fn join<C: Clone>(mut cases: Vec<C>, epoch: fn(&mut C) -> Option<(&mut Epoch, usize)>, whole: bool) -> Joined<C> {
    let mut joined = Joined { cases: vec![], failures: vec![], unchecked: vec![] };
    let mut out = vec![];
    for mut places in series(&mut cases, epoch) {
        let number = |cases: &mut [C], place: usize| epoch(&mut cases[place]).expect("it is one").0.epoch;
        places.sort_by_cached_key(|&place| number(&mut cases, place));
        let mut own: Vec<Epoch> =
            places.iter().map(|&place| epoch(&mut cases[place]).expect("it is one").0.clone()).collect();
        if own[0].epoch != 0 {
            let lacks = lacks(&own[0], &[0]);
            joined.unchecked.push(format!("{lacks}; epoch 0 checks the answers, so the scene is left out."));
            out.extend(places);
            continue;
        }
        let agree = |own: &[Epoch]| own.iter().try_for_each(if whole { Epoch::is_whole } else { Epoch::is_unanimous });
        let found = one(&mut own).and_then(|()| agree(&own));
        if let Err(error) = found {
            joined.failures.push(error);
            out.extend(places);
            continue;
        }
        for (place, own) in places.into_iter().zip(own) {
            *epoch(&mut cases[place]).expect("it is one").0 = own;
        }
    }
    let kept = cases.into_iter().enumerate().filter(|(place, _)| !out.contains(place));
    joined.cases = kept.map(|(_, case)| case).collect();
    joined
}

/// The epochs that are planned and not there, of scenes that are checked, a sentence each. `planned` is told the most
/// epochs that a scene has, and the triangles of the scene that it is asked about.
pub fn missing<C>(
    cases: &mut [C],
    epoch: fn(&mut C) -> Option<(&mut Epoch, usize)>,
    planned: impl Fn(usize, usize) -> usize,
) -> Vec<String> {
    let series = series(cases, epoch);
    let mut number = |&place: &usize| epoch(&mut cases[place]).expect("it is one").0.epoch;
    let numbers: Vec<Vec<usize>> = series.iter().map(|places| places.iter().map(&mut number).collect()).collect();
    let most = numbers.iter().flatten().max().map_or(0, |last| last + 1);
    let mut missing = vec![];
    for (places, there) in series.iter().zip(&numbers).filter(|(_, there)| there.contains(&0)) {
        let (first, _) = epoch(&mut cases[places[0]]).expect("it is one");
        let not_there = (0..planned(most, first.triangles)).filter(|number| !there.contains(number));
        let not_there: Vec<usize> = not_there.collect();
        if !not_there.is_empty() {
            missing.push(format!("{}.", lacks(first, &not_there)));
        }
    }
    missing
}

/// The places of the cases of each series.
fn series<C>(cases: &mut [C], epoch: fn(&mut C) -> Option<(&mut Epoch, usize)>) -> Vec<Vec<usize>> {
    let mut found: Vec<((String, usize), Vec<usize>)> = vec![];
    for (place, case) in cases.iter_mut().enumerate() {
        let Some((own, number)) = epoch(case) else { continue };
        let key = (own.scene_hash.clone(), number);
        match found.iter_mut().find(|(known, _)| *known == key) {
            Some((_, places)) => places.push(place),
            None => found.push((key, vec![place])),
        }
    }
    found.into_iter().map(|(_, places)| places).collect()
}

/// `Dragon: epochs 1 and 2 are not measured`.
fn lacks(epoch: &Epoch, missing: &[usize]) -> String {
    let numbers: Vec<String> = missing.iter().map(ToString::to_string).collect();
    let (epochs, are) = if missing.len() == 1 { ("epoch", "is") } else { ("epochs", "are") };
    format!("{}: {epochs} {} {are} not measured", epoch.title(), listed(&numbers))
}

/// Makes the epochs of a scene, the first of which is epoch 0, one measurement.
fn one(epochs: &mut [Epoch]) -> Result<(), StudyError> {
    let (title, structures) = (epochs[0].title(), epochs[0].structures.len());
    for place in 0..structures {
        let label = epochs[0].structures[place].label.clone();
        let apart = |epoch: &Epoch, rays: &str, what: &'static str| StudyError::Apart {
            structure: label.clone(),
            scene: title.clone(),
            rays: rays.into(),
            epoch: epoch.epoch,
            what,
        };
        if let Some(other) = epochs.iter().find(|e| e.structures.get(place).is_none_or(|own| own.label != label)) {
            return Err(apart(other, "", "the structures"));
        }
        // What takes no part in one of them takes part in none.
        let refused = epochs.iter().find_map(|epoch| epoch.structures[place].refused.clone());
        if let Some(reason) = refused {
            refuse(epochs, place, &reason);
            continue;
        }
        for kind in 0..epochs[0].structures[place].rays.len() {
            let first = epochs[0].structures[place].rays[kind].clone();
            let alike = |epoch: &&Epoch| {
                let own = epoch.structures[place].rays.get(kind);
                own.is_some_and(|own| own.hash == first.hash && own.workload == first.workload && own.all == first.all)
            };
            if let Some(other) = epochs.iter().find(|epoch| !alike(epoch)) {
                return Err(apart(other, &first.workload, "the rays"));
            }
            if first.untimed.is_some() {
                let (untimed, wrong) = (first.untimed, first.wrong);
                for rays in epochs.iter_mut().skip(1).map(|epoch| &mut epoch.structures[place].rays[kind]) {
                    *rays = Rays {
                        ns: vec![],
                        parts: vec![],
                        rays: 0,
                        checksum: 0,
                        untimed: untimed.clone(),
                        wrong,
                        ..rays.clone()
                    };
                }
                continue;
            }
            let of = |epoch: &Epoch| epoch.structures[place].rays[kind].clone();
            let structure = &epochs[0].structures[place];
            let (is_program, may_err) = (structure.name == RUNNER, structure.may_err());
            let other = epochs.iter().find(|epoch| of(epoch).checksum != first.checksum);
            match (other, may_err) {
                (Some(_), true) => {
                    refuse(epochs, place, CHANGED);
                    break;
                }
                (Some(other), false) => return Err(apart(other, &first.workload, ANSWERS)),
                (None, _) => {}
            }
            if let Some(other) = epochs.iter().find(|epoch| of(epoch).ns.len() != first.ns.len()) {
                return Err(apart(other, &first.workload, "the number of samples"));
            }
            let Some(other) = epochs.iter().find(|epoch| of(epoch).rays != first.rays) else { continue };
            if !is_program {
                return Err(apart(other, &first.workload, "the number of rays that are timed"));
            }
            if !reduce(epochs, place, kind) {
                refuse(epochs, place, UNSTEADY);
                break;
            }
        }
    }
    keep_common_parts(epochs);
    Ok(())
}

/// Said of a structure of others that answers otherwise once it is built again, as packets do in which other rays
/// travel together.
const CHANGED: &str = "built again, it gives other answers than before: its times cannot be compared";

/// Said of a program whose epochs have no rays in common.
const UNSTEADY: &str =
    "by its own clock it is more than sixteen times as slow in one epoch as in another: they have no rays in common";

/// It takes no part, for wrong answers if that is so in one of the epochs.
fn refuse(epochs: &mut [Epoch], place: usize, reason: &str) {
    let wrong = epochs.iter().any(|epoch| epoch.structures[place].wrong);
    for structure in epochs.iter_mut().map(|epoch| &mut epoch.structures[place]) {
        *structure = Structure { refused: Some(reason.into()), wrong, rays: vec![], ..structure.clone() };
    }
}

/// Leaves of the samples of a program the largest part that all epochs have. Whether there is one.
fn reduce(epochs: &mut [Epoch], place: usize, kind: usize) -> bool {
    let timed = |rays: &Rays, count: usize| rays.rays == count || rays.parts.iter().any(|part| part.rays == count);
    let of = |epoch: &Epoch| epoch.structures[place].rays[kind].clone();
    let first = of(&epochs[0]);
    let counts = std::iter::once(first.rays).chain(first.parts.iter().map(|part| part.rays));
    let Some(common) = counts.into_iter().find(|&count| epochs.iter().all(|epoch| timed(&of(epoch), count))) else {
        return false;
    };
    for rays in epochs.iter_mut().map(|epoch| &mut epoch.structures[place].rays[kind]) {
        if let Some(part) = rays.parts.iter().find(|part| part.rays == common) {
            (rays.ns, rays.rays) = (part.ns.clone(), common);
        }
        rays.parts.retain(|part| part.rays < common);
    }
    true
}

/// Leaves of each structure the parts that all epochs have.
fn keep_common_parts(epochs: &mut [Epoch]) {
    for place in 0..epochs[0].structures.len() {
        for kind in 0..epochs[0].structures[place].rays.len() {
            let parts = |epoch: &Epoch| -> Vec<usize> {
                epoch.structures[place].rays[kind].parts.iter().map(|part| part.rays).collect()
            };
            let all: Vec<Vec<usize>> = epochs.iter().map(parts).collect();
            for rays in epochs.iter_mut().map(|epoch| &mut epoch.structures[place].rays[kind]) {
                rays.parts.retain(|part| all.iter().all(|own| own.contains(&part.rays)));
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::super::tests::{example, rays};
    use super::super::{CaseCounts, StructureDetails};
    use super::*;
    use crate::measure::Part;

    fn epochs(scene: &str, numbers: &[usize]) -> Vec<Epoch> {
        numbers.iter().map(|&n| example(scene, 10, n, &[("x", 50, &[1000; 3]), ("y", 10, &[500; 3])])).collect()
    }

    fn joined(epochs: Vec<Epoch>) -> Joined<Epoch> {
        join(epochs, |epoch| Some((epoch, 0)), false)
    }

    /// Why two epochs of which the second is changed so are not joined.
    fn failure(change: impl Fn(&mut Epoch)) -> StudyError {
        let mut epochs = epochs("a", &[0, 1]);
        change(&mut epochs[1]);
        let Joined { cases, mut failures, .. } = joined(epochs);
        assert!(cases.is_empty() && failures.len() == 1, "{failures:?}");
        failures.remove(0)
    }

    #[test]
    fn epochs_need_no_order_and_come_out_as_they_came_in() {
        let given = [epochs("a", &[2, 0]), epochs("b", &[1, 0, 2]), epochs("a", &[1])].concat();
        let Joined { cases, failures, unchecked } = joined(given.clone());
        assert_eq!(cases, given);
        assert!(failures.is_empty() && unchecked.is_empty());
    }

    #[test]
    fn a_scene_without_its_first_epoch_is_left_out_and_one_without_another_is_named() {
        let mut given = [epochs("a", &[1, 2]), epochs("b", &[0, 2]), epochs("c", &[0, 1, 2])].concat();
        let missing = missing(&mut given, |epoch| Some((epoch, 0)), |most, _| most);
        let Joined { cases, unchecked, .. } = joined(given);
        assert!(cases.len() == 5 && cases.iter().all(|epoch| epoch.scene != "a"));
        assert_eq!(unchecked, ["a: epoch 0 is not measured; epoch 0 checks the answers, so the scene is left out."]);
        assert_eq!(missing, ["b: epoch 1 is not measured."]);
    }

    #[test]
    fn what_the_first_epoch_found_wrong_has_no_time_anywhere() {
        let mut given = epochs("a", &[1, 0]);
        let wrong = &mut given[1].structures[0].rays[0];
        (wrong.untimed, wrong.wrong, wrong.ns) = (Some("3 wrong answers to 9 rays".into()), true, vec![]);
        let Joined { cases, .. } = joined(given.clone());
        let one = &cases[0].structures[0].rays[0];
        assert!(one.ns.is_empty() && one.wrong && one.untimed.as_deref() == Some("3 wrong answers to 9 rays"));
        assert_eq!(cases[0].structures[1], given[0].structures[1]);
        // A study that compares all or nothing leaves the scene out.
        let Joined { cases, failures, .. } = join(given, |epoch| Some((epoch, 0)), true);
        assert!(cases.is_empty() && failures[0].is_wrong_answer(), "{failures:?}");
    }

    #[test]
    fn structures_over_the_exact_test_that_answer_otherwise_are_a_wrong_answer() {
        let with = |tests: [&str; 2], change: &dyn Fn(&mut Structure)| {
            let mut given = epochs("a", &[0, 1]);
            for (structure, test) in given[0].structures.iter_mut().zip(tests) {
                structure.details = Some(StructureDetails {
                    config: true.into(),
                    triangle_test: test.into(),
                    build_peak_bytes: None,
                    counts: CaseCounts::default(),
                });
            }
            let other = &mut given[0].structures[1];
            other.rays[0].counts.as_mut().unwrap().distances = 10;
            change(other);
            joined(given).failures
        };
        let failures = with(["exact", "exact"], &|_| ());
        let sentence = failures[0].to_string();
        assert!(
            failures[0].is_wrong_answer() && sentence.starts_with("x and y, over the same triangle test"),
            "{sentence}"
        );
        assert!(with(["exact", "moller-trumbore"], &|_| ()).is_empty());
        assert!(with(["moller-trumbore"; 2], &|_| ()).is_empty(), "it rounds");
        let known = |structure: &mut Structure| structure.name = "obvhs-bvh2".into();
        assert!(with(["exact", "exact"], &known).is_empty(), "it is known to err");
        let untimed = |structure: &mut Structure| structure.rays[0].untimed = Some("3 wrong answers to 9 rays".into());
        assert!(with(["exact", "exact"], &untimed).is_empty(), "it has been told already");
        let fewer = |structure: &mut Structure| structure.rays[0].counts.as_mut().unwrap().rays = 10;
        assert!(with(["exact", "exact"], &fewer).is_empty(), "of other rays");
    }

    #[test]
    fn what_takes_no_part_in_one_epoch_takes_part_in_none() {
        let mut given = epochs("a", &[0, 1, 2]);
        (given[1].structures[1].refused, given[1].structures[1].wrong) = (Some("it fell over".into()), true);
        let Joined { cases, .. } = joined(given);
        assert!(cases.iter().all(|epoch| epoch.structures[1].refused.as_deref() == Some("it fell over")));
        assert!(cases.iter().all(|epoch| epoch.structures[1].wrong));
        assert!(cases.iter().all(|epoch| epoch.structures[0].refused.is_none()));
    }

    #[test]
    fn epochs_that_differ_in_what_they_must_not_are_named() {
        let answers = failure(|epoch| epoch.structures[1].rays[0].checksum = 2);
        let sentence = answers.to_string();
        assert!(sentence.contains("y on the primary rays of a") && sentence.contains("epoch 1"), "{sentence}");
        assert!(sentence.contains("the answers") && answers.is_wrong_answer(), "{sentence}");
        // What else may differ is no wrong answer, as where a structure that counts could not be built in one of them.
        for (other, what) in [
            (failure(|epoch| epoch.structures[1].rays[0].hash = "12".into()), "differ in the rays"),
            (failure(|epoch| epoch.structures[1].rays[0].rays = 250), "the number of rays that are timed"),
            (failure(|epoch| epoch.structures[1].rays[0].ns.truncate(2)), "the number of samples"),
            (failure(|epoch| epoch.structures[1].label = "z".into()), "the structures"),
        ] {
            assert!(other.to_string().contains(what) && !other.is_wrong_answer(), "{other}");
        }
    }

    #[test]
    fn a_structure_of_others_that_answers_otherwise_takes_no_part() {
        let mut given = epochs("a", &[0, 1]);
        given.iter_mut().for_each(|epoch| epoch.structures[1].name = "embree".into());
        given[1].structures[1].rays[0].checksum = 2;
        let Joined { cases, failures, .. } = joined(given);
        assert!(failures.is_empty(), "{failures:?}");
        for epoch in cases {
            let refused: Vec<Option<&str>> = epoch.structures.iter().map(|s| s.refused.as_deref()).collect();
            assert_eq!(refused, [None, Some(CHANGED)]);
        }
    }

    #[test]
    fn series_of_a_scene_are_joined_each_by_itself() {
        let mut given: Vec<(usize, Epoch)> = vec![];
        for threads in [1, 2] {
            given.extend(epochs("a", &[0, 1]).into_iter().map(|epoch| (threads, epoch)));
        }
        given.iter_mut().filter(|(threads, _)| *threads == 2).for_each(|(_, epoch)| {
            epoch.structures[0].rays[0].rays = 250;
        });
        let joined = join(given.clone(), |(threads, epoch)| Some((epoch, *threads)), false);
        assert_eq!(joined.cases, given);
    }

    #[test]
    fn a_program_whose_clock_chose_otherwise_is_timed_on_the_rays_that_all_epochs_have() {
        let program = |number: usize, counts: &[usize]| {
            let mut epoch = example("a", 10, number, &[("p", 50, &[1000]), ("y", 10, &[500])]);
            let parts = |from: usize| counts[from..].iter().map(|&rays| Part { rays, ns: vec![rays as u64] }).collect();
            let ns = vec![counts[0] as u64];
            epoch.structures[0].name = RUNNER.into();
            epoch.structures[0].rays = vec![Rays { ns, parts: parts(1), rays: counts[0], ..rays("primary") }];
            epoch.structures[1].rays[0].parts = parts(0);
            epoch
        };
        let Joined { cases, failures, .. } = joined(vec![program(0, &[400, 100]), program(1, &[100, 25])]);
        assert!(failures.is_empty());
        for epoch in &cases {
            let [one, other] = [0, 1].map(|place| &epoch.structures[place].rays[0]);
            assert_eq!((one.rays, &one.ns, one.parts.len()), (100, &vec![100], 0), "{one:?}");
            assert_eq!(other.parts.iter().map(|part| part.rays).collect::<Vec<_>>(), [100]);
        }
        let Joined { cases, .. } = joined(vec![program(0, &[400, 100]), program(1, &[25, 6])]);
        assert!(cases.iter().all(|epoch| epoch.structures[0].refused.as_deref() == Some(UNSTEADY)));
        // Another checksum is another answer, on however many rays.
        let mut other = program(1, &[400, 100]);
        other.structures[0].rays[0].checksum = 2;
        let Joined { cases, .. } = joined(vec![program(0, &[400, 100]), other]);
        assert!(cases.iter().all(|epoch| epoch.structures[0].refused.as_deref() == Some(CHANGED)));
    }
}
