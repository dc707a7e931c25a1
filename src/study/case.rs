//! A case: one epoch of one scene, measured by one process. A case is plain data: the process that measures it does
//! not need the study that planned it.

use std::collections::BTreeMap;

use serde::{Deserialize, Serialize};
use serde_json::{Map, Value, json};

use crate::measure::checksum;
use crate::registry::Registry;
use crate::report::words::scene_name;
use crate::request::{Measuring, SceneRequest, StructureRequest, WorkloadRequest, secondary_ray_structure};

#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Case {
    pub study: String,
    pub scene: SceneRequest,
    /// Parameters that the study varies, such as `level=7`.
    #[serde(default, skip_serializing_if = "BTreeMap::is_empty")]
    pub labels: BTreeMap<String, String>,
    /// In the order of the tables.
    pub structures: Vec<StructureRequest>,
    pub workloads: WorkloadRequest,
    pub settings: Settings,
    /// Counted from 0. Only epoch 0 checks hits and counts triangle tests.
    pub epoch: usize,
    /// The number of planned epochs. A run with more epochs adds to the existing epochs.
    pub epochs: usize,
    /// The command line that planned the case.
    pub command: String,
}

#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Settings {
    /// Maximum number of samples per structure and workload, at least 1.
    pub runs: usize,
    /// Time limit for all samples of an epoch. `None` is unlimited.
    pub budget_ns: Option<u64>,
    /// Time limit of a sample, relative to the median of all samples. `None` is unlimited.
    ///
    /// A structure above the limit is timed on fewer rays. Ignored if `budget_ns` is `None`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub slowest: Option<f64>,
    pub check: Check,
    /// Time limit of a build in seconds. `None` is unlimited.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub build_limit_s: Option<f64>,
    /// Specs of structures whose triangle tests are counted over all rays.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub whole_counts: Vec<String>,
    /// Whether to drop the scene if a structure has no time.
    #[serde(default, skip_serializing_if = "std::ops::Not::not")]
    pub whole: bool,
    /// Spec of the structure whose hits are the origins of secondary rays.
    #[serde(rename = "guide")]
    pub secondary_ray_structure: String,
    /// Seed of the workloads and of the order of samples.
    pub seed: u64,
    pub threads: usize,
}

/// The method that checks the hits of epoch 0.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(tag = "against", rename_all = "kebab-case")]
pub enum Check {
    /// Brute force with the triangle test of each structure.
    ///
    /// A structure with wrong hits loses all its times. A structure with a known defect loses only its times on the
    /// workloads with wrong hits.
    BruteForce {
        /// Approximate maximum number of brute-force triangle tests per workload.
        tests: usize,
        /// Time limit for all checks of a scene. `None` is unlimited.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        limit_ns: Option<u64>,
    },
    /// Exact arithmetic. Structures with wrong hits keep their times.
    Oracle,
}

/// The default of `tests` in [`Check::BruteForce`]. Brute force then takes about 0.2 s per workload.
pub const TESTS: usize = 1 << 27;

impl Default for Check {
    fn default() -> Self {
        Self::BruteForce { tests: TESTS, limit_ns: None }
    }
}

/// The usual value of [`Settings::slowest`]. More rays would take much time, but hardly improve the ratios of slow
/// structures.
pub const SLOWEST: f64 = 4.0;

impl Settings {
    /// Only quick runs have a time limit for checks.
    pub fn is_quick(&self) -> bool {
        matches!(self.check, Check::BruteForce { limit_ns: Some(_), .. })
    }

    /// The settings for one sample of all rays on one thread.
    pub fn one_sample(secondary_ray_structure: impl Into<String>) -> Self {
        Self {
            runs: 1,
            budget_ns: None,
            slowest: None,
            check: Check::default(),
            build_limit_s: None,
            whole_counts: vec![],
            whole: false,
            secondary_ray_structure: secondary_ray_structure.into(),
            seed: 1,
            threads: 1,
        }
    }

    /// Returns an error if the registry is empty.
    pub fn new<const EPOCHS: u16, const RUNS: u16, const BUDGET: u32>(
        measuring: &Measuring<EPOCHS, RUNS, BUDGET>,
        registry: &Registry,
    ) -> anyhow::Result<Self> {
        Ok(Self {
            runs: measuring.runs.into(),
            budget_ns: measuring.budget.ns(),
            seed: measuring.seed,
            threads: measuring.threads.into(),
            ..Self::one_sample(secondary_ray_structure(registry)?.label)
        })
    }
}

/// The number of triangles per unit of [`Case::work`]. Builds over this many triangles take about a quarter of the
/// fixed time of an epoch.
const TRIANGLES: u64 = 12_000;

impl Case {
    pub fn scene_title(&self) -> String {
        scene_name(&self.scene.name, self.scene.stand_in)
    }

    pub fn title(&self) -> String {
        format!("epoch {} of {}: {}", self.epoch + 1, self.epochs, self.scene_title())
    }

