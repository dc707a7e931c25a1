//! `compare`, with the baselines that it is held against.

use std::ffi::OsString;
use std::path::PathBuf;

use clap::parser::ValueSource;
use clap::{ArgMatches, Args as _, FromArgMatches};

use super::progress::OnTerminal;
use super::study::{Common, RUNS};
use super::terminal::Terminal;
use super::{Session, Suite, study};
use crate::escaped::Escaped as _;
use crate::measure::{Provenance, SystemClock};
use crate::output::OutputFile;
use crate::registry::Registry;
use crate::report::to_json;
use crate::scene::WorkloadKind;
use crate::study::baseline::{
    Run, SCENES, against, may_replace, new_baseline_path, outcome as held_against, read_baseline,
};
use crate::study::compare::{CompareArgs, CompareStudy, Compared, Reference, brief_table, refusals, scene_table};
use crate::study::diff::{Comparison, tables};
use crate::study::epoch::{Epoch, Settings, troubles};
use crate::study::history;
use crate::study::job::Job;
use crate::study::process;
use crate::study::{AnyStudy, BRUTE_FORCE, Chosen, Plan, Screen, Status, Study as _, StudyError};

/// Options about runs that are kept.
#[derive(Clone, Debug, clap::Args)]
#[command(
    next_help_heading = "Baselines, which change these defaults: teapot, starters and cornellbox, without brute-force; primary, \
                               shadow and diffuse rays; 12 epochs of 3 samples, and no budget"
)]
struct Gate {
    /// Keep this run under a name, with four times as many epochs, unless answers are wrong
    #[arg(long, value_name = "NAME", conflicts_with = "quick")]
    save_baseline: Option<String>,
    /// Hold this run against one that was kept
    #[arg(long, value_name = "NAME", conflicts_with = "quick")]
    baseline: Option<String>,
    /// Fail, with status 3, if a structure is slower than in the baseline by more than so many per cent; with 4 if that cannot be
    /// told with four times as many epochs
    #[arg(long, value_name = "PCT", requires = "baseline", conflicts_with = "quick", value_parser = percent)]
    fail_on_regression: Option<f64>,
}

/// Epochs of a baseline that is kept, and the most where nothing is decided, as a multiple of those asked for.
const MOST: u16 = 4;

/// More epochs are taken so many at a time.
const STEP: u16 = 4;

fn percent(text: &str) -> Result<f64, String> {
    let percent = text.trim_end_matches('%').parse::<f64>().map_err(|error| error.to_string())?;
    if percent > 0.0 && percent <= 1000.0 { Ok(percent) } else { Err("it must lie above 0 and be at most 1000".into()) }
}

/// The command.
pub fn command(study: &dyn AnyStudy) -> clap::Command {
    Gate::augment_args(study::command(study)).about(study.question()).long_about(None)
}

pub fn run(session: &Session, matches: &ArgMatches) -> anyhow::Result<Status> {
    let gate = Gate::from_arg_matches(matches)?;
    if gate.is_asked_for() {
        return gated(session, &gate, matches);
    }
    let compare = session.suite.studies.find(super::COMPARE).expect("its command is there");
    study::run(session, compare, matches)
}

/// What a process with a job does that a run of this command has started.
pub fn answer_job(suite: &Suite, matches: &ArgMatches, job: &Job) -> anyhow::Result<()> {
    if Gate::from_arg_matches(matches)?.is_asked_for() {
        return Ok(process::answer(|| gated_plan(&suite.registry, matches).map(|(_, plan)| plan), job)?);
    }
    let compare = suite.studies.find(super::COMPARE).expect("its command is there");
    compare.answer_job(Chosen::Matches(matches), &suite.registry, job)
}

impl Gate {
    fn is_asked_for(&self) -> bool {
        self.save_baseline.is_some() || self.baseline.is_some()
    }
}

fn options(matches: &ArgMatches) -> anyhow::Result<CompareArgs> {
    let mut args = CompareArgs::from_arg_matches(matches)?;
    let is_default = |id: &str| matches.value_source(id) == Some(ValueSource::DefaultValue);
    if args.scenes.scenes.is_empty() && args.rays.file().is_none() {
        args.scenes.scenes = SCENES.map(OsString::from).into();
    }
    if args.workload.is_empty() && args.rays.file().is_none() {
        args.workload = vec![WorkloadKind::Primary, WorkloadKind::Shadow, WorkloadKind::Diffuse];
    }
    if is_default("epochs") {
        args.measuring.epochs = 12;
    }
    if is_default("runs") {
        args.measuring.runs = 3;
    }
    Ok(args)
}

/// The options, and the most epochs that may be needed.
fn gated_plan(registry: &Registry, matches: &ArgMatches) -> anyhow::Result<(CompareArgs, Plan<Epoch>)> {
    let args = options(matches)?;
    let (scenes, settings) = args.settings(registry)?;
    // Another run must take the same rays: no budget decides how many.
    let mut settings = Settings { slowest: f64::INFINITY, ..settings };
    if matches.value_source("budget") == Some(ValueSource::DefaultValue) {
        settings.budget_ns = u64::MAX;
    }
    if args.structures.structure.is_empty() && !args.named().names_brute_force() {
        settings.structures.retain(|choice| choice.entry.name != BRUTE_FORCE);
    }
    let most = args.measuring.epochs.saturating_mul(MOST);
    Ok((args, settings.plan(scenes, most)))
}

