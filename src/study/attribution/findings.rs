//! The findings of `attribution`.

use super::design::{Factor, Treatment};
use super::result::Attribution;
use crate::measure::Estimate;
use crate::report::Finding;
use crate::report::number::figures;
use crate::report::words::{each_once, interval, listed, slug};
use crate::scene::WorkloadKind;
use crate::study::kendall::{kendall, mean_of_scenes};

/// The scenes in the claims of the study.
pub const HARD: [&str; 3] = ["Dragon", "Lucy", "Sponza"];

pub fn findings(results: &[Attribution]) -> Vec<Finding> {
    let best = |name: &str| result_of(results, name, false).or_else(|| result_of(results, name, true));
    // Claims are about primary rays.
    let is_claimed = |r: &&Attribution| r.first().workload == WorkloadKind::Primary.name();
    let hard: Vec<&Attribution> = HARD.iter().filter_map(|name| best(name)).filter(is_claimed).collect();
    let mut findings: Vec<Finding> = parts(&hard).into_iter().collect();
    let scenes = each_once(HARD.into_iter().chain(results.iter().map(|r| r.first().scene.as_str())));
    let has_summary = !findings.is_empty();
    let splits = scenes.into_iter().filter_map(best).map(split);
    findings.extend(splits.map(|split| if has_summary { split.detail() } else { split }));
    for r in &hard {
        let key = slug(&r.first().scene);
        findings.push(Finding::number(format!("whole-{key}"), r.whole()));
        findings.push(Finding::number(format!("plane-{key}"), r.plane_alone()));
    }
    if hard.len() > 1 {
        findings.extend(gains(results));
    }
    findings.extend(tau(results).map(|tau| Finding::number("tau", tau)));
    findings
}

fn result_of<'a>(results: &'a [Attribution<'a>], name: &str, stand_in: bool) -> Option<&'a Attribution<'a>> {
    results.iter().find(|r| r.first().scene == name && r.first().stand_in == stand_in)
}

fn parts(hard: &[&Attribution]) -> Option<Finding> {
    let scenes = listed(&hard.iter().map(|r| r.first().scene_title()).collect::<Vec<_>>());
    let phrase = |factor: &Factor| {
        let parts: Vec<String> = hard.iter().map(|r| interval(r.part(*factor))).collect();
        format!("{} {}", words(*factor), listed(&parts))
    };
    // On every scene, the interval of `first` lies above the intervals of the other factors.
    let first = Factor::ALL.into_iter().find(|&factor| {
        let above = |r: &Attribution, other: Factor| r.part(factor).low() > r.part(other).high();
        hard.iter().all(|r| Factor::ALL.into_iter().all(|other| other == factor || above(r, other)))
    });
    let (all_of, order) = if hard.len() > 1 { ("all of ", ", scene by scene") } else { ("", "") };
    let most = match first {
        Some(factor) => format!("On {scenes} most of the speedup is due to the {}", words(factor)),
        None => format!("No single factor gives most of the speedup on {all_of}{scenes}"),
    };
    let factors = Factor::ALL.iter().map(phrase).collect::<Vec<_>>().join("; ");
    (!hard.is_empty()).then(|| Finding::new("parts", format!("{most}. The factors{order}: {factors}.")))
}

fn words(factor: Factor) -> &'static str {
    if factor == Factor::Plane { "split plane" } else { factor.name() }
}

pub fn split(r: &Attribution) -> Finding {
    let whole = r.whole();
    let parts = Factor::ALL.map(|factor| format!("{} {}", words(factor), figures(r.part(factor).estimate)));
    let orders = Factor::ALL.map(|factor| r.range(factor).map(figures).join(" to "));
    let sentence = format!(
        "{}: the speedup of {} is the product of {}; in the six orders in which the three can be exchanged, their \
         gains are {}.",
        r.first().scene_title(),
        figures(whole.estimate),
        listed(&parts),
        listed(&orders)
    );
    Finding::new(format!("split-{}", slug(&r.first().scene)), sentence).with_value(whole)
}

/// The ratios of the speedup on Sponza to the speedups on Dragon and Lucy. Stand-ins are used only if the real meshes
/// give no ratio.
fn gains(results: &[Attribution]) -> Vec<Finding> {
    let of = |stand_in: bool| -> Vec<Finding> {
        let whole = |name: &str| Some(result_of(results, name, stand_in)?.whole());
        let gain = |name| Some(Finding::number(format!("gain-{}", slug(name)), whole("Sponza")?.over(whole(name)?)));
        ["Dragon", "Lucy"].into_iter().filter_map(gain).collect()
    };
    [false, true].map(of).into_iter().find(|found| !found.is_empty()).unwrap_or_default()
}

/// Kendall's tau between SAH cost and time, averaged over traversal methods and scenes.
fn tau(results: &[Attribution]) -> Option<Estimate> {
    let families = results.iter().flat_map(|r| [0, 1].map(|traversal| (r, traversal)));
    let taus = families.filter_map(|(r, traversal)| {
        let trees = Treatment::all().filter(|cell| cell.0[Factor::Traversal as usize] == traversal);
        let cost = |cell: Treatment| Some((r.trees[cell.number()].shape.sah_cost?, r.ns_per_ray(cell)));
        Some((r.first().scene.as_str(), kendall(&trees.filter_map(cost).collect::<Vec<_>>(), |_, _| true)?))
    });
    // The interval is `None` for a single scene.
    mean_of_scenes(taus).filter(|tau| tau.interval.is_some())
}
