//! Runs a study: measures the cases that its journal lacks, one by one, and answers.

use std::any::Any;
use std::fs;
use std::path::{Path, PathBuf};

use super::epoch::{Joined, join};
use super::job::Job;
use super::journal::{Header, Journal, JournalError, Read};
use super::process::Processes;
use super::{Answers, AnyAnswer, AnyCase, AnyStudy, Chosen, Plan, Planned, Screen, Stage, Status, StudyError};
use crate::measure::{Clock, Provenance, SystemClock};
use crate::registry::Registry;
use crate::report::Table;

/// What a study is run with.
pub struct Run<'a> {
    pub registry: &'a Registry,
    /// Reads the answers of the other studies, from which one that is [`Study::LAST`](super::Study::LAST) is made.
    pub others: &'a dyn Fn() -> Result<Answers, JournalError>,
    /// Where journals are kept.
    pub folder: &'a Path,
    /// Whether the journal stays there when all is measured.
    pub is_kept: bool,
    /// Whether what was measured before is thrown away.
    pub fresh: bool,
    /// Starts a process for each case; without it they are measured in this one.
    pub processes: Option<&'a Processes>,
    pub screen: &'a mut dyn Screen,
}

/// What came of a run.
pub struct Measured {
    /// The answer of the study. Nothing where it was interrupted, or no scene could be measured: then no file is written.
    pub answer: Option<AnyAnswer>,
    pub provenance: Provenance,
    /// All tables of the answer, and what their columns mean.
    pub tables: Vec<Table>,
    pub legend: Vec<String>,
    /// What is to be printed of them: the others were while the run went on.
    pub to_print: Vec<Table>,
    pub to_explain: Vec<String>,
    /// Sentences below the tables.
    pub foot: Vec<String>,
    pub outcome: Status,
    /// What ended the measuring of scenes; the others are measured.
    pub failures: Vec<StudyError>,
}

/// An epoch that takes so long is worth a first look.
const LONG_NS: u64 = 5_000_000_000;

impl dyn AnyStudy + '_ {
    /// Measures and answers. `check` is told which files are read, before anything is measured.
    ///
    /// # Errors
    /// As [`Study::plan`](super::Study::plan), as `check`, and if the journal cannot be used or nothing can be measured.
    pub fn run(
        &self,
        chosen: Chosen,
        run: &mut Run,
        check: &mut dyn FnMut(&[PathBuf]) -> anyhow::Result<()>,
    ) -> anyhow::Result<Measured> {
        let args = self.args(chosen)?;
        let plan = self.plan(&*args, run.registry)?;
        check(&plan.inputs)?;
        measure(self, &*args, &plan, run)
    }
}

