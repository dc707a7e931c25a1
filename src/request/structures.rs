//! Structures by what the command line names, and as a case names them.

use std::time::Duration;

use anyhow::Context;
use serde::{Deserialize, Serialize};

use crate::names::suggestion;
use crate::registry::{Choice, Registry};
use crate::report::words::{bare, each_once_by};
use crate::runner::Program;
use crate::scene::Scene;

/// Every ray against every triangle.
pub const BRUTE_FORCE: &str = "brute-force";

/// The report's tree.
pub const REPORT_TREE: &str = "median-kd";

/// The tree of which the report claims that it would be faster.
pub const SAH_TREE: &str = "sah-kd";

/// Stands for one structure of every name.
pub const ALL: &str = "all";

/// The role of a structure that is built a second time, for the A/A noise.
pub const TWIN: &str = "twin";

/// The qualities that `--quality` takes.
pub const QUALITIES: [&str; 3] = ["fast", "balanced", "high"];

/// A structure as a case names it.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct StructureRequest {
    /// `NAME` or `NAME:key=value,..`; the label of a runner.
    pub spec: String,
    /// What the structure stands for in a study: [`TWIN`], or a cell of a design; empty where the spec says it all.
    #[serde(default, skip_serializing_if = "String::is_empty")]
    pub role: String,
    /// A program that takes the structure's place.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub runner: Option<RunnerRequest>,
    /// Why the structure is not built: a clause. It has no time then.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub skipped: Option<String>,
}

/// A program of another language.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct RunnerRequest {
    /// The command line.
    pub command: String,
    /// Seconds that it may take for an answer.
    pub limit_s: f64,
    /// What is known of it, the digest of its file among it: another program is another structure.
    pub config: serde_json::Value,
}

impl StructureRequest {
    /// The structure of this spec, in a role of its own.
    pub fn new(spec: impl Into<String>, role: impl Into<String>) -> Self {
        Self { spec: spec.into(), role: role.into(), runner: None, skipped: None }
    }

    /// The program, with its label.
    ///
    /// # Errors
    /// If there is no such program.
    pub fn of_runner(command: &str, limit_s: f64) -> anyhow::Result<Self> {
        let choice = runner(command, limit_s)?;
        let runner = RunnerRequest { command: command.into(), limit_s, config: choice.config.clone() };
        Ok(Self { runner: Some(runner), ..Self::new(choice.label, "") })
    }

    /// What is built.
    ///
    /// # Errors
    /// If the name, a key or the program is not known here.
    pub fn choose(&self, registry: &Registry) -> anyhow::Result<Choice> {
        match &self.runner {
            Some(own) => runner(&own.command, own.limit_s),
            None => Ok(registry.choose(&self.spec)?),
        }
    }

    /// Name in the registry.
    pub fn name(&self) -> &str {
        bare(&self.spec)
    }
}

impl From<&Choice> for StructureRequest {
    fn from(choice: &Choice) -> Self {
        Self::new(choice.label.clone(), "")
    }
}

/// The structure of a program, `[NAME=]COMMAND`, that has so many seconds for an answer.
///
/// # Errors
/// If there is no such program, or it does not follow the protocol.
pub fn runner(command: &str, limit_s: f64) -> anyhow::Result<Choice> {
    let program = Program::new(command, Duration::from_secs_f64(limit_s));
    let program = program.map_err(|problem| anyhow::anyhow!("--runner {command:?}: {problem}"))?;
    Ok(Choice::of_program(program))
}

/// Whether a structure is none of this suite's: another crate's, or a program.
pub fn is_brought(name: &str, triangle_test: &str) -> bool {
    Registry::builtin().find(name, triangle_test).is_none()
}

/// What is named, with [`ALL`] spelt out; every name if there is nothing.
pub fn specs(registry: &Registry, named: &[String]) -> Vec<String> {
    let names = || registry.names().into_iter().map(String::from);
    if named.is_empty() {
        return names().collect();
    }
    named
        .iter()
        .flat_map(|spec| if spec.eq_ignore_ascii_case(ALL) { names().collect() } else { vec![spec.clone()] })
        .collect()
}

/// The structures named, or the first of every name; the same one twice would only take time.
///
/// # Errors
/// If a name, key or value is not known.
pub fn structures(registry: &Registry, named: &[String]) -> anyhow::Result<Vec<Choice>> {
    structures_at(registry, named, None)
}

