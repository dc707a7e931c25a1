//! What is known at the end, one record a case.

use super::epoch::{Tally, Trial};
use super::{Compared, twins};
use crate::measure::advice::{Conditions, of_samples};
use crate::measure::{Provenance, Samples, machine, median};
use crate::report::Record;
use crate::study::timing::Case;

impl Trial<'_> {
    /// The records of all epochs so far.
    ///
    /// # Panics
    /// If there was none.
    pub fn results(&self) -> Compared {
        assert!(self.epochs > 0, "a trial has an epoch");
        let mut provenance = Provenance::of(&self.settings.threads);
        provenance.warnings = self.warnings(&provenance);
        let scene_hash = self.scene.hash();
        let hashes: Vec<String> = self.workloads.iter().map(|workload| workload.hash()).collect();

        let twin = self.twin.map(|_| self.subjects.len() - 1);
        let mut records = vec![];
        for (s, subject) in self.subjects.iter().enumerate().filter(|(s, _)| Some(*s) != twin) {
            let builds: Vec<f64> = subject.build_ns.iter().map(|&ns| ns as f64).collect();
            for (w, workload) in self.workloads.iter().enumerate() {
                let Tally { rays: counted_rays, hits, tests_per_ray, steps_per_ray, instructions_per_ray, counts } =
                    self.tallies[s][w];
                let samples = self.samples_of(s, w);
                let rays = samples.map_or(0, |samples| samples.rays);
                let samples_ns = nanoseconds(samples);
                let trace_ns = median(&samples_ns);
                let twin = twin.filter(|_| self.twin == Some(s)).and_then(|twin| self.samples_of(twin, w));
                records.push(Record {
                    schema: Record::SCHEMA,
                    scene: self.scene.name.clone(),
                    scene_hash: scene_hash.clone(),
                    triangles: self.scene.mesh.len(),
                    degenerate: self.scene.mesh.degenerate().len(),
                    stand_in: !self.scene.stand_ins.is_empty(),
                    structure: subject.choice.entry.name.clone(),
                    label: subject.choice.label.clone(),
                    config: subject.choice.config.clone(),
                    triangle_test: subject.choice.triangle_test().into(),
                    workload: workload.name.clone(),
                    query: workload.query,
                    workload_hash: hashes[w].clone(),
                    workload_rays: workload.rays.len(),
                    rays,
                    sampled: rays < workload.rays.len(),
                    parts: samples.map_or(vec![], |samples| samples.parts.clone()),
                    counted_rays,
                    hits,
                    answers: samples.filter(|s| s.same_answers).map(|s| format!("{:016x}", s.checksum)),
                    build_ns: median(&builds).expect("every epoch builds") as u64,
                    build_samples_ns: subject.build_ns.clone(),
                    build_peak_bytes: subject.build_peak_bytes,
                    trace_ns,
                    runs: samples_ns.len(),
                    epochs: self.epochs,
                    samples_ns,
                    twin_samples_ns: twin.map(|twin| nanoseconds(Some(twin))),
                    noise_floor: None,
                    mrays_per_s: trace_ns.map(|ns| rays as f64 * 1e3 / ns),
                    tests_per_ray,
                    steps_per_ray,
                    instructions_per_ray,
                    bytes: subject.bytes,
                    declined: subject.declined[w].map(String::from),
                    checked_rays: Some(subject.checks[w].rays),
                    structure_errors: Some(subject.checks[w].errors),
                    provenance: provenance.clone(),
                    counts,
                });
            }
        }
        let floor = twins(&records).log().map(|log| libm::exp(log) - 1.0);
        records.iter_mut().for_each(|record| record.noise_floor = floor);
        Compared { records, refused: self.refused.clone() }
    }

    fn samples_of(&self, subject: usize, workload: usize) -> Option<&Samples> {
        let case = self.cases.iter().position(|case| *case == Case { structure: subject, workload })?;
        Some(&self.samples[case])
    }

    /// What spoilt the run.
    fn warnings(&self, provenance: &Provenance) -> Vec<String> {
        let conditions = Conditions {
            load: provenance.load,
            cores: provenance.cores,
            governor: provenance.governor.clone(),
            denormals: machine::denormals(provenance.mxcsr),
            debug: provenance.profile == "debug",
            ..self.conditions.clone()
        };
        let mut warnings = conditions.warnings();
        let samples: Vec<Vec<f64>> = self.samples.iter().map(|samples| nanoseconds(Some(samples))).collect();
        warnings.extend(of_samples(&samples.iter().map(Vec::as_slice).collect::<Vec<_>>()));

        for (case, _) in self.cases.iter().zip(&self.samples).filter(|(_, samples)| !samples.same_answers) {
            let (label, rays) = (&self.subjects[case.structure].choice.label, &self.workloads[case.workload].name);
            warnings.push(format!(
                "{label}, built again, gives other answers to the same {rays} rays: its build is not repeatable"
            ));
        }
        warnings
    }
}

fn nanoseconds(samples: Option<&Samples>) -> Vec<f64> {
    samples.map_or(vec![], |samples| samples.ns.iter().map(|&ns| ns.max(1) as f64).collect())
}
