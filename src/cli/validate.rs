//! `validate`.

use anyhow::Context;

use super::terminal::Terminal;
use super::{Verdict, sources};
use crate::geometry::Ray;
use crate::registry::{Choice, Registry};
use crate::report::number::{count, plural};
use crate::report::{Cell, Table, Tone};
use crate::scene::{Sampling, Scene, Workload, WorkloadKind};
use crate::study::{BRUTE_FORCE, guarded};
use crate::validate::{Reference, Stratum, Validation, validate};

#[derive(Debug, clap::Args)]
pub struct Args {
    /// Built-in scenes and mesh files; all built-in scenes if none is named
    #[arg(value_name = "SCENE|FILE")]
    scenes: Vec<String>,
    /// A structure, with keys that differ from their defaults; may be repeated [default: all, one of each name]
    #[arg(long, short, value_name = "NAME[:key=value,..]")]
    structure: Vec<String>,
    /// Rays of each scene, shared out among the kinds
    #[arg(long, value_name = "N", default_value_t = 10_000, value_parser = clap::value_parser!(u32).range(1..=1 << 26))]
    rays: u32,
    /// What is right: `brute-force` with each structure's own triangle test, or another structure, judged by exact
    /// arithmetic where the two differ
    #[arg(long, value_name = "NAME[:key=value,..]", default_value = BRUTE_FORCE)]
    against: String,
    /// Rays that break traversals, in place of those of the workloads
    #[arg(long)]
    adversarial: bool,
    /// Ask this ray alone; may be repeated
    #[arg(long, value_name = "ox,oy,oz dx,dy,dz", allow_hyphen_values = true)]
    ray: Vec<Ray>,
    /// Seed of the rays
    #[arg(long, value_name = "N", default_value_t = 1)]
    seed: u64,
}

pub fn run(registry: &Registry, args: &Args, terminal: &Terminal) -> anyhow::Result<Verdict> {
    let structures = sources::structures(registry, &args.structure)?;
    let against = sources::structure(registry, &args.against)?;
    let scenes = sources::scenes(&args.scenes)?;

    let mut verdict = Verdict::Right;
    for scene in &scenes {
        let rays = if args.ray.is_empty() { rays(scene, registry, args)? } else { args.ray.clone() };
        let mut rows = vec![];
        let mut notes = scene.notes.clone();
        for choice in &structures {
            let found = match check(scene, choice, &against, &rays)? {
                Ok(found) => found,
                Err(reason) => {
                    if verdict == Verdict::Right {
                        verdict = Verdict::Refused;
                    }
                    rows.push(refused(choice));
                    notes.push(format!("{}: {reason}", choice.label));
                    continue;
                }
            };
            if found.errors() > 0 {
                verdict = Verdict::Wrong;
            }
            rows.push(row(choice, &found));
            notes.extend(found.worst.iter().map(|worst| format!("{}: {worst}", choice.label)));
        }
        let stand_in = if scene.stand_ins.is_empty() { "" } else { ", stand-in" };
        let (triangles, rays) = (plural(scene.mesh.len(), "triangle"), plural(rays.len(), "ray"));
        let title = format!("{}: {triangles}{stand_in}; {rays} against {}", scene.name, against.label);
        terminal.print_table(&Table { title, columns: COLUMNS.map(String::from).into(), rows, notes })?;
    }
    terminal.print_lines(&LEGEND.map(String::from))?;
    Ok(verdict)
}

const COLUMNS: [&str; 7] =
    ["structure", "triangle test", "hits", "structure errors", "answer errors", "kernel", "ties"];

const LEGEND: [&str; 3] = [
    "structure errors: hits lost or invented although the structure's own triangle test, run over all triangles, says \
     otherwise; none in a correct structure. answer errors: wrong answers where the reference has another triangle test.",
    "kernel: differences that the triangle test is to blame for. ties: as near a hit on another triangle; no error.",
    "To ask a ray again: sahara validate SCENE --structure NAME --ray \"ox,oy,oz dx,dy,dz\"",
];

/// Of every kind the same number, at least one.
fn rays(scene: &Scene, registry: &Registry, args: &Args) -> anyhow::Result<Vec<Ray>> {
    if args.adversarial {
        let each = (args.rays as usize).div_ceil(Stratum::ALL.len());
        return Ok(Stratum::ALL.iter().flat_map(|stratum| stratum.rays(&scene.mesh, each, args.seed)).collect());
    }
    let guide = sources::guide(registry)?.build(&scene.mesh)?;
    let limit = (args.rays as usize).div_ceil(WorkloadKind::ALL.len());
    // Four pixels a ray: most kinds start where a pixel sees something.
    let pixels = u32::try_from(4 * limit).unwrap_or(u32::MAX).min(scene.size[0] * scene.size[1]);
    let sampling = Sampling { limit, ..Sampling::about(scene, pixels, args.seed) };
    let of_kind = |&kind| Workload::new(scene, kind, &sampling, guide.as_ref()).rays;
    Ok(WorkloadKind::ALL.iter().flat_map(of_kind).collect())
}

/// What was found, or why the structure takes no part.
fn check(scene: &Scene, choice: &Choice, against: &Choice, rays: &[Ray]) -> anyhow::Result<Result<Validation, String>> {
    // Brute force by its bare name shares each structure's test; with a test of its own it is a structure like any other.
    let reference = if against.label == BRUTE_FORCE {
        Reference::of_test(choice.triangle_test(), &scene.mesh)?
    } else {
        let built = against.build(&scene.mesh);
        Reference::structure(built.with_context(|| format!("{} cannot be built over {}", against.label, scene.name))?)
    };
    Ok(match choice.build(&scene.mesh) {
        Err(error) => Err(error.to_string()),
        Ok(accel) => guarded(|| validate(accel.as_ref(), &reference, &scene.mesh, rays))
            .ok_or_else(|| "its traversal panicked: ask rays one by one with --ray to find the one".into()),
    })
}

fn refused(choice: &Choice) -> Vec<Cell> {
    let mut row = vec![Cell::blank(); COLUMNS.len()];
    row[0] = choice.label.as_str().into();
    row[1] = choice.triangle_test().into();
    row[2] = Cell::from("refused").with(Tone::Wrong);
    row
}

fn row(choice: &Choice, found: &Validation) -> Vec<Cell> {
    let errors = |n: u64| Cell::from(count(n)).with(if n > 0 { Tone::Wrong } else { Tone::Plain });
    vec![
        choice.label.as_str().into(),
        choice.triangle_test().into(),
        count(found.hits).into(),
        errors(found.structure_errors + found.any_hit_errors + found.unrepeatable),
        errors(found.answer_errors),
        count(found.kernel_differences).into(),
        count(found.ties).into(),
    ]
}
