//! Answers in files: those of a structure of ours for others, and those of others held against the reference.

use std::path::Path;
use std::sync::Arc;

use anyhow::Context;

use super::Args;
use super::against::{Against, closest_hits};
use super::table::{note_on_reference, print, row};
use crate::accel::{DynAccel, Query};
use crate::cli::progress::Waiting;
use crate::cli::terminal::Terminal;
use crate::escaped::Escaped as _;
use crate::geometry::{Hit, Ray};
use crate::registry::{Choice, Registry};
use crate::report::number::plural;
use crate::scene::Scene;
use crate::scene::files::{HitFile, RayFile};
use crate::study::{Status, sources};
use crate::validate::{validate_answers, validate_any_answers, watched};

/// Writes the answers of one structure.
pub fn export(
    scene: &Scene,
    file: &RayFile,
    structures: &[Choice],
    args: &Args,
    output: &Path,
    waiting: Waiting,
    terminal: &Terminal,
) -> anyhow::Result<Status> {
    let [choice] = structures else {
        anyhow::bail!("a file holds the answers of one structure: name one with --structure");
    };
    let output = sources::output(output, &args.scenes, args.source().file())?;
    waiting.says(format!("{} builds {}", scene.name, choice.label));
    let (own, mesh) = (choice.clone(), Arc::clone(&scene.mesh));
    let built = watched(args.build_limit(scene.mesh.len()), move || own.build(&mesh));
    let accel: Arc<dyn DynAccel> = Arc::from(built.with_context(|| format!("the builder of {}", choice.label))??);
    let rays = &file.workload.rays;
    let can = accel.capabilities();
    let declined = rays.iter().find_map(|ray| can.declines(ray));
    let declined = declined.or((file.workload.query == Query::Any && !can.any_hit).then_some("any hit"));
    if let Some(what) = declined {
        anyhow::bail!("{} declines {what}, which these rays need", choice.label);
    }
    waiting.says(format!("{}: {} answers {}", scene.name, choice.label, plural(rays.len(), "ray")));
    let mut hits = vec![];
    for batch in rays.chunks(BATCH) {
        let (accel, query, batch) = (Arc::clone(&accel), file.workload.query, batch.to_vec());
        let answers = watched(args.limit(), move || answers(accel.as_ref(), query, &batch));
        let ray = || format!("{}: find the ray by the same command without --export-hits", choice.label);
        hits.extend(answers.with_context(ray)?);
    }
    HitFile::new(&file.workload, hits).write(&output)?;
    drop(waiting);
    let what = plural(rays.len(), "answer");
    terminal.print(&format!(
        "{}: {what} of {} to the rays {}\n",
        output.path().escaped(),
        choice.label,
        file.workload.hash()
    ));
    Ok(Status::Right)
}

/// Rays that are asked at a time, under one limit.
const BATCH: usize = 256;

fn answers(accel: &dyn DynAccel, query: Query, rays: &[Ray]) -> Vec<Option<Hit>> {
    match query {
        Query::Closest => accel.closest(rays),
        Query::Any => accel.any(rays).into_iter().map(|any| any.then(|| Hit::new(0.0, 0))).collect(),
    }
}

/// Holds the answers of a file against the reference.
pub fn check(
    registry: &Registry,
    args: &Args,
    scene: &Scene,
    file: &RayFile,
    against: &Against,
    waiting: Waiting,
    terminal: &Terminal,
) -> anyhow::Result<Status> {
    let path = args.hits.as_deref().context("the caller has seen it")?;
    anyhow::ensure!(args.test.len() < 2, "answers come from one triangle test: name one");
    let test = args.test.first().map_or("own", String::as_str);
    sources::known_tests(registry, &args.test)?;
    let answers = HitFile::read(path)?;
    let name = path.escaped().to_string();
    let found = answers.answers(&file.workload).map_err(|problem| anyhow::anyhow!("{name}: {problem}"))?;
    let recorded: Vec<(Ray, Option<Hit>)> = file.workload.rays.iter().copied().zip(found.iter().copied()).collect();
    let (asked, some) = against.sample(&recorded, scene.mesh.len());
    let (rays, found): (Vec<Ray>, Vec<Option<Hit>>) = asked.into_iter().unzip();
    let reference = against.reference(scene, test)?;
    let who = against.of_answers(&reference, test);
    let expected = closest_hits(&reference, scene, &rays, &who, &waiting);
    let found = match answers.query {
        Query::Closest => validate_answers(&reference, &expected, &scene.mesh, &rays, &found),
        Query::Any => {
            let found: Vec<bool> = found.iter().map(Option::is_some).collect();
            validate_any_answers(&reference, &expected, &scene.mesh, &rays, &found)
        }
    };
    drop(waiting);
    let worst = found.worst.iter().map(|worst| format!("{name}: {worst}"));
    let notes = scene.notes.iter().cloned().chain(some).chain(worst).chain(note_on_reference(&name, &found)).collect();
    print(scene, &rays, &who, vec![row(&name, test, &found)], notes, terminal);
    Ok(if against.refutes(&found) { Status::Wrong } else { Status::Right })
}
