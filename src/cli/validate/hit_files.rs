//! Exports a structure's hits to a file, and checks the hits of a file.

use std::path::Path;
use std::sync::Arc;

use anyhow::Context;
use indicatif::ProgressBar;

use super::Run;
use super::outcome::Outcome;
use super::reference::closest_hits;
use super::table::{note_on_reference, scene_table};
use crate::accel::Query;
use crate::escaped::Escaped as _;
use crate::geometry::{Hit, Ray};
use crate::report::number::plural;
use crate::request;
use crate::scene::Scene;
use crate::scene::files::{HitFile, RayFile, RaysId};
use crate::study::Status;
use crate::validate::{ExpectedHits, has_replied, validate_any_hits, validate_hits, watched};

/// Rays per batch. The rays of a batch share one time limit.
const BATCH: usize = 256;

impl Run<'_> {
    pub fn export_hits(
        &self,
        scene: &Scene,
        file: &RayFile,
        to: &Path,
        waiting: ProgressBar,
    ) -> anyhow::Result<Status> {
        let (args, workload) = (self.args, &file.workload);
        let [choice] = &self.structures[..] else {
            anyhow::bail!("a hit file contains the hits of one structure: name one with --structure");
        };
        let output = request::output(self.registry, to, &args.scenes, args.source().file())?;
        let label = &choice.label;
        let accel = args.build(choice, scene, &waiting).with_context(|| format!("cannot build {label}"))?;
        let can = accel.capabilities();
        let declined = workload.rays.iter().find_map(|ray| can.declines(ray));
        if let Some(what) = declined.or((workload.query == Query::Any && !can.any_hit).then_some("any hit")) {
            anyhow::bail!("{label} declines {what}, which these rays need: name another structure");
        }
        let rays = workload.rays.len();
        waiting.set_message(format!("{}: tracing {} with {label}", scene.name, plural(rays, "ray")));
        let (mut hits, limit) = (vec![], args.query_limit(accel.as_ref()));
        for batch in workload.rays.chunks(BATCH) {
            let (accel, query, batch) = (Arc::clone(&accel), workload.query, batch.to_vec());
            let traced = watched(limit, move || match query {
                Query::Closest => accel.closest(&batch),
                Query::Any => accel.any(&batch).into_iter().map(|any| any.then(|| Hit::new(0.0, 0))).collect(),
            });
            let advice = || format!("{label}: run the same command without --export-hits to find the ray");
            hits.extend(traced.with_context(advice)?);
        }
        has_replied(accel.as_ref()).with_context(|| label.clone())?;
        HitFile::new(workload, hits).write(&output)?;
        drop(waiting);
        let (path, results, hash) = (output.path.escaped(), plural(rays, "result"), workload.hash());
        self.terminal.print(&format!("{path}: {results} of {label}; hash of the rays {hash}\n"));
        Ok(Status::Right)
    }

    pub fn check_hits(&self, scene: &Scene, file: &RayFile, waiting: ProgressBar) -> anyhow::Result<Outcome> {
        let (args, choice) = (self.args, &self.reference);
        let path = args.hits.as_deref().context("--hits is missing")?;
        anyhow::ensure!(args.test.len() < 2, "a hit file has one triangle test: name one");
        let test = args.test.first().map_or("own", String::as_str);
        request::known_tests(self.registry, &args.test)?;
        let hit_file = HitFile::read(path)?;
        let name = path.escaped().to_string();
        let rays = RaysId::of(&file.workload);
        let hits = hit_file.hits_of(&rays).map_err(|problem| anyhow::anyhow!("{name}: {problem}"))?;
        let recorded: Vec<(Ray, Option<Hit>)> = file.workload.rays.iter().copied().zip(hits.iter().copied()).collect();
        let (sample, note) = choice.sample(&recorded, scene.mesh.len());
        let (rays, hits): (Vec<Ray>, Vec<Option<Hit>>) = sample.into_iter().unzip();
        let reference = choice.build(scene, test)?;
        let reference_name = choice.name_for_file(&reference, test);
        let expected = closest_hits(&reference, scene, &rays, &reference_name, &waiting);
        let expected = ExpectedHits { reference: &reference, mesh: &scene.mesh, rays: &rays, hits: &expected };
        let found = match hit_file.rays.query {
            Query::Closest => validate_hits(&expected, &hits),
            Query::Any => validate_any_hits(&expected, &hits.iter().map(Option::is_some).collect::<Vec<bool>>(), None),
        };
        drop(waiting);
        let mut notes: Vec<String> =
            scene.notes.iter().cloned().chain(note).chain(note_on_reference(&name, &found)).collect();
        let mut faults: Vec<String> = found.worst.iter().map(|worst| format!("{name}: {worst}")).collect();
        notes.extend(faults.drain(faults.len().min(1)..));
        let outcome = Outcome {
            scene: scene.name.clone(),
            label: name,
            triangle_test: test.into(),
            is_external: true,
            has_known_defect: false,
            found: Ok(found),
        };
        let outcomes = std::slice::from_ref(&outcome);
        self.terminal.print_table(&scene_table(scene, &rays, &reference_name, outcomes, faults));
        self.terminal.print_notes(notes);
        Ok(outcome)
    }
}
