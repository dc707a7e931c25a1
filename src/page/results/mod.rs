//! `report --results`: a paper, a data file, and the generated texts in README.
//!
//! The data file contains digests of the paper, the figures and the tables. A test compares README, the paper, the
//! figures and the tables with the data file.

mod marks;
mod paper;
#[cfg(test)]
mod tests;

use std::collections::BTreeMap;

use anyhow::Context;
use serde::{Deserialize, Serialize};

pub use marks::{OPEN, fill, marked};

use super::document::Document;
use super::runs::Runs;
use super::sections::tally;
use crate::measure::program::digest;
use crate::measure::{Estimate, Provenance};
use crate::report::plot::WIDTH;
use crate::report::words::each_once;
use crate::study::Studies;

pub const COMMAND: &str = "sahara report RUN.. --results";

pub const PAPER: &str = "RESULTS.md";
pub const DATA: &str = "results.json";
pub const FIGURES: &str = "figures";
/// The folder with the CSV files of the long tables.
pub const TABLES: &str = "results";

/// Each element is the name and the content of a file.
pub type Files = Vec<(String, Vec<u8>)>;

pub struct Results {
    pub data: ResultsData,
    pub paper: String,
    pub figures: Files,
    pub tables: Files,
}

#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct ResultsData {
    pub schema: u32,
    pub made_by: String,
    pub run: RunFacts,
    /// A key is `GROUP.FINDING`, such as `run.machine`. A group is `answer`, `claims`, `run` or the name of a study.
    pub statements: BTreeMap<String, Statement>,
    /// SHA-256 digests of the paper, figures and tables. A key is a path relative to the data file.
    pub files: BTreeMap<String, String>,
}

/// A finding. If the finding has no sentence, `text` is empty.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Statement {
    pub text: String,
    pub value: Option<Estimate>,
}

impl Results {
    /// `document` must be made from `runs`.
    pub fn new(document: &Document, runs: &Runs) -> anyhow::Result<Self> {
        let run = RunFacts::new(runs)?;
        let statements = statements(document, runs, &run);
        let (mut paper, tables) = paper::text(document, runs, &run);
        let answer = document.answer.chart.as_ref().map(|chart| (paper::ANSWER.into(), chart.svg(WIDTH).into_bytes()));
        let mut figures: Files = answer.into_iter().collect();
        for figure in document.figures() {
            let path = paper::path(&figure.id);
            let Some(chart) = figure.chart().filter(|_| paper.contains(&path)) else { continue };
            // The chart of the answer may equal the chart of a study. Equal charts are written only once.
            let bytes = chart.svg(WIDTH).into_bytes();
            match figures.iter().find(|(_, known)| *known == bytes) {
                Some((known, _)) => paper = paper.replace(&path, &format!("{FIGURES}/{known}")),
                None => figures.push((format!("{}.svg", figure.id), bytes)),
            }
        }
        let mut files = BTreeMap::from([(PAPER.to_owned(), digest(paper.as_bytes()))]);
        for (folder, own) in [(FIGURES, &figures), (TABLES, &tables)] {
            files.extend(own.iter().map(|(name, bytes)| (format!("{folder}/{name}"), digest(bytes))));
        }
        let data = ResultsData { schema: 3, made_by: COMMAND.into(), run, statements, files };
        Ok(Self { data, paper, figures, tables })
    }

    /// Fills the marked places of `readme`. A missing statement of a study becomes `Not measured in this run`.
    pub fn fill(&mut self, readme: &str, studies: &Studies) -> anyhow::Result<String> {
        for (key, _) in marked(readme).context("README.md")? {
            if self.data.statements.contains_key(&key) {
                continue;
            }
            let study = studies.iter().find(|study| key.split('.').next() == Some(study.name));
            let study = study.ok_or_else(|| {
                let known = self.data.statements.keys().map(String::as_str).collect::<Vec<_>>().join(", ");
                anyhow::anyhow!("README.md marks {key:?}, but there is no such statement; the statements are: {known}")
            })?;
            let text = format!("Not measured in this run (`{}`).", study.command_line());
            self.data.statements.insert(key, Statement { text, value: None });
        }
        fill(readme, |key| self.data.statements.get(key).map(|statement| statement.text.clone())).context("README.md")
    }

