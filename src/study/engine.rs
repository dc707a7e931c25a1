//! Runs a study: measures the cases that its journal lacks, one by one, and answers.

use std::io;
use std::path::Path;

use serde::Serialize;
use serde::de::DeserializeOwned;

use super::journal::{Header, Journal};
use super::process::{Job, Processes};
use super::{Answers, AnyAnswer, Context, Plan, Planned, Stage, Status, Studies, Study, StudyError};
use crate::measure::{Clock, Provenance, SystemClock};
use crate::registry::Registry;
use crate::report::Table;

/// What a study is run with.
pub struct Run<'a> {
    pub registry: &'a Registry,
    pub studies: &'a Studies,
    /// Where the journal is kept; nothing keeps none.
    pub folder: Option<&'a Path>,
    /// Whether what was measured before is thrown away.
    pub fresh: bool,
    /// Starts a process for each timed case; without it they are measured in this one.
    pub processes: Option<&'a Processes>,
    pub screen: &'a mut dyn Screen,
}

/// Shows how far a run has come. It is never called inside a timed region.
pub trait Screen {
    /// So many cases are to be measured.
    fn begin(&mut self, cases: usize);
    /// The next one is measured.
    fn case(&mut self, title: &str);
    /// What is done for it.
    fn stage(&mut self, stage: &Stage);
    /// It is measured.
    fn done(&mut self);
    /// Whether somebody watches, who may want a first look at a scene of which not all epochs are measured.
    fn is_watched(&self) -> bool;
    /// A first look.
    fn look(&mut self, table: &Table);
    /// Shows what spoilt the run.
    fn warn(&mut self, warnings: &[String]);
    /// A table of the result.
    ///
    /// # Errors
    /// If it cannot be printed.
    fn table(&mut self, table: &Table) -> io::Result<()>;
    /// Nothing more is measured.
    fn end(&mut self);
}

/// What came of a run.
pub struct Measured {
    /// The answer of the study.
    pub answer: AnyAnswer,
    pub provenance: Provenance,
    /// All tables of the answer.
    pub tables: Vec<Table>,
    /// How many of them were printed while the run went on.
    pub printed: usize,
    /// Sentences below the tables.
    pub foot: Vec<String>,
    pub outcome: Status,
    /// What ended the measuring of a scene; the others are measured.
    pub failure: Option<StudyError>,
}

