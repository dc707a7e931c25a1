//! `study all`: everything that the report shows, in one run that can be killed and goes on.

use std::path::{Path, PathBuf};
use std::time::Instant;

use anyhow::Context;
use serde_json::Value;

use super::{attribution, break_even, costs, crossover, parameters, partitions, predictions, scaling};
use crate::cli::terminal::Terminal;
use crate::cli::{Verdict, accuracy, compare, replicate};
use crate::measure::Provenance;
use crate::registry::Registry;
use crate::report::number::duration;
use crate::report::{Cell, Record, Table};
use crate::study::documented_defect;

#[derive(Clone, Debug, clap::Args)]
pub struct Args {
    /// The folder of journals and results: the same command again goes on where the last one stopped
    #[arg(long, value_name = "DIR", default_value = "runs")]
    dir: PathBuf,
    /// Throw away what was measured before, and start anew
    #[arg(long)]
    fresh: bool,
    /// A few minutes for trying out: few scenes, rays and epochs; its numbers mean little
    #[arg(long)]
    quick: bool,
}

/// One study of the run.
struct Step {
    name: &'static str,
    run: fn(&Registry, &[String], &Terminal) -> anyhow::Result<Verdict>,
    /// What it leaves in the folder.
    file: &'static str,
    /// Options of the whole run.
    full: &'static str,
    /// Options of the quick run.
    quick: &'static str,
}

/// The command of a module as a step.
macro_rules! step {
    ($command:ident, $name:literal, $file:literal, $full:expr, $quick:expr) => {
        Step {
            name: $name,
            run: |registry, words, terminal| $command::run(registry, &parsed(words)?, terminal),
            file: $file,
            full: $full,
            quick: $quick,
        }
    };
}

/// A quick study of epochs.
const FEW: &str = "torus --epochs 2 --runs 2 --budget 1 --rays 1024";

/// In this order: the last one judges by what the others have left.
const STEPS: [Step; 11] = [
    step!(replicate, "replicate", "replicate.json", "", "--epochs 2 --runs 2 --budget 1"),
    step!(compare, "compare", "compare.json", "", "cube torus --rays 1024 --runs 2 --budget 1"),
    step!(attribution, "attribution", "attribution.jsonl", "", FEW),
    step!(parameters, "parameters", "parameters.jsonl", "", "cube torus --epochs 2 --runs 2 --budget 1"),
    step!(scaling, "scaling", "scaling.jsonl", "", "torus --finest 4 --epochs 2 --runs 2 --budget 1 --rays 1024"),
    step!(crossover, "crossover", "crossover.jsonl", "", "--epochs 2 --runs 2 --budget 1 --rays 1024"),
    step!(break_even, "break-even", "break-even.jsonl", "", FEW),
    step!(costs, "costs", "costs.jsonl", "", FEW),
    step!(
        accuracy,
        "accuracy",
        "accuracy.json",
        "dragon cornellbox --stratum uniform --stratum vertex --stratum grazing",
        "cube --stratum vertex --rays 500 --runs 2 --budget 1"
    ),
    step!(partitions, "partitions", "partitions.json", "", "torus --rays 1024 --runs 2 --epochs 2 --budget 2"),
    step!(predictions, "predictions", "predictions.json", "", ""),
];

/// The options of a command, from words.
fn parsed<T: clap::Args>(words: &[String]) -> anyhow::Result<T> {
    let matches = T::augment_args(clap::Command::new("study").no_binary_name(true)).try_get_matches_from(words)?;
    Ok(T::from_arg_matches(&matches)?)
}

impl Step {
    /// Whether the whole file is written at the end, so that its being there means that the step is done.
    fn is_whole(&self) -> bool {
        self.file.ends_with(".json") && self.name != "predictions"
    }

    fn words(&self, args: &Args) -> Vec<String> {
        let path = |path: &Path| path.to_string_lossy().into_owned();
        let own = if args.quick { self.quick } else { self.full };
        let mut words: Vec<String> = own.split_whitespace().map(String::from).collect();
        if self.is_whole() {
            words.extend(["--export-json".into(), path(&args.dir.join(self.file))]);
        } else {
            words.extend(["--dir".into(), path(&args.dir)]);
            words.extend(args.fresh.then(|| "--fresh".to_owned()));
        }
        words
    }
}