/// As [`structures`]; those that have the quality and are named without one get it, as if it had been named.
///
/// # Errors
/// As [`structures`].
pub fn structures_at(registry: &Registry, named: &[String], quality: Option<&str>) -> anyhow::Result<Vec<Choice>> {
    let at = |spec: String| {
        let Some(quality) = quality else { return spec };
        let separator = if spec.contains(':') { ',' } else { ':' };
        let better = format!("{spec}{separator}quality={quality}");
        if spec.contains("quality=") || registry.choose(&better).is_err() { spec } else { better }
    };
    let choices = specs(registry, named).into_iter().map(|spec| structure(registry, &at(spec)));
    Ok(each_once_by(choices.collect::<anyhow::Result<Vec<_>>>()?, |one, other| one.label == other.label))
}

/// One structure.
///
/// # Errors
/// As [`structures`].
pub fn structure(registry: &Registry, spec: &str) -> anyhow::Result<Choice> {
    Ok(registry.choose(spec)?)
}

/// Refuses names that are no triangle test of any structure.
///
/// # Errors
/// If there is one, listing those there are.
pub fn known_tests(registry: &Registry, tests: &[String]) -> anyhow::Result<()> {
    let mut known: Vec<&str> = registry.entries().iter().map(|entry| entry.triangle_test).collect();
    known.sort_unstable();
    known.dedup();
    for test in tests {
        anyhow::ensure!(
            known.iter().any(|known| known.eq_ignore_ascii_case(test)),
            "there is no triangle test {test:?}{}; the tests are: {}",
            suggestion(test, known.iter().copied()),
            known.join(", ")
        );
    }
    Ok(())
}

/// The structure that tells where secondary rays start: the SAH tree, or the first of a registry without it.
///
/// # Errors
/// If the registry is empty.
pub fn guide(registry: &Registry) -> anyhow::Result<Choice> {
    let guide = registry.choose(SAH_TREE).ok().or_else(|| registry.all().into_iter().next());
    guide.context("no structure is registered: register one with `Registry::with`")
}

/// Structures on the command line.
#[derive(Clone, Debug, Default, clap::Args)]
#[command(next_help_heading = super::STRUCTURES)]
pub struct Structures {
    /// Structure with options (see `sahara list NAME`); may be repeated, `all` is one of each name [default: the study's]
    #[arg(long, short, value_name = "NAME[:key=value,..]")]
    pub structure: Vec<String>,
    /// Default build quality of eight-wide trees
    #[arg(long, value_parser = QUALITIES)]
    pub quality: Option<String>,
}

impl Structures {
    /// Those named, else `own`, else one of each name.
    ///
    /// # Errors
    /// If a structure is not known.
    pub fn chosen(&self, registry: &Registry, own: &[&str]) -> anyhow::Result<Vec<StructureRequest>> {
        let own: Vec<String> = own.iter().map(|&name| name.into()).collect();
        let named = if self.structure.is_empty() { &own } else { &self.structure };
        Ok(structures_at(registry, named, self.quality.as_deref())?.iter().map(Into::into).collect())
    }

    /// Whether the structure of this name is left out among so many triangles: it would take minutes, and was not
    /// named.
    pub fn leaves_out(&self, name: &str, triangles: usize) -> bool {
        name == BRUTE_FORCE && is_large(triangles) && !self.names_brute_force()
    }

    /// Whether brute force is named: `all` does not.
    pub fn names_brute_force(&self) -> bool {
        self.structure.iter().any(|spec| bare(spec).eq_ignore_ascii_case(BRUTE_FORCE))
    }
}

/// The structures and, for the A/A noise, the twin of one of them: of the SAH tree, or else of the first that is
/// neither brute force nor the report's tree, which take long, or else of the first.
pub fn with_twin(mut structures: Vec<StructureRequest>) -> Vec<StructureRequest> {
    let slow = |structure: &&StructureRequest| [BRUTE_FORCE, REPORT_TREE].contains(&structure.name());
    let sah = structures.iter().find(|structure| structure.name() == SAH_TREE);
    let twin = sah.or_else(|| structures.iter().find(|structure| !slow(structure))).or(structures.first());
    structures.extend(twin.map(|twin| StructureRequest { role: TWIN.into(), ..twin.clone() }));
    structures
}

/// Among more triangles brute force takes ten milliseconds and more for a ray: it is run only where it is named.
const MANY: usize = 1 << 22;

/// Whether so many triangles are so many that what grows with each of them is sampled or left out.
pub fn is_large(triangles: usize) -> bool {
    triangles > MANY
}

/// Said of a scene with so many.
pub fn left_out(scene: &Scene) -> String {
    format!(
        "{}: {BRUTE_FORCE} is skipped (minutes on so many triangles); pass --structure {BRUTE_FORCE} to run it",
        scene.name
    )
}

