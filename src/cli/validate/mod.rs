//! The command `validate`: checks hits against a reference.

mod hard;
mod hit_files;
mod outcome;
mod reference;
mod scene;
mod table;

use std::ffi::OsString;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::time::Duration;

use anyhow::Context;
use indicatif::ProgressBar;

use super::progress::spinner;
use super::terminal::Terminal;
use crate::accel::DynAccel;
use crate::geometry::Ray;
use crate::registry::{Choice, Registry};
use crate::request::{
    self, BRUTE_FORCE, OUTPUT, RAYS, RUNNER_LIMIT, RaySource, SCENES, STRUCTURES, Seconds, ViewArgs, recorded,
};
use crate::scene::Scene;
use crate::study::Status;
use crate::validate::{LIMIT, watched};

use outcome::{BuildFailure, Outcome};
use reference::{DEFAULT_RAYS, ReferenceChoice};
use table::{LEGEND, RETRACE};

pub use hard::{CHILD, ChildArgs, described, run_child};

#[derive(Debug, clap::Args)]
pub struct Args {
    /// Built-in scenes, scene files (.toml) and mesh files [default: all built-in scenes]
    #[arg(value_name = "SCENE|FILE")]
    scenes: Vec<OsString>,
    #[command(flatten)]
    from: ViewArgs,
    /// Structure with options (see `sahara list NAME`); may be repeated [default: one of each name]
    #[arg(long, short, help_heading = STRUCTURES, value_name = "NAME[:key=value,..]")]
    structure: Vec<String>,
    /// External program, with arguments, to check as a structure; NAME is its name in tables; may be repeated
    #[arg(long, help_heading = STRUCTURES, value_name = "[NAME=]COMMAND", allow_hyphen_values = true)]
    runner: Vec<String>,
    /// Timeout in seconds for each reply of an external program, including builds
    #[arg(long, help_heading = STRUCTURES, value_name = "SECONDS", requires = "runner", default_value_t = RUNNER_LIMIT, allow_negative_numbers = true)]
    runner_limit: Seconds,
    /// Build quality of the eight-wide trees (sah-kd-wide, sah-kd-tight, sah-hybrid, sah-bvh) that do not set
    /// `quality=` [default: balanced]
    #[arg(long, help_heading = STRUCTURES, value_parser = request::QUALITIES)]
    quality: Option<String>,
    /// Rays per scene, divided among the workloads, or a ray file to replay [default: 10000, or fewer if brute force
    /// would take minutes]
    #[arg(long, help_heading = RAYS, value_name = "N|F.rays")]
    rays: Option<RaySource>,
    /// Reference: `brute-force` with each structure's own triangle test, or another structure, e.g.
    /// `brute-force:test=exact`; exact arithmetic decides where the two differ
    #[arg(long, help_heading = STRUCTURES, value_name = "NAME[:key=value,..]", default_value = BRUTE_FORCE)]
    against: String,
    /// Instead of the workloads, trace adversarial rays, which are made to break traversals
    #[arg(long, help_heading = RAYS, conflicts_with_all = ["ray", "camera", "inside", "size"])]
    adversarial: bool,
    /// Run hard cases (inputs that ray tracers are known to get wrong) instead of scenes; CASE is a name or a number
    /// (see `sahara list hard`). Each structure runs in its own process [default: all cases]
    #[arg(long, help_heading = SCENES, value_name = "CASE", num_args = 0.., conflicts_with_all = [
        "scenes", "ray", "adversarial", "hits", "export_hits", "against", "seed", "camera", "inside", "size",
    ])]
    hard: Option<Vec<String>>,
    /// Trace only this ray and print every structure's hit; may be repeated
    #[arg(long, help_heading = RAYS, value_name = "ox,oy,oz dx,dy,dz", allow_hyphen_values = true, value_parser = Ray::parse_valid,
        conflicts_with_all = ["rays", "seed", "camera", "inside", "size"])]
    ray: Vec<Ray>,
    /// Instead of structures, check the hits in this file, which belong to the ray file of --rays
    #[arg(long, help_heading = STRUCTURES, value_name = "F.hits", conflicts_with_all = ["structure", "runner", "quality", "export_hits", "limit"])]
    hits: Option<PathBuf>,
    /// With --hits: triangle test that produced the hits [default: unknown; exact arithmetic decides]. With --hard: use
    /// this triangle test in every structure that supports it; may be repeated [default: the default test of each
    /// structure]
    #[arg(long, short, help_heading = STRUCTURES, value_name = "NAME")]
    test: Vec<String>,
    /// Count rounding of the triangle test as a failure (status 2)
    #[arg(long, help_heading = OUTPUT)]
    strict: bool,
    /// Write verdicts, counts and the worst rays as JSON
    #[arg(long, help_heading = OUTPUT, value_name = "FILE")]
    export_json: Option<PathBuf>,
    /// Write the hits of one structure for the ray file of --rays
    #[arg(long, help_heading = OUTPUT, value_name = "F.hits", conflicts_with = "against")]
    export_hits: Option<PathBuf>,
    /// Time limit in seconds for each batch of 256 rays, for each build (plus the same again per million triangles) or,
    /// with --hard, for a whole case. A structure that exceeds it counts as hanging. External programs have
    /// --runner-limit instead
    #[arg(long, help_heading = STRUCTURES, value_name = "SECONDS", default_value_t = Seconds::whole(LIMIT.as_secs() as u32), allow_negative_numbers = true)]
    limit: Seconds,
    /// Seed of the rays [default: 1]
    #[arg(long, help_heading = RAYS, value_name = "N")]
    seed: Option<u64>,
}

