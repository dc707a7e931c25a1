//! From the journal to what is real. Pure functions.

use serde::Serialize;

use super::{DEFAULT, default_row, is_default};
use crate::measure::{AaNoise, Estimate, LEVEL, holm};
use crate::names::named_enum;
use crate::study::epoch::{Epoch, RayCounts, Rays, Shape, Structure, WholeTimes};
use crate::study::replicate::original::{SWEEP, main_scenes};

/// What came of the sweep.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Parameters {
    pub epochs: usize,
    /// The [A/A noise](AaNoise) of the twins of the default, as a factor; 1 is none.
    pub aa_noise: f64,
    /// Comparisons that were made: so many looks does the correction allow for.
    pub comparisons: usize,
    /// Scene by scene, in the order of the sweep.
    pub settings: Vec<Setting>,
}

/// One setting on one scene.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Setting {
    pub scene: String,
    pub triangles: usize,
    /// L.
    pub leaf: u32,
    /// T.
    pub threshold: f32,
    /// For all rays of the picture, geometric mean over the epochs.
    pub seconds: f64,
    pub report_s: f64,
    /// Time as a multiple of the default's; nothing for the default.
    pub times: Option<Estimate>,
    /// The same in the report: single runs.
    pub report_times: f64,
    pub tests_per_ray: f64,
    /// The chance that an interval of `times` would have to leave to its outside to reach just to 1; nothing for the
    /// default, with fewer than two epochs, or where the trees are the same.
    pub probability: Option<f64>,
    pub verdict: Difference,
}

named_enum! {
    /// Whether a setting differs from the default.
    #[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
    #[serde(rename_all = "kebab-case")]
    pub enum Difference {
        /// It is the default.
        Default = "default",
        /// Its tree is that of the default: there is nothing to differ.
        SameTree = "same tree",
        /// Its interval lies below 1, as one of all that are compared.
        Faster = "faster",
        /// As [`Difference::Faster`].
        Slower = "slower",
        /// Chance or noise may explain what is seen.
        NotShown = "not shown",
    }
}

/// Compares the settings of all scenes whose first epoch is there.
pub fn result(epochs: &[Epoch]) -> Parameters {
    let names = main_scenes();
    let of = |scene: &&str| epochs.iter().filter(|epoch| epoch.scene == **scene).collect::<Vec<_>>();
    let scenes: Vec<Measured> = names.iter().filter_map(|scene| Measured::of(&of(scene))).collect();
    let default = default_row();

    // There are twins in every scene.
    let twin = |scene: &Measured| scene.times.cell(SWEEP.len(), default);
    let noise = AaNoise::new(&scenes.iter().map(twin).collect::<Vec<_>>());

    let mut settings = vec![];
    for scene in &scenes {
        let column = names.iter().position(|name| *name == scene.name).expect("it is one of them");
        for (i, row) in SWEEP.iter().enumerate() {
            let times = scene.times.ratio(i, default, &noise);
            let same_tree = scene.trees[i] == scene.trees[default];
            settings.push(Setting {
                scene: scene.name.clone(),
                triangles: scene.triangles,
                leaf: row.leaf,
                threshold: row.threshold,
                seconds: scene.times.seconds(i, &noise).estimate,
                report_s: row.seconds[column],
                times: (!is_default(row)).then_some(times),
                report_times: row.seconds[column] / SWEEP[default].seconds[column],
                tests_per_ray: scene.tests_per_ray[i],
                probability: if is_default(row) || same_tree { None } else { times.chance_of_one() },
                verdict: match (is_default(row), same_tree) {
                    (true, _) => Difference::Default,
                    (_, true) => Difference::SameTree,
                    _ => Difference::NotShown,
                },
            });
        }
    }

    let compared: Vec<usize> = (0..settings.len()).filter(|&i| settings[i].probability.is_some()).collect();
    let probabilities: Vec<f64> = compared.iter().filter_map(|&i| settings[i].probability).collect();
    for (&i, real) in compared.iter().zip(holm(&probabilities, LEVEL)) {
        let times = settings[i].times.expect("only others than the default are compared").estimate;
        if real {
            settings[i].verdict = if times < 1.0 { Difference::Faster } else { Difference::Slower };
        }
    }
    let epochs = scenes.iter().map(|scene| scene.epochs).min().unwrap_or(0);
    Parameters { epochs, aa_noise: libm::exp(noise.log().unwrap_or(0.0)), comparisons: compared.len(), settings }
}

impl Parameters {
    /// The setting of the report's main table, as text.
    pub fn default_name() -> String {
        format!("{} / {}", DEFAULT.0, DEFAULT.1)
    }
}

struct Measured {
    name: String,
    triangles: usize,
    epochs: usize,
    /// Over the rays of the picture.
    tests_per_ray: Vec<f64>,
    /// Of each setting and the twin.
    times: WholeTimes,
    trees: Vec<Made>,
}

/// Tests for a ray of the picture: those of each query, by its share of the rays.
fn tests_per_ray(tree: &Structure) -> f64 {
    let tests = |rays: &Rays| rays.counts.and_then(|counts| counts.tests_per_ray()).unwrap_or(0.0) * rays.all as f64;
    tree.rays.iter().map(tests).sum::<f64>() / tree.rays.iter().map(|rays| rays.all).sum::<usize>() as f64
}

/// What makes a tree: where all of it is the same, so is the tree.
#[derive(PartialEq)]
struct Made {
    shape: Shape,
    counts: Vec<Option<RayCounts>>,
}

impl Measured {
    fn of(epochs: &[&Epoch]) -> Option<Self> {
        let timed = |tree: &Structure| {
            !tree.rays.is_empty() && tree.rays.iter().all(|rays| !rays.ns.is_empty() && rays.rays > 0)
        };
        let whole = |epoch: &&Epoch| epoch.structures.len() == SWEEP.len() + 1 && epoch.structures.iter().all(timed);
        let epochs: Vec<&Epoch> = epochs.iter().copied().filter(whole).collect();
        let counted = |tree: &Structure| tree.rays.iter().all(|rays| rays.counts.is_some());
        let first = *epochs.iter().find(|epoch| epoch.structures.iter().all(counted))?;
        let made = |tree: &Structure| Made {
            shape: tree.shape.clone(),
            counts: tree.rays.iter().map(|rays| rays.counts).collect(),
        };
        Some(Self {
            name: first.scene.clone(),
            triangles: first.triangles,
            epochs: epochs.len(),
            tests_per_ray: first.structures.iter().map(tests_per_ray).collect(),
            times: WholeTimes::new(epochs.iter().copied()),
            trees: first.structures.iter().map(made).collect(),
        })
    }
}
