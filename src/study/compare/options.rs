//! The options of `compare`, and the plan of a run.

use std::collections::BTreeSet;
use std::ffi::OsString;
use std::path::PathBuf;
use std::time::Duration;

use crate::measure::{Provenance, Threads};
use crate::registry::{Registry, is_named};
use crate::report::words::each_once_by;
use crate::request::{
    BRUTE_FORCE, Limit, MEASURING, Measuring, OUTPUT, RAYS, RUNNER_LIMIT, RaySource, STRUCTURES, SceneRequest, Scenes,
    Seconds, StructureRequest, Structures, ViewArgs, WORKLOADS, WorkloadRequest, brute_force_note, each_kind, is_obvhs,
    replayed, runners, scene_files, structures_at, with_twin,
};
use crate::scene::{Scene, WorkloadKind};
use crate::study::case::SLOWEST;
use crate::study::diff::{read, unlike_plan};
use crate::study::{Check, Plan, PlannedScene, Settings};

pub const NAME: &str = "compare";

#[derive(Clone, Debug, clap::Args)]
pub struct CompareArgs {
    #[command(flatten)]
    pub scenes: Scenes,
    #[command(flatten)]
    pub from: ViewArgs,
    #[command(flatten)]
    pub structures: Structures,
    /// External program, with arguments, to benchmark as a structure; it times itself (protocol: FORMAT.md). May be
    /// repeated; `-s none` omits the built-in structures
    #[arg(long, value_name = "[NAME=]COMMAND", help_heading = STRUCTURES)]
    pub runner: Vec<String>,
    /// Timeout in seconds for each reply of an external program, including builds
    #[arg(long, help_heading = STRUCTURES, value_name = "SECONDS", requires = "runner", default_value_t = RUNNER_LIMIT, allow_negative_numbers = true)]
    pub runner_limit: Seconds,
    /// Structure that speeds are relative to; always measured [default: median-kd and the faster obvhs BVH, if
    /// measured, else the first structure]
    #[arg(long, help_heading = STRUCTURES, value_name = "NAME[:key=value,..]")]
    pub reference: Option<String>,
    /// For a gate: measure only this structure, or the --runner with this name, and the reference, which is obvhs-bvh2
    /// unless --reference is given
    #[arg(long, help_heading = STRUCTURES, value_name = "NAME[:key=value,..]", conflicts_with_all = ["structure", "quick"])]
    pub only: Option<String>,
    /// Workload (see `sahara list`); may be repeated [default: primary, shadow, diffuse, random]
    #[arg(long, short, help_heading = RAYS, value_name = "WORKLOAD")]
    pub workload: Vec<WorkloadKind>,
    /// Maximum number of rays to time per workload, or a ray file to replay
    #[arg(long, help_heading = RAYS, value_name = "N|all|F.rays", default_value = "all")]
    pub rays: RaySource,
    #[command(flatten)]
    pub measuring: Measuring<4, 1, 2>,
    /// Stop before the first build if `diff` could not compare the results with the earlier run RUN, an export file
    /// (--export-json) or a folder of --dir
    #[arg(long, help_heading = MEASURING, value_name = "RUN")]
    pub like: Option<PathBuf>,
    /// Coarse result in seconds: few rays, up to three epochs and about 4 s per scene; no brute-force unless named
    #[arg(long, help_heading = MEASURING, conflicts_with_all = ["epochs", "runs", "budget"])]
    pub quick: bool,
    /// Time limit of a build in seconds [default: 60 + 30 per million triangles; with --quick 10 + 10; none with
    /// --budget none]
    #[arg(long, help_heading = MEASURING, value_name = "SECONDS|none", value_parser = Limit::parse, allow_negative_numbers = true)]
    pub build_limit: Option<Limit>,
    /// Print the additional columns: builds, memory, tree shape, tests, steps, checks, the speed relative to each
    /// reference, and when a build pays off
    #[arg(long, help_heading = OUTPUT)]
    pub wide: bool,
}