/// A run of `validate` without `--hard`.
struct Run<'a> {
    registry: &'a Registry,
    args: &'a Args,
    structures: Vec<Choice>,
    reference: ReferenceChoice,
    terminal: &'a Terminal,
}

pub fn run(registry: &Registry, args: &Args, terminal: &Terminal) -> anyhow::Result<Status> {
    anyhow::ensure!(
        args.test.is_empty() || args.hard.is_some() || args.hits.is_some(),
        "--test works with --hits and --hard only: name the test with the structure, as in sah-kd:test=exact"
    );
    if let Some(cases) = &args.hard {
        return hard::run(registry, args, cases, terminal);
    }
    let structures = args.structures(registry)?;
    let output = |path: &Path| request::output(registry, path, &args.scenes, args.source().file());
    let json = args.export_json.as_deref().map(output).transpose()?;
    let reference = ReferenceChoice::named(registry, &args.against)?;
    let run = Run { registry, args, structures, reference, terminal };
    let waiting = spinner("loading scenes", terminal);
    let replay = recorded(registry, &args.source(), &args.scenes)?;
    if replay.is_some() {
        args.from.reject_unused()?;
    }
    anyhow::ensure!(
        replay.is_none() || args.seed.is_none() && !args.adversarial,
        "the file defines the rays: omit --adversarial and --seed"
    );
    if let Some(output) = &args.export_hits {
        let ((_, scene), file) = replay.context(NEEDS_RAYS)?;
        return run.export_hits(&scene, &file, output, waiting);
    }
    let outcomes = if args.hits.is_some() {
        let ((_, scene), file) = replay.context(NEEDS_RAYS)?;
        vec![run.check_hits(&scene, &file, waiting)?]
    } else {
        let (scenes, recorded) = match replay {
            Some(((_, scene), file)) => (vec![scene], Some(file.workload.rays)),
            None => {
                // Only the rays of workloads depend on the camera.
                let is_seen = args.ray.is_empty() && !args.adversarial;
                let seen = |scene| if is_seen { args.from.of(scene) } else { Ok(scene) };
                let scenes = request::scenes(registry, &args.scenes)?.into_iter().map(seen);
                (scenes.collect::<anyhow::Result<Vec<Scene>>>()?, None)
            }
        };
        drop(waiting);
        let outcomes = scenes.iter().map(|scene| run.validate(scene, recorded.as_deref()));
        outcomes.collect::<anyhow::Result<Vec<_>>>()?.into_iter().flatten().collect()
    };

    if outcomes.iter().any(Outcome::has_example) {
        terminal.print_lines([RETRACE]);
    }
    terminal.print_notes(LEGEND);
    let verdicts = outcome::verdicts(&outcomes);
    let results: Vec<_> = outcomes.iter().map(Outcome::record).collect();
    outcome::finish(&verdicts, &results, json, terminal)?;
    Ok(outcomes.iter().fold(Status::Right, |status, own| status.and(own.status(args.strict))))
}

const NEEDS_RAYS: &str = "--hits and --export-hits need a ray file: pass --rays F.rays";

impl Args {
    fn source(&self) -> RaySource {
        self.rays.clone().unwrap_or(RaySource::Count(DEFAULT_RAYS))
    }

    /// `--runner` without `--structure` checks only the runners.
    fn structures(&self, registry: &Registry) -> anyhow::Result<Vec<Choice>> {
        let mut structures = vec![];
        if self.runner.is_empty() || !self.structure.is_empty() {
            structures = request::structures_at(registry, &self.structure, self.quality.as_deref())?;
        }
        structures.extend(request::runners(registry, &self.runner, self.runner_limit.seconds())?);
        Ok(structures)
    }

    /// Runners have no query limit, because `--runner-limit` limits each reply.
    fn query_limit(&self, accel: &dyn DynAccel) -> Duration {
        if accel.remote().is_some() { Duration::MAX } else { self.limit.duration() }
    }

    fn build(&self, choice: &Choice, scene: &Scene, waiting: &ProgressBar) -> Result<Arc<dyn DynAccel>, BuildFailure> {
        waiting.set_message(format!("{}: building {}", scene.name, choice.label));
        if choice.command().is_some() {
            return Ok(Arc::from(choice.build(&scene.mesh)?));
        }
        let (own, mesh) = (choice.clone(), Arc::clone(&scene.mesh));
        let limit = self.limit.duration() * u32::try_from(1 + mesh.len() / 1_000_000).unwrap_or(u32::MAX);
        // `own.build` catches panics of the builder. `watched` therefore fails only if the build hangs.
        let built = watched(limit, move || own.build(&mesh)).map_err(|_| BuildFailure::Hangs(limit.as_secs_f64()))?;
        Ok(Arc::from(built?))
    }
}