/// Why a baseline may give wrong answers: a defect of its own that is known and described, so that wrong answers are
/// shown and do not end a run with the status of ours. Nothing for all other structures.
pub fn known_defect(structure: &str) -> Option<&'static str> {
    match structure {
        "obvhs-bvh2" | "obvhs-cwbvh" => Some(
            "obvhs 0.4.0 tests triangles in single precision, clamps the inverse of small direction components and \
             loses rays in the plane of a box face; its CwBvh also loses rays with a component of -0.0",
        ),
        "bvh" => Some(
            "bvh 0.13 loses rays in the plane of a box face, its triangle test uses absolute epsilons, and its stack \
             holds 32 nodes",
        ),
        "parry" => Some(
            "parry3d 0.31 clamps the inverse of small direction components and loses rays in the plane of a box face",
        ),
        "tinybvh" => Some(
            "tinybvh 1.6 does not widen boxes, suffers cancellation far from the origin, rejects small determinants \
             and divides approximately",
        ),
        "embree" => Some(
            "Embree without ROBUST does not widen boxes; it loses hits far from the origin, rays in the plane of a box \
             face and hits at the ray origin",
        ),
        "embree-robust" => Some("Embree loses rays in the plane of a box face and rays with very short directions"),
        _ => None,
    }
}

/// Whether a structure is one of the BVHs from outside.
pub fn is_obvhs(structure: &str) -> bool {
    structure.starts_with("obvhs-")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_field_has_a_twin_of_a_structure_that_is_not_slow() {
        let of = |names: &[&str]| -> Vec<String> {
            let chosen = names.iter().map(|&name| StructureRequest::new(name, "")).collect();
            with_twin(chosen).into_iter().map(|own| [own.spec, own.role].concat()).collect()
        };
        assert_eq!(of(&["median-kd", "sah-bvh", "sah-kd"]), ["median-kd", "sah-bvh", "sah-kd", "sah-kdtwin"]);
        assert_eq!(of(&["brute-force", "sah-bvh"]), ["brute-force", "sah-bvh", "sah-bvhtwin"]);
        assert_eq!(of(&["median-kd"]), ["median-kd", "median-kdtwin"]);
        assert!(of(&[]).is_empty());
    }

    #[test]
    fn brute_force_is_run_in_a_large_scene_only_where_it_is_named() {
        let registry = Registry::builtin();
        let left_out = |named: &[&str], triangles| {
            let structures = Structures { structure: named.iter().map(|&name| name.into()).collect(), quality: None };
            let mut chosen = structures.chosen(&registry, &[]).unwrap();
            chosen.retain(|choice| structures.leaves_out(choice.name(), triangles));
            chosen.into_iter().map(|choice| choice.spec).collect::<Vec<_>>()
        };
        assert_eq!(left_out(&[], 10_000_000), [BRUTE_FORCE]);
        assert_eq!(left_out(&["all"], 10_000_000), [BRUTE_FORCE]);
        assert!(left_out(&[], 1_000_000).is_empty() && left_out(&["sah-kd"], 10_000_000).is_empty());
        assert!(left_out(&["all", "Brute-Force:test=exact"], 10_000_000).is_empty());
    }

    #[test]
    fn a_quality_is_that_of_the_trees_that_are_named_without_one() {
        let registry = Registry::builtin();
        let labels = |specs: &[&str], quality| -> Vec<String> {
            let specs: Vec<String> = specs.iter().map(|&spec| spec.into()).collect();
            let chosen = structures_at(&registry, &specs, quality).unwrap();
            // What a case keeps of a choice is its label.
            assert!(chosen.iter().all(|choice| registry.choose(&choice.label).unwrap().config == choice.config));
            chosen.into_iter().map(|choice| choice.label).collect()
        };
        let named = ["median-kd", "sah-hybrid", "sah-bvh:batch=packets", "sah-kd-wide:quality=balanced"];
        let fast = ["median-kd", "sah-hybrid:quality=fast", "sah-bvh:batch=packets,quality=fast", "sah-kd-wide"];
        assert_eq!(labels(&named, Some("fast")), fast);
        for quality in QUALITIES {
            let all = labels(&[ALL], Some(quality));
            let named = all.iter().filter(|label| label.contains(quality)).count();
            assert_eq!(named, if quality == "balanced" { 0 } else { 4 });
            assert!(all.iter().filter(|label| label.starts_with("sah-")).count() == 5);
        }
        assert_eq!(labels(&[ALL], None), labels(&[ALL], Some("balanced")));
        assert!(structures_at(&registry, &["octree".into()], Some("fast")).is_err());
    }
}