/// Measures, keeps, and holds against what was kept.
fn gated(session: &Session, gate: &Gate, matches: &ArgMatches) -> anyhow::Result<Status> {
    let terminal = session.terminal;
    let common = Common::from_arg_matches(matches)?;
    anyhow::ensure!(options(matches)?.measuring.epochs > 1, "a baseline needs two epochs or more: --epochs 2");
    let folder = common.dir.clone().unwrap_or_else(|| PathBuf::from(RUNS));
    let baseline = gate.baseline.as_deref().map(|name| read_baseline(&folder, name)).transpose()?;
    let kept = gate.save_baseline.as_deref().map(|name| new_baseline_path(&folder, name)).transpose()?;
    let kept = kept.as_deref().map(OutputFile::check).transpose()?;
    let past = folder.join("baselines").join(history::FILE);
    if kept.is_some() {
        // What cannot be added to is refused before the long run.
        history::read(&past)?;
    }
    let json = common.export_json.as_deref().map(OutputFile::check).transpose()?;
    let mut screen = OnTerminal::new(terminal);
    let (args, plan) = gated_plan(&session.suite.registry, matches)?;
    let most = args.measuring.epochs.saturating_mul(MOST);
    let first = if kept.is_some() { most } else { args.measuring.epochs };
    let clock = SystemClock::start();
    let mut run = Run::new(&plan, session.processes(&common), &clock);
    // Where nothing is decided there are more epochs and another look.
    let looks = 1 + usize::from(most - first).div_ceil(STEP.into());
    let process_per_epoch = session.processes(&common).is_some();
    let provenance = Provenance { process_per_epoch, ..Provenance::of(&plan.threads) };
    if let Some(name) = &gate.save_baseline {
        may_replace(&folder, name, &provenance)?;
    }
    screen.begin(Plan::<Epoch>::work(&plan.cases));
    screen.warn(&plan.warnings);
    screen.warn(provenance.too_many_threads().as_slice());
    let (compared, comparison) = loop {
        let step = if run.epochs() == 0 { first } else { STEP };
        for _ in 0..step {
            let measured = run.epoch(&mut screen);
            if screen.is_interrupted() {
                screen.end();
                terminal.print_lines(&["Interrupted: nothing is kept of a run for a baseline.".into()]);
                return Ok(Status::Interrupted);
            }
            measured?;
        }
        let compared = run.compared(&provenance);
        let compare = |old: &Vec<_>| against(old, &compared, gate.fail_on_regression, looks);
        let comparison = baseline.as_ref().map(compare).transpose()?;
        let open = comparison.as_ref().is_some_and(|c| held_against(c) == Status::Undecided);
        if !open || run.epochs() >= usize::from(most) {
            break (compared, comparison);
        }
    };
    anyhow::ensure!(!compared.records.is_empty(), StudyError::Nothing);
    screen.warn(&CompareStudy::warnings(&compared));
    screen.end();

    print(&compared, comparison.as_ref(), args.wide, terminal);
    terminal.print_lines(&refusals(&compared.refused));
    terminal.print_lines(&plan.notes);
    terminal.print_lines(&[provenance.line()]);
    if let Some(file) = json {
        file.write(&to_json(&compared.records))?;
    }
    let own = Status::of(&troubles(&run.all()));
    let found = match (own, comparison.as_ref().map(held_against)) {
        (Status::Wrong, _) | (_, None) => own,
        (own, Some(Status::Right)) => own,
        (_, Some(against)) => against,
    };
    if let Some(file) = kept {
        let line = if found == Status::Wrong {
            "Not kept as a baseline: answers are wrong.".into()
        } else {
            file.write(&to_json(&compared.records))?;
            let name = gate.save_baseline.as_deref().unwrap_or_default();
            let added = match history::Entry::new(name, &compared.records) {
                Some(entry) => {
                    history::add(&past, entry)?;
                    format!("added to {}", past.escaped())
                }
                None => "not added to the history, for no structure of obvhs over its own triangle test has a time to relate others to".into(),
            };
            format!("Kept as baseline {name}: {}; {added}.", file.path().escaped())
        };
        terminal.print_lines(&[line]);
    }
    Ok(found)
}

fn print(compared: &Compared, comparison: Option<&Comparison>, wide: bool, terminal: &Terminal) {
    if let Some(comparison) = comparison {
        return tables(comparison).iter().for_each(|table| terminal.print_table(table));
    }
    for records in compared.records.chunk_by(|a, b| a.scene == b.scene) {
        let refused: Vec<_> = compared.refused.iter().filter(|r| r.scene == records[0].scene).cloned().collect();
        let table = if wide { scene_table } else { brief_table };
        terminal.print_table(&table(records, &Reference::of(records, None), &refused));
    }
}