/// Measures what `plan` asks for and the journal lacks. All scenes of an epoch come before the next epoch, so that what changes
/// on the machine over hours changes all scenes alike.
///
/// # Errors
/// If the journal cannot be used, or nothing can be measured.
pub(super) fn measure<S: Study>(args: &S::Args, plan: &Plan<S::Case>, run: &mut Run) -> anyhow::Result<Measured> {
    let process_per_epoch = run.processes.is_some() && plan.cases.iter().any(|case| case.process.is_some());
    let provenance = Provenance { process_per_epoch, ..Provenance::of(&plan.threads) };
    let header = Header::new(S::NAME, &plan.settings, provenance);
    let mut journal: Journal<S::Case> = match run.folder {
        Some(folder) => Journal::open(&folder.join(format!("{}.jsonl", S::NAME)), header, run.fresh)?,
        None => Journal::in_memory(header),
    };
    let others = match run.folder {
        Some(folder) if S::LAST => Answers::read(folder, run.studies, S::NAME)?,
        _ => Answers::default(),
    };
    let provenance = journal.provenance().clone();
    let context = Context::<S> { provenance: &provenance, others: &others, args: Some(args) };

    run.screen.begin(journal.left(plan.cases.iter().map(|case| case.key.as_str())).len());
    let clock = SystemClock::start();
    let epochs = plan.cases.iter().map(|case| case.epoch + 1).max().unwrap_or(0);
    let (mut failure, mut failed) = (None, vec![]);
    let (mut tables, mut printed): (Vec<Table>, usize) = (vec![], 0);
    for (number, case) in plan.cases.iter().enumerate() {
        if failed.contains(&case.scene) {
            continue;
        }
        if journal.get(&case.key).is_none() {
            run.screen.case(&case.title);
            let of_scene = |other: &&Planned| other.scene == case.scene && other.epoch == 0;
            let first = plan.cases.iter().find(of_scene).and_then(|first| journal.get(&first.key));
            match measure_case(S::NAME, plan, number, first, run.processes, &clock, run.screen) {
                Ok(measured) => journal.append(&case.key, measured)?,
                Err(error) if error.is_of_one_scene() => {
                    failure.get_or_insert(error);
                    failed.push(case.scene);
                    run.screen.done();
                    continue;
                }
                Err(error) => return Err(error.into()),
            }
            run.screen.done();
        }
        let scene: Vec<S::Case> = of(plan, &journal, |other| other.scene == case.scene);
        if S::SCENE_BY_SCENE && case.epoch + 1 == epochs {
            for table in S::tables(&S::answer(&scene, &context)) {
                run.screen.table(&table)?;
                tables.push(table);
                printed += 1;
            }
        } else if epochs > 1 && case.epoch == 0 && run.screen.is_watched() {
            let look = S::tables(&S::answer(&scene[..1], &context)).into_iter().next();
            if let Some(table) = look {
                let title = format!("{} (a first look: epoch 1 of {epochs})", table.title);
                run.screen.look(&Table { title, ..table });
            }
        }
    }

    // The journal may hold other scenes as well: those asked for are shown.
    let cases = of(plan, &journal, |_| true);
    if let (true, Some(error)) = (cases.is_empty(), failure.take_if(|_| cases.is_empty())) {
        return Err(error.into());
    }
    let answer = S::answer(&cases, &context);
    if !S::SCENE_BY_SCENE {
        tables = S::tables(&answer);
    }
    tables.extend(S::summary(&answer));
    run.screen.warn(&S::warnings(&answer));
    let troubles = S::troubles(&cases);
    let mut foot = S::legend(&answer);
    foot.extend(troubles.iter().map(|trouble| trouble.sentence.clone()).filter(|sentence| !sentence.is_empty()));
    foot.extend(plan.notes.iter().cloned());
    foot.push(provenance.line());
    foot.extend(S::remarks(&answer));
    let outcome = Status::of(&troubles);
    run.screen.end();
    Ok(Measured { answer: Box::new(answer), provenance, tables, printed, foot, outcome, failure })
}

/// Measures a case of the plan, in a process of its own where there are any.
///
/// # Errors
/// As [`Plan::measure`] and [`Processes::measure`].
pub(super) fn measure_case<C: Serialize + DeserializeOwned>(
    study: &str,
    plan: &Plan<C>,
    number: usize,
    first: Option<&C>,
    processes: Option<&Processes>,
    clock: &dyn Clock,
    screen: &mut dyn Screen,
) -> Result<C, StudyError> {
    let mut progress = |stage: Stage| screen.stage(&stage);
    let Planned { key, epoch, process, .. } = &plan.cases[number];
    let first = first.filter(|_| *epoch > 0);
    match processes.zip(process.clone()) {
        Some((processes, scene)) => {
            let cores = plan.threads.cores().map(Into::into);
            processes.measure(&Job { study: study.into(), scene, key: key.clone(), cores }, first, &mut progress)
        }
        None => (plan.measure)(number, first, clock, &mut progress),
    }
}

/// The measured cases of the plan that `is` picks.
fn of<C: Clone + Serialize + DeserializeOwned>(
    plan: &Plan<C>,
    journal: &Journal<C>,
    is: impl Fn(&Planned) -> bool,
) -> Vec<C> {
    plan.cases.iter().filter(|case| is(case)).filter_map(|case| journal.get(&case.key).cloned()).collect()
}
