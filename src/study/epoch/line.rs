//! All epochs of one structure on one kind of rays.

use super::{Epoch, Rays, Structure};
use crate::measure::{AaNoise, median};
use crate::study::grouped::grouped;

/// All epochs of one structure on one kind of rays of one scene.
#[derive(Clone, Debug, PartialEq)]
pub struct Line {
    /// As tables name it.
    pub scene: String,
    /// Tells scenes of one name apart.
    pub scene_hash: String,
    pub triangles: usize,
    /// As chosen.
    pub structure: String,
    /// Name in the registry.
    pub name: String,
    pub workload: String,
    pub bytes: usize,
    pub leaves: usize,
    pub tests: Option<f64>,
    pub blocks: Option<f64>,
    pub steps: Option<f64>,
    /// Rays of a sample: a slow structure is timed on fewer than others.
    pub rays: usize,
    /// ln nanoseconds of a ray, epoch by epoch, round by round.
    pub trace: Vec<Vec<f64>>,
    /// The same of the parts of the samples that slower structures are timed on, by the number of rays.
    parts: Vec<(usize, Vec<Vec<f64>>)>,
    /// ln nanoseconds of the build, epoch by epoch.
    pub build: Vec<Vec<f64>>,
}

/// The lines of all scenes, in the order in which scenes, structures and kinds of rays come first. What has no time in
/// one of its epochs has no line, nor has a twin.
pub fn lines<'a>(epochs: impl IntoIterator<Item = &'a Epoch>) -> Vec<Line> {
    let mut found = vec![];
    for scene in scenes(epochs) {
        for (place, structure) in scene[0].structures.iter().enumerate() {
            if twin_of(scene[0], place).is_none() {
                found.extend(structure.rays.iter().filter_map(|rays| line(&scene, place, &rays.workload)));
            }
        }
    }
    found
}

/// The A/A noise of a run: what two builds of the same structure differ by.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Twins {
    /// In times of rays, a cell for each scene and kind of rays.
    pub trace: AaNoise,
    /// In times of builds, a cell for each scene.
    pub build: AaNoise,
}

/// That of these epochs: a structure that stands among those of an epoch a second time is the twin of the first.
pub fn twins<'a>(epochs: impl IntoIterator<Item = &'a Epoch>) -> Twins {
    let [mut trace, mut build] = [vec![], vec![]];
    for scene in scenes(epochs) {
        for place in 0..scene[0].structures.len() {
            let Some(first) = twin_of(scene[0], place) else { continue };
            let pairs = scene[0].structures[place]
                .rays
                .iter()
                .filter_map(|rays| Some((line(&scene, first, &rays.workload)?, line(&scene, place, &rays.workload)?)));
            let pairs: Vec<(Line, Line)> = pairs.collect();
            trace.extend(pairs.iter().filter_map(|(one, twin)| one.log_ratios(twin)));
            build.extend(pairs.first().and_then(|(one, twin)| log_ratios(&one.build, &twin.build)));
        }
    }
    Twins { trace: AaNoise::new(&trace), build: AaNoise::new(&build) }
}

/// The epochs scene by scene, in their order.
pub fn scenes<'a>(epochs: impl IntoIterator<Item = &'a Epoch>) -> Vec<Vec<&'a Epoch>> {
    let mut scenes = grouped(epochs, |a, b| a.scene_hash == b.scene_hash);
    scenes.iter_mut().for_each(|scene| scene.sort_by_key(|epoch| epoch.epoch));
    scenes
}

/// The place of the structure that the one at `place` is the twin of.
pub fn twin_of(epoch: &Epoch, place: usize) -> Option<usize> {
    epoch.structures[..place].iter().position(|first| first.label == epoch.structures[place].label)
}

/// One line, if it was timed in every epoch. Structures have the same places in all epochs, and the same rays.
fn line(scene: &[&Epoch], place: usize, workload: &str) -> Option<Line> {
    let (mut samples, mut build): (Vec<&Rays>, _) = (vec![], vec![]);
    for epoch in scene {
        let timed = |s: &&Structure| s.label == scene[0].structures[place].label && s.refused.is_none();
        let structure = epoch.structures.get(place).filter(timed)?;
        samples.push(structure.rays.iter().find(|rays| rays.workload == workload && !rays.ns.is_empty())?);
        build.push(vec![libm::log(structure.build_ns.max(1) as f64)]);
    }
    let (structure, rays) = (&scene[0].structures[place], samples[0]);
    let trace = |count: usize| -> Vec<Vec<f64>> {
        samples.iter().map(|own| own.paces(count).into_iter().map(libm::log).collect()).collect()
    };
    Some(Line {
        scene: scene[0].title(),
        scene_hash: scene[0].scene_hash.clone(),
        triangles: scene[0].triangles,
        structure: structure.label.clone(),
        name: structure.name.clone(),
        workload: workload.into(),
        bytes: structure.shape.bytes,
        leaves: structure.shape.leaves,
        tests: rays.counts.and_then(|counts| counts.tests_per_ray()),
        blocks: rays.counts.and_then(|counts| counts.blocks_per_ray()),
        steps: rays.counts.and_then(|counts| counts.steps_per_ray()),
        rays: rays.rays,
        trace: trace(rays.rays),
        parts: rays.parts.iter().map(|part| (part.rays, trace(part.rays))).collect(),
        build,
    })
}

impl Line {
    /// Nanoseconds a ray: the geometric mean over the epochs of the median of their rounds.
    pub fn ns_per_ray(&self) -> f64 {
        libm::exp(centre(&self.trace))
    }

    /// Nanoseconds of the build, likewise.
    pub fn build_ns(&self) -> f64 {
        libm::exp(centre(&self.build))
    }

    /// This line on no more rays than `other`: two lines are compared on the rays of the one that is timed on fewer.
    /// Nothing where those were not timed.
    pub fn on_rays_of(&self, other: &Self) -> Option<Self> {
        if self.rays <= other.rays {
            return Some(self.clone());
        }
        let (rays, trace) = self.parts.iter().find(|(rays, _)| *rays == other.rays)?;
        Some(Self { rays: *rays, trace: trace.clone(), ..self.clone() })
    }

    /// ln of this line's time over that of `other` on the same rays, pair by pair. Nothing where they were not measured
    /// together.
    pub fn log_ratios(&self, other: &Self) -> Option<Vec<Vec<f64>>> {
        log_ratios(&self.on_rays_of(other)?.trace, &other.on_rays_of(self)?.trace)
    }
}

fn log_ratios(one: &[Vec<f64>], other: &[Vec<f64>]) -> Option<Vec<Vec<f64>>> {
    let alike = one.len() == other.len() && one.iter().zip(other).all(|(one, other)| one.len() == other.len());
    let pair = |(one, other): (&Vec<f64>, &Vec<f64>)| one.iter().zip(other).map(|(a, b)| a - b).collect();
    alike.then(|| one.iter().zip(other).map(pair).collect())
}

/// The median of the rounds of each epoch.
pub fn middles(epochs: &[Vec<f64>]) -> Vec<f64> {
    epochs.iter().map(|rounds| median(rounds).expect("an epoch has rounds")).collect()
}

/// The mean over epochs of the median of their rounds.
fn centre(epochs: &[Vec<f64>]) -> f64 {
    middles(epochs).iter().sum::<f64>() / epochs.len() as f64
}
