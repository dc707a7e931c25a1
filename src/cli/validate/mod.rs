//! `validate`.

mod against;
mod answers;
mod exchange;
mod hard;
mod table;

use std::ffi::OsString;
use std::path::PathBuf;
use std::sync::Arc;
use std::time::Duration;

use anyhow::Context;

use super::progress::Waiting;
use super::terminal::Terminal;
use crate::accel::DynAccel;
use crate::geometry::Ray;
use crate::registry::{Choice, Registry};
use crate::report::number::plural;
use crate::scene::{Sampling, Scene, Workload, WorkloadKind};
use crate::study::args::Structures;
use crate::study::{BRUTE_FORCE, documented_defect, left_out};
use crate::study::{RaySource, Seconds, Status, ViewArgs, replayed, sources};
use crate::validate::{LIMIT, Stratum, Validation, validate_watched, watched};

use against::{ASKED, Against, Known, References};
use table::{LEGEND, note_on_reference, print, row, set_apart};

pub use hard::{CHILD, ChildArgs, described, run_child};

#[derive(Debug, clap::Args)]
pub struct Args {
    /// Built-in scenes, scene files (.toml) and mesh files; all built-in scenes if none is named
    #[arg(value_name = "SCENE|FILE")]
    scenes: Vec<OsString>,
    #[command(flatten)]
    from: ViewArgs,
    /// A structure, with keys that differ from their defaults; may be repeated [default: all, one of each name]
    #[arg(long, short, value_name = "NAME[:key=value,..]")]
    structure: Vec<String>,
    /// How much time the builds of eight-wide trees may take, where a structure is named without a quality of its own
    #[arg(long, value_parser = sources::QUALITIES)]
    quality: Option<String>,
    /// Rays of each scene, shared out among the kinds, or a file of rays to replay; of a file, and of the default, fewer where brute
    /// force would take minutes [default: 10000]
    #[arg(long, value_name = "N|F.rays")]
    rays: Option<RaySource>,
    /// What is right: `brute-force` with each structure's own triangle test, or another structure (also `brute-force:test=exact`),
    /// judged by exact arithmetic where the two differ
    #[arg(long, value_name = "NAME[:key=value,..]", default_value = BRUTE_FORCE)]
    against: String,
    /// Rays that break traversals, in place of those of the workloads
    #[arg(long, conflicts_with_all = ["ray", "camera", "inside", "size"])]
    adversarial: bool,
    /// Hard cases by name or number, in place of scenes: what ray tracers are known to get wrong, each structure in a process of its
    /// own; all cases if none is named (see `sahara list hard`)
    #[arg(long, value_name = "CASE", num_args = 0.., conflicts_with_all = [
        "scenes", "ray", "adversarial", "hits", "export_hits", "against", "seed", "camera", "inside", "size",
    ])]
    hard: Option<Vec<String>>,
    /// Ask this ray alone, and print what every structure answers; may be repeated
    #[arg(long, value_name = "ox,oy,oz dx,dy,dz", allow_hyphen_values = true, value_parser = Ray::parse_valid,
        conflicts_with_all = ["rays", "seed", "camera", "inside", "size"])]
    ray: Vec<Ray>,
    /// Hold the answers of a file, to the rays of the file of --rays, against the reference, in place of structures
    #[arg(long, value_name = "F.hits", conflicts_with_all = ["structure", "quality", "export_hits", "limit"])]
    hits: Option<PathBuf>,
    /// The triangle test of the answers of --hits [default: one of their own, judged by exact arithmetic]; with --hard the test of all
    /// structures that are offered over it, may be repeated [default: each structure's own]
    #[arg(long, short, value_name = "NAME")]
    test: Vec<String>,
    /// Write the results of --hard as JSON
    #[arg(long, value_name = "FILE")]
    export_json: Option<PathBuf>,
    /// Write the answers of the one structure to the rays of the file of --rays
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
    let structures = sources::structures_at(registry, &args.structure, args.quality.as_deref())?;
    let against = Against::named(registry, &args.against)?;
    let waiting = Waiting::show("loads scenes".into(), terminal);
    let replay = replayed(&args.source(), &args.scenes)?;
    if replay.is_some() {
        args.from.is_unasked()?;
    }
    anyhow::ensure!(
        replay.is_none() || args.seed.is_none() && !args.adversarial,
        "the rays are those of the file: leave --adversarial and --seed out"
    );
    if args.hits.is_some() || args.export_hits.is_some() {
        let (scene, file) = replay.context("answers belong to rays of a file: give one with --rays F.rays")?;
        return match &args.export_hits {
            Some(output) => exchange::export(&scene, &file, &structures, args, output, waiting, terminal),
            None => exchange::check(registry, args, &scene, &file, &against, waiting, terminal),
        };
    }
    let (scenes, recorded) = match replay {
        Some((scene, file)) => (vec![scene], Some(file.workload.rays)),
        None => {
            // Other rays start wherever the scene is seen from.
            let is_seen = args.ray.is_empty() && !args.adversarial;
            let seen = |scene| if is_seen { args.from.of(scene) } else { Ok(scene) };
            let scenes = sources::scenes(&args.scenes)?.into_iter().map(seen);
            (scenes.collect::<anyhow::Result<_>>()?, None)
        }
    };
    drop(waiting);

    let mut verdict = Status::Right;
    for scene in &scenes {
        let mut notes = scene.notes.clone();
        let rays = match &recorded {
            Some(recorded) => {
                let (asked, some) = against.sample(recorded, scene.mesh.len());
                notes.extend(some);
                asked
            }
            None if args.ray.is_empty() => {
                let _waiting = Waiting::show(format!("{} makes rays", scene.name), terminal);
                rays(scene, registry, args, &against)?
            }
            None => args.ray.clone(),
        };
        let (mut rows, mut answered, mut hits) = (vec![], vec![], vec![]);
        let asked = against.affordable(scene.mesh.len());
        if recorded.is_none() && args.rays.is_none() && args.ray.is_empty() && asked < ASKED {
            notes.push(format!(
                "about {asked} rays, since brute force would take minutes for {ASKED}: --rays asks for more"
            ));
        }
        let asked = Structures { structure: args.structure.clone(), quality: None };
        let mut references = References::new(scene, &against, &rays);
        for choice in &structures {
            if asked.leaves_out(choice, scene.mesh.len()) {
                notes.push(left_out(scene));
                continue;
            }
            let waiting = Waiting::show(String::new(), terminal);
            match check(&mut references, choice, args, &waiting)? {
                Taken::Compared(accel, found) => {
                    match documented_defect(&choice.entry.name) {
                        _ if !against.refutes(&found) => {}
                        None => verdict = Status::Wrong,
                        Some(defect) => notes.push(format!(
                            "{}: its documented defects, which do not change the exit status: {defect}",
                            choice.label
                        )),
                    }
                    if !args.ray.is_empty() {
                        answered.extend(answers::answers(&choice.label, &accel, &rays, &scene.mesh, args.limit()));
                    }
                    rows.push(row(&choice.label, choice.triangle_test(), &found));
                    hits.push(found.hits);
                    notes.extend(declined(choice, &found));
                    notes.extend(found.worst.iter().map(|worst| format!("{}: {worst}", choice.label)));
                    notes.extend(note_on_reference(&choice.label, &found));
                }
                Taken::Hangs => {
                    verdict = Status::Wrong;
                    rows.push(set_apart(choice, "hangs"));
                    let limit = args.build_limit(scene.mesh.len()).as_secs_f64();
                    notes.push(format!("{}: its builder did not end within {limit} s: see --limit", choice.label));
                }
                Taken::Refused(reason) => {
                    if verdict == Status::Right {
                        verdict = Status::Refused;
                    }
                    rows.push(set_apart(choice, "refused"));
                    notes.push(format!("{}: {reason}", choice.label));
                }
            }
        }
        if args.ray.is_empty() && !hits.is_empty() && hits.iter().all(|&hits| hits == 0) {
            notes.push("No ray hits anything by the reference: no hit could be lost, and this shows little.".into());
        }
        print(scene, &rays, &against, rows, notes, terminal);
        if !args.ray.is_empty() {
            terminal.print_table(&answers::table(&scene.name, answered));
        }
    }
    terminal.print_lines(&LEGEND.map(String::from));
    Ok(verdict)
}

