//! `study all`: everything that the page shows, in one run that can be killed and goes on with the case that it was measuring.

use std::path::PathBuf;
use std::time::Instant;

use super::study::{Common, RUNS, run_as};
use super::{Session, interrupt};
use crate::report::Table;
use crate::report::number::duration;
use crate::study::{Chosen, Effort, Status};

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
    /// Measure all epochs in one process: quicker, but how it happens to lie in memory is then in none of the intervals
    #[arg(long)]
    in_process: bool,
    /// A few minutes for trying out: few scenes, rays and epochs; its numbers mean little
    #[arg(long)]
    quick: bool,
    /// Scenes and mesh files, in place of those of each study; some have scenes of their own
    #[arg(long, value_name = "SCENE|FILE", num_args = 1..)]
    scenes: Vec<String>,
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
        let found = run_as(session, *study, args.chosen(), &common)?;
        if found == Status::Interrupted || interrupt::is_asked() {
            return Ok(Status::Interrupted);
        }
        outcome = outcome.and(found);
        let words = match found {
            Status::Wrong => "wrong answers",
            Status::Refused => "a structure took no part",
            _ => "right",
        };
        let took = duration(start.elapsed().as_nanos() as f64);
        rows.push([study.name().into(), took, words.into(), format!("{}/", study.name())]);
    }
    let title = format!("All studies, in {}", args.dir.display());
    let mut table = Table::of_texts(&title, ["study", "took", "answers", "journal"], rows);
    table.notes.append(&mut notes);
    table.notes.push(format!("Nothing is left. `sahara report {} -o OUT` makes the page.", args.dir.display()));
    terminal.print_table(&table)?;
    Ok(outcome)
}