/// Measures what `plan` asks for and the journal lacks.
///
/// # Errors
/// If the journal cannot be used, or nothing can be measured.
fn measure(
    study: &dyn AnyStudy,
    args: &dyn Any,
    plan: &Plan<Box<dyn AnyCase>>,
    run: &mut Run,
) -> anyhow::Result<Measured> {
    let name = study.name();
    let process_per_epoch = run.processes.is_some();
    let provenance = Provenance { process_per_epoch, ..Provenance::of(&plan.threads) };
    let header = Header::new(name, &plan.settings, provenance);
    let keys = || plan.cases.iter().map(|case| case.key.as_str());
    let unfinished = run.folder.join(UNFINISHED).join(format!("{name}-{}", header.id(keys())));
    // A run that is ended by the clock is not gone on with.
    let may_go_on = !run.is_kept && plan.limit_ns.is_none();
    let is_taken_up = may_go_on && unfinished.exists();
    let folder = match () {
        () if run.is_kept => Some(run.folder.join(name)),
        () if is_taken_up => Some(unfinished.clone()),
        () => None,
    };
    let mut journal = match folder {
        Some(folder) => Journal::open_to_measure(&folder, header, run.fresh, study.reader(), keys())?,
        None => Journal::in_memory(header, study.reader()),
    };
    let others = if run.is_kept && study.is_last() { (run.others)()? } else { Answers::default() };
    let provenance = journal.provenance().clone();
    let answer = |cases: &[Box<dyn AnyCase>]| study.answer(cases, &provenance, &others, Some(args));
    let (all, before) = (plan.cases.len(), plan.cases.len() - journal.left(keys()).len());
    let gone_on = (before > 0 && !run.is_kept).then(|| {
        let when = provenance.date.replace(['T', 'Z'], " ");
        format!("{before} of {all} cases are those of a run that was begun at {when}UTC and interrupted; --fresh starts anew.")
    });
    run.screen.begin(Plan::<Box<dyn AnyCase>>::work(plan.cases.iter().filter(|case| journal.get(&case.key).is_none())));
    run.screen.warn(gone_on.as_slice());
    run.screen.warn(&plan.warnings);
    run.screen.warn(Provenance::of(&plan.threads).too_many_threads().as_slice());
    if before < all {
        plan.threads.are_given().map_err(StudyError::Threads)?;
    }
    let clock = SystemClock::start();
    let epochs = plan.cases.iter().map(|case| case.epoch + 1).max().unwrap_or(0);
    // Why scenes failed, which they are, and those that have no time for another epoch.
    let (mut failures, mut failed, mut late) = (vec![], vec![], vec![]);
    let (mut stopped, mut began) = (false, 0);
    for case in &plan.cases {
        if failed.contains(&case.scene) || late.contains(&case.scene) {
            continue;
        }
        if run.screen.is_interrupted() {
            stopped = true;
            break;
        }
        let start = clock.now_ns();
        if case.epoch == 0 {
            began = start;
        }
        if journal.get(&case.key).is_none() {
            run.screen.case(&case.title, case.work);
            match measure_case(name, plan, case, study.reader(), run.processes, &clock, run.screen) {
                Ok(measured) => journal.append(&case.key, measured)?,
                Err(_) if run.screen.is_interrupted() => {}
                Err(error) if error.is_of_one_scene() => {
                    failures.push(error);
                    failed.push(case.scene);
                }
                Err(error) => return Err(error.into()),
            }
            run.screen.done();
        }
        let Joined { cases: scene, failures: apart, .. } =
            joined(study, plan, &journal, |other| other.scene == case.scene);
        stopped = run.screen.is_interrupted();
        if !apart.is_empty() {
            failed.push(case.scene);
        }
        let has_failed = failed.contains(&case.scene);
        // The next epoch takes as long as this one, about.
        let is_late = plan.limit_ns.is_some_and(|limit| {
            let now = clock.now_ns();
            (now - began) + (now - start) > limit
        });
        if is_late {
            late.push(case.scene);
        }
        let is_whole = !has_failed && (case.epoch + 1 == epochs || is_late) && journal.get(&case.key).is_some();
        if study.is_scene_by_scene() && (is_whole || (stopped || has_failed) && !scene.is_empty()) {
            for table in study.printed(&*answer(&scene)).tables {
                let of = if is_whole { String::new() } else { format!(" ({} of {epochs} epochs)", scene.len()) };
                run.screen.table(&Table { title: table.title + &of, ..table });
            }
        } else if !(stopped || has_failed)
            && case.epoch == 0
            && clock.now_ns() - start > LONG_NS
            && run.screen.is_watched()
        {
            let look = study.printed(&*answer(&scene[..1.min(scene.len())])).tables.into_iter().next();
            if let Some(table) = look {
                let title = format!("{} (a first look: epoch 1 of {epochs})", table.title);
                // Nothing is lost with it.
                run.screen.table(&Table { title, ..table });
            }
        }
        if stopped {
            break;
        }
    }
    let left = journal.left(keys()).len();
    stopped &= left > 0;

    // The journal may hold other scenes as well: those asked for are shown.
    let Joined { mut cases, unchecked, failures: apart, .. } = joined(study, plan, &journal, |_| true);
    failures.extend(apart);
    let says_nothing = |case: &mut Box<dyn AnyCase>| case.epoch().is_some_and(|(epoch, _)| epoch.says_nothing());
    if !stopped && !cases.is_empty() && cases.iter_mut().all(says_nothing) {
        failures.push(StudyError::Nothing);
        cases.clear();
    }
    let is_answered = !stopped && (failures.is_empty() || !cases.is_empty());
    let found = answer(&cases);
    run.screen.warn(&study.warnings(&*found));
    let troubles = study.troubles(&cases);
    let (mut tables, mut legend, mut foot) = (vec![], vec![], vec![]);
    let (mut to_print, mut to_explain) = (vec![], vec![]);
    if is_answered || !cases.is_empty() {
        // A scene that was interrupted or failed would cut means over scenes to as many epochs as it has.
        let lacks =
            |scene: usize| plan.cases.iter().any(|case| case.scene == scene && journal.get(&case.key).is_none());
        let is_cut = |scene: usize| failed.contains(&scene) || stopped && lacks(scene);
        let whole = joined(study, plan, &journal, |case| !is_cut(case.scene)).cases;
        let whole = answer(if whole.is_empty() { &cases } else { &whole });
        let printed = study.printed(&*found);
        if !study.is_scene_by_scene() {
            to_print = printed.tables;
        }
        to_print.extend(study.printed(&*whole).summary);
        to_explain = printed.legend;
        tables = study.tables(&*found);
        tables.extend(study.summary(&*whole));
        legend = study.legend(&*found);
        foot.extend(troubles.iter().map(|trouble| trouble.sentence.clone()).filter(|sentence| !sentence.is_empty()));
        foot.extend(unchecked);
        foot.extend(plan.notes.iter().cloned());
        foot.extend(gone_on);
        foot.push(provenance.line());
        foot.extend(study.remarks(&*whole));
    }
    let told = failures.iter().map(|error| if error.is_wrong_answer() { Status::Wrong } else { Status::Failed });
    let mut outcome = told.fold(Status::of(&troubles), Status::and);
    if stopped {
        outcome = Status::Interrupted;
        let is_new = may_go_on && !is_taken_up && !cases.is_empty();
        let kept = match is_new.then(|| journal.keep(&unfinished)) {
            Some(Err(error)) => format!(", but not kept: {error}"),
            None if cases.is_empty() || plan.limit_ns.is_some() => String::new(),
            _ => " and kept; the same command goes on with the others".into(),
        };
        foot.push(format!("Interrupted: {} of {all} cases are measured{kept}.", all - left));
    } else if may_go_on && failures.is_empty() {
        drop(journal);
        forget(&unfinished);
    }
    run.screen.end();
    let answer = is_answered.then_some(found);
    Ok(Measured { answer, provenance, tables, legend, to_print, to_explain, foot, outcome, failures })
}

