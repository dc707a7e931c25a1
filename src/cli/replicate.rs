//! `replicate`.

use std::path::PathBuf;

use super::progress::Progress;
use super::terminal::Terminal;
use super::{Verdict, sources};
use crate::measure::{SystemClock, Threads};
use crate::output::OutputFile;
use crate::registry::Registry;
use crate::report::{to_json, to_markdown};
use crate::study::replicate::{Settings, Study, tables};

#[derive(Debug, clap::Args)]
pub struct Args {
    /// Threads that build and trace; the report had one
    #[arg(long, value_name = "N", default_value_t = 1, value_parser = clap::value_parser!(u16).range(1..=1024))]
    threads: u16,
    /// Epochs: in each all structures are built anew
    #[arg(long, value_name = "N", default_value_t = 4, value_parser = clap::value_parser!(u16).range(1..=1000))]
    epochs: u16,
    /// Samples of every picture in an epoch
    #[arg(long, value_name = "N", default_value_t = 3, value_parser = clap::value_parser!(u16).range(1..=1000))]
    runs: u16,
    /// Seconds that the samples of an epoch of a scene may take: slow structures are timed on fewer rays to keep within them
    #[arg(long, value_name = "SECONDS", default_value_t = 8, value_parser = clap::value_parser!(u32).range(1..=86400))]
    budget: u32,
    /// Write `rays`, `main`, `parameters`, `hard` and `conclusion` as JSON
    #[arg(long, value_name = "FILE")]
    export_json: Option<PathBuf>,
    /// Write the tables as Markdown
    #[arg(long, value_name = "FILE")]
    export_markdown: Option<PathBuf>,
}

pub fn run(registry: &Registry, args: &Args, terminal: &Terminal) -> anyhow::Result<Verdict> {
    let threads = Threads::pinned(args.threads.into()).map_err(anyhow::Error::msg)?;
    let check = |path: &Option<PathBuf>| path.as_deref().map(OutputFile::check).transpose();
    let (json, markdown) = (check(&args.export_json)?, check(&args.export_markdown)?);
    let settings = Settings {
        epochs: args.epochs.into(),
        runs: args.runs.into(),
        budget_ns: u64::from(args.budget) * 1_000_000_000,
        seed: 1,
        threads,
    };
    let study = Study { registry, settings: &settings, clock: &SystemClock::start() };

    let names = Study::scenes();
    let mut progress = Progress::over(names.len(), terminal);
    let mut result = study.start();
    for name in names {
        progress.scene(name);
        let scene = sources::scene(name)?;
        match study.add(&scene, &mut result, &mut |stage| progress.stage(&stage)) {
            Err(error) if error.is_wrong_answer() => {
                progress.finish();
                eprintln!("error: {error}");
                return Ok(Verdict::Wrong);
            }
            added => added?,
        }
        progress.scene_done();
    }
    progress.finish();

    let tables = tables(&result);
    for table in &tables {
        terminal.print_table(table)?;
    }
    let foot = [result.provenance.line()];
    terminal.print_lines(&foot)?;
    if let Some(file) = json {
        file.write(&to_json(&result))?;
    }
    if let Some(file) = markdown {
        file.write(&to_markdown(&tables, &foot))?;
    }
    Ok(Verdict::Right)
}