impl Args {
    fn source(&self) -> RaySource {
        self.rays.clone().unwrap_or(RaySource::Count(ASKED))
    }

    fn seed(&self) -> u64 {
        self.seed.unwrap_or(1)
    }

    fn limit(&self) -> Duration {
        self.limit.duration()
    }

    /// What a build over so many triangles may take.
    fn build_limit(&self, triangles: usize) -> Duration {
        self.limit() * u32::try_from(1 + triangles / 1_000_000).unwrap_or(u32::MAX)
    }
}

/// Of every kind the same number, at least one.
fn rays(scene: &Scene, registry: &Registry, args: &Args, against: &Against) -> anyhow::Result<Vec<Ray>> {
    let number = match &args.rays {
        Some(source) => source.clone(),
        None => RaySource::Count(against.affordable(scene.mesh.len())),
    };
    if args.adversarial {
        let each = number.number()?.div_ceil(Stratum::ALL.len());
        return Ok(Stratum::ALL.iter().flat_map(|stratum| stratum.rays(&scene.mesh, each, args.seed())).collect());
    }
    let guide = sources::guide(registry)?.build(&scene.mesh)?;
    let limit = number.count().div_ceil(WorkloadKind::ALL.len());
    let sampling = Sampling::some(scene, limit, args.seed());
    let of_kind = |&kind| Workload::new(scene, kind, &sampling, guide.as_ref()).rays;
    Ok(WorkloadKind::ALL.iter().flat_map(of_kind).collect())
}

enum Taken {
    Compared(Arc<dyn DynAccel>, Validation),
    /// Its builder does not end.
    Hangs,
    /// It cannot be built; the sentence says why.
    Refused(String),
}

fn check(references: &mut References, choice: &Choice, args: &Args, waiting: &Waiting) -> anyhow::Result<Taken> {
    let Known { reference, answers } = references.of(choice.triangle_test(), waiting)?;
    let (scene, rays) = (references.scene, references.rays);
    waiting.says(format!("{} builds {}", scene.name, choice.label));
    let (own, mesh) = (choice.clone(), Arc::clone(&scene.mesh));
    // A panic of the builder is caught by the registry: what ends without a result hangs.
    let Ok(built) = watched(args.build_limit(scene.mesh.len()), move || own.build(&mesh)) else {
        return Ok(Taken::Hangs);
    };
    let accel: Arc<dyn DynAccel> = match built {
        Ok(accel) => Arc::from(accel),
        Err(error) => return Ok(Taken::Refused(error.to_string())),
    };
    waiting.says(format!("{} checks {}", scene.name, choice.label));
    let found = validate_watched(&accel, &reference, &answers, &scene.mesh, rays, args.limit());
    Ok(Taken::Compared(accel, found))
}

/// What a structure was not asked.
fn declined(choice: &Choice, found: &Validation) -> Option<String> {
    let can = choice.entry.capabilities;
    let what = can.declined();
    let rays = match found.declined {
        0 => String::new(),
        n => format!(": {} not asked", plural(n as usize, "ray")),
    };
    (!what.is_empty()).then(|| format!("{} declines {}{rays}", choice.label, what.join(", ")))
}
