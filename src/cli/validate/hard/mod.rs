//! `validate --hard`: runs structures on hard cases.

mod child;
mod record;
mod table;

use std::sync::Mutex;
use std::thread;

use anyhow::Context;

use super::Args;
use super::outcome::{StructureVerdict, finish};
use crate::cli::progress::{LogLines, spinner};
use crate::cli::terminal::Terminal;
use crate::output::OutputFile;
use crate::registry::{Choice, Registry, plain_name};
use crate::report::number::plural;
use crate::report::words::each_once_by;
use crate::request::{self, known_defect};
use crate::study::{Status, Verdict};
use crate::triangle::{Exact, TriangleTest};
use crate::validate::hard_cases::{CaseTruth, Content, Failure, HardCase, Score, catalogue, find_all};
use record::{record, verdict};
use table::{Column, LEGEND, summary, tables};

pub use child::{Args as ChildArgs, COMMAND as CHILD, run_child};

const CHILDREN: usize = 2;

const MOST_RAYS: usize = 10_000;

pub fn run(registry: &Registry, args: &Args, named: &[String], terminal: &Terminal) -> anyhow::Result<Status> {
    let cases = if named.is_empty() {
        catalogue()
    } else {
        named.iter().map(|name| find_all(name)).collect::<Result<Vec<_>, _>>()?.concat()
    };
    let cases = each_once_by(cases, |one, other| one.name == other.name);
    let choices = choices(registry, args.structures(registry)?, &args.test)?;
    let rays = u32::try_from(args.source().number()?.min(MOST_RAYS))?;
    let json = args.export_json.as_deref().map(OutputFile::check).transpose()?;

    let mut columns: Vec<Column> = choices.iter().map(|choice| Column { choice, scores: vec![] }).collect();
    let (waiting, mut log) = (spinner(String::new(), terminal), LogLines::new(terminal));
    let mut records = vec![];
    for (i, case) in cases.iter().enumerate() {
        let message = format!("{} of {}: {}", i + 1, cases.len(), case.name);
        log.print_if_due(&message);
        waiting.set_message(message);
        let scores = scores(case, &choices, rays, args)?;
        for (column, score) in columns.iter_mut().zip(scores) {
            records.push(record(case, column.choice, &score));
            column.scores.push(score);
        }
    }
    drop(waiting);

    let tables = if terminal.verbose { tables } else { summary };
    let tables = tables(&cases, &columns);
    tables.iter().filter(|table| !table.rows.is_empty()).for_each(|table| terminal.print_table(table));
    terminal.print_notes(LEGEND);
    let verdicts: Vec<StructureVerdict> = columns.iter().map(|column| verdicts(&cases, column)).collect();
    finish(&verdicts, &records, json, terminal)?;
    let all = columns.iter().flat_map(|own| own.scores.iter().map(|score| status(own.choice, score, args.strict)));
    Ok(all.fold(Status::Right, Status::and))
}

fn verdicts(cases: &[&HardCase], column: &Column) -> StructureVerdict {
    let unchecked = |(case, score): (&&HardCase, &Score)| Some((case.name.to_owned(), refusal(score)?.to_owned()));
    StructureVerdict {
        label: plain_name(&column.choice.label).into(),
        is_external: !column.choice.entry.is_builtin,
        verdict: column.scores.iter().map(verdict).fold(Verdict::default(), Verdict::and),
        unchecked: cases.iter().zip(&column.scores).find_map(unchecked),
    }
}

fn refusal(score: &Score) -> Option<&str> {
    match score {
        Score::Failed(Failure::Refused(why)) => Some(why),
        _ => None,
    }
}

/// Runners may refuse a case. All other structures must build over every mesh.
fn status(choice: &Choice, score: &Score, strict: bool) -> Status {
    let is_inexact = choice.triangle_test() == Exact::NAME && score.rays().is_some_and(|rays| rays.inexact > 0);
    let rounds = strict && verdict(score).rounded > 0;
    match () {
        () if choice.command().is_some() && refusal(score).is_some() => Status::Refused,
        () if known_defect(&choice.entry.name).is_some() => Status::Right,
        () if !score.is_sound() || is_inexact || rounds => Status::Wrong,
        () => Status::Right,
    }
}

fn choices(registry: &Registry, structures: Vec<Choice>, tests: &[String]) -> anyhow::Result<Vec<Choice>> {
    request::known_tests(registry, tests)?;
    let mut choices: Vec<Choice> = vec![];
    for choice in structures {
        let name = &choice.entry.name;
        let offered: Vec<&String> = tests.iter().filter(|test| registry.find(name, test).is_some()).collect();
        if offered.is_empty() || known_defect(name).is_some() || choice.label.contains("test=") {
            choices.push(choice);
            continue;
        }
        let separator = if choice.label.contains(':') { ',' } else { ':' };
        for test in offered {
            choices.push(registry.choose(&format!("{}{separator}test={test}", choice.label))?);
        }
    }
    Ok(each_once_by(choices, |one, other| one.label == other.label))
}

fn scores(case: &HardCase, choices: &[Choice], rays: u32, limits: &Args) -> anyhow::Result<Vec<Score>> {
    let mut answers: Vec<_> = choices.iter().map(|_| None).collect();
    let waiting = Mutex::new(choices.iter().zip(&mut answers));
    let next = || waiting.lock().expect("no worker panics").next();
    let worker = || {
        while let Some((choice, answers)) = next() {
            *answers = Some(child::answers(case, choice, rays, limits)?);
        }
        std::io::Result::Ok(())
    };
    let mut truth = thread::scope(|scope| {
        let workers: Vec<_> = (0..CHILDREN).map(|_| scope.spawn(worker)).collect();
        let truth = CaseTruth::new(case, rays as usize);
        let done = workers.into_iter().try_for_each(|worker| worker.join().expect("a worker only waits"));
        done.map(|()| truth).context("no process can be started for a structure")
    })?;
    let score = |(choice, answers): (&Choice, _)| match answers {
        Ok(answers) => Ok(truth.score(choice.triangle_test(), answers)?),
        Err(failure) => Ok(Score::Failed(failure)),
    };
    choices.iter().zip(answers.into_iter().flatten()).map(score).collect()
}

pub fn described() -> Vec<String> {
    let lines = |case: &&HardCase| {
        let what = match case.content {
            Content::Rays { rays, .. } => plural(rays, "ray"),
            Content::Property(_) => "a property".into(),
        };
        [format!("{} {}: {what}", case.number, case.name), format!("   {} ({})", case.reason, case.source)]
    };
    let head = "Cases 1 to 84 come from a survey, cited below as \"survey\". Two cases have the number 23; `--hard 23` \
                runs both.";
    std::iter::once(head.to_owned()).chain(catalogue().iter().flat_map(lines)).collect()
}