/// Limits of a quick run.
const QUICK_EPOCHS: u16 = 3;
/// The maximum number of rays per workload.
const QUICK_RAYS: usize = 1 << 14;
/// Time limit for all epochs of a scene.
const QUICK: Duration = Duration::from_secs(4);
/// Time limit for the samples of one epoch.
const QUICK_SAMPLES_NS: u64 = 250_000_000;
/// Approximate maximum number of brute-force triangle tests for all checks of a scene.
const QUICK_CHECKS: usize = 1 << 28;
const QUICK_CHECKS_NS: u64 = 1_000_000_000;

/// An additional structure of the default selection.
const PACKETS: &str = "sah-hybrid:batch=packets";

/// `--only` and `--budget none` add this structure unless `--reference` is given. A chosen obvhs structure with its
/// default triangle test also prevents the addition. Changes to this crate or to a user's crate do not affect the code
/// of this structure.
const GATE_REFERENCE: &str = "obvhs-bvh2";

/// The value of `-s` that omits all structures except runners.
const NONE: &str = "none";

impl CompareArgs {
    fn chosen(&self, registry: &Registry) -> anyhow::Result<Vec<StructureRequest>> {
        let is_none = matches!(&self.structures.structure[..], [word] if word == NONE) && !self.runner.is_empty();
        let named_alone = is_none || self.only.is_some();
        let mut structures = if named_alone { vec![] } else { self.structures.chosen(registry, &[])? };
        let is_default = self.structures.structure.is_empty() && !named_alone;
        if let Some(packets) = registry.choose(PACKETS).ok().filter(|_| is_default) {
            let hybrid = structures.iter().position(|own| own.spec == "sah-hybrid");
            structures.insert(hybrid.map_or(structures.len(), |place| place + 1), (&packets).into());
        }
        let limit_s = self.runner_limit.seconds();
        let runners = runners(registry, &self.runner, limit_s)?;
        structures.extend(runners.iter().map(|choice| StructureRequest::of_runner(choice, limit_s)));
        let has = |all: &[StructureRequest], name: &str| all.iter().any(|own| is_named(&own.spec, name));
        let one = |spec: &String| -> anyhow::Result<StructureRequest> {
            let chosen = structures_at(registry, std::slice::from_ref(spec), self.structures.quality.as_deref())?;
            Ok((&chosen[0]).into())
        };
        if let Some(spec) = self.reference.as_ref().filter(|spec| !has(&structures, spec)) {
            structures.push(one(spec)?);
        }
        if let Some(name) = &self.only {
            if !has(&structures, name) {
                let advice =
                    |error| anyhow::anyhow!("{error}; for a program of that name, add --runner {name}=COMMAND");
                structures.insert(0, one(name).map_err(advice)?);
            }
            let is_asked = |own: &StructureRequest| {
                is_named(&own.spec, name)
                    || self.reference.as_ref().is_some_and(|reference| is_named(&own.spec, reference))
            };
            if let Some(other) = structures.iter().find(|own| own.runner.is_some() && !is_asked(own)) {
                anyhow::bail!("--only {name} measures nothing else: omit the runner {}", other.spec);
            }
        }
        // A run without a budget may be one of the two runs that a gate compares.
        let is_gate = self.reference.is_none() && (self.only.is_some() || self.measuring.budget == Limit(None));
        if is_gate && structures.iter().all(|own| !is_obvhs(own.name()) || own.spec.contains("test=")) {
            structures.extend(registry.choose(GATE_REFERENCE).ok().map(|choice| (&choice).into()));
        }
        Ok(each_once_by(structures, |one, other| one.spec == other.spec))
    }

    fn named(&self) -> Structures {
        let mut named = self.structures.clone();
        named.structure.extend(self.reference.iter().chain(&self.only).cloned());
        named
    }

