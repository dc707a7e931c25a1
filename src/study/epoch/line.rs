//! All epochs of one structure on one kind of rays, and what another run might find.

use super::Epoch;
use crate::measure::{LEVEL, RandomOrder, factor, median};

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
    pub steps: Option<f64>,
    /// ln nanoseconds of a ray, epoch by epoch, round by round, on rays that are the same for all structures.
    pub trace: Vec<Vec<f64>>,
    /// ln nanoseconds of the build, epoch by epoch.
    pub build: Vec<Vec<f64>>,
}

/// The lines of all scenes, in the order in which scenes, structures and kinds of rays come first. What has no time in one of its
/// epochs has no line.
pub fn lines<'a>(epochs: impl IntoIterator<Item = &'a Epoch>) -> Vec<Line> {
    let mut scenes: Vec<Vec<&Epoch>> = vec![];
    for epoch in epochs {
        match scenes.iter_mut().find(|scene| scene[0].scene_hash == epoch.scene_hash) {
            Some(scene) => scene.push(epoch),
            None => scenes.push(vec![epoch]),
        }
    }
    let mut lines = vec![];
    for scene in &mut scenes {
        scene.sort_by_key(|epoch| epoch.epoch);
        for structure in &scene[0].structures {
            for rays in &structure.rays {
                lines.extend(line(scene, &structure.label, &rays.workload));
            }
        }
    }
    lines
}

/// One line, if it was timed in every epoch.
fn line(scene: &[&Epoch], label: &str, workload: &str) -> Option<Line> {
    let (mut trace, mut build) = (vec![], vec![]);
    let mut first = None;
    for epoch in scene {
        let structure = epoch.structures.iter().find(|s| s.label == label && s.refused.is_none())?;
        let rays = structure.rays.iter().find(|rays| rays.workload == workload && !rays.ns.is_empty())?;
        first = first.or(Some((structure, rays)));
        trace.push(rays.paces(epoch.common_rays(workload)).into_iter().map(libm::log).collect());
        build.push(vec![libm::log(structure.build_ns.max(1) as f64)]);
    }
    let (structure, rays) = first?;
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
        steps: rays.counts.and_then(|counts| counts.steps_per_ray()),
        trace,
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

    /// ln of this line's time over that of `other`, pair by pair. Nothing where they were not measured together.
    pub fn log_ratios(&self, other: &Self) -> Option<Vec<Vec<f64>>> {
        let alike = self.trace.len() == other.trace.len()
            && self.trace.iter().zip(&other.trace).all(|(one, other)| one.len() == other.len());
        let pair = |(one, other): (&Vec<f64>, &Vec<f64>)| one.iter().zip(other).map(|(a, b)| a - b).collect();
        alike.then(|| self.trace.iter().zip(&other.trace).map(pair).collect())
    }
}

/// The mean over epochs of the median of their rounds.
pub fn centre(epochs: &[Vec<f64>]) -> f64 {
    let middles = epochs.iter().map(|rounds| median(rounds).expect("an epoch has rounds"));
    middles.sum::<f64>() / epochs.len() as f64
}

/// Epochs, and rounds within each, drawn with replacement: the same for everything that was measured together.
#[derive(Clone, Debug)]
pub struct Draw(Vec<(usize, Vec<usize>)>);

/// Draws what another run of the same plan might find.
pub struct Draws(RandomOrder);

impl Draws {
    /// The same draws for the same seed.
    pub fn new(seed: u64) -> Self {
        Self(RandomOrder::new(seed))
    }

    /// A draw for what has as many epochs and rounds as `epochs`.
    pub fn draw(&mut self, epochs: &[Vec<f64>]) -> Draw {
        let rounds = epochs.iter().map(Vec::len).min().unwrap_or(0);
        let one = |random: &mut RandomOrder| {
            (random.below(epochs.len()), (0..rounds).map(|_| random.below(rounds)).collect())
        };
        Draw((0..epochs.len()).map(|_| one(&mut self.0)).collect())
    }

    /// A number below `n`.
    pub fn below(&mut self, n: usize) -> usize {
        self.0.below(n)
    }
}

impl Draw {
    /// [`centre`] as another run might find it: that of the epochs and rounds drawn, moved away from our own by as much more as few
    /// epochs know too little of themselves, and as another run errs as well.
    pub fn centre(&self, epochs: &[Vec<f64>]) -> f64 {
        let own = centre(epochs);
        let middle = |(epoch, rounds): &(usize, Vec<usize>)| {
            // The build of an epoch is a single round.
            let of = &epochs[*epoch];
            let drawn: Vec<f64> = rounds.iter().map(|&round| of[round % of.len()]).collect();
            median(&drawn).expect("an epoch has rounds")
        };
        let drawn = self.0.iter().map(middle).sum::<f64>() / self.0.len() as f64;
        own + (drawn - own) * stretch(epochs)
    }
}

/// A bootstrap over n values has the variance (n - 1) / n s^2 / n; the difference of two runs' means has 2 s^2 / n and, s being
/// known from n values alone, the tails of Student's t with n - 1 degrees of freedom. As [`crate::measure::replication`] argues.
fn stretch(epochs: &[Vec<f64>]) -> f64 {
    let n = if epochs.len() > 1 { epochs.len() } else { epochs[0].len() } as f64;
    if n < 2.0 {
        return 1.0;
    }
    factor(n - 1.0, LEVEL) / factor(f64::INFINITY, LEVEL) * libm::sqrt(2.0 * n / (n - 1.0))
}