/// What a file that is written whole came to, if it is of this build, this machine and as quick a run as this one.
///
/// # Errors
/// If it is not, or does not read.
fn done(path: &Path, quick: bool) -> anyhow::Result<Verdict> {
    let again = "--fresh measures anew, --dir names another folder";
    let text = std::fs::read(path).with_context(|| format!("cannot read {}", path.display()))?;
    let value: Value = serde_json::from_slice(&text)
        .map_err(|error| anyhow::anyhow!("{} does not read: {error}: {again}", path.display()))?;
    let records = value.get("partitions").unwrap_or(&value);
    let provenance = value.get("provenance").or_else(|| records.get(0)?.get("provenance")).cloned().unwrap_or_default();
    let there: Provenance = serde_json::from_value(provenance)
        .map_err(|error| anyhow::anyhow!("{} does not say where it comes from: {error}: {again}", path.display()))?;
    let here = Provenance::capture(1);
    let same = (&there.commit, &there.cpu, &there.simd) == (&here.commit, &here.cpu, &here.simd);
    anyhow::ensure!(same, "{} is of another build or machine; times must not be mixed: {again}", path.display());
    let was_quick = there.command.split(' ').any(|word| word == "--quick");
    anyhow::ensure!(was_quick == quick, "{} is of a run with another --quick: {again}", path.display());
    let wrong = |record: &Record| record.is_disqualified() && documented_defect(&record.structure).is_none();
    let records: Vec<Record> = serde_json::from_value(records.clone()).unwrap_or_default();
    Ok(if records.iter().any(wrong) { Verdict::Wrong } else { Verdict::Right })
}

pub fn run(registry: &Registry, args: &Args, terminal: &Terminal) -> anyhow::Result<Verdict> {
    std::fs::create_dir_all(&args.dir).map_err(|error| {
        anyhow::anyhow!("cannot make the folder {}: {error}: name another one with --dir", args.dir.display())
    })?;
    let mut rows = vec![];
    let mut verdict = Verdict::Right;
    for (i, step) in STEPS.iter().enumerate() {
        let there = step.is_whole() && !args.fresh && args.dir.join(step.file).exists();
        let rest: Vec<&str> = STEPS[i + 1..].iter().map(|step| step.name).collect();
        let left = if rest.is_empty() { "nothing".into() } else { rest.join(", ") };
        if !terminal.quiet {
            eprintln!("{}{}; then left: {left}", step.name, if there { " is done" } else { "" });
        }
        let start = Instant::now();
        let found = if there {
            done(&args.dir.join(step.file), args.quick)?
        } else {
            (step.run)(registry, &step.words(args), terminal)?
        };
        let took = duration(start.elapsed().as_nanos() as f64);
        verdict = match (verdict, found) {
            (Verdict::Right, found) => found,
            (_, Verdict::Wrong) => Verdict::Wrong,
            (before, _) => before,
        };
        let words = match found {
            Verdict::Wrong => "wrong answers",
            Verdict::Refused => "a structure took no part",
            _ => "right",
        };
        let took: Cell = if there { "done before".into() } else { took.into() };
        rows.push(vec![step.name.into(), took, words.into(), step.file.into()]);
    }
    terminal.print_table(&Table {
        title: format!("All studies, in {}", args.dir.display()),
        columns: ["study", "took", "answers", "file"].map(String::from).into(),
        rows,
        notes: vec![format!("Nothing is left. `sahara report {} -o OUT` makes the page.", args.dir.display())],
    })?;
    Ok(verdict)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_step_takes_its_words() {
        for quick in [false, true] {
            let args = Args { dir: "runs".into(), fresh: true, quick };
            for step in &STEPS {
                let words = step.words(&args);
                let taken = match step.name {
                    "replicate" => parsed::<replicate::Args>(&words).map(drop),
                    "compare" => parsed::<compare::Args>(&words).map(drop),
                    "attribution" => parsed::<attribution::Args>(&words).map(drop),
                    "parameters" => parsed::<parameters::Args>(&words).map(drop),
                    "scaling" => parsed::<scaling::Args>(&words).map(drop),
                    "crossover" => parsed::<crossover::Args>(&words).map(drop),
                    "break-even" => parsed::<break_even::Args>(&words).map(drop),
                    "costs" => parsed::<costs::Args>(&words).map(drop),
                    "accuracy" => parsed::<accuracy::Args>(&words).map(drop),
                    "partitions" => parsed::<partitions::Args>(&words).map(drop),
                    "predictions" => parsed::<predictions::Args>(&words).map(drop),
                    other => panic!("{other} is not known"),
                };
                assert!(taken.is_ok(), "{}: {:?}", step.name, taken);
            }
        }
    }
}
