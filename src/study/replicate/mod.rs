//! `replicate`: the source report's tables measured again, and the claim it ends with put to the test.
//!
//! The report times all rays of a picture, construction left out, on a machine of its own: seconds can be compared with its
//! seconds only in their ratios. `t'` is seconds / (rays x triangles).

pub(in crate::study) mod original;
pub(in crate::study) mod picture;
mod tables;
mod timing;

use serde::{Deserialize, Serialize};

use crate::accel::DynAccel;
use crate::measure::{Clock, Interval, Provenance, Threads, mean_ratio, median, paired_ratio};
use crate::registry::{Choice, Registry};
use crate::scene::Scene;
use crate::study::baselines::{BRUTE_FORCE, REPORT_TREE, SAH_TREE};
use crate::study::built::Built;
use crate::study::{Stage, StudyError};
use original::{HARD, MAIN, SWEEP, t_prime};
use picture::Picture;
use timing::{Timing, time};

pub use tables::tables;

/// How long the study may take.
pub struct Settings {
    /// Samples of a picture, at least 1; of the hard scenes twice as many, of the sweep half as many.
    pub runs: usize,
    /// What one sample may take, nanoseconds; a slower case is timed on fewer rays and extrapolated.
    pub sample_ns: u64,
    /// What the check of the answers may take for each scene, nanoseconds.
    pub check_ns: u64,
    /// Seed of the order of samples.
    pub seed: u64,
    pub threads: Threads,
}

/// The report's three tables, ours beside its own, and its conclusion.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Replication {
    /// Version of this form.
    pub schema: u32,
    /// Scenes in which a mesh of our own stands in for a real one.
    pub stand_ins: Vec<String>,
    pub rays: Vec<Rays>,
    pub main: Vec<Main>,
    pub parameters: Vec<Setting>,
    pub hard: Vec<Hard>,
    pub conclusion: Conclusion,
    pub provenance: Provenance,
}

/// Rays of a 512 x 512 picture.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Rays {
    pub scene: String,
    pub primary: u64,
    pub mirror: u64,
    pub shadow: u64,
    /// Of these three; on the hard scenes the report counts primary rays alone, and so does this.
    pub total: u64,
    /// The report's total.
    pub report: u64,
}

/// Seconds of a picture.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Seconds {
    /// Median.
    pub seconds: f64,
    /// `t'`: seconds / (rays x triangles).
    pub t_prime: f64,
    /// Whether a part of the rays was timed and stands for all.
    pub extrapolated: bool,
}

/// An easy or normal scene.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Main {
    pub scene: String,
    pub triangles: usize,
    pub rays: u64,
    /// With the report's tree.
    pub tree: Seconds,
    /// Every ray against every triangle: "unoptimised".
    pub brute_force: Seconds,
    /// Seconds without the tree / seconds with it.
    pub improvement: Interval,
    /// With the SAH tree.
    pub sah: Seconds,
    pub report_tree_s: f64,
    pub report_brute_force_s: f64,
    pub report_tree_t_prime: f64,
    pub report_brute_force_t_prime: f64,
    /// As printed.
    pub report_improvement: f64,
}

/// The report's tree with one pair of parameters on one scene.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Setting {
    pub scene: String,
    /// L.
    pub leaf: u32,
    /// T.
    pub threshold: f32,
    pub seconds: f64,
    pub extrapolated: bool,
    pub report_s: f64,
}

/// A hard scene, primary rays.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Hard {
    pub scene: String,
    pub triangles: usize,
    pub rays: u64,
    pub stand_in: bool,
    /// With the report's tree.
    pub tree: Seconds,
    /// Construction of the report's tree, seconds.
    pub tree_build_s: f64,
    pub sah: Seconds,
    pub sah_build_s: f64,
    /// Seconds with the report's tree / seconds with the SAH tree: how much faster SAH is.
    pub sah_over_median: Interval,
    /// The same of each round.
    pub rounds: Vec<f64>,
    pub report_tree_s: f64,
    pub report_tree_build_s: f64,
    pub report_tree_t_prime: f64,
}

/// The claim that the report ends with: for the hard scenes a SAH tree would have been much faster.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Conclusion {
    /// The scenes of the mean.
    pub scenes: Vec<String>,
    /// Geometric mean over the scenes of how much faster SAH is, with a bootstrap interval over the rounds.
    pub sah_over_median: Option<Interval>,
}

/// What the study is told to do and told of, and what it makes of it.
pub struct Study<'a> {
    pub registry: &'a Registry,
    pub settings: &'a Settings,
    pub clock: &'a dyn Clock,
}

