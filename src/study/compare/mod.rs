//! The study `compare`: the speed of structures on the workloads of each scene.

mod details;
mod means;
mod options;
mod rank;
mod reference;
mod section;
mod table;
mod tradeoff;

use crate::request::known_defect;
use clap::{ArgMatches, Args, Command, FromArgMatches};

use super::claims::judge;
use super::measure::Environment;
use super::measurement::measurements;
use super::{Dataset, Presets, SceneEpochs, Study};
use crate::measure::advice::{of_conditions, of_own_clock};
use crate::measure::{Provenance, median};
use crate::report::words::each_once_by;
use crate::report::{Failure, Report};
use options::{CompareArgs, NAME};
pub use rank::FASTEST;
use rank::Ranking;
pub use reference::Reference;
use table::refusals;

/// The arguments of `compare` in `study all`.
const FULL: &str = "-s all -s sah-hybrid:batch=packets -s median-kd:test=moller-trumbore -s sah-kd:test=moller-trumbore \
    -s sah-kd-wide:test=moller-trumbore -s sah-kd-tight:test=moller-trumbore -s sah-hybrid:test=moller-trumbore \
    -s sah-bvh:test=moller-trumbore -s obvhs-bvh2:test=exact -s obvhs-cwbvh:test=exact --epochs 4 --runs 1 --budget 4";

pub const STUDY: Study = Study {
    name: NAME,
    question: "Benchmark structures with checked hits",
    presets: Presets { full: FULL, quick: "cube torus --rays 16384 --epochs 2 --runs 2 --budget 1" },
    options: || CompareArgs::augment_args(Command::new(NAME)),
    plan: |matches, registry| CompareArgs::from_arg_matches(matches)?.plan(registry),
    report,
};

fn report(dataset: &Dataset, matches: &ArgMatches) -> Report {
    let args = CompareArgs::from_arg_matches(matches).expect("the options are those of the command");
    let all = measurements(dataset);
    let references = Reference::of(&all, args.reference.as_deref());
    let ranking = references.last().and_then(|reference| Ranking::of(&all, reference));
    let mut findings = ranking.map_or(vec![], |ranking| ranking.findings());
    findings.extend(section::checked(&all));
    findings.extend(section::tau(&all));
    Report {
        verdicts: judge(NAME, &findings),
        blocks: section::blocks(dataset, &references, args.wide),
        failures: failures(dataset),
        warnings: warnings(dataset),
        data: details::data(&all),
        findings,
    }
}

/// Keeps one sentence per reason of a refusal.
///
/// Keeps one sentence per structure with wrong hits and no known defect.
fn failures(dataset: &Dataset) -> Vec<Failure> {
    let (mut failures, mut reported) = (dataset.failures(), vec![]);
    let scenes = dataset.scenes();
    let refused: Vec<_> = scenes.iter().flat_map(section::refused).collect();
    let mut reasons = refusals(&refused).into_iter();
    for own in &mut failures {
        if own.refused && !refused.is_empty() {
            // There are at least as many refused structures as reasons, so all reasons are kept.
            own.sentence = reasons.next().unwrap_or_default();
        } else if !own.wrong || known_defect(&own.structure).is_some() || reported.contains(&own.structure) {
            own.sentence.clear();
        } else {
            reported.push(own.structure.clone());
        }
    }
    failures
}

/// Removes a warning that differs from an earlier warning only in digits.
fn warnings(dataset: &Dataset) -> Vec<String> {
    let all = dataset.scenes().into_iter().flat_map(|scene| scene_warnings(&scene, &dataset.provenance));
    let words = |warning: &str| warning.replace(|c: char| c.is_ascii_digit() || c == '.', "");
    each_once_by(all, |one, other| words(one) == words(other))
}

fn scene_warnings(scene: &SceneEpochs, provenance: &Provenance) -> Vec<String> {
    let during = Environment::of_all(scene.epochs.iter().map(|epoch| &epoch.environment));
    let mut warnings = of_conditions(provenance, during.seconds, during.interruptions, during.clock_rates);
    warnings.extend(scene.epochs[0].structures.iter().enumerate().filter_map(|(place, structure)| {
        let outside = scene.epochs.iter().filter_map(|epoch| epoch.structures.get(place)?.outside);
        of_own_clock(&structure.label, median(&outside.collect::<Vec<_>>())?)
    }));
    warnings
}
