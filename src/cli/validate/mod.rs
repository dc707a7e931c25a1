//! `validate`.

mod hard;
mod hit_files;
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
use crate::accel::{BuildError, DynAccel};
use crate::geometry::Ray;
use crate::registry::{Choice, Registry};
use crate::request::{self, BRUTE_FORCE, RaySource, Seconds, ViewArgs, recorded};
use crate::scene::Scene;
use crate::study::Status;
use crate::validate::{LIMIT, watched};

use reference::{DEFAULT_RAYS, ReferenceChoice};
use table::LEGEND;

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
    #[arg(long, value_name = "F.hits", conflicts_with_all = ["structure", "quality", "export_hits", "limit"])]
    hits: Option<PathBuf>,
    /// With --hits the triangle test that found them [default: an unknown one, judged by exact arithmetic]; with --hard the test of all
    /// structures that offer it, may be repeated [default: each structure's own]
    #[arg(long, short, value_name = "NAME")]
    test: Vec<String>,
    /// Write the results of --hard as JSON
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
    anyhow::ensure!(
        args.export_json.is_none() || args.hard.is_some(),
        "--export-json is for --hard: here answers are written by --export-hits"
    );
    if let Some(cases) = &args.hard {
        return hard::run(registry, args, cases, terminal);
    }
    let structures = request::structures_at(registry, &args.structure, args.quality.as_deref())?;
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
    if args.hits.is_some() || args.export_hits.is_some() {
        let ((_, scene), file) = replay.context("answers belong to rays of a file: give one with --rays F.rays")?;
        return match &args.export_hits {
            Some(output) => run.export_hits(&scene, &file, output, waiting),
            None => run.check_hits(&scene, &file, waiting),
        };
    }
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

    let mut status = Status::Right;
    for scene in &scenes {
        status = status.and(run.validate(scene, recorded.as_deref())?);
    }
    terminal.print_lines(&LEGEND.map(String::from));
    Ok(status)
}

impl Args {
    fn source(&self) -> RaySource {
        self.rays.clone().unwrap_or(RaySource::Count(DEFAULT_RAYS))
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

/// Why a structure could not be built.
#[derive(Debug, thiserror::Error)]
enum BuildFailure {
    #[error("it hangs: its builder did not end within {0} s: see --limit")]
    Hangs(f64),
    #[error(transparent)]
    Refused(#[from] BuildError),
}
