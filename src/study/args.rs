//! Options that studies share. The same option means the same in all of them.

use std::ffi::OsString;
use std::path::PathBuf;

use clap::ValueEnum;

use super::bench::check::TESTS;
use super::epoch::{Asked, Settings};
use super::reference_structures::takes_minutes;
use super::{BRUTE_FORCE, REPORT_TREE, SAH_TREE, Seconds, rays_or_all, sources};
use crate::measure::Threads;
use crate::registry::{Choice, Registry};
use crate::report::words::{each_once, listed};
use crate::scene::{BUILTIN, Builtin, Scene, WorkloadKind};

/// The kinds of rays of studies that have no others.
pub const WORKLOADS: [WorkloadKind; 4] =
    [WorkloadKind::Primary, WorkloadKind::Shadow, WorkloadKind::Diffuse, WorkloadKind::Random];

/// What most studies of epochs measure in `study all --quick`.
pub const QUICK_EPOCHS: &str = "torus --rays 1024 --epochs 2 --runs 2 --budget 1";

/// Where pairs are compared each on its own rays, a structure that takes more than so many times as long as the median one is timed on
/// fewer: its ratios hardly gain from more of them, and the run would be about it alone.
pub const SLOWEST: f64 = 4.0;

/// How much is timed. The numbers are the defaults of a study, as texts: clap keeps one default value of another type for all parameters.
#[derive(Clone, Debug, clap::Args)]
pub struct Measuring<const EPOCHS: u16 = 5, const RUNS: u16 = 3, const BUDGET: u32 = 8> {
    /// Epochs: in each all structures are built anew; more of them can be added later
    #[arg(long, value_name = "N", default_value = EPOCHS.to_string(), value_parser = clap::value_parser!(u16).range(1..=1000))]
    pub epochs: u16,
    /// Samples of every case in an epoch; fewer where there is not time for them all
    #[arg(long, value_name = "N", default_value = RUNS.to_string(), value_parser = clap::value_parser!(u16).range(1..=1000))]
    pub runs: u16,
    /// Seconds that the samples of an epoch of a scene may take: slow cases are timed on fewer rays to keep within them
    #[arg(long, value_name = "SECONDS", default_value = BUDGET.to_string(), allow_negative_numbers = true)]
    pub budget: Seconds,
    /// Threads that build and trace; 1 is the unit of comparison
    #[arg(long, value_name = "N", default_value_t = 1, value_parser = clap::value_parser!(u16).range(1..=1024))]
    pub threads: u16,
    /// Seed of the rays and of the order of samples
    #[arg(long, value_name = "N", default_value_t = 1)]
    pub seed: u64,
}

impl<const EPOCHS: u16, const RUNS: u16, const BUDGET: u32> Measuring<EPOCHS, RUNS, BUDGET> {
    /// The settings for `structures` and what they are asked: each thread has a processor of its own where the system allows it.
    ///
    /// # Errors
    /// If the system does not give the threads.
    pub fn settings(&self, registry: &Registry, structures: Vec<Choice>, asked: Asked) -> anyhow::Result<Settings> {
        let threads = Threads::pinned(self.threads.into()).map_err(anyhow::Error::msg)?;
        self.settings_on(threads, registry, structures, asked)
    }

    /// The same on these threads.
    ///
    /// # Errors
    /// If there is no structure to check against.
    pub fn settings_on(
        &self,
        threads: Threads,
        registry: &Registry,
        structures: Vec<Choice>,
        asked: Asked,
    ) -> anyhow::Result<Settings> {
        Ok(Settings {
            structures,
            guide: sources::guide(registry)?,
            asked,
            runs: self.runs.into(),
            budget_ns: self.budget.ns(),
            slowest: f64::INFINITY,
            check_tests: TESTS,
            detailed: false,
            seed: self.seed,
            threads,
        })
    }
}

/// The structures.
#[derive(Clone, Debug, Default, clap::Args)]
pub struct Structures {
    /// A structure, with keys that differ from their defaults; may be repeated [default: those of the study]
    #[arg(long, short, value_name = "NAME[:key=value,..]")]
    pub structure: Vec<String>,
    /// How much time the builds of eight-wide trees may take, where a structure is named without a quality of its own
    #[arg(long, value_parser = sources::QUALITIES)]
    pub quality: Option<String>,
}

impl Structures {
    /// Those named, else `own`, else one of each name.
    ///
    /// # Errors
    /// If a structure is not known.
    pub fn chosen(&self, registry: &Registry, own: &[&str]) -> anyhow::Result<Vec<Choice>> {
        let own: Vec<String> = own.iter().map(|&name| name.into()).collect();
        let named = if self.structure.is_empty() { &own } else { &self.structure };
        sources::structures_at(registry, named, self.quality.as_deref())
    }

    /// Whether one of the chosen structures is left out among so many triangles: it would take minutes, and was not named.
    pub fn leaves_out(&self, choice: &Choice, triangles: usize) -> bool {
        takes_minutes(choice, triangles) && !self.names_brute_force()
    }

    /// Whether brute force is named: `all` does not.
    pub fn names_brute_force(&self) -> bool {
        let is_named =
            |spec: &String| spec.split(':').next().is_some_and(|name| name.eq_ignore_ascii_case(BRUTE_FORCE));
        self.structure.iter().any(is_named)
    }
}

/// The structures and, for the A/A noise, the twin of one of them: of the SAH tree, or else of the first that is
/// neither brute force nor the report's tree, which take long, or else of the first.
pub fn with_twin(mut structures: Vec<Choice>) -> Vec<Choice> {
    let slow = |choice: &&Choice| [BRUTE_FORCE, REPORT_TREE].contains(&choice.entry.name.as_str());
    let sah = structures.iter().find(|choice| choice.entry.name == SAH_TREE);
    let twin = sah.or_else(|| structures.iter().find(|choice| !slow(choice))).or(structures.first());
    structures.extend(twin.cloned());
    structures
}

