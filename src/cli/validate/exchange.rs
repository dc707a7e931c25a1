//! Answers in files: those of a structure of ours for others, and those of others held against the reference.

use std::path::Path;

use anyhow::Context;

use super::{Args, print, reference, row};
use crate::accel::Query;
use crate::cli::terminal::Terminal;
use crate::cli::{Verdict, sources};
use crate::geometry::Hit;
use crate::output::OutputFile;
use crate::registry::{Choice, Registry};
use crate::report::number::plural;
use crate::scene::Scene;
use crate::scene::files::{HitFile, RayFile};
use crate::validate::{validate_answers, validate_any_answers};

/// Writes the answers of one structure.
pub fn export(
    scene: &Scene,
    file: &RayFile,
    structures: &[Choice],
    output: &Path,
    terminal: &Terminal,
) -> anyhow::Result<Verdict> {
    let [choice] = structures else {
        anyhow::bail!("a file holds the answers of one structure: name one with --structure");
    };
    let output = OutputFile::check(output)?;
    let accel = choice.build(&scene.mesh)?;
    let rays = &file.workload.rays;
    let can = accel.capabilities();
    let declined = rays.iter().find_map(|ray| can.declines(ray));
    let declined = declined.or((file.workload.query == Query::Any && !can.any_hit).then_some("any hit"));
    if let Some(what) = declined {
        anyhow::bail!("{} declines {what}, which these rays need", choice.label);
    }
    let mut hits = vec![None; rays.len()];
    match file.workload.query {
        Query::Closest => accel.closest_hits(rays, &mut hits),
        Query::Any => {
            let mut any = vec![false; rays.len()];
            accel.any_hits(rays, &mut any);
            hits = any.into_iter().map(|any| any.then(|| Hit::new(0.0, 0))).collect();
        }
    }
    HitFile::new(&file.workload, hits).write(&output)?;
    let what = plural(rays.len(), "answer");
    terminal.print(&format!(
        "{}: {what} of {} to the rays {}\n",
        output.path().display(),
        choice.label,
        file.workload.hash()
    ))?;
    Ok(Verdict::Right)
}

/// Holds the answers of a file against the reference.
pub fn check(
    registry: &Registry,
    args: &Args,
    scene: &Scene,
    file: &RayFile,
    against: &Choice,
    terminal: &Terminal,
) -> anyhow::Result<Verdict> {
    let path = args.hits.as_deref().context("the caller has seen it")?;
    let test = args.test.as_deref().unwrap_or("own");
    sources::known_tests(registry, args.test.as_slice())?;
    let answers = HitFile::read(path)?;
    let name = path.display().to_string();
    let found = answers.answers(&file.workload).map_err(|problem| anyhow::anyhow!("{name}: {problem}"))?;
    let reference = reference(scene, test, against)?;
    let rays = &file.workload.rays;
    let found = match answers.query() {
        Query::Closest => validate_answers(&reference, &scene.mesh, rays, found),
        Query::Any => {
            let found: Vec<bool> = found.iter().map(Option::is_some).collect();
            validate_any_answers(&reference, &scene.mesh, rays, &found)
        }
    };
    let notes = scene.notes.iter().cloned().chain(found.worst.iter().map(|worst| format!("{name}: {worst}"))).collect();
    print(scene, rays, against, vec![row(&name, test, &found)], notes, terminal)?;
    Ok(if found.errors() > 0 { Verdict::Wrong } else { Verdict::Right })
}
