//! `predictions`: what was expected of the report's scenes before anything was measured.
//!
//! Each number in the words of an expectation is a claim of its own, which is confirmed or refuted by its whole
//! interval, or undecided. What was called open before anything was measured has figures and no verdict.
//!
//! The numbers come from the answers of other studies: `attribution`, `scaling`, `crossover`, `replicate` and
//! `compare`. What takes seconds is counted here: rays, and tests on Infinitycandy.

mod claims;
mod counted;
mod rank;
mod section;
mod table;
#[cfg(test)]
mod tests;

use serde::Serialize;

use super::attribution::{Attribution, AttributionStudy};
use super::compare::CompareStudy;
use super::plan::{Measure, scene_key};
use super::replicate::original::main_scenes;
use super::replicate::{self, ReplicateStudy};
use super::scaling::{Growth, ScalingStudy};
use super::{Answers, Context, Data, Plan, Study, sources};
use crate::measure::{Estimate, Interval, Threads};
use crate::names::named_enum;
use crate::registry::Registry;
use crate::report::document::Block;
use crate::report::number::figures;
use crate::report::{Record, Statement, Table};
use crate::scene::{BUILTIN, Builtin, Scene};

pub use claims::result;
pub use counted::PictureCounts;
use counted::measure;
pub use rank::kendall;
pub use section::{REST_BELOW, sentence};
pub use table::{table, tally, tone};

/// What there is to judge by. What is missing is empty.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Inputs {
    /// Counted here.
    pub counted: Vec<PictureCounts>,
    /// The easy and normal scenes of the report.
    pub replicated: Vec<Main>,
    pub attribution: Vec<Attribution>,
    pub scaling: Vec<Growth>,
    pub compare: Vec<Record>,
}

/// An easy or normal scene of the report, measured again.
#[derive(Clone, Debug, PartialEq)]
pub struct Main {
    pub scene: String,
    pub triangles: usize,
    /// Seconds / (rays x triangles) of brute force.
    pub brute_force_t_prime: Estimate,
    pub improvement: Estimate,
}

impl Inputs {
    /// From what is counted here and what other studies say.
    fn new(counted: &[PictureCounts], others: &Answers) -> Self {
        let main = |main: &replicate::Main| Main {
            scene: main.scene.clone(),
            triangles: main.triangles,
            brute_force_t_prime: main.brute_force.t_prime,
            improvement: main.improvement,
        };
        let replicated = others.of::<ReplicateStudy>().map(|replication| replication.main.iter().map(main).collect());
        Self {
            counted: counted.to_vec(),
            replicated: replicated.unwrap_or_default(),
            attribution: others.of::<AttributionStudy>().cloned().unwrap_or_default(),
            scaling: others.of::<ScalingStudy>().cloned().unwrap_or_default(),
            compare: others.of::<CompareStudy>().map_or(vec![], |compared| of_builtin(&compared.records)),
        }
    }
}

/// The records of built-in scenes: nothing was expected of others.
fn of_builtin(records: &[Record]) -> Vec<Record> {
    let is = |record: &&Record| BUILTIN.iter().any(|builtin| builtin.name == record.scene);
    records.iter().filter(is).cloned().collect()
}

pub struct PredictionsStudy;

#[derive(Clone, Debug, clap::Args)]
pub struct PredictionsArgs {}

#[derive(Serialize)]
struct Row<'a> {
    prediction: u8,
    #[serde(flatten)]
    claim: &'a Claim,
}

impl Study for PredictionsStudy {
    const NAME: &'static str = "predictions";
    const QUESTION: &'static str = "What was expected, and what came of it?";
    const LAST: bool = true;

    type Args = PredictionsArgs;
    type Case = PictureCounts;
    type Answer = Vec<Prediction>;

    fn plan(_: &PredictionsArgs, registry: &Registry) -> anyhow::Result<Plan<PictureCounts>> {
        let scenes: Vec<Scene> =
            sources::wanted(&main_scenes()).map(|name| Builtin::find(name)?.scene(None)).collect::<Result<_, _>>()?;
        let threads = Threads::pinned(1).map_err(anyhow::Error::msg)?;
        let names: Vec<(String, String)> = scenes.iter().map(|scene| (scene.name.clone(), scene_key(scene))).collect();
        let (registry, own) = (registry.clone(), threads.clone());
        let measure: Measure<PictureCounts> =
            Box::new(move |case, clock, progress| measure(&registry, &scenes[case.scene], &own, clock, progress));
        Ok(Plan::of_scenes(&serde_json::Map::new(), threads, names, measure))
    }

