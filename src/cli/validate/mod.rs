//! `validate`.

mod export;
mod hard;
mod hit_files;
mod outcome;
mod reference;
mod scene;
mod table;

use std::ffi::OsString;
use std::path::PathBuf;
use std::sync::Arc;

use anyhow::Context;
use indicatif::ProgressBar;

use super::progress::spinner;
use super::terminal::Terminal;
use crate::accel::DynAccel;
use crate::geometry::Ray;
use crate::registry::{Choice, Registry};
use crate::request::{self, BRUTE_FORCE, RaySource, Seconds, ViewArgs, recorded};
use crate::scene::Scene;
use crate::study::Status;
use crate::validate::{LIMIT, watched};

use export::Export;
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
    /// A structure, with keys that differ from their defaults; may be repeated [default: all, one of each name]
    #[arg(long, short, value_name = "NAME[:key=value,..]")]
    structure: Vec<String>,
    /// A program in another language as a structure, with its arguments; NAME is how tables call it; may be repeated
    #[arg(long, value_name = "[NAME=]COMMAND", allow_hyphen_values = true)]
    runner: Vec<String>,
    /// Default build quality of eight-wide trees
    #[arg(long, value_parser = request::QUALITIES)]
    quality: Option<String>,
    /// Rays per scene, divided among the workloads, or a file of rays to replay; by default, and of a file, fewer if brute force would
    /// take minutes [default: 10000]
    #[arg(long, value_name = "N|F.rays")]
    rays: Option<RaySource>,
    /// The reference: `brute-force` with each structure's own triangle test, or another structure (also `brute-force:test=exact`), with
    /// exact arithmetic as the judge where the two differ
    #[arg(long, value_name = "NAME[:key=value,..]", default_value = BRUTE_FORCE)]
    against: String,
    /// Trace rays that break traversals instead of the workloads
    #[arg(long, conflicts_with_all = ["ray", "camera", "inside", "size"])]
    adversarial: bool,
    /// Run hard cases instead of scenes, by name or number: what ray tracers are known to get wrong, each structure in a process of its
    /// own; without a name all cases (see `sahara list hard`)
    #[arg(long, value_name = "CASE", num_args = 0.., conflicts_with_all = [
        "scenes", "ray", "adversarial", "hits", "export_hits", "against", "seed", "camera", "inside", "size",
    ])]
    hard: Option<Vec<String>>,
    /// Trace only this ray, and print what every structure returns; may be repeated
    #[arg(long, value_name = "ox,oy,oz dx,dy,dz", allow_hyphen_values = true, value_parser = Ray::parse_valid,
        conflicts_with_all = ["rays", "seed", "camera", "inside", "size"])]
    ray: Vec<Ray>,
    /// Check the hits of this file, for the rays of the file of --rays, instead of structures
    #[arg(long, value_name = "F.hits", conflicts_with_all = ["structure", "runner", "quality", "export_hits", "limit"])]
    hits: Option<PathBuf>,
    /// With --hits the triangle test that found them [default: an unknown one, judged by exact arithmetic]; with --hard the test of all
    /// structures that offer it, may be repeated [default: each structure's own]
    #[arg(long, short, value_name = "NAME")]
    test: Vec<String>,
    /// Fail, with status 2, also where a triangle test rounds and the tree is right
    #[arg(long)]
    strict: bool,
    /// Write verdicts, counts and the worst rays as JSON
    #[arg(long, value_name = "FILE")]
    export_json: Option<PathBuf>,
    /// Write the hits of one structure for the rays of the file of --rays
    #[arg(long, value_name = "F.hits", conflicts_with = "against")]
    export_hits: Option<PathBuf>,
    /// Seconds that a structure may take for 256 rays, or for its build and for each further million triangles of it, before it counts
    /// as hanging
    #[arg(long, value_name = "SECONDS", default_value_t = Seconds::whole(LIMIT.as_secs() as u32), allow_negative_numbers = true)]
    limit: Seconds,
    /// Seed of the rays [default: 1]
    #[arg(long, value_name = "N")]
    seed: Option<u64>,
}

/// One run of the command, but for hard cases.
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
        "--test is for --hits and --hard: here name it with the structure, as in sah-kd:test=exact"
    );
    if let Some(cases) = &args.hard {
        return hard::run(registry, args, cases, terminal);
    }
    let structures = args.structures(registry)?;
    let json = args.export_json.as_deref().map(|to| request::output(registry, to, &args.scenes, args.source().file()));
    let json = json.transpose()?;
    let reference = ReferenceChoice::named(registry, &args.against)?;
    let run = Run { registry, args, structures, reference, terminal };
    let waiting = spinner("loads scenes", terminal);
    let replay = recorded(registry, &args.source(), &args.scenes)?;
    if replay.is_some() {
        args.from.is_unasked()?;
    }
    anyhow::ensure!(
        replay.is_none() || args.seed.is_none() && !args.adversarial,
        "the rays are those of the file: leave --adversarial and --seed out"
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
                // Where the scene is seen from matters to the rays of the workloads alone.
                let is_seen = args.ray.is_empty() && !args.adversarial;
                let seen = |scene| if is_seen { args.from.of(scene) } else { Ok(scene) };
                let scenes = request::scenes(registry, &args.scenes)?.into_iter().map(seen);
                (scenes.collect::<anyhow::Result<Vec<Scene>>>()?, None)
            }
        };
        drop(waiting);
        let mut outcomes = vec![];
        for scene in &scenes {
            outcomes.extend(run.validate(scene, recorded.as_deref())?);
        }
        outcomes
    };

    terminal.print_lines(&[RETRACE].map(String::from));
    if terminal.verbose {
        terminal.print_lines(&LEGEND.map(String::from));
    }
    let verdicts = outcome::verdicts(&outcomes);
    terminal.print_lines(&outcome::sentences(&verdicts));
    if let Some(file) = json {
        let results = outcomes.iter().map(Outcome::record).collect();
        file.write(&serde_json::to_vec_pretty(&Export::new(&verdicts, results))?)?;
    }
    Ok(outcomes.iter().fold(Status::Right, |status, own| status.and(own.status(args.strict))))
}

const NEEDS_RAYS: &str = "answers belong to rays of a file: give one with --rays F.rays";

impl Args {
    fn source(&self) -> RaySource {
        self.rays.clone().unwrap_or(RaySource::Count(DEFAULT_RAYS))
    }

    /// The structures to check: with --runner and without --structure the programs alone.
    fn structures(&self, registry: &Registry) -> anyhow::Result<Vec<Choice>> {
        let mut structures = vec![];
        if self.runner.is_empty() || !self.structure.is_empty() {
            structures = request::structures_at(registry, &self.structure, self.quality.as_deref())?;
        }
        for command in &self.runner {
            structures.push(request::runner(command, self.limit.seconds())?);
        }
        Ok(structures)
    }

    fn build(&self, choice: &Choice, scene: &Scene, waiting: &ProgressBar) -> Result<Arc<dyn DynAccel>, BuildFailure> {
        waiting.set_message(format!("{} builds {}", scene.name, choice.label));
        let (own, mesh) = (choice.clone(), Arc::clone(&scene.mesh));
        let limit = self.limit.duration() * u32::try_from(1 + mesh.len() / 1_000_000).unwrap_or(u32::MAX);
        // The registry catches a panic of the builder: what ends without a result hangs.
        let built = watched(limit, move || own.build(&mesh)).map_err(|_| BuildFailure::Hangs(limit.as_secs_f64()))?;
        Ok(Arc::from(built?))
    }
}
