//! `study all`: everything that the report shows, in one run that can be killed and goes on: with the epoch that it was measuring in
//! steps that keep a journal, from the beginning of the step in those that write at their end.

use std::path::{Path, PathBuf};
use std::time::Instant;

use anyhow::Context;
use serde::{Deserialize, Serialize};

use super::{attribution, break_even, costs, crossover, parameters, partitions, predictions, scaling};
use crate::cli::terminal::Terminal;
use crate::cli::{Verdict, accuracy, compare, replicate};
use crate::measure::{Provenance, program};
use crate::registry::Registry;
use crate::report::number::duration;
use crate::report::{Cell, Table};
use crate::scene::{BUILTIN, real_mesh_folder};
use crate::study::journal::{Header, Journal, JournalError, OF_ALL};

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

    /// Its own options.
    fn options(&self, args: &Args) -> &'static str {
        if args.quick { self.quick } else { self.full }
    }

    fn words(&self, args: &Args) -> Vec<String> {
        let path = |path: &Path| path.to_string_lossy().into_owned();
        let mut words: Vec<String> = self.options(args).split_whitespace().map(String::from).collect();
        if self.is_whole() {
            words.extend(["--export-json".into(), path(&args.dir.join(self.file))]);
        } else {
            words.extend(["--dir".into(), path(&args.dir)]);
            words.extend(args.fresh.then(|| "--fresh".to_owned()));
        }
        words
    }
}

/// What is kept of a step whose file is written whole.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
struct Done {
    /// The options that it ran with.
    options: String,
    found: Verdict,
}

/// What the journal of this run depends on besides the build and the machine.
#[derive(Debug, Serialize)]
struct Settings {
    quick: bool,
    /// The real meshes that are there, each with the first digits of its hash.
    meshes: String,
}

impl Settings {
    fn new(quick: bool) -> Self {
        let folder = real_mesh_folder();
        let objects = BUILTIN.iter().flat_map(|builtin| builtin.file().objects);
        let mut files: Vec<String> = objects.filter_map(|object| Some(object.real?.file)).collect();
        files.sort();
        files.dedup();
        let there = |file: String| Some(format!("{file} {}", program::file_id(&folder.join(&file)).ok()?));
        let there: Vec<String> = files.into_iter().filter_map(there).collect();
        Self { quick, meshes: if there.is_empty() { "none".into() } else { there.join(", ") } }
    }
}

/// The steps that are done, in the folder of the run: of this build, this machine and these settings.
struct Steps {
    journal: Journal<Done>,
    dir: PathBuf,
}

impl Steps {
    /// # Errors
    /// As [`Journal::open`].
    fn open(args: &Args) -> Result<Self, JournalError> {
        let header = Header::new(OF_ALL, &Settings::new(args.quick), Provenance::capture(1));
        let journal = Journal::open(&args.dir.join(format!("{OF_ALL}.jsonl")), header, args.fresh)?;
        Ok(Self { journal, dir: args.dir.clone() })
    }

    /// What the step came to whose file is there; nothing if there is none.
    ///
    /// # Errors
    /// If the file is not the one that this run has written, with the options of this run.
    fn found(&self, step: &Step, options: &str) -> anyhow::Result<Option<Verdict>> {
        let path = self.dir.join(step.file);
        if !step.is_whole() || !path.exists() {
            return Ok(None);
        }
        match self.journal.get(&self.key(step)?) {
            Some(done) if done.options == options => Ok(Some(done.found)),
            _ => anyhow::bail!(
                "{} is not what this run writes there: by its settings or its contents it is of another run: move it away to \
                 measure it, --fresh measures everything anew, --dir names another folder",
                path.display()
            ),
        }
    }

    /// Keeps that the step is done.
    ///
    /// # Errors
    /// As [`Journal::append`], and if the file of the step cannot be read.
    fn keep(&mut self, step: &Step, options: String, found: Verdict) -> anyhow::Result<()> {
        // A command that was stopped by wrong answers may have left nothing.
        if step.is_whole() && self.dir.join(step.file).exists() {
            let key = self.key(step)?;
            if self.journal.get(&key).is_none() {
                self.journal.append(&key, Done { options, found })?;
            }
        }
        Ok(())
    }

    /// The step and the contents of its file.
    fn key(&self, step: &Step) -> anyhow::Result<String> {
        let path = self.dir.join(step.file);
        let id = program::file_id(&path).with_context(|| format!("cannot read {}", path.display()))?;
        Ok(format!("{} {id}", step.name))
    }
}

pub fn run(registry: &Registry, args: &Args, terminal: &Terminal) -> anyhow::Result<Verdict> {
    std::fs::create_dir_all(&args.dir).map_err(|error| {
        anyhow::anyhow!("cannot make the folder {}: {error}: name another one with --dir", args.dir.display())
    })?;
    let mut rows = vec![];
    let mut verdict = Verdict::Right;
    let mut steps = Steps::open(args)?;
    for (i, step) in STEPS.iter().enumerate() {
        let words = step.words(args);
        // The folder does not matter to what is measured.
        let options = step.options(args).to_owned();
        let before = if args.fresh { None } else { steps.found(step, &options)? };
        let there = before.is_some();
        let rest: Vec<&str> = STEPS[i + 1..].iter().map(|step| step.name).collect();
        let left = if rest.is_empty() { "nothing".into() } else { rest.join(", ") };
        if !terminal.quiet {
            eprintln!("{}{}; then left: {left}", step.name, if there { " is done" } else { "" });
        }
        let start = Instant::now();
        let found = match before {
            Some(found) => found,
            None => {
                let found = (step.run)(registry, &words, terminal)?;
                steps.keep(step, options, found)?;
                found
            }
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
    fn a_file_counts_as_done_only_if_this_run_has_written_it() {
        let folder = tempfile::tempdir().unwrap();
        let args = Args { dir: folder.path().into(), fresh: false, quick: true };
        let step = STEPS.iter().find(|step| step.name == "compare").unwrap();
        let file = folder.path().join(step.file);
        let refused = |found: anyhow::Result<Option<Verdict>>| {
            let error = found.unwrap_err().to_string();
            assert!(["compare.json", "--fresh", "--dir"].iter().all(|part| error.contains(part)), "{error}");
        };
        let mut steps = Steps::open(&args).unwrap();
        assert_eq!(steps.found(step, step.quick).unwrap(), None);
        // A file of the right name that `compare` has written with whatever options.
        std::fs::write(&file, "[1]").unwrap();
        refused(steps.found(step, step.quick));
        steps.keep(step, step.quick.into(), Verdict::Wrong).unwrap();
        assert_eq!(steps.found(step, step.quick).unwrap(), Some(Verdict::Wrong));
        refused(steps.found(step, step.full));
        std::fs::write(&file, "[2]").unwrap();
        refused(steps.found(step, step.quick));
        std::fs::write(&file, "[1]").unwrap();
        drop(steps);

        // Another run goes on; one with other settings does not.
        let steps = Steps::open(&args).unwrap();
        assert_eq!(steps.found(step, step.quick).unwrap(), Some(Verdict::Wrong));
        drop(steps);
        let error = Steps::open(&Args { quick: false, ..args }).map(drop).unwrap_err().to_string();
        assert!(error.contains("quick was true and is false") && error.contains("--fresh"), "{error}");
    }

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
