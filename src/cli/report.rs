//! `report`.

use std::path::PathBuf;

use super::progress::Progress;
use super::terminal::Terminal;
use super::{Verdict, sources};
use crate::publish::{ReportFolder, Runs, document, draw, files, left_out};
use crate::registry::Registry;

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

/// Where studies leave their results.
const RUNS: &str = "runs";

pub fn run(registry: &Registry, args: &Args, terminal: &Terminal) -> anyhow::Result<Verdict> {
    let folder = ReportFolder::check(&args.output)?;
    let paths = if args.runs.is_empty() { vec![PathBuf::from(RUNS)] } else { args.runs.clone() };
    let runs = Runs::read(&paths)?;

    let mut pictures = left_out();
    if !args.no_pictures {
        let scenes = runs.scenes().len();
        let mut progress = Progress::over(scenes, terminal);
        pictures = draw(&runs, registry, &|name| sources::scene(name).ok(), &mut |name| progress.scene(name));
        progress.finish();
    }
    let document = document(&runs, pictures);
    folder.write(&files(&document, &runs))?;

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
    Ok(Verdict::Right)
}