    pub fn key(&self) -> String {
        let labels: String = self.labels.iter().map(|(name, value)| format!("{name}={value} ")).collect();
        format!("{} {labels}epoch {}", self.scene_title(), self.epoch)
    }

    /// Approximate duration in an arbitrary unit.
    pub fn work(&self) -> u64 {
        // Epoch 0 also checks hits and counts triangle tests.
        (4 + self.scene.triangles as u64 / TRIANGLES) * if self.epoch == 0 { 2 } else { 1 }
    }

    /// Whether both cases belong to one measurement. The epochs of the cases may differ.
    pub fn is_same_measurement(&self, other: &Self) -> bool {
        self.identity() == other.identity()
    }

    /// Whether both cases are the same epoch of one measurement.
    pub fn is_same(&self, other: &Self) -> bool {
        self.epoch == other.epoch && self.is_same_measurement(other)
    }

    pub fn is_of_scene(&self, other: &Self) -> bool {
        (&self.scene.hash, self.scene_title(), &self.labels) == (&other.scene.hash, other.scene_title(), &other.labels)
    }

    /// The fields that identify a measurement. The epoch is excluded.
    fn identity(&self) -> Value {
        let structure =
            |own: &StructureRequest| json!([own.spec, own.role, own.runner.as_ref().map(|own| &own.config)]);
        let structures: Vec<Value> = self.structures.iter().map(structure).collect();
        json!({
            "study": self.study,
            "scene": [self.scene.hash, self.scene_title()],
            "labels": self.labels,
            "structures": structures,
            "settings": self.group(),
            "build_limit_s": self.settings.build_limit_s,
        })
    }

    /// The settings and workloads that all scenes of a comparison share.
    pub fn group(&self) -> Map<String, Value> {
        let settings = serde_json::to_value(&self.settings).expect("settings have text keys");
        let Value::Object(mut map) = settings else { unreachable!("settings are a struct") };
        map.remove("whole_counts");
        // By default, scenes of different sizes have different build limits.
        map.remove("build_limit_s");
        let workloads = serde_json::to_value(&self.workloads).expect("a request has text keys");
        // Only `replicate` has these two workloads. Its scenes form one group, whichever of the two they have.
        if !matches!(self.workloads, WorkloadRequest::Picture | WorkloadRequest::PrimaryPicture) {
            map.insert("workloads".into(), workloads);
        }
        map
    }

    /// A hash of `identity` and `machine`.
    pub fn digest(&self, machine: &impl Serialize) -> String {
        let text = serde_json::to_string(&(self.identity(), machine)).expect("a case has text keys");
        format!("{:08x}", checksum(text.bytes().map(u64::from)) as u32)
    }
}

#[cfg(test)]
pub(crate) mod tests {
    use super::*;

    pub fn example(scene: &str, epoch: usize, structures: &[&str]) -> Case {
        Case {
            study: "compare".into(),
            scene: SceneRequest {
                word: scene.into(),
                view: Default::default(),
                name: scene.into(),
                hash: format!("{:0<16}", scene.to_ascii_lowercase()),
                stand_in: false,
                triangles: 12,
            },
            labels: BTreeMap::new(),
            structures: structures.iter().map(|&spec| StructureRequest::new(spec, "")).collect(),
            workloads: WorkloadRequest::Scene { kinds: vec![crate::scene::WorkloadKind::Primary], rays: None },
            settings: Settings { runs: 3, budget_ns: Some(1_000_000_000), ..Settings::one_sample("sah-kd") },
            epoch,
            epochs: 2,
            command: "sahara compare".into(),
        }
    }

    #[test]
    fn a_case_reads_back_and_is_told_from_others_by_all_but_the_epochs() {
        let case = example("Cube", 0, &["sah-kd", "median-kd"]);
        let text = serde_json::to_string(&case).unwrap();
        assert_eq!(serde_json::from_str::<Case>(&text).unwrap(), case);
        let more = Case { epochs: 9, command: "sahara study all".into(), ..case.clone() };
        assert!(case.is_same(&more) && case.digest(&()) == more.digest(&()) && case.key() == more.key());
        let next = Case { epoch: 1, ..case.clone() };
        assert!(case.is_same_measurement(&next) && !case.is_same(&next) && case.key() != next.key());
        let changes: [fn(&mut Case); 6] = [
            |case| case.settings.runs = 4,
            |case| case.structures[0].spec = "sah-bvh".into(),
            |case| case.structures[1].role = "twin".into(),
            |case| case.workloads = WorkloadRequest::Picture,
            |case| drop(case.labels.insert("level".into(), "7".into())),
            |case| case.study = "scaling".into(),
        ];
        for change in changes {
            let mut other = case.clone();
            change(&mut other);
            assert!(!case.is_same_measurement(&other) && case.digest(&()) != other.digest(&()), "{other:?}");
        }
        assert_ne!(case.digest(&"this machine"), case.digest(&"another"));
    }
}
