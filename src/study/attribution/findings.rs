//! What was found: sentences, and the numbers of the claims.

use super::design::{Factor, Treatment};
use super::result::{Attribution, Part};
use crate::measure::Estimate;
use crate::report::Finding;
use crate::report::number::figures;
use crate::report::words::{each_once, interval, listed, slug};
use crate::scene::WorkloadKind;
use crate::study::kendall::{kendall, mean};

/// The factors in the order of texts and charts.
pub const PARTS: [Factor; 3] = [Factor::Stop, Factor::Plane, Factor::Traversal];

/// The scenes that the claims are about.
pub const HARD: [&str; 3] = ["Dragon", "Lucy", "Sponza"];

pub fn findings(results: &[Attribution]) -> Vec<Finding> {
    let best = |name: &str| form(results, name, false).or_else(|| form(results, name, true));
    // Claims are about primary rays.
    let is_claimed = |r: &&Attribution| r.workload() == WorkloadKind::Primary.name();
    let hard: Vec<&Attribution> = HARD.iter().filter_map(|name| best(name)).filter(is_claimed).collect();
    let mut findings: Vec<Finding> = parts(&hard).into_iter().collect();
    let scenes = each_once(HARD.into_iter().chain(results.iter().map(|r| r.first().scene.as_str())));
    findings.extend(scenes.into_iter().filter_map(best).map(split));
    for r in &hard {
        let key = slug(&r.first().scene);
        findings.push(Finding::number(format!("whole-{key}"), r.time().whole));
        findings.push(Finding::number(format!("plane-{key}"), r.plane_alone()));
    }
    if hard.len() > 1 {
        findings.extend(gains(results));
    }
    findings.extend(tau(results).map(|tau| Finding::number("tau", tau)));
    findings
}

/// The scene `name`, the real mesh or the stand-in.
fn form<'a>(results: &'a [Attribution<'a>], name: &str, stand_in: bool) -> Option<&'a Attribution<'a>> {
    results.iter().find(|r| r.first().scene == name && r.first().stand_in == stand_in)
}

/// Which of the three gives most of the speedup on the hard scenes.
fn parts(hard: &[&Attribution]) -> Option<Finding> {
    let times = |r: &Attribution, factor: Factor| r.time().part(factor).times;
    let scenes = listed(&hard.iter().map(|r| r.first().title()).collect::<Vec<_>>());
    let told = |factor: Factor| listed(&hard.iter().map(|r| interval(times(r, factor))).collect::<Vec<_>>());
    // The first of all scenes: its interval lies above the others' there.
    let first = PARTS.into_iter().find(|&factor| {
        let above = |r: &Attribution, other: Factor| times(r, factor).low() > times(r, other).high();
        hard.iter().all(|r| PARTS.into_iter().all(|other| other == factor || above(r, other)))
    });
    let most = match first {
        Some(factor) => {
            format!("On {scenes} most of the speedup is due to the {}: it gives {} times", factor.name(), told(factor))
        }
        None => format!("On {scenes} no one of the three gives most of the speedup everywhere"),
    };
    let others = PARTS.into_iter().filter(|&factor| Some(factor) != first);
    let others: Vec<String> = others.map(|factor| format!("the {} {} times", factor.name(), told(factor))).collect();
    (!hard.is_empty()).then(|| Finding::new("parts", format!("{most}; {}.", listed(&others))))
}

/// `Of the 21.1-fold speedup on Dragon, the stop rule gives 9.10, the plane 1.60, the traversal 1.45`, and by the order
/// in which the three are switched.
fn split(r: &Attribution) -> Finding {
    let (time, scene) = (r.time(), r.first().title());
    let [stop, plane, traversal] = PARTS.map(|factor| figures(time.part(factor).times.estimate));
    let orders = listed(&PARTS.map(|factor| range(time.part(factor))));
    let sentence = format!(
        "Of the {}-fold speedup on {scene}, the stop rule gives {stop}, the plane {plane}, the traversal {traversal}; \
         by the order of switching {orders}.",
        figures(time.whole.estimate)
    );
    Finding::new(format!("split-{}", slug(&r.first().scene)), sentence).of(time.whole)
}

/// What a part is by the order of switching.
pub fn range(part: Part) -> String {
    format!("{} to {}", figures(part.least), figures(part.most))
}

/// How much more the SAH tree gains on Sponza than on the scans. Real meshes are held against real ones, and stand-ins
/// only where those are not there.
fn gains(results: &[Attribution]) -> Vec<Finding> {
    let of = |stand_in: bool| -> Vec<Finding> {
        let whole = |name: &str| Some(form(results, name, stand_in)?.time().whole);
        let gain =
            |name: &&str| Some(Finding::number(format!("gain-{}", slug(name)), whole("Sponza")?.over(whole(name)?)));
        ["Dragon", "Lucy"].iter().filter_map(gain).collect()
    };
    let real = of(false);
    if real.is_empty() { of(true) } else { real }
}

/// Kendall's tau of SAH cost and time within a family, the trees that are walked alike: the mean over the scenes.
fn tau(results: &[Attribution]) -> Option<Estimate> {
    let of = |r: &Attribution, traversal: usize| {
        let trees = Treatment::all().into_iter().filter(|cell| cell.level(Factor::Traversal) == traversal);
        let pairs = trees.filter_map(|cell| Some((r.tree(cell).shape.sah_cost?, r.ns_per_ray(cell))));
        kendall(&pairs.collect::<Vec<_>>(), |_, _| true)
    };
    // A stand-in is built after the real mesh, so that taus of one scene are not independent.
    let of_scene = |name: &str| -> Option<f64> {
        let forms = results.iter().filter(|r| r.first().scene == name);
        let taus: Vec<f64> = forms.flat_map(|r| [0, 1].into_iter().filter_map(|traversal| of(r, traversal))).collect();
        (!taus.is_empty()).then(|| taus.iter().sum::<f64>() / taus.len() as f64)
    };
    let scenes = each_once(results.iter().map(|r| r.first().scene.as_str()));
    // One scene is no mean of scenes.
    mean(&scenes.into_iter().filter_map(of_scene).collect::<Vec<_>>()).filter(|tau| tau.interval.is_some())
}
