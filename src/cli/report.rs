//! `report`.

use std::path::PathBuf;

use super::Suite;
use super::progress::Progress;
use super::study::RUNS;
use super::terminal::Terminal;
use crate::page::{ReportFolder, Runs, document, draw, files, left_out};
use crate::study::{Status, sources};

#[derive(Debug, clap::Args)]
pub struct Args {
    /// Files of `--export-json` and of studies, and folders of them [default: runs]
    #[arg(value_name = "RUN")]
    runs: Vec<PathBuf>,
    /// Folder for the page, Markdown, LaTeX, figures and data; an older report there is replaced
    #[arg(long, short, value_name = "DIR")]
    output: PathBuf,
    /// Leave out what must be drawn first: thumbnails of the scenes, and heat maps
    #[arg(long)]
    no_pictures: bool,
}

pub fn run(suite: &Suite, args: &Args, terminal: &Terminal) -> anyhow::Result<Status> {
    let folder = ReportFolder::check(&args.output)?;
    let paths = if args.runs.is_empty() { vec![PathBuf::from(RUNS)] } else { args.runs.clone() };
    let runs = Runs::read(&paths, &suite.studies)?;

    let mut pictures = left_out();
    if !args.no_pictures {
        let scenes = runs.scenes(&suite.studies).len() as u64;
        let mut progress = Progress::over(scenes, terminal);
        pictures = draw(&runs, (&suite.registry, &suite.studies), &|name| sources::scene(name).ok(), &mut |name| {
            progress.scene(name, 1);
        });
        progress.finish();
    }
    let document = document(&runs, &suite.studies, pictures);
    folder.write(&files(&document, &runs, &suite.studies))?;

    if !document.answer.banner.is_empty() {
        terminal.print_lines(std::slice::from_ref(&document.answer.banner))?;
    }
    terminal.print(&format!("{} {}.\n", document.title, document.answer.verdict))?;
    for number in &document.answer.numbers {
        terminal.print(&format!("  {}: {} {}\n", number.label, number.number, number.interval))?;
    }
    for missing in document.missing() {
        terminal.print(&format!("not measured: {}: {}\n", missing.what, missing.command))?;
    }
    terminal.print(&format!("{}\n", folder.path().join("index.html").display()))?;
    Ok(Status::Right)
}
