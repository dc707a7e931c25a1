//! `report --results`: the statements as a short paper, the numbers that README prints, and the file that holds them.
//!
//! All three are made from one run. The data file has every sentence with a number in it, by its key, and the digests of the
//! other files: whoever changes a number by hand, or forgets a file, is told by a test.

mod marks;
mod paper;
#[cfg(test)]
mod tests;

use std::collections::BTreeMap;

use serde::{Deserialize, Serialize};
use sha2::{Digest, Sha256};

pub use marks::{MarkError, OPEN, fill, marked};

use super::runs::Runs;
use crate::measure::{Estimate, Provenance};
use crate::report::document::{Art, Document};
use crate::report::words::{command_line, distinct};
use crate::report::{Record, Statement, Table, to_json};
use crate::scene::{Builtin, WorkloadKind};
use crate::study::compare::{CompareStudy, ranks};
use crate::study::{Studies, Study};

/// The command that makes all of it.
pub const COMMAND: &str = "sahara report RUN.. --results";

/// The paper, in the folder of results.
pub const PAPER: &str = "RESULTS.md";

/// The data file, likewise.
pub const DATA: &str = "results.json";

/// The folder of figures, likewise.
pub const FIGURES: &str = "figures";

/// Width of figures, in their units.
const WIDTH: f64 = 900.0;

/// All that is written.
pub struct Results {
    pub data: ResultsData,
    /// The paper.
    pub paper: String,
    /// Names and bytes of the files in the folder of figures.
    pub figures: Vec<(String, Vec<u8>)>,
}

/// The data file.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct ResultsData {
    /// Version of these fields.
    pub schema: u32,
    pub made_by: String,
    pub run: RunFacts,
    /// By key: the name of the study or part, a full stop, and the name of the statement in it.
    pub statements: BTreeMap<String, Told>,
    /// The triangle test of each structure that is compared, by its label: after a change of a default the numbers are of another.
    pub tests: BTreeMap<String, String>,
    /// What structures count for primary rays, by scene and label. No machine changes it: it tells whether trees and searches are still
    /// those of the run.
    #[serde(default)]
    pub counts: BTreeMap<String, BTreeMap<String, String>>,
    /// Digests (SHA-256) of the other files, by their paths beside this one.
    pub files: BTreeMap<String, String>,
}

/// Where all numbers come from.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct RunFacts {
    pub version: String,
    pub commit: String,
    pub cpu: String,
    pub simd: String,
    /// Threads of the study that takes the most.
    pub threads: usize,
    pub rustc: String,
    pub target: String,
    pub obvhs: String,
    /// Days of the first and of the last measurement, in UTC.
    pub days: [String; 2],
    pub commands: Vec<String>,
}

/// A sentence or table, and the number that it is about.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Told {
    pub text: String,
    pub value: Option<Estimate>,
}