/// Where runs are kept that were interrupted, if their study keeps no journal otherwise: a folder in that of journals.
const UNFINISHED: &str = "unfinished";

/// Removes what was kept of a run that is finished now, so that it is not taken for a new one; and the folders, if nothing else is in them.
fn forget(unfinished: &Path) {
    if fs::remove_dir_all(unfinished).is_ok() {
        let _ = unfinished.ancestors().skip(1).take(2).try_for_each(fs::remove_dir);
    }
}

/// Measures a case of the plan, in a process of its own where there are any.
///
/// # Errors
/// As [`Plan::measure`] and [`Processes::measure`].
pub(super) fn measure_case<C>(
    study: &str,
    plan: &Plan<C>,
    case: &Planned,
    read: Read<C>,
    processes: Option<&Processes>,
    clock: &dyn Clock,
    screen: &mut dyn Screen,
) -> Result<C, StudyError> {
    let mut progress = |stage: Stage| screen.stage(&stage);
    match processes {
        Some(processes) => {
            let cores = plan.threads.cores().map(Into::into);
            processes.measure(&Job { cores, ..Job::of(study, case) }, read, &mut progress)
        }
        None => (plan.measure)(case, clock, &mut progress),
    }
}

/// The measured cases of the plan that `is` picks, so that answers can be made from them.
fn joined(
    study: &dyn AnyStudy,
    plan: &Plan<Box<dyn AnyCase>>,
    journal: &Journal<Box<dyn AnyCase>>,
    is: impl Fn(&Planned) -> bool,
) -> Joined<Box<dyn AnyCase>> {
    let measured = plan.cases.iter().filter(|case| is(case)).filter_map(|case| journal.get(&case.key).cloned());
    join(measured.collect(), |case| case.epoch(), study.is_whole())
}
