//! Compares structures with the reference in one scene.

use std::collections::BTreeMap;

use super::Run;
use super::outcome::Outcome;
use super::reference::{DEFAULT_RAYS, References};
use super::table::{answer_table, answers, note_on_reference, scene_table};
use crate::cli::progress::spinner;
use crate::geometry::Ray;
use crate::registry::Choice;
use crate::report::number::plural;
use crate::request::{self, RaySource, Structures, brute_force_note, known_defect};
use crate::scene::{Sampling, Scene, Workload, WorkloadKind};
use crate::validate::{ExpectedHits, Stratum, validate_remote, validate_watched};

impl Run<'_> {
    /// `recorded` contains the rays of a ray file.
    pub fn validate(&self, scene: &Scene, recorded: Option<&[Ray]>) -> anyhow::Result<Vec<Outcome>> {
        let Self { args, terminal, .. } = self;
        let triangles = scene.mesh.len();
        let (mut notes, mut shown) = (scene.notes.clone(), vec![]);
        let rays = self.rays(scene, recorded, &mut notes)?;
        let named = Structures { structure: args.structure.clone(), quality: None };
        let mut references = References { scene, rays: &rays, choice: &self.reference, known: BTreeMap::new() };
        let (mut outcomes, mut of_structures) = (vec![], vec![]);
        for choice in &self.structures {
            if args.runner.is_empty() && named.leaves_out(&choice.entry.name, triangles) {
                notes.push(brute_force_note(scene));
                continue;
            }
            let waiting = spinner(String::new(), terminal);
            let (reference, expected) = references.get(choice.triangle_test(), &waiting)?;
            let found = args.build(choice, scene, &waiting).and_then(|accel| {
                waiting.set_message(format!("{}: checking {}", scene.name, choice.label));
                let limit = args.query_limit(accel.as_ref());
                if !args.ray.is_empty() {
                    of_structures.push(answers(&choice.label, &accel, &rays, &scene.mesh, limit));
                }
                match accel.remote() {
                    Some(_) => {
                        let expected = ExpectedHits { reference, mesh: &scene.mesh, rays: &rays, hits: expected };
                        Ok(validate_remote(accel.as_ref(), &expected)?)
                    }
                    None => Ok(validate_watched(&accel, reference, expected, &scene.mesh, &rays, limit)),
                }
            });
            let outcome = Outcome::new(&scene.name, choice, found);
            notes.extend(notes_on(choice, &outcome));
            shown.extend(fault(choice, &outcome));
            outcomes.push(outcome);
        }
        let hits: Vec<u64> = outcomes.iter().filter_map(|own| Some(own.found.as_ref().ok()?.hits)).collect();
        if args.ray.is_empty() && !hits.is_empty() && hits.iter().all(|&hits| hits == 0) {
            shown.push("No ray hits anything in the reference, so this run cannot find lost hits.".into());
        }
        terminal.print_table(&scene_table(scene, &rays, &self.reference, &outcomes, shown));
        terminal.print_notes(notes.into_iter().map(|note| format!("{}: {note}", scene.name)));
        if !args.ray.is_empty() {
            terminal.print_table(&answer_table(&scene.name, &of_structures));
        }
        Ok(outcomes)
    }

    fn rays(&self, scene: &Scene, recorded: Option<&[Ray]>, notes: &mut Vec<String>) -> anyhow::Result<Vec<Ray>> {
        let Self { registry, args, reference, terminal, .. } = self;
        if let Some(recorded) = recorded {
            let (sample, note) = reference.sample(recorded, scene.mesh.len());
            notes.extend(note);
            return Ok(sample);
        }
        if !args.ray.is_empty() {
            return Ok(args.ray.clone());
        }
        let _waiting = spinner(format!("{}: generating rays", scene.name), terminal);
        let affordable = reference.affordable(scene.mesh.len());
        if args.rays.is_none() && affordable < DEFAULT_RAYS {
            notes.push(format!(
                "only about {affordable} rays: brute force would take minutes for {DEFAULT_RAYS}; --rays sets the number"
            ));
        }
        let number = args.rays.clone().unwrap_or(RaySource::Count(affordable));
        let seed = args.seed.unwrap_or(1);
        if args.adversarial {
            let each = number.number()?.div_ceil(Stratum::ALL.len());
            let of_stratum = |stratum: Stratum| stratum.rays(&scene.mesh, each, seed);
            return Ok(Stratum::ALL.into_iter().flat_map(of_stratum).collect());
        }
        let tracer = request::secondary_ray_structure(registry)?.build(&scene.mesh)?;
        let limit = number.count().div_ceil(WorkloadKind::ALL.len());
        let sampling = Sampling::some(scene, limit, seed);
        let of_kind = |&kind| Workload::new(scene, kind, &sampling, tracer.as_ref()).rays;
        Ok(WorkloadKind::ALL.iter().flat_map(of_kind).collect())
    }
}

fn fault(choice: &Choice, outcome: &Outcome) -> Option<String> {
    let fault = match &outcome.found {
        Ok(_) if outcome.has_known_defect => None,
        Ok(found) => found.worst.first().map(ToString::to_string),
        Err(failure) => Some(failure.to_string()),
    };
    fault.map(|fault| format!("{}: {fault}", choice.label))
}

fn notes_on(choice: &Choice, outcome: &Outcome) -> Vec<String> {
    let Ok(found) = &outcome.found else { return vec![] };
    let label = &choice.label;
    let defect = known_defect(&choice.entry.name).filter(|_| found.errors() > 0);
    let defect = defect.map(|defect| format!("{label}: known defects (they do not change the exit status): {defect}"));
    let declined = choice.entry.capabilities.declined().join(", ");
    let not_traced = match found.declined {
        0 => String::new(),
        n => format!(": {} not traced", plural(n as usize, "ray")),
    };
    let declines = (!declined.is_empty()).then(|| format!("{label} declines {declined}{not_traced}"));
    let notes = [defect, declines, note_on_reference(label, found)].into_iter().flatten();
    let others = found.worst.iter().skip(usize::from(!outcome.has_known_defect));
    notes.chain(others.map(|worst| format!("{label}: {worst}"))).collect()
}
