//! Selection of structures.

use anyhow::Context;
use serde::{Deserialize, Serialize};

use super::runners::{RunnerRequest, runner};
use crate::names::suggestion;
use crate::registry::{Choice, Registry};
use crate::report::words::{bare, each_once_by};
use crate::scene::Scene;

pub const BRUTE_FORCE: &str = "brute-force";

pub const REPORT_TREE: &str = "median-kd";

pub const SAH_TREE: &str = "sah-kd";

/// The word that selects one structure of every name.
pub const ALL: &str = "all";

/// The role of the second build of a structure, which measures the A/A noise.
pub const TWIN: &str = "twin";

pub const QUALITIES: [&str; 3] = ["fast", "balanced", "high"];

#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct StructureRequest {
    /// A label such as `NAME` or `NAME:key=value,..`.
    pub spec: String,
    /// The role in the study, for example [`TWIN`], or empty.
    #[serde(default, skip_serializing_if = "String::is_empty")]
    pub role: String,
    /// `None` for a structure of the registry.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub runner: Option<RunnerRequest>,
    /// A clause with the reason why the structure is not built.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub skipped: Option<String>,
}

impl StructureRequest {
    pub fn new(spec: impl Into<String>, role: impl Into<String>) -> Self {
        Self { spec: spec.into(), role: role.into(), runner: None, skipped: None }
    }

    pub fn of_runner(choice: &Choice, limit_s: f64) -> Self {
        let command = choice.command().unwrap_or_default().into();
        let runner = RunnerRequest { command, limit_s, config: choice.config.clone() };
        Self { runner: Some(runner), ..Self::from(choice) }
    }

    pub fn choose(&self, registry: &Registry) -> anyhow::Result<Choice> {
        match &self.runner {
            Some(own) => runner(&own.command, own.limit_s),
            None => Ok(registry.choose(&self.spec)?),
        }
    }

    pub fn name(&self) -> &str {
        bare(&self.spec)
    }
}

impl From<&Choice> for StructureRequest {
    fn from(choice: &Choice) -> Self {
        Self::new(choice.label.clone(), "")
    }
}

/// Whether the structure is missing from the built-in registry.
pub fn is_external(name: &str, triangle_test: &str) -> bool {
    Registry::builtin().find(name, triangle_test).is_none()
}

/// Replaces [`ALL`] by all names in the registry. If `named` is empty, returns all names in the registry.
pub fn specs(registry: &Registry, named: &[String]) -> Vec<String> {
    let all = [ALL.to_owned()];
    let specs = if named.is_empty() { &all } else { named }.iter();
    let each = specs.flat_map(|spec| if spec.eq_ignore_ascii_case(ALL) { registry.names() } else { vec![&spec[..]] });
    each.map(String::from).collect()
}

/// If `named` is empty, returns every structure with its default triangle test.
pub fn structures(registry: &Registry, named: &[String]) -> anyhow::Result<Vec<Choice>> {
    structures_at(registry, named, None)
}

/// Sets the key `quality` of every structure that accepts this key. A quality in `named` takes precedence.
pub fn structures_at(registry: &Registry, named: &[String], quality: Option<&str>) -> anyhow::Result<Vec<Choice>> {
    let at = |spec: String| {
        let Some(quality) = quality else { return spec };
        let separator = if spec.contains(':') { ',' } else { ':' };
        let better = format!("{spec}{separator}quality={quality}");
        if spec.contains("quality=") || registry.choose(&better).is_err() { spec } else { better }
    };
    let choices = specs(registry, named).into_iter().map(|spec| registry.choose(&at(spec)));
    Ok(each_once_by(choices.collect::<Result<Vec<_>, _>>()?, |one, other| one.label == other.label))
}

/// Rejects unknown names of triangle tests.
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

/// The structure whose hits are the origins of secondary rays.
pub fn secondary_ray_structure(registry: &Registry) -> anyhow::Result<Choice> {
    let structure = registry.choose(SAH_TREE).ok().or_else(|| registry.all().into_iter().next());
    structure.context("no structure is registered: register one with `Registry::with`")
}

/// Structures on the command line.
#[derive(Clone, Debug, Default, clap::Args)]
#[command(next_help_heading = super::STRUCTURES)]
pub struct Structures {
    /// Structure with options (see `sahara list NAME`); may be repeated; `all` selects every structure once [default:
    /// in `compare`, all and sah-hybrid:batch=packets; in `scaling`, median-kd, sah-kd, sah-kd-wide, sah-hybrid,
    /// sah-bvh, obvhs-bvh2 and obvhs-cwbvh]
    #[arg(long, short, value_name = "NAME[:key=value,..]")]
    pub structure: Vec<String>,
    /// Build quality of the eight-wide trees (sah-kd-wide, sah-kd-tight, sah-hybrid, sah-bvh) that do not set
    /// `quality=` [default: balanced]
    #[arg(long, value_parser = QUALITIES)]
    pub quality: Option<String>,
}

impl Structures {
    /// Returns `own` if the command line names no structure. An empty `own` selects all structures.
    pub fn chosen(&self, registry: &Registry, own: &[&str]) -> anyhow::Result<Vec<StructureRequest>> {
        let own: Vec<String> = own.iter().map(|&name| name.into()).collect();
        let named = if self.structure.is_empty() { &own } else { &self.structure };
        Ok(structures_at(registry, named, self.quality.as_deref())?.iter().map(Into::into).collect())
    }

    /// Whether to skip the structure. Brute force takes minutes on a large mesh.
    pub fn leaves_out(&self, name: &str, triangles: usize) -> bool {
        name == BRUTE_FORCE && is_large(triangles) && !self.names_brute_force()
    }

    /// Whether the command line names brute force. The word `all` does not name brute force.
    pub fn names_brute_force(&self) -> bool {
        self.structure.iter().any(|spec| bare(spec).eq_ignore_ascii_case(BRUTE_FORCE))
    }
}

/// Adds a twin, which is a second build of one structure. The SAH tree is preferred. A slow structure has a twin only
/// if all structures are slow.
pub fn with_twin(mut structures: Vec<StructureRequest>) -> Vec<StructureRequest> {
    let slow = |structure: &&StructureRequest| [BRUTE_FORCE, REPORT_TREE].contains(&structure.name());
    let sah = structures.iter().find(|structure| structure.name() == SAH_TREE);
    let twin = sah.or_else(|| structures.iter().find(|structure| !slow(structure))).or(structures.first());
    structures.extend(twin.map(|twin| StructureRequest { role: TWIN.into(), ..twin.clone() }));
    structures
}

/// Whether work proportional to the number of triangles is sampled or skipped. On a large mesh, brute force takes at
/// least ten milliseconds per ray.
pub fn is_large(triangles: usize) -> bool {
    triangles > 1 << 22
}

pub fn brute_force_note(scene: &Scene) -> String {
    format!(
        "{}: {BRUTE_FORCE} is skipped (minutes on so many triangles); pass --structure {BRUTE_FORCE} to run it",
        scene.name
    )
}

/// Wrong hits of a structure with known defects do not affect the exit status.
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
            // The label must select the configuration of the choice.
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