    fn scenes(&self, registry: &Registry) -> anyhow::Result<(Vec<(OsString, Scene)>, WorkloadRequest)> {
        let quick = self.quick.then_some(QUICK_RAYS);
        if let Some((scene, rays)) = replayed(registry, &self.rays, &self.scenes.scenes, &self.workload, quick)? {
            self.from.reject_unused()?;
            return Ok((vec![scene], rays));
        }
        let rays = quick.unwrap_or(self.rays.count());
        let workloads = WorkloadRequest::of_scene(each_kind(&self.workload, &WORKLOADS), rays);
        let scenes = self.scenes.read(registry, &[])?.into_iter();
        let scenes = scenes.map(|(word, scene)| Ok((word, self.from.of(scene)?)));
        Ok((scenes.collect::<anyhow::Result<_>>()?, workloads))
    }

    fn build_limit_s(&self, triangles: usize) -> Option<f64> {
        let millions = triangles as f64 * 1e-6;
        match self.build_limit {
            Some(limit) => limit.0.map(Seconds::seconds),
            None if self.quick => Some(10.0 + 10.0 * millions),
            None => self.measuring.budget.ns().map(|_| 60.0 + 30.0 * millions),
        }
    }

    fn settings(&self, registry: &Registry, all: &[StructureRequest], workloads: usize) -> anyhow::Result<Settings> {
        let mut settings = Settings { slowest: Some(SLOWEST), ..Settings::new(&self.measuring, registry)? };
        if self.quick {
            let tests = all.iter().map(|own| Ok(own.choose(registry)?.triangle_test()));
            let tests: BTreeSet<&str> = tests.collect::<anyhow::Result<_>>()?;
            let tests = QUICK_CHECKS / (tests.len() * workloads).max(1);
            settings.check = Check::BruteForce { tests, limit_ns: Some(QUICK_CHECKS_NS) };
            settings.budget_ns = Some(QUICK_SAMPLES_NS);
        }
        Ok(settings)
    }

    pub fn plan(&self, registry: &Registry) -> anyhow::Result<Plan> {
        let mut structures = self.chosen(registry)?;
        let named = self.named();
        let (mut scenes, workloads) = self.scenes(registry)?;
        scenes.sort_by_key(|(_, scene)| scene.mesh.len());
        let is_bounded = self.measuring.budget.ns().is_some() && !self.quick;
        let is_skipped =
            |own: &StructureRequest| own.name() == BRUTE_FORCE && !is_bounded && !named.names_brute_force();
        let mut notes = vec![];
        if structures.iter().any(is_skipped) && !self.quick {
            notes.push(format!(
                "{BRUTE_FORCE} is skipped (hours for all rays); pass --structure {BRUTE_FORCE} to run it."
            ));
        }
        structures.retain(|own| !is_skipped(own));
        let structures = with_twin(structures);
        let settings = self.settings(registry, &structures, workloads.kinds())?;
        let epochs = if self.quick { QUICK_EPOCHS } else { self.measuring.epochs };
        let mut planned = vec![];
        for own in &scenes {
            let (word, scene) = own;
            let triangles = scene.mesh.len();
            let mut fitting = structures.clone();
            fitting.retain(|own| !named.leaves_out(own.name(), triangles));
            notes.extend((fitting.len() < structures.len()).then(|| brute_force_note(scene)));
            let settings = Settings { build_limit_s: self.build_limit_s(triangles), ..settings.clone() };
            let mut plan = PlannedScene::new(own, &fitting, &workloads, &settings, epochs.into());
            plan.case.scene = SceneRequest::new(word, &self.from, scene);
            planned.push(plan);
        }
        let mut plan = Plan::by_epoch(NAME, &planned).by_scene().noting(scenes.iter().map(|(_, scene)| scene));
        plan.inputs = scene_files(registry, &self.scenes.scenes);
        plan.inputs.extend(self.rays.file().map(Into::into));
        plan.notes.extend(notes);
        plan.keep_journal = false;
        if let Some(path) = &self.like {
            let here = Provenance::of(&Threads::unstarted(self.measuring.threads.into()));
            unlike_plan(&read(path)?, &plan.cases, &here)?;
            plan.inputs.push(path.clone());
        }
        if self.quick {
            plan.limit = Some(QUICK);
            plan.notes.push("Coarse: few rays, few checks, up to three epochs. Omit --quick for a full run.".into());
        }
        Ok(plan)
    }
}

