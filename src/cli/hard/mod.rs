//! `hard`.

mod child;

use std::io;
use std::path::{Path, PathBuf};
use std::sync::Mutex;
use std::thread;
use std::time::Duration;

use anyhow::Context;

use super::Verdict;
use super::progress::Progress;
use super::sources;
use super::terminal::Terminal;
use crate::measure::Provenance;
use crate::output::OutputFile;
use crate::registry::{Choice, Registry};
use crate::report::number::plural;
use crate::report::to_json;
use crate::study::documented_defect;
use crate::study::hard_cases::{
    Answers, Case, Column, Court, Failure, HardRecord, HardRun, Score, catalogue, find_all, legend, tables,
};
use crate::triangle::{Exact, TriangleTest};

pub use child::{Args as ChildArgs, COMMAND as CHILD, run as run_child};

#[derive(Debug, clap::Args)]
pub struct Args {
    /// Hard cases by name or number; all if none is named
    #[arg(value_name = "CASE")]
    cases: Vec<String>,
    /// A structure, with keys that differ from their defaults; may be repeated [default: all, one of each name]
    #[arg(long, short, value_name = "NAME[:key=value,..]")]
    structure: Vec<String>,
    /// A triangle test for all structures that are offered over it; may be repeated [default: each structure's own]
    #[arg(long, short, value_name = "NAME")]
    test: Vec<String>,
    /// Rays of a case at most; no case has more than 10,000
    #[arg(long, value_name = "N", default_value_t = 10_000, value_parser = clap::value_parser!(u32).range(1..=10_000))]
    rays: u32,
    /// Seconds that a structure may take for a case, its build included
    #[arg(long, value_name = "SECONDS", default_value_t = 20, value_parser = clap::value_parser!(u32).range(1..=86400))]
    limit: u32,
    /// Write the results as JSON
    #[arg(long, value_name = "FILE")]
    json: Option<PathBuf>,
    /// Name the cases, and why systems fail on them
    #[arg(long)]
    list: bool,
}

/// Children at a time.
const CHILDREN: usize = 2;

pub fn run(registry: &Registry, args: &Args, terminal: &Terminal) -> anyhow::Result<Verdict> {
    let cases = if args.cases.is_empty() {
        catalogue()
    } else {
        args.cases.iter().map(|name| find_all(name)).collect::<Result<Vec<_>, _>>()?.concat()
    };
    if args.list {
        terminal.print_lines(&cases.iter().flat_map(|case| described(case, args.rays)).collect::<Vec<_>>())?;
        return Ok(Verdict::Right);
    }
    let choices = choices(registry, &args.structure, &args.test)?;
    let json = args.json.as_deref().map(OutputFile::check).transpose()?;
    let program = std::env::current_exe()
        .context("this program cannot find itself to ask structures in a process of their own")?;

    let mut columns: Vec<Column> = choices.iter().map(Column::of).collect();
    let mut progress = Progress::over(cases.len(), terminal);
    let mut records = vec![];
    for case in &cases {
        progress.scene(case.name);
        let scores = scores(&program, case, &choices, args)?;
        for ((choice, column), score) in choices.iter().zip(&mut columns).zip(scores) {
            records.push(HardRecord::new(case, choice, &score));
            column.scores.push(score);
        }
        progress.scene_done();
    }
    progress.finish();

    for table in tables(&cases, &columns) {
        terminal.print_table(&table)?;
    }
    terminal.print_lines(&legend())?;
    if let Some(file) = json {
        // Every structure answers on one thread.
        let provenance = Provenance::capture(1);
        file.write(&to_json(&HardRun { schema: HardRun::SCHEMA, provenance, results: records }))?;
    }
    let wrong =
        choices.iter().zip(&columns).any(|(choice, column)| column.scores.iter().any(|score| owed(choice, score)));
    Ok(if wrong { Verdict::Wrong } else { Verdict::Right })
}

/// Whether a structure owes a better answer: all but the baselines with their documented defects owe one, without structure
/// errors; those over the exact test owe the truth.
fn owed(choice: &Choice, score: &Score) -> bool {
    let inexact = |score: &Score| match score {
        Score::Rays(rays) => rays.inexact > 0,
        _ => false,
    };
    let sound = score.is_sound() && !(choice.triangle_test() == Exact::NAME && inexact(score));
    !sound && documented_defect(&choice.entry.name).is_none()
}

/// The structures asked for, each over all the tests asked for that it is offered over; the baselines with defects of their
/// own, and structures that are offered over none of the tests, stay as they are.
fn choices(registry: &Registry, structures: &[String], tests: &[String]) -> anyhow::Result<Vec<Choice>> {
    sources::known_tests(registry, tests)?;
    let mut choices = vec![];
    for choice in sources::structures(registry, structures)? {
        let name = &choice.entry.name;
        let offered: Vec<&String> = tests.iter().filter(|test| registry.find(name, test).is_some()).collect();
        if offered.is_empty() || documented_defect(name).is_some() || choice.label.contains("test=") {
            choices.push(choice);
            continue;
        }
        let separator = if choice.label.contains(':') { ',' } else { ':' };
        for test in offered {
            choices.push(sources::structure(registry, &format!("{}{separator}test={test}", choice.label))?);
        }
    }
    Ok(choices)
}

/// Asks all structures, some at a time, and finds the truth meanwhile.
fn scores(program: &Path, case: &Case, choices: &[Choice], args: &Args) -> anyhow::Result<Vec<Score>> {
    let limit = Duration::from_secs(args.limit.into());
    let waiting = Mutex::new(choices.iter().enumerate());
    let worker = || -> io::Result<Vec<(usize, Result<Answers, Failure>)>> {
        let mut done = vec![];
        loop {
            let next = waiting.lock().expect("no worker panics").next();
            let Some((index, choice)) = next else { return Ok(done) };
            done.push((index, child::answers(program, case, choice, args.rays, limit)?));
        }
    };
    let (mut court, mut answers) = thread::scope(|scope| -> anyhow::Result<_> {
        let workers: Vec<_> = (0..CHILDREN).map(|_| scope.spawn(worker)).collect();
        let court = Court::new(case, args.rays as usize);
        let mut answers = vec![];
        for worker in workers {
            let done = worker.join().expect("a worker only waits");
            answers.extend(done.context("no process can be started to ask a structure")?);
        }
        Ok((court, answers))
    })?;

    answers.sort_by_key(|(index, _)| *index);
    let mut scores = vec![];
    for (index, answers) in answers {
        scores.push(match answers {
            Ok(answers) => court.score(choices[index].triangle_test(), answers)?,
            Err(failure) => Score::Failed(failure),
        });
    }
    Ok(scores)
}

/// Name and reason of a case; the rays are as many as it makes.
fn described(case: &Case, rays: u32) -> [String; 2] {
    let what = case.rays(rays as usize).map_or("a property".into(), |rays| plural(rays, "ray"));
    [format!("{} {}: {what}", case.number, case.name), format!("   {} ({})", case.reason, case.source)]
}