    fn answer(cases: &[PictureCounts], context: &Context<Self>) -> Vec<Prediction> {
        result(&Inputs::new(cases, context.others))
    }

    fn tables(answer: &Vec<Prediction>) -> Vec<Table> {
        vec![table(answer)]
    }

    fn data(answer: &Vec<Prediction>) -> Vec<Data> {
        let measured = |p: &Prediction| !p.figures.is_empty() || p.claims.iter().any(Claim::is_judged);
        let rows = answer.iter().flat_map(|p| p.claims.iter().map(|claim| Row { prediction: p.number, claim }));
        let rows: Vec<Row> = if answer.iter().any(measured) { rows.collect() } else { vec![] };
        vec![Data::new(Self::NAME, &rows)]
    }

    fn statements(answer: &Vec<Prediction>) -> Vec<Statement> {
        sentence(answer).map(|sentence| Statement::new("tally", sentence)).into_iter().collect()
    }

    fn section(answer: &Vec<Prediction>, command: &str) -> Vec<Block> {
        section::blocks(answer, command)
    }
}

/// One expectation in the words that were written before the measurement, and what came of it.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Prediction {
    /// From 1 to 8.
    pub number: u8,
    pub words: &'static str,
    /// Each number in the words is a claim of its own. None where the question was called open.
    pub claims: Vec<Claim>,
    /// What was measured where nothing was claimed: it has no verdict.
    pub figures: Vec<Figure>,
    /// What explains it; empty where nothing is measured.
    pub why: String,
    /// The command that measures it.
    pub command: &'static str,
}

/// One number against what was expected of it.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Claim {
    /// What is measured.
    pub what: String,
    /// What was measured, with the interval of one among all [`CLAIMS`]; nothing where it was not.
    pub value: Option<Estimate>,
    /// What was expected of it: `at least 20`.
    pub expected: String,
    pub verdict: Verdict,
}

/// A number of which nothing was claimed.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Figure {
    pub what: String,
    pub value: Estimate,
}

/// How many claims there are: all are judged together.
pub const CLAIMS: usize = 24;

named_enum! {
    /// What came of a claim.
    #[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
    #[serde(rename_all = "kebab-case")]
    pub enum Verdict {
        /// The whole interval is as expected.
        Confirmed = "confirmed",
        /// The whole interval is not.
        Refuted = "refuted",
        /// The interval reaches across a bound, or is not known.
        Undecided = "undecided",
        /// There is nothing to judge by.
        NotMeasured = "not measured",
    }
}

/// What is expected of a number: an end that is not there has no bound.
#[derive(Clone, Copy, Debug)]
struct Bounds {
    low: f64,
    high: f64,
}

impl Bounds {
    fn within(low: f64, high: f64) -> Self {
        Self { low, high }
    }

    fn at_least(low: f64) -> Self {
        Self { low, high: f64::INFINITY }
    }

    fn at_most(high: f64) -> Self {
        Self { low: f64::NEG_INFINITY, high }
    }

    fn words(self) -> String {
        match (self.low.is_finite(), self.high.is_finite()) {
            (true, true) => format!("{} to {}", figures(self.low), figures(self.high)),
            (true, false) => format!("at least {}", figures(self.low)),
            (false, _) => format!("at most {}", figures(self.high)),
        }
    }

    fn verdict(self, value: Option<Estimate>) -> Verdict {
        let Some(value) = value else { return Verdict::NotMeasured };
        let Some(Interval { low, high, .. }) = value.interval else { return Verdict::Undecided };
        match () {
            () if self.low <= low && high <= self.high => Verdict::Confirmed,
            () if high < self.low || low > self.high => Verdict::Refuted,
            () => Verdict::Undecided,
        }
    }
}

impl Claim {
    fn ratio(what: impl Into<String>, value: Option<Estimate>, bounds: Bounds) -> Self {
        Self::judged(what, value.map(|value| value.ratio_among(CLAIMS)), bounds)
    }

    fn number(what: impl Into<String>, value: Option<Estimate>, bounds: Bounds) -> Self {
        Self::judged(what, value.map(|value| value.among(CLAIMS)), bounds)
    }

    /// Whether there is an interval to judge it by: one epoch or one scene has none.
    fn is_judged(&self) -> bool {
        self.value.is_some_and(|value| value.interval.is_some())
    }

    /// Of a number whose interval allows for all claims already.
    fn judged(what: impl Into<String>, value: Option<Estimate>, bounds: Bounds) -> Self {
        Self { what: what.into(), value, expected: bounds.words(), verdict: bounds.verdict(value) }
    }
}