/// The rays.
#[derive(Clone, Debug, clap::Args)]
pub struct Rays {
    /// A kind of rays; may be repeated [default: those of the study]
    #[arg(long, short, value_name = "KIND")]
    pub workload: Vec<WorkloadKind>,
    /// Rays of a workload that are timed, at most, in whole tiles of the scene's picture
    #[arg(long, value_name = "N|all", default_value = "all", value_parser = rays_or_all)]
    pub rays: usize,
}

impl Rays {
    /// What structures are asked.
    pub fn asked(&self, own: &[WorkloadKind]) -> Asked {
        Asked::Kinds(kinds(&self.workload, own), self.rays)
    }
}

/// The kinds of rays that are named, each once, else `own`: the same one twice would count twice in every mean.
pub fn kinds<K: Copy + PartialEq>(named: &[K], own: &[K]) -> Vec<K> {
    each_once(if named.is_empty() { own } else { named }.iter().copied())
}

/// Scenes.
#[derive(Clone, Debug, Default, clap::Args)]
pub struct Scenes {
    /// Built-in scenes, scene files (.toml) and mesh files (.obj, .ply, .gltf, .glb) [default: those of the study, else all
    /// built-in ones]
    #[arg(value_name = "SCENE|FILE")]
    pub scenes: Vec<OsString>,
}

impl Scenes {
    /// These ones.
    pub fn named(names: &[&str]) -> Self {
        Self { scenes: names.iter().map(|&name| name.into()).collect() }
    }

    /// Those named, else `own`, else all built-in ones.
    ///
    /// # Errors
    /// As [`sources::scenes`].
    pub fn read(&self, own: &[&str]) -> anyhow::Result<Vec<Scene>> {
        if self.scenes.is_empty() { sources::scenes(&Self::named(own).scenes) } else { sources::scenes(&self.scenes) }
    }

    /// Those that are files.
    pub fn files(&self) -> Vec<PathBuf> {
        self.scenes.iter().filter(|name| Builtin::find(name).is_err()).map(PathBuf::from).collect()
    }
}

/// Which meshes the built-in scenes are measured with.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, ValueEnum)]
pub enum Meshes {
    /// Stand-ins, and the real meshes where they have been fetched
    #[default]
    Both,
    /// Real meshes alone: a scene whose mesh has not been fetched is refused
    Real,
    /// Stand-ins alone
    StandIns,
}

/// Scenes and their meshes.
#[derive(Clone, Debug, Default, clap::Args)]
pub struct ScenesAndMeshes {
    #[command(flatten)]
    pub named: Scenes,
    /// Meshes of the built-in scenes
    #[arg(long, value_name = "WHICH", value_enum, default_value_t)]
    pub meshes: Meshes,
}

impl ScenesAndMeshes {
    /// The scenes named, all built-in ones without a name; of those with a stand-in both forms, if the meshes are to be both.
    ///
    /// # Errors
    /// As [`sources::scene`] and [`sources::distinct`], and if real meshes are asked for and one is not there.
    pub fn read(&self) -> anyhow::Result<Vec<Scene>> {
        let all: Vec<OsString> = BUILTIN.iter().map(|builtin| builtin.name.into()).collect();
        let mut forms: Vec<Scene> = vec![];
        for name in sources::wanted(if self.named.scenes.is_empty() { &all } else { &self.named.scenes }) {
            let builtin = Builtin::find(name).ok().filter(|_| self.meshes != Meshes::Real);
            forms.extend(builtin.map(|builtin| builtin.scene(None)).transpose()?);
            if builtin.is_none() || self.meshes == Meshes::Both {
                forms.push(sources::scene(name)?);
            }
        }
        // Both forms of a scene without a real mesh are one.
        let scenes = sources::distinct(forms)?;
        if let (Meshes::Real, Some(note)) = (self.meshes, self.note(&scenes)) {
            anyhow::bail!("{note} Without `--meshes real` stand-ins are measured.");
        }
        Ok(scenes)
    }

    /// A note where a real mesh could have been measured and is not there.
    pub fn note(&self, read: &[Scene]) -> Option<String> {
        let alone = |scene: &&Scene| {
            !scene.stand_ins.is_empty()
                && !read.iter().any(|other| other.name == scene.name && other.stand_ins.is_empty())
        };
        let names: Vec<&str> = read.iter().filter(alone).map(|scene| scene.name.as_str()).collect();
        (!names.is_empty() && self.meshes != Meshes::StandIns).then(|| {
            format!(
                "The real meshes of {} are not there: `sahara fetch` gets them, SAHARA_DATA names their folder.",
                listed(&names)
            )
        })
    }
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

    #[test]
    fn brute_force_takes_part_in_a_large_scene_only_where_it_is_named() {
        let registry = Registry::builtin();
        let left_out = |named: &[&str], triangles| {
            let structures = Structures { structure: named.iter().map(|&name| name.into()).collect(), quality: None };
            let mut chosen = structures.chosen(&registry, &[]).unwrap();
            chosen.retain(|choice| structures.leaves_out(choice, triangles));
            chosen.into_iter().map(|choice| choice.label).collect::<Vec<_>>()
        };
        assert_eq!(left_out(&[], 10_000_000), [BRUTE_FORCE]);
        assert_eq!(left_out(&["all"], 10_000_000), [BRUTE_FORCE]);
        assert!(left_out(&[], 1_000_000).is_empty() && left_out(&["sah-kd"], 10_000_000).is_empty());
        assert!(left_out(&["all", "Brute-Force:test=exact"], 10_000_000).is_empty());
    }
}
