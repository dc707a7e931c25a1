//! What is found again of the report.

use super::original::{CROWDED, MAIN};
use super::replication::{Main, Replication};
use crate::measure::Estimate;
use crate::report::Finding;
use crate::report::number::{count, plural};
use crate::report::words::{interval, listed, slug};
use crate::study::claims::CLAIMS;
use crate::study::kendall::Order;

/// How much faster the SAH tree is, whether the rays are the report's, and the numbers that claims are about.
pub fn findings(answer: &Replication) -> Vec<Finding> {
    let mut findings: Vec<Finding> = [hard(answer), rays(answer)].into_iter().flatten().collect();
    let number = |key: &str, scene: &str, value| Finding::number(format!("{key}-{}", slug(scene)), value);
    findings.extend(answer.hard.iter().map(|hard| number("hard", &hard.scene.name, hard.faster)));
    let own = answer.main.iter().filter(|main| main.scene.name != OWN);
    findings.extend(own.map(|main| {
        let difference = main.scene.total() as f64 - main.report.rays as f64;
        number("rays", &main.scene.name, Estimate::exact(difference))
    }));
    findings.extend(t_prime(answer).map(|factor| Finding::number("t-prime", factor)));
    findings.extend(order(answer).map(|(order, _)| Finding::number("order", order.tau)));
    let crowded = answer.main.iter().find(|main| main.scene.name == CROWDED.0);
    for (key, tests) in ["crowded", "crowded-50"].into_iter().zip(crowded.map(|main| main.tests).unwrap_or_default()) {
        findings.extend(tests.map(|tests| Finding::number(key, Estimate::exact(tests))));
    }
    findings
}

fn hard(answer: &Replication) -> Option<Finding> {
    let of = |hard: &super::replication::Hard| format!("{} {} times", hard.scene.title, interval(hard.faster));
    let scenes: Vec<String> = answer.hard.iter().map(of).collect();
    let mean = answer.faster?;
    let told = match () {
        () if mean.is_above(1.0) => "are faster with the SAH tree than with",
        () if mean.holds(1.0) => "cannot be told to be faster or slower with the SAH tree than with",
        () => "are slower with the SAH tree than with",
    };
    let sentence = format!(
        "Primary rays {told} the report's tree, by this much: {}; geometric mean {}.",
        listed(&scenes),
        interval(mean)
    );
    Some(Finding::new("hard", sentence).of(mean))
}

/// So many rays may be decided otherwise at edges.
const CLOSE: u64 = 2;

/// Its creatures must not be copied: its rays are our own.
const OWN: &str = "Starters";

fn rays(answer: &Replication) -> Option<Finding> {
    let off = |main: &&Main| main.scene.total().abs_diff(main.report.rays);
    let far = answer.main.iter().filter(|main| off(main) > CLOSE);
    let told = |main: &Main| format!("{} is {} of {} off", main.scene.name, count(off(&main)), count(main.report.rays));
    let far: Vec<String> = far.map(told).collect();
    let all = answer.main.len();
    let exceptions = if far.is_empty() { String::new() } else { format!("; {}", listed(&far)) };
    let sentence = format!(
        "The report's ray counts are found again to within {CLOSE} rays in {} of {}{exceptions}.",
        all - far.len(),
        plural(all, "scene")
    );
    (all > 0).then(|| Finding::new("rays", sentence))
}

/// The largest `t'` of brute force over the smallest, of all scenes.
fn t_prime(answer: &Replication) -> Option<Estimate> {
    let of = |main: &Main| main.brute_force.t_prime;
    let by_size = |one: &&Main, other: &&Main| of(one).estimate.total_cmp(&of(other).estimate);
    let (most, least) = (answer.main.iter().max_by(by_size)?, answer.main.iter().min_by(by_size)?);
    answer.has_all_main().then(|| of(most).over(of(least)))
}

/// The scenes by falling improvement, as expected; those on one line are expected alike.
const ORDER: [&[&str]; 8] = [
    &["Torus", "Sphere"],
    &["Teapot"],
    &["Metallic"],
    &["Cornellbox"],
    &["Starters"],
    &["Billards"],
    &["Infinitycandy"],
    &["Cube"],
];

/// How well the improvements have the order that was expected of them, and what surely has not: about all scenes.
pub fn order(answer: &Replication) -> Option<(Order, Option<String>)> {
    let mut expected: Vec<(&Main, usize)> = vec![];
    for (rank, names) in ORDER.iter().enumerate() {
        expected.extend(
            names.iter().filter_map(|name| Some((answer.main.iter().find(|main| main.scene.name == *name)?, rank))),
        );
    }
    let ranked: Vec<(Estimate, usize)> = expected.iter().map(|(main, rank)| (main.improvement, *rank)).collect();
    let order = Order::of(&ranked, CLAIMS);
    let name = |place: usize| &expected[place].0.scene.name;
    let reversed = order.reversed.iter().map(|&[more, less]| format!("{} gains less than {}", name(more), name(less)));
    let reversed: Vec<String> = reversed.collect();
    let told = (!reversed.is_empty()).then(|| format!("Surely not in the order expected: {}.", listed(&reversed)));
    (expected.len() == MAIN.len()).then_some((order, told))
}
