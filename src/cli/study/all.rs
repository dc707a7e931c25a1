//! `study all`: every study, `compare` and `replicate` in one run that can be killed and goes on.

use std::path::{Path, PathBuf};
use std::time::Instant;

use super::{attribution, break_even, costs, crossover, parameters, predictions, scaling};
use crate::cli::terminal::Terminal;
use crate::cli::{Verdict, compare, replicate};
use crate::registry::Registry;
use crate::report::number::duration;
use crate::report::{Cell, Table};

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
    /// Options of the quick run.
    quick: &'static [&'static str],
}

/// In this order: the last one judges by what the others have left.
const STEPS: [Step; 9] = [
    Step {
        name: "replicate",
        run: |registry, words, terminal| replicate::run(registry, &parsed(words)?, terminal),
        file: "replicate.json",
        quick: &["--runs", "1"],
    },
    Step {
        name: "compare",
        run: |registry, words, terminal| compare::run(registry, &parsed(words)?, terminal),
        file: "compare.json",
        quick: &["cube", "torus", "--rays", "1024", "--runs", "2", "--budget", "1"],
    },
    Step {
        name: "attribution",
        run: |registry, words, terminal| attribution::run(registry, &parsed(words)?, terminal),
        file: "attribution.jsonl",
        quick: &["torus", "teapot", "--epochs", "2", "--runs", "2", "--budget", "1", "--rays", "1024"],
    },
    Step {
        name: "parameters",
        run: |registry, words, terminal| parameters::run(registry, &parsed(words)?, terminal),
        file: "parameters.jsonl",
        quick: &["cube", "torus", "--epochs", "2", "--runs", "2", "--budget", "1"],
    },
    Step {
        name: "scaling",
        run: |registry, words, terminal| scaling::run(registry, &parsed(words)?, terminal),
        file: "scaling.jsonl",
        quick: &["torus", "--finest", "4", "--epochs", "2", "--runs", "2", "--budget", "1", "--rays", "1024"],
    },
    Step {
        name: "crossover",
        run: |registry, words, terminal| crossover::run(registry, &parsed(words)?, terminal),
        file: "crossover.jsonl",
        quick: &["--epochs", "2", "--runs", "2", "--budget", "1", "--rays", "1024"],
    },
    Step {
        name: "break-even",
        run: |registry, words, terminal| break_even::run(registry, &parsed(words)?, terminal),
        file: "break-even.jsonl",
        quick: &["torus", "--epochs", "2", "--runs", "2", "--budget", "1", "--rays", "1024"],
    },
    Step {
        name: "costs",
        run: |registry, words, terminal| costs::run(registry, &parsed(words)?, terminal),
        file: "costs.jsonl",
        quick: &["torus", "--epochs", "2", "--runs", "2", "--budget", "1", "--rays", "1024"],
    },
    Step {
        name: "predictions",
        run: |registry, words, terminal| predictions::run(registry, &parsed(words)?, terminal),
        file: "predictions.json",
        quick: &[],
    },
];

/// The options of a command, from words.
fn parsed<T: clap::Args>(words: &[String]) -> anyhow::Result<T> {
    let matches = T::augment_args(clap::Command::new("study").no_binary_name(true)).try_get_matches_from(words)?;
    Ok(T::from_arg_matches(&matches)?)
}

impl Step {
    /// Whether the whole file is written at the end, so that its being there means that the step is done.
    fn is_whole(&self) -> bool {
        ["replicate.json", "compare.json"].contains(&self.file)
    }

    fn words(&self, args: &Args) -> Vec<String> {
        let path = |path: &Path| path.to_string_lossy().into_owned();
        let mut words: Vec<String> =
            if args.quick { self.quick.iter().map(|&word| word.into()).collect() } else { vec![] };
        if self.is_whole() {
            words.extend(["--export-json".into(), path(&args.dir.join(self.file))]);
        } else {
            words.extend(["--dir".into(), path(&args.dir)]);
            words.extend(args.fresh.then(|| "--fresh".to_owned()));
        }
        words
    }
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
        let found = if there { Verdict::Right } else { (step.run)(registry, &step.words(args), terminal)? };
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
                    "predictions" => parsed::<predictions::Args>(&words).map(drop),
                    other => panic!("{other} is not known"),
                };
                assert!(taken.is_ok(), "{}: {:?}", step.name, taken);
            }
        }
    }
}
