//! What the studies of epochs share on the command line: epochs of scenes, measured one by one and kept in a journal.

use serde::Serialize;
use serde::de::DeserializeOwned;

use super::folder::{Exports, Folder};
use super::meshes::Scenes;
use crate::cli::progress::Progress;
use crate::cli::rays::rays_or_all;
use crate::cli::terminal::Terminal;
use crate::cli::{Verdict, sources};
use crate::measure::{Provenance, SystemClock, Threads};
use crate::registry::{Choice, Registry};
use crate::report::words::scene_name;
use crate::scene::{Scene, WorkloadKind};
use crate::study::epoch::{Asked, Epoch, Settings, key, measure, troubles};
use crate::study::journal::Journal;
use crate::study::{BRUTE_FORCE, REPORT_TREE, SAH_TREE, StudyError, documented_defect};

/// Options of all of them.
#[derive(Clone, Debug, clap::Args)]
pub struct Options {
    /// Epochs: in each all structures are built anew; more of them can be added later
    #[arg(long, value_name = "N", default_value_t = 5, value_parser = clap::value_parser!(u16).range(1..=1000))]
    pub epochs: u16,
    /// Samples of every case in an epoch
    #[arg(long, value_name = "N", default_value_t = 3, value_parser = clap::value_parser!(u16).range(1..=1000))]
    pub runs: u16,
    /// Seconds that the samples of an epoch of a scene may take: slow cases are timed on fewer rays to keep within them
    #[arg(long, value_name = "SECONDS", default_value_t = 8, value_parser = clap::value_parser!(u32).range(1..=86400))]
    pub budget: u32,
    /// Threads that build and trace; 1 is the unit of comparison
    #[arg(long, value_name = "N", default_value_t = 1, value_parser = clap::value_parser!(u16).range(1..=1024))]
    pub threads: u16,
    /// Seed of the rays and of the order of samples
    #[arg(long, value_name = "N", default_value_t = 1)]
    pub seed: u64,
    #[command(flatten)]
    pub folder: Folder,
    #[command(flatten)]
    pub exports: Exports,
}

/// Options of those that compare structures of the user's choice on rays of the user's choice.
#[derive(Clone, Debug, clap::Args)]
pub struct Field {
    /// A structure, with keys that differ from their defaults; may be repeated [default: those of the study]
    #[arg(long, short, value_name = "NAME[:key=value,..]")]
    pub structure: Vec<String>,
    /// A kind of rays; may be repeated [default: those of the study]
    #[arg(long, short, value_name = "KIND")]
    pub workload: Vec<WorkloadKind>,
    /// Rays of a workload that are timed, at most, in whole tiles of the scene's picture
    #[arg(long, value_name = "N|all", default_value = "all", value_parser = rays_or_all)]
    pub rays: usize,
    #[command(flatten)]
    pub options: Options,
}

impl Options {
    /// The settings for `structures` and what they are asked.
    ///
    /// # Errors
    /// If the system does not give the threads.
    pub fn settings(&self, registry: &Registry, structures: Vec<Choice>, asked: Asked) -> anyhow::Result<Settings> {
        Ok(Settings {
            structures,
            guide: sources::guide(registry)?,
            asked,
            runs: self.runs.into(),
            budget_ns: u64::from(self.budget) * 1_000_000_000,
            seed: self.seed,
            threads: Threads::pinned(self.threads.into()).map_err(anyhow::Error::msg)?,
        })
    }
}

/// A study of a field of structures, as it is unless the user says otherwise.
pub struct Study<'a> {
    pub name: &'a str,
    pub structures: &'a [&'a str],
    pub workloads: &'a [WorkloadKind],
    /// What its tables mean.
    pub legend: &'a [&'a str],
}

/// Options of those that compare such structures on scenes.
#[derive(Clone, Debug, clap::Args)]
pub struct OnScenes {
    #[command(flatten)]
    scenes: Scenes,
    #[command(flatten)]
    pub field: Field,
}

impl OnScenes {
    /// The epochs of a study, what to say below its tables, where its times come from, and what the run comes to.
    ///
    /// # Errors
    /// As [`cases`], and if a structure or a scene is not known.
    pub fn measured(
        &self,
        study: &Study,
        registry: &Registry,
        terminal: &Terminal,
    ) -> anyhow::Result<(Vec<Epoch>, Vec<String>, Provenance, Verdict)> {
        let settings = self.field.settings(registry, study.structures, study.workloads)?;
        let read = self.scenes.read()?;
        let whole = |_, epoch| Ok(epoch);
        let (epochs, provenance) =
            cases(study.name, &self.field.options, &settings, &read, terminal, whole, |epoch: &Epoch| epoch)?;
        let (troubles, verdict) = verdict(&epochs);
        let mut foot: Vec<String> = study.legend.iter().map(|&line| line.into()).collect();
        foot.extend(troubles);
        foot.extend(self.scenes.note(&read));
        foot.push(provenance.line());
        Ok((epochs, foot, provenance, verdict))
    }
}

impl Field {
    /// The settings, with `structures` and `workloads` where none are named.
    ///
    /// # Errors
    /// If a structure is not known, or the system does not give the threads.
    pub fn settings(
        &self,
        registry: &Registry,
        structures: &[&str],
        workloads: &[WorkloadKind],
    ) -> anyhow::Result<Settings> {
        let own: Vec<String> = structures.iter().map(|&name| name.into()).collect();
        let named = if self.structure.is_empty() { &own } else { &self.structure };
        let kinds = if self.workload.is_empty() { workloads.into() } else { self.workload.clone() };
        let structures = with_twin(sources::structures(registry, named)?);
        self.options.settings(registry, structures, Asked::Kinds(kinds, self.rays))
    }
}

