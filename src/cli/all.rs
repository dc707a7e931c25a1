//! `study all`: everything that the page shows, in one run that can be killed and goes on with the case that it was measuring.

use std::ffi::OsString;
use std::path::PathBuf;
use std::time::Instant;

use super::progress::Waiting;
use super::study::{Common, RUNS, run_as};
use super::{Session, interrupt};
use crate::escaped::Escaped as _;
use crate::report::Table;
use crate::report::number::duration;
use crate::study::journal::JournalError;
use crate::study::{Chosen, Effort, Status, sources};

/// Name of the command.
pub const NAME: &str = "all";

/// Every study, one after the other: a run that is killed goes on with the case that it was at
#[derive(Clone, Debug, clap::Args)]
pub struct Args {
    /// The folder of journals: the same command again goes on where the last one stopped
    #[arg(long, value_name = "DIR", default_value = RUNS)]
    dir: PathBuf,
    /// Throw away what was measured before, and start anew
    #[arg(long)]
    fresh: bool,
    /// Measure all scenes and epochs in one process: quicker, but how it happens to lie in memory is then in none of the
    /// intervals
    #[arg(long)]
    in_process: bool,
    /// A few minutes for trying out: few scenes, rays and epochs; its numbers mean little
    #[arg(long)]
    quick: bool,
    /// Scenes and mesh files, in place of those of each study; some have scenes of their own
    #[arg(long, value_name = "SCENE|FILE", num_args = 1..)]
    scenes: Vec<OsString>,
}

impl Args {
    /// How much is measured, and of which scenes.
    pub fn chosen(&self) -> Chosen<'static> {
        Chosen::Preset(if self.quick { Effort::Quick } else { Effort::Full }, self.scenes.clone())
    }
}

pub fn run(session: &Session, args: &Args) -> anyhow::Result<Status> {
    let &Session { suite, terminal, .. } = session;
    let common =
        Common { dir: Some(args.dir.clone()), fresh: args.fresh, in_process: args.in_process, ..Common::default() };
    if !args.scenes.is_empty() {
        // What is not there is refused before the studies that have scenes of their own are measured.
        let _waiting = Waiting::show("loads scenes".into(), terminal);
        sources::scenes(&args.scenes)?;
    }
    let mut outcome = Status::Right;
    let (mut rows, mut notes) = (vec![], vec![]);
    let studies = suite.studies.in_order_of_measuring();
    for (i, study) in studies.iter().enumerate() {
        let rest: Vec<&str> = studies[i + 1..].iter().map(|study| study.name()).collect();
        let left = if rest.is_empty() { "nothing".into() } else { rest.join(", ") };
        terminal.tell(&format!("{}; then left: {left}", study.name()));
        if let Some(why) = study.cannot_be_measured_here() {
            rows.push([study.name().into(), "-".into(), "left out".into(), "-".into()]);
            notes.push(format!("{}: left out, for {why}.", study.name()));
            continue;
        }
        let start = Instant::now();
        let found = match run_as(session, *study, args.chosen(), &common) {
            Err(error) if !ends_all(&error) => {
                crate::output::tell_error(format_args!("{}: {error:#}", study.name()));
                Status::Failed
            }
            found => found?,
        };
        if found == Status::Interrupted || interrupt::is_asked() {
            return Ok(Status::Interrupted);
        }
        outcome = outcome.and(found);
        let words = match found {
            Status::Wrong => "wrong answers",
            Status::Failed => "failed",
            Status::Refused => "a structure took no part",
            _ => "right",
        };
        let took = duration(start.elapsed().as_nanos() as f64);
        rows.push([study.name().into(), took, words.into(), format!("{}/", study.name())]);
    }
    let title = format!("All studies, in {}", args.dir.escaped());
    // Without the cases that were measured before.
    let mut table = Table::of_texts(&title, ["study", "took this time", "answers", "journal"], rows);
    table.notes.append(&mut notes);
    table.notes.push(format!("{} `sahara report {} -o OUT` makes the page.", left(outcome), args.dir.escaped()));
    terminal.print_table(&table);
    Ok(outcome)
}

/// What there is still to be measured; scenes may have failed beside wrong answers, which weigh more.
fn left(outcome: Status) -> &'static str {
    match outcome {
        Status::Failed => "The same command tries again what failed.",
        Status::Wrong => "The same command tries again what failed, if anything has.",
        _ => "Nothing is left.",
    }
}

/// Whether the next studies would fare no better: nothing can be written into the folder of journals, or another run
/// measures there, beside which none is to be measured.
fn ends_all(error: &anyhow::Error) -> bool {
    let of_journal = error.downcast_ref::<JournalError>();
    matches!(of_journal, Some(JournalError::Write { .. } | JournalError::Place(_) | JournalError::Busy(_)))
}

#[cfg(test)]
mod tests {
    use std::fs;
    use std::path::Path;

    use super::*;
    use crate::cli::Suite;
    use crate::cli::terminal::{Colour, Terminal};
    use crate::registry::Registry;
    use crate::study::Studies;
    use crate::study::tests::Tiny;

    /// What becomes of a study whose scenes fail and one that is right.
    fn found(folder: &Path) -> Status {
        let studies = Studies::empty().with::<Tiny<true>>().with::<Tiny<false>>();
        let suite = Suite { registry: Registry::empty(), studies };
        let session = Session { suite: &suite, terminal: &Terminal::new(Colour::Never, true), processes: None };
        let args = Args { dir: folder.into(), fresh: false, in_process: true, quick: false, scenes: vec![] };
        run(&session, &args).unwrap()
    }

    #[track_caller]
    fn is_measured(folder: &Path) {
        assert_eq!(fs::read_dir(folder.join("right")).unwrap().count(), 6);
    }

    #[test]
    fn a_study_whose_scenes_fail_does_not_keep_the_next_one_from_being_measured() {
        let folder = tempfile::tempdir().unwrap();
        let outcome = found(folder.path());
        assert_eq!(outcome, Status::Wrong);
        assert!(left(outcome).contains("what failed") && !left(Status::Right).contains("what failed"));
        is_measured(folder.path());
    }

    #[test]
    fn nor_does_a_folder_that_holds_something_else() {
        let folder = tempfile::tempdir().unwrap();
        let own = folder.path().join("failing");
        fs::create_dir(&own).unwrap();
        fs::write(own.join("foreign.json"), "{}").unwrap();
        assert_eq!(found(folder.path()), Status::Failed);
        is_measured(folder.path());
    }
}