    pub fn json(&self) -> Vec<u8> {
        let mut bytes = serde_json::to_vec_pretty(&self.data).expect("keys are text");
        bytes.push(b'\n');
        bytes
    }
}

fn statements(document: &Document, runs: &Runs, run: &RunFacts) -> BTreeMap<String, Statement> {
    let sentence = |text: String| Statement { text, value: None };
    let mut all = BTreeMap::new();
    all.insert("answer.verdict".to_owned(), sentence(format!("{}.", document.answer.verdict)));
    let why = document.answer.sentences.first();
    all.extend(why.map(|why| ("answer.why".to_owned(), sentence(why.clone()))));
    all.insert("claims.tally".into(), sentence(tally(runs)));
    all.insert("run.machine".into(), sentence(run.sentence()));
    for own in &runs.studies {
        for finding in &own.report.findings {
            let statement = Statement { text: finding.sentence.clone(), value: finding.value };
            all.insert(format!("{}.{}", own.study.name, finding.key), statement);
        }
    }
    all
}

#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct RunFacts {
    pub version: String,
    pub commit: String,
    pub cpu: String,
    pub simd: String,
    /// The maximum thread count over all studies.
    pub threads: usize,
    pub rustc: String,
    pub target: String,
    pub obvhs: String,
    /// The earliest and the latest day of the measurements, in UTC.
    pub days: [String; 2],
    pub commands: Vec<String>,
}

impl RunFacts {
    /// Rejects runs of different builds or machines.
    pub fn new(runs: &Runs) -> anyhow::Result<Self> {
        let all = runs.provenances();
        let one = |what: &'static str, of: fn(&Provenance) -> &String| -> anyhow::Result<String> {
            let mut values: Vec<&str> = all.iter().map(|p| of(p).as_str()).collect();
            values.sort_unstable();
            values.dedup();
            match values[..] {
                [] => Ok("unknown".into()),
                [only] => Ok(only.into()),
                _ => anyhow::bail!(
                    "these runs have more than one {what} ({}), but --results needs a single run: measure everything \
                     again into a new folder",
                    values.join(", ")
                ),
            }
        };
        let days = || all.iter().map(|p| p.date.split('T').next().unwrap_or("").to_owned());
        Ok(Self {
            version: one("version", |p| &p.version)?,
            commit: one("commit", |p| &p.commit)?,
            cpu: one("machine", |p| &p.cpu)?,
            simd: one("instruction set", |p| &p.simd)?,
            threads: all.iter().map(|p| p.threads).max().unwrap_or(1),
            rustc: one("compiler", |p| &p.rustc)?,
            target: one("target", |p| &p.target)?,
            obvhs: one("version of obvhs", |p| &p.obvhs)?,
            days: [days().min().unwrap_or_default(), days().max().unwrap_or_default()],
            commands: each_once(runs.commands().iter().map(|command| portable(command))),
        })
    }

    pub fn sentence(&self) -> String {
        let [first, last] = &self.days;
        let days = if first == last { first.clone() } else { format!("{first} to {last}") };
        let threads = if self.threads > 1 { "one thread unless another number is given" } else { "one thread" };
        let Self { version, commit, cpu, simd, .. } = self;
        format!(
            "All numbers come from one run of sahara {version}, commit {commit}, on {threads} ({cpu}, {simd}), {days}."
        )
    }
}

/// Shortens each absolute path in a command to the file name.
fn portable(command: &str) -> String {
    let name = |(i, word): (usize, &str)| match word.rsplit('/').next() {
        _ if i == 0 => "sahara".to_owned(),
        Some(last) if word.starts_with('/') => last.to_owned(),
        _ => word.to_owned(),
    };
    command.split(' ').enumerate().map(name).collect::<Vec<_>>().join(" ")
}
