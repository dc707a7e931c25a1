//! Findings about the reproduction of the source report (a student report).

use super::original::{CROWDED, DEFAULT, MAIN};
use super::replication::{BRUTE, Replicated, mean};
use crate::measure::Estimate;
use crate::report::Finding;
use crate::report::number::{count, plural};
use crate::report::words::{interval, listed, slug};
use crate::study::claims::CLAIMS;
use crate::study::kendall::Order;

pub fn findings(main: &[Replicated], hard: &[Replicated]) -> Vec<Finding> {
    let mut findings: Vec<Finding> = [faster(hard), rays(main)].into_iter().flatten().collect();
    let number =
        |key: &str, own: &Replicated, value| Finding::number(format!("{key}-{}", slug(own.report.scene)), value);
    findings.extend(hard.iter().map(|own| number("hard", own, own.faster())));
    let difference = |own: &Replicated| Estimate::exact(own.total() as f64 - own.report.rays as f64);
    // The creatures in the report's scene Starters must not be copied. Our scene contains our own creatures, so the ray
    // counts differ from the report.
    let theirs = main.iter().filter(|own| own.report.scene != "Starters");
    findings.extend(theirs.map(|own| number("rays", own, difference(own))));
    findings.extend(t_prime(main).map(|factor| Finding::number("t-prime", factor)));
    findings.extend(order(main));
    let crowded = main.iter().find(|own| own.report.scene == CROWDED.0);
    for (key, setting) in [("crowded", DEFAULT), ("crowded-50", CROWDED.1)] {
        let tests = crowded.and_then(|own| own.tests(&setting.role()));
        findings.extend(tests.map(|tests| Finding::number(key, Estimate::exact(tests))));
    }
    findings
}

fn faster(hard: &[Replicated]) -> Option<Finding> {
    let on_scene = |own: &Replicated| format!("{} on {}", interval(own.faster()), own.first().title());
    let scenes = listed(&hard.iter().map(on_scene).collect::<Vec<_>>());
    let mean = mean(hard)?;
    let comparison = match () {
        () if mean.is_above(1.0) => "faster than",
        () if mean.holds(1.0) => "at a speed that is not distinguishable from the speed of",
        () => "more slowly than",
    };
    let times = interval(mean);
    let sentence = format!(
        "The SAH tree traces primary rays {comparison} the report's tree: speedup {scenes}; geometric mean {times}."
    );
    Some(Finding::new("hard", sentence).with_value(mean))
}

/// The tolerance of ray counts, in rays. A few hits at triangle edges may differ.
const CLOSE: u64 = 2;

fn rays(main: &[Replicated]) -> Option<Finding> {
    let off = |own: &Replicated| own.total().abs_diff(own.report.rays);
    let phrase = |own: &Replicated| {
        format!("{} is off by {} of {}", own.first().title(), count(off(own)), count(own.report.rays))
    };
    let far: Vec<String> = main.iter().filter(|own| off(own) > CLOSE).map(phrase).collect();
    let exceptions = if far.is_empty() { String::new() } else { format!("; {}", listed(&far)) };
    let (close, all) = (main.len() - far.len(), plural(main.len(), "scene"));
    let sentence = format!(
        "Outside the hard scenes, our ray counts match the report's within {CLOSE} rays in {close} of {all}{exceptions}."
    );
    (!main.is_empty()).then(|| Finding::new("rays", sentence))
}

/// The ratio of the largest to the smallest `t'` of brute force on the scenes of [`MAIN`]. `t'` is seconds / (rays x
/// triangles).
fn t_prime(main: &[Replicated]) -> Option<Estimate> {
    let all: Vec<Estimate> = main.iter().filter_map(|own| own.t_prime(BRUTE)).collect();
    let by_size = |one: &&Estimate, other: &&Estimate| one.estimate.total_cmp(&other.estimate);
    let (most, least) = (all.iter().max_by(by_size)?, all.iter().min_by(by_size)?);
    (all.len() == MAIN.len()).then(|| most.over(*least))
}

/// The scenes by expected improvement, from largest to smallest. Torus and Sphere have the same rank.
const ORDER: &str = "Torus Sphere Teapot Metallic Cornellbox Starters Billards Infinitycandy Cube";

fn order(main: &[Replicated]) -> Option<Finding> {
    let improvement = |name: &str| main.iter().find(|own| own.report.scene == name)?.improvement();
    let names: Vec<&str> = ORDER.split(' ').collect();
    let ranked = names.iter().enumerate().map(|(place, name)| Some((improvement(name)?, place.max(1))));
    let order = Order::of(&ranked.collect::<Option<Vec<_>>>()?, CLAIMS);
    let reversed = order.reversed.iter().map(|&[more, less]| [names[more], names[less]].join(" improves less than "));
    let reversed = listed(&reversed.collect::<Vec<_>>());
    let expected = names.join(" > ").replacen('>', "~", 1);
    let sentence = format!(
        "The expected order of the improvements over brute force is {expected}. Significantly out of this order: \
         {reversed}."
    );
    Some(Finding::new("order", if reversed.is_empty() { String::new() } else { sentence }).with_value(order.tau))
}
