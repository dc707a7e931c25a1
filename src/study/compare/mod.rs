//! `compare`: every structure is built, checked, counted and timed on every workload of a scene.

mod details;
mod means;
mod options;
mod rank;
mod reference;
mod section;
mod table;
mod tradeoff;

use clap::{ArgMatches, Args, Command, FromArgMatches};

use super::claims::judge;
use super::measurement::{Measurement, UntimedStructure, measurements, refused, samples};
use super::{Dataset, Plan, Presets, SceneEpochs, Study};
use crate::measure::advice::{Conditions, of_own_clock, of_samples};
use crate::measure::{Provenance, machine, median};
use crate::registry::Registry;
use crate::report::words::each_once;
use crate::report::{Failure, Report, Table};
pub use options::CompareArgs;
pub use rank::{FASTEST, ranks};
pub use reference::{Reference, is_reference};
pub use section::bias;

const NAME: &str = "compare";

/// The structures of `study all`: all names, and each again over a triangle test of the other precision.
const FULL: &str = "-s all -s sah-hybrid:batch=packets -s median-kd:test=moller-trumbore -s sah-kd:test=moller-trumbore \
    -s sah-kd-wide:test=moller-trumbore -s sah-kd-tight:test=moller-trumbore -s sah-hybrid:test=moller-trumbore \
    -s sah-bvh:test=moller-trumbore -s obvhs-bvh2:test=exact -s obvhs-cwbvh:test=exact --epochs 4 --runs 1 --budget 4";

/// The study.
pub const STUDY: Study = Study {
    name: NAME,
    question: "Benchmark structures: verify hits, then time them",
    presets: Presets { full: FULL, quick: "cube torus --rays 16384 --epochs 2 --runs 2 --budget 1" },
    options: || CompareArgs::augment_args(Command::new(NAME)),
    plan,
    report,
};

fn plan(matches: &ArgMatches, registry: &Registry) -> anyhow::Result<Plan> {
    CompareArgs::from_arg_matches(matches)?.plan(registry)
}

fn report(dataset: &Dataset, matches: &ArgMatches) -> Report {
    let args = CompareArgs::from_arg_matches(matches).expect("the options are those of the command");
    let (all, refused) = (measurements(dataset), refused(dataset));
    let named = args.reference.as_ref().map(|spec| {
        let known = all.iter().find(|own| own.label.eq_ignore_ascii_case(spec));
        known.map_or(spec.clone(), |own| own.label.clone())
    });
    let references = Reference::of(&all, named.as_deref());
    let mut findings = ranks(&all, references.last()).map_or(vec![], |ranks| ranks.findings(&all));
    findings.extend(section::checked(&all));
    findings.extend(section::tau(&all));
    Report {
        verdicts: judge(NAME, &findings),
        blocks: section::blocks(&all, &refused, &references, args.wide),
        // The tables tell them.
        failures: dataset.failures().into_iter().map(|own| Failure { sentence: String::new(), ..own }).collect(),
        warnings: warnings(dataset),
        data: details::data(&all),
        findings,
    }
}

/// The measurements of each scene.
fn by_scene(all: &[Measurement]) -> Vec<Vec<Measurement>> {
    let scenes = each_once(all.iter().map(|own| (own.scene.clone(), own.scene_hash.clone())));
    let of = |(scene, hash): &(String, String)| {
        all.iter().filter(|own| own.scene == *scene && own.scene_hash == *hash).cloned().collect()
    };
    scenes.iter().map(of).collect()
}

/// What spoilt the run. Warnings of several scenes that differ in their numbers alone are one.
fn warnings(dataset: &Dataset) -> Vec<String> {
    let all = each_once(dataset.scenes().iter().flat_map(|scene| scene_warnings(scene, &dataset.provenance)));
    let words = |warning: &str| warning.replace(|c: char| c.is_ascii_digit() || c == '.', "");
    let mut alike: Vec<(String, usize)> = vec![];
    for warning in all {
        match alike.iter_mut().find(|(first, _)| words(first) == words(&warning)) {
            Some((_, count)) => *count += 1,
            None => alike.push((warning, 1)),
        }
    }
    let told = |(first, count): (String, usize)| match count {
        1 => first,
        n => format!("{first} (the first of {n} scenes of which that is so)"),
    };
    alike.into_iter().map(told).collect()
}

fn scene_warnings(scene: &SceneEpochs, provenance: &Provenance) -> Vec<String> {
    let mut conditions = Conditions {
        load: provenance.load,
        cores: provenance.cores,
        governor: provenance.governor.clone(),
        denormals: machine::denormals(provenance.mxcsr),
        debug: provenance.profile == "debug",
        ..Conditions::default()
    };
    scene.epochs.iter().for_each(|epoch| epoch.environment.add_to(&mut conditions));
    let mut warnings = conditions.warnings();
    let structures = &scene.epochs[0].structures;
    let pairs =
        structures.iter().enumerate().flat_map(|(place, own)| (0..own.rays.len()).map(move |kind| (place, kind)));
    let all: Vec<Vec<f64>> = pairs.map(|(place, kind)| samples(scene, place, kind)).collect();
    let all: Vec<&[f64]> = all.iter().map(Vec::as_slice).filter(|samples| !samples.is_empty()).collect();
    warnings.extend(of_samples(&all));
    let runners = structures.iter().enumerate().filter_map(|(place, structure)| {
        let outside = scene.epochs.iter().filter_map(|epoch| epoch.structures.get(place)?.outside);
        of_own_clock(&structure.label, median(&outside.collect::<Vec<_>>())?)
    });
    warnings.extend(runners);
    warnings
}

/// A table of one scene, whose structures are all refused.
fn nothing_measured(scene: &str, refused: &[UntimedStructure]) -> Table {
    let rows = refused.iter().map(|own| vec![own.label.as_str().into()]);
    Table::new(format!("{scene}: every structure is refused, or no ray is left"), ["structure"], rows).of_one_scene()
}