/// Why no results are made.
#[derive(Debug, thiserror::Error)]
pub enum ResultsError {
    #[error(
        "these runs are of more than one {what} ({values}): results are of one run; measure all of it anew into a folder of its own"
    )]
    Mixed { what: &'static str, values: String },
    #[error("README.md: {0}")]
    Mark(#[from] MarkError),
    #[error("README.md marks {key:?}, and there is no such statement; there are: {known}")]
    Unknown { key: String, known: String },
}

impl Results {
    /// The results of `document`, which was made from `runs`.
    ///
    /// # Errors
    /// If the runs are of different commits or machines.
    pub fn new(document: &Document, runs: &Runs, studies: &Studies) -> Result<Self, ResultsError> {
        let run = RunFacts::new(&runs.provenances)?;
        let statements = statements(document, runs, studies, &run);
        let mut paper = paper::text(document, runs, studies, &run);
        let shown = document.figures().into_iter().filter(|figure| paper.contains(&paper::path(&figure.id)));
        let drawn = shown.filter_map(|figure| match &figure.art {
            Art::Chart(chart) => Some((figure.id.clone(), chart.svg(WIDTH).into_bytes())),
            _ => None,
        });
        let drawn: Vec<(String, Vec<u8>)> = drawn.collect();
        let answer = document.answer.chart.as_ref().map(|chart| (paper::ANSWER.into(), chart.svg(WIDTH).into_bytes()));
        let mut figures: Vec<(String, Vec<u8>)> = answer.into_iter().collect();
        for (id, bytes) in drawn {
            // The answer may be the figure of a study as well: it is kept once.
            match figures.iter().find(|(_, known)| *known == bytes) {
                Some((known, _)) => paper = paper.replace(&paper::path(&id), &format!("{FIGURES}/{known}")),
                None => figures.push((format!("{id}.svg"), bytes)),
            }
        }
        let mut files: BTreeMap<String, String> =
            figures.iter().map(|(name, bytes)| (format!("{FIGURES}/{name}"), digest(bytes))).collect();
        files.insert(PAPER.into(), digest(paper.as_bytes()));
        let tests = runs.records().iter().map(|record| (record.label.clone(), record.triangle_test.clone())).collect();
        let data = ResultsData {
            schema: 3,
            made_by: COMMAND.into(),
            run,
            statements,
            tests,
            counts: counts(runs.records()),
            files,
        };
        Ok(Self { data, paper, figures })
    }

    /// The text of README with what it marks filled in. What it marks and no run has measured says so, here and in the data.
    ///
    /// # Errors
    /// If a mark is not closed, or names no statement.
    pub fn fill(&mut self, readme: &str, studies: &Studies) -> Result<String, ResultsError> {
        for (key, _) in marked(readme)? {
            if self.data.statements.contains_key(&key) {
                continue;
            }
            let study = studies.iter().find(|study| key.split('.').next() == Some(study.name()));
            let study = study.ok_or_else(|| ResultsError::Unknown {
                key: key.clone(),
                known: self.data.statements.keys().cloned().collect::<Vec<_>>().join(", "),
            })?;
            let text = format!("Not measured in this run (`{}`).", study.command());
            self.data.statements.insert(key, Told { text, value: None });
        }
        Ok(fill(readme, |key| self.data.statements.get(key).map(|told| told.text.clone()))?)
    }

    /// The bytes of the data file.
    pub fn json(&self) -> Vec<u8> {
        to_json(&self.data)
    }
}

/// The digest by which the data file knows a file.
pub fn digest(bytes: &[u8]) -> String {
    format!("{:x}", Sha256::digest(bytes))
}

/// Triangles of the scenes whose counts are kept, at most: they are counted again in seconds.
const RECOUNTED: usize = 1 << 16;

/// Of small scenes that need no mesh of others.
fn counts(records: &[Record]) -> BTreeMap<String, BTreeMap<String, String>> {
    let is_own = |record: &Record| {
        let scene = Builtin::find(&record.scene).ok().and_then(|builtin| builtin.scene(None).ok());
        scene.is_some_and(|scene| scene.hash() == record.scene_hash)
    };
    let counted = |record: &Record| {
        let rays = record.counted_rays as f64;
        let [tests, steps] = [record.tests_per_ray, record.steps_per_ray]
            .map(|per_ray| per_ray.map(|per_ray| libm::round(per_ray * rays) as u64));
        (record.label.clone(), work(record.counted_rays, record.hits, tests, steps))
    };
    let scenes = records.chunk_by(|a, b| a.scene == b.scene);
    let scenes = scenes.filter(|scene| scene[0].triangles <= RECOUNTED && is_own(&scene[0]));
    let of = |scene: &[Record]| {
        let primary = scene.iter().filter(|r| r.workload == WorkloadKind::Primary.name() && r.counted_rays > 0);
        (scene[0].scene.clone(), primary.map(counted).collect())
    };
    scenes.map(of).collect()
}

/// What a structure counts for so many rays.
fn work(rays: usize, hits: usize, tests: Option<u64>, steps: Option<u64>) -> String {
    let told = |n: Option<u64>, what: &str| n.map_or(String::new(), |n| format!(", {n} {what}"));
    format!("{rays} rays: {hits} hits{}{}", told(tests, "tests"), told(steps, "steps"))
}

/// Every statement of every study, the answer, the rank and the run by their keys.
fn statements(document: &Document, runs: &Runs, studies: &Studies, run: &RunFacts) -> BTreeMap<String, Told> {
    let mut all = BTreeMap::new();
    let mut add = |part: &str, Statement { key, sentence, value }: Statement| {
        all.insert(format!("{part}.{key}"), Told { text: sentence, value });
    };
    add("answer", Statement::new("verdict", format!("{}.", document.answer.verdict)));
    if let Some(sentence) = document.answer.sentences.first() {
        add("answer", Statement::new("why", sentence.clone()));
    }
    add("run", Statement::new("machine", run.sentence()));
    for study in studies.iter() {
        let found = runs.answers.get(study.name()).map_or(vec![], |answer| study.statements(answer));
        found.into_iter().for_each(|statement| add(study.name(), statement));
    }
    let mut add_table = |part: &str, key: &str, table: Option<Table>| {
        if let Some(table) = table {
            let text = Table { title: String::new(), notes: vec![], ..table }.to_markdown();
            add(part, Statement::new(key, text.trim().trim_start_matches('#').trim()));
        }
    };
    let ranked = ranks(runs.records()).map_or(vec![], |ranks| ranks.tables(runs.records()));
    add_table(CompareStudy::NAME, "rank", ranked.into_iter().next());
    all
}

impl RunFacts {
    /// # Errors
    /// If there is more than one commit or machine.
    fn new(all: &[Provenance]) -> Result<Self, ResultsError> {
        let one = |what: &'static str, of: fn(&Provenance) -> &String| -> Result<String, ResultsError> {
            let mut values: Vec<&str> = all.iter().map(|p| of(p).as_str()).collect();
            values.sort_unstable();
            values.dedup();
            match values[..] {
                [] => Ok("unknown".into()),
                [only] => Ok(only.into()),
                _ => Err(ResultsError::Mixed { what, values: values.join(", ") }),
            }
        };
        let mut days: Vec<String> = all.iter().map(|p| p.date.split('T').next().unwrap_or("").to_owned()).collect();
        days.sort_unstable();
        let ends =
            days.first().zip(days.last()).map_or([String::new(), String::new()], |(a, b)| [a.clone(), b.clone()]);
        let commands: Vec<String> = all.iter().map(|p| portable(&command_line(&p.command))).collect();
        Ok(Self {
            version: one("version", |p| &p.version)?,
            commit: one("commit", |p| &p.commit)?,
            cpu: one("machine", |p| &p.cpu)?,
            simd: one("instruction set", |p| &p.simd)?,
            threads: all.iter().map(|p| p.threads).max().unwrap_or(1),
            rustc: one("compiler", |p| &p.rustc)?,
            target: one("target", |p| &p.target)?,
            obvhs: one("version of obvhs", |p| &p.obvhs)?,
            days: ends,
            commands: distinct(commands.iter()),
        })
    }

    /// Commit, machine and day in one sentence.
    fn sentence(&self) -> String {
        let [first, last] = &self.days;
        let days = if first == last { first.clone() } else { format!("{first} to {last}") };
        let Self { version, commit, cpu, simd, .. } = self;
        format!(
            "All numbers are of one run of sahara {version}, commit {commit}, on {} ({cpu}, {simd}), {days}.",
            self.threads()
        )
    }

    /// How many threads build and trace.
    fn threads(&self) -> &'static str {
        if self.threads > 1 { "one thread where no other number is named" } else { "one thread" }
    }
}

/// A command without the folders of the machine that it ran on.
fn portable(command: &str) -> String {
    let name = |word: &str| match word.starts_with('/') {
        true => word.rsplit('/').next().unwrap_or(word).to_owned(),
        false => word.to_owned(),
    };
    command.split(' ').map(name).collect::<Vec<_>>().join(" ")
}
