//! The command `study all`: runs all studies.

use std::ffi::OsString;
use std::time::Instant;

use super::progress::spinner;
use super::study::{Common, Keeping, RUNS, run_as};
use super::{Session, interrupt};
use crate::escaped::Escaped as _;
use crate::report::Table;
use crate::report::number::duration;
use crate::request::{MEASURING, SCENES, scenes};
use crate::study::journal::JournalError;
use crate::study::{Status, Study};

pub const NAME: &str = "all";

/// Run every study; the same command resumes a killed run
#[derive(Clone, Debug, clap::Args)]
#[command(next_help_heading = MEASURING)]
pub struct Args {
    #[command(flatten)]
    keeping: Keeping,
    /// Run everything in a few minutes, with few scenes, rays and epochs: to try the program, not for results
    #[arg(long)]
    quick: bool,
    /// Scenes and mesh files instead of each study's own; `replicate` ignores this
    #[arg(long, help_heading = SCENES, value_name = "SCENE|FILE", num_args = 1..)]
    scenes: Vec<OsString>,
}

pub fn run(session: &Session, args: &Args) -> anyhow::Result<Status> {
    let &Session { suite, terminal, .. } = session;
    let dir = args.keeping.dir.clone().unwrap_or_else(|| RUNS.into());
    let keeping = Keeping { dir: Some(dir.clone()), ..args.keeping.clone() };
    let common = Common { keeping, ..Common::default() };
    if !args.scenes.is_empty() {
        // Reject a missing scene before the first measurement.
        let _waiting = spinner("loading scenes", terminal);
        scenes(&suite.registry, &args.scenes)?;
    }
    let (mut outcome, mut rows) = (Status::Right, vec![]);
    let studies: Vec<&Study> = suite.studies.iter().collect();
    for (i, study) in studies.iter().enumerate() {
        let rest: Vec<&str> = studies[i + 1..].iter().map(|study| study.name).collect();
        let left = if rest.is_empty() { "nothing".into() } else { rest.join(", ") };
        terminal.print_message(&format!("{}; remaining: {left}", study.name));
        let start = Instant::now();
        let preset = if args.quick { study.presets.quick } else { study.presets.full };
        let words = study.preset(preset, &args.scenes);
        let found = study.matches(&words).map_err(anyhow::Error::from);
        let found = match found.and_then(|matches| run_as(session, study, &matches, &common)) {
            Err(error) if !ends_all(&error) => {
                crate::output::print_error(format_args!("{}: {error:#}", study.name));
                Status::Failed
            }
            found => found?,
        };
        if found == Status::Interrupted || interrupt::is_asked() {
            return Ok(Status::Interrupted);
        }
        outcome = outcome.and(found);
        let words = match found {
            Status::Wrong => "wrong hits",
            Status::Failed => "failed",
            Status::Refused => "a structure failed or was skipped",
            _ => "correct",
        };
        let took = duration(start.elapsed().as_nanos() as f64);
        rows.push([study.name.into(), took, words.into(), format!("{}/", study.name)]);
    }
    let left = match outcome {
        Status::Failed => "The same command retries what failed.",
        // If the outcome is `Status::Wrong`, some measurements may also have failed.
        Status::Wrong => "The same command retries anything that failed.",
        _ => "Everything is measured.",
    };
    let dir = dir.escaped();
    // The times exclude cases that earlier runs have measured.
    let table = Table::of_texts(&format!("All studies in {dir}"), ["study", "time taken", "result", "journal"], rows);
    terminal.print_table(&table.noted([format!("{left} `sahara report {dir} -o OUT` writes the page.")]));
    Ok(outcome)
}

/// Whether all later studies would fail with the same error.
fn ends_all(error: &anyhow::Error) -> bool {
    let of_journal = error.downcast_ref::<JournalError>();
    matches!(of_journal, Some(JournalError::Write { .. } | JournalError::Place(_) | JournalError::Busy(_)))
}