/// The structures and, for the A/A noise, the twin of one of them: of the SAH tree, or else of the first that is
/// neither brute force nor the report's tree, which take long, or else of the first.
fn with_twin(mut structures: Vec<Choice>) -> Vec<Choice> {
    let slow = |choice: &&Choice| [BRUTE_FORCE, REPORT_TREE].contains(&choice.entry.name.as_str());
    let sah = structures.iter().find(|choice| choice.entry.name == SAH_TREE);
    let twin = sah.or_else(|| structures.iter().find(|choice| !slow(choice))).or(structures.first());
    structures.extend(twin.cloned());
    structures
}

/// Measures the epochs of `scenes` that the journal of the study `name` lacks, and gives all those asked for, and where
/// the journal's times come from. `wrap` makes a case of the epoch of a scene, by its number; `epoch` is its inverse.
/// All scenes of an epoch come before the next one: what changes on the machine over hours changes all scenes alike.
///
/// # Errors
/// If the journal cannot be used, or a scene cannot be measured.
pub fn cases<C: Clone + Serialize + DeserializeOwned>(
    name: &str,
    options: &Options,
    settings: &Settings,
    scenes: &[Scene],
    terminal: &Terminal,
    wrap: impl Fn(usize, Epoch) -> Result<C, StudyError>,
    epoch_of: impl Fn(&C) -> &Epoch,
) -> anyhow::Result<(Vec<C>, Provenance)> {
    let provenance = Provenance::of(&settings.threads);
    let mut journal: Journal<C> = options.folder.journal(name, &settings.kept(), provenance)?;
    let epochs = 0..usize::from(options.epochs);
    let plan: Vec<(usize, usize, String)> =
        epochs.flat_map(|e| scenes.iter().enumerate().map(move |(s, scene)| (s, e, key(scene, e)))).collect();
    let left = journal.left(plan.iter().map(|(.., key)| key.as_str())).len();
    let clock = SystemClock::start();
    let mut progress = Progress::over(left, terminal);
    for (s, e, key_of_case) in &plan {
        if journal.get(key_of_case).is_some() {
            continue;
        }
        let scene = &scenes[*s];
        let name = scene_name(&scene.name, !scene.stand_ins.is_empty());
        progress.scene(&format!("epoch {} of {}: {name}", e + 1, options.epochs));
        let first = journal.get(&key(scene, 0)).map(&epoch_of);
        let epoch = measure(scene, settings, *e, first, &clock, &mut |stage| progress.stage(&stage))?;
        journal.append(key_of_case, wrap(*s, epoch)?)?;
        progress.scene_done();
    }
    progress.finish();
    // The journal may hold other scenes as well: those asked for are shown.
    let cases = plan.iter().filter_map(|(.., key)| journal.get(key).cloned()).collect();
    Ok((cases, journal.provenance().clone()))
}

/// As [`cases`], of a study that is nothing without all of its structures: nothing once one of them has answered
/// wrongly, which is said.
///
/// # Errors
/// As [`cases`], and if a structure is missing.
pub fn measured(
    name: &str,
    options: &Options,
    settings: &Settings,
    scenes: &[Scene],
    terminal: &Terminal,
) -> anyhow::Result<Option<(Vec<Epoch>, Provenance)>> {
    let whole = |_, epoch: Epoch| epoch.is_whole().map(|()| epoch);
    match cases(name, options, settings, scenes, terminal, whole, |epoch: &Epoch| epoch) {
        Ok(cases) => Ok(Some(cases)),
        Err(error) => match error.downcast_ref::<StudyError>() {
            Some(wrong) if wrong.is_wrong_answer() => {
                eprintln!("error: {error}");
                Ok(None)
            }
            _ => Err(error),
        },
    }
}

/// What to say of structures that took no part, and what they make of the run.
pub fn verdict<'a>(epochs: impl IntoIterator<Item = &'a Epoch>) -> (Vec<String>, Verdict) {
    let troubles = troubles(epochs);
    let wrong = |t: &crate::study::epoch::Trouble| t.wrong && documented_defect(&t.structure).is_none();
    let verdict = if troubles.iter().any(wrong) {
        Verdict::Wrong
    } else if troubles.iter().any(|trouble| trouble.refused) {
        Verdict::Refused
    } else {
        Verdict::Right
    };
    (troubles.into_iter().map(|trouble| trouble.sentence).collect(), verdict)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_field_has_a_twin_of_a_structure_that_is_not_slow() {
        let registry = Registry::builtin();
        let of = |names: &[&str]| -> Vec<String> {
            let chosen = names.iter().map(|name| registry.choose(name).unwrap()).collect();
            with_twin(chosen).into_iter().map(|choice| choice.label).collect()
        };
        assert_eq!(of(&["median-kd", "sah-bvh", "sah-kd"]), ["median-kd", "sah-bvh", "sah-kd", "sah-kd"]);
        assert_eq!(of(&["brute-force", "sah-bvh"]), ["brute-force", "sah-bvh", "sah-bvh"]);
        assert_eq!(of(&["median-kd"]), ["median-kd", "median-kd"]);
        assert!(of(&[]).is_empty());
    }
}