impl Study<'_> {
    /// An empty result, to which scenes are added.
    pub fn start(&self) -> Replication {
        Replication {
            schema: 1,
            stand_ins: vec![],
            rays: vec![],
            main: vec![],
            parameters: vec![],
            hard: vec![],
            conclusion: Conclusion { scenes: vec![], sah_over_median: None },
            provenance: Provenance::capture(self.settings.threads.count()),
        }
    }

    /// Names of the scenes of the report: easy and normal, then hard.
    pub fn scenes() -> Vec<&'static str> {
        MAIN.iter().map(|row| row.scene).chain(HARD.iter().map(|row| row.scene)).collect()
    }

    /// Measures one scene of the report; others are passed over.
    ///
    /// # Errors
    /// If a structure of the study is not registered, cannot be built or answers wrongly.
    pub fn add(
        &self,
        scene: &Scene,
        result: &mut Replication,
        progress: &mut dyn FnMut(Stage),
    ) -> Result<(), StudyError> {
        if !scene.stand_ins.is_empty() {
            result.stand_ins.push(scene.name.clone());
        }
        if let Some(row) = MAIN.iter().position(|row| row.scene == scene.name) {
            return self.add_main(row, scene, result, progress);
        }
        match HARD.iter().find(|row| row.scene == scene.name) {
            Some(row) => self.add_hard(row, scene, result, progress),
            None => Ok(()),
        }
    }

    fn add_main(
        &self,
        index: usize,
        scene: &Scene,
        result: &mut Replication,
        progress: &mut dyn FnMut(Stage),
    ) -> Result<(), StudyError> {
        let row = &MAIN[index];
        progress(Stage::Rays("image"));
        let picture = Picture::whole(scene, self.guide(scene)?.as_ref());
        result.rays.push(picture.rays(scene, row.rays));
        let (rays, triangles) = (picture.total(), scene.mesh.len());

        let structures = self.choose(&[BRUTE_FORCE, REPORT_TREE, SAH_TREE])?;
        let timings = self.time(scene, &picture, &structures, self.settings.runs, progress)?;
        let [brute_force, tree, sah] = &timings[..] else { unreachable!("one timing a structure") };
        let seconds = |timing| Seconds::of(timing, rays, triangles);
        result.main.push(Main {
            scene: scene.name.clone(),
            triangles,
            rays,
            tree: seconds(tree),
            brute_force: seconds(brute_force),
            improvement: self.ratio(brute_force, tree),
            sah: seconds(sah),
            report_tree_s: row.tree_s,
            report_brute_force_s: row.brute_s,
            report_tree_t_prime: t_prime(row.tree_s, row.rays, row.triangles),
            report_brute_force_t_prime: t_prime(row.brute_s, row.rays, row.triangles),
            report_improvement: row.improvement,
        });

        let specs: Vec<String> =
            SWEEP.iter().map(|s| format!("{REPORT_TREE}:leaf={},threshold={}", s.leaf, s.threshold)).collect();
        let settings = self.choose(&specs.iter().map(String::as_str).collect::<Vec<_>>())?;
        let timings = self.time(scene, &picture, &settings, self.settings.runs.div_ceil(2), progress)?;
        for (setting, timing) in SWEEP.iter().zip(&timings) {
            result.parameters.push(Setting {
                scene: scene.name.clone(),
                leaf: setting.leaf,
                threshold: setting.threshold,
                seconds: median_seconds(timing),
                extrapolated: timing.extrapolated,
                report_s: setting.seconds[index],
            });
        }
        Ok(())
    }

    fn add_hard(
        &self,
        row: &original::HardRow,
        scene: &Scene,
        result: &mut Replication,
        progress: &mut dyn FnMut(Stage),
    ) -> Result<(), StudyError> {
        progress(Stage::Rays("primary"));
        let picture = Picture::primary(scene, self.guide(scene)?.as_ref());
        result.rays.push(picture.rays(scene, row.rays));
        let (rays, triangles) = (picture.total(), scene.mesh.len());

        let structures = self.choose(&[REPORT_TREE, SAH_TREE])?;
        let timings = self.time(scene, &picture, &structures, 2 * self.settings.runs, progress)?;
        let [tree, sah] = &timings[..] else { unreachable!("one timing a structure") };
        result.hard.push(Hard {
            scene: scene.name.clone(),
            triangles,
            rays,
            stand_in: !scene.stand_ins.is_empty(),
            tree: Seconds::of(tree, rays, triangles),
            tree_build_s: tree.build_s,
            sah: Seconds::of(sah, rays, triangles),
            sah_build_s: sah.build_s,
            sah_over_median: self.ratio(tree, sah),
            rounds: tree.seconds.iter().zip(&sah.seconds).map(|(tree, sah)| tree / sah).collect(),
            report_tree_s: row.tree_s,
            report_tree_build_s: row.build_s,
            report_tree_t_prime: t_prime(row.tree_s, row.rays, row.triangles),
        });

        // The claim is about all hard scenes: say so far as they are measured.
        let ratios: Vec<Vec<f64>> = result.hard.iter().map(|hard| hard.rounds.clone()).collect();
        result.conclusion = Conclusion {
            scenes: result.hard.iter().map(|hard| hard.scene.clone()).collect(),
            sah_over_median: mean_ratio(&ratios, self.settings.seed),
        };
        Ok(())
    }

    /// The structure that tells where secondary rays start.
    fn guide(&self, scene: &Scene) -> Result<Box<dyn DynAccel>, StudyError> {
        let guide = &self.choose(&[SAH_TREE])?[0];
        Ok(Built::new(guide, scene, &self.settings.threads, self.clock)?.accel)
    }

    fn choose(&self, specs: &[&str]) -> Result<Vec<Choice>, StudyError> {
        specs.iter().map(|spec| self.registry.choose(spec).map_err(StudyError::from)).collect()
    }

    /// Times structures on all rays of a picture.
    fn time(
        &self,
        scene: &Scene,
        picture: &Picture,
        structures: &[Choice],
        runs: usize,
        progress: &mut dyn FnMut(Stage),
    ) -> Result<Vec<Timing>, StudyError> {
        time(scene, picture, structures, runs, self.settings, self.clock, progress)
    }

    /// Seconds of `slow` / seconds of `fast`.
    fn ratio(&self, slow: &Timing, fast: &Timing) -> Interval {
        paired_ratio(&slow.seconds, &fast.seconds, self.settings.seed).expect("there is a sample")
    }
}

impl Seconds {
    fn of(timing: &Timing, rays: u64, triangles: usize) -> Self {
        let seconds = median_seconds(timing);
        Self { seconds, t_prime: t_prime(seconds, rays, triangles), extrapolated: timing.extrapolated }
    }
}

fn median_seconds(timing: &Timing) -> f64 {
    median(&timing.seconds).expect("there is a sample")
}