#[cfg(test)]
mod tests {
    use clap::{Args as _, FromArgMatches as _};

    use super::*;
    use crate::request::ALL;
    use crate::study::compare::STUDY;

    fn plan(words: &[&str]) -> Plan {
        let command = CompareArgs::augment_args(clap::Command::new("compare"));
        let matches = command.get_matches_from([&["compare"], words].concat());
        CompareArgs::from_arg_matches(&matches).unwrap().plan(&Registry::builtin()).unwrap()
    }

    fn specs(words: &[&str]) -> Vec<String> {
        plan(words).cases[0].structures.iter().map(|own| own.spec.clone()).collect()
    }

    #[test]
    fn brute_force_is_in_a_quick_run_and_one_without_a_budget_where_it_is_named_alone() {
        for bounds in [&["cube", "--quick"][..], &["cube", "--budget", "none"]] {
            let has = |words: &[&str]| specs(&[bounds, words].concat()).contains(&BRUTE_FORCE.into());
            assert!(!has(&[]) && !has(&["-s", ALL]) && !has(&["-s", "sah-kd"]));
            assert!(has(&["-s", ALL, "-s", BRUTE_FORCE]) && has(&["-s", "sah-kd", "--reference", BRUTE_FORCE]));
        }
        assert!(specs(&["cube"]).contains(&BRUTE_FORCE.into()));
    }

    #[test]
    fn builds_have_a_limit_unless_all_rays_are_timed() {
        let limit = |words: &[&str]| plan(&[&["cube", "-s", "sah-kd"], words].concat()).cases[0].settings.build_limit_s;
        let seconds = |limit: Option<f64>| limit.map(|seconds| seconds as u64);
        assert_eq!([limit(&[]), limit(&["--quick"])].map(seconds), [Some(60), Some(10)]);
        assert_eq!([limit(&["--budget", "none"]), limit(&["--build-limit", "none"])], [None, None]);
        assert_eq!(limit(&["--build-limit", "1.5"]), Some(1.5));
    }

    #[test]
    fn study_all_compares_every_structure_with_right_answers_and_in_single_precision() {
        let registry = Registry::builtin();
        let matches = STUDY.matches(&STUDY.preset(STUDY.presets.full, &["cube".into()])).unwrap();
        let plan = (STUDY.plan)(&matches, &registry).unwrap();
        let labels: Vec<&str> = plan.cases[0].structures.iter().map(|own| own.spec.as_str()).collect();
        assert!(registry.names().iter().all(|name| labels.contains(name)), "{labels:?}");
        // Each `-s` except `-s all` adds one structure. The twin is one more structure.
        assert_eq!(labels.len(), registry.names().len() + super::super::FULL.matches("-s ").count());
    }

    #[test]
    fn a_gate_measures_its_structure_and_the_yardstick() {
        // `each_once_by` removes the twin, because the twin repeats a spec.
        let distinct = |words: &[&str]| each_once_by(specs(&[&["cube"], words].concat()), String::eq);
        assert_eq!(distinct(&["--only", "sah-bvh"]), ["sah-bvh", "obvhs-bvh2"]);
        assert_eq!(distinct(&["-s", "sah-kd", "--budget", "none"]), ["sah-kd", "obvhs-bvh2"]);
        assert_eq!(
            distinct(&["-s", "obvhs-cwbvh", "--budget", "none"]),
            ["obvhs-cwbvh"],
            "an obvhs structure is already measured"
        );
        assert!(!specs(&["cube", "-s", "sah-kd"]).contains(&GATE_REFERENCE.into()));
    }
}
