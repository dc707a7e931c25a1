//! The command `report`: writes the results of runs as a web page, Markdown and CSV.

use std::fs;
use std::path::{Path, PathBuf};

use super::Suite;
use super::progress::spinner;
use super::study::RUNS;
use super::terminal::Terminal;
use crate::escaped::Escaped as _;
use crate::output::{OutputFile, OutputFolder};
use crate::page::results::{self, Results};
use crate::page::{Runs, document, draw, files, left_out};
use crate::request::OUTPUT;
use crate::study::{Status, Studies};

#[derive(Debug, clap::Args)]
pub struct Args {
    /// Export files (`--export-json`), or folders of export files or journals [default: runs]
    #[arg(value_name = "RUN")]
    runs: Vec<PathBuf>,
    /// Folder for the page, Markdown, figures and data; replaces an older report there
    #[arg(long, short, help_heading = OUTPUT, value_name = "DIR", required_unless_present = "results")]
    output: Option<PathBuf>,
    /// Write the findings of one run into this folder as a short paper (RESULTS.md, figures, tables, results.json), and
    /// update the generated numbers in the README.md next to the folder [default folder: papers]
    #[arg(long, help_heading = OUTPUT, value_name = "DIR", num_args = 0..=1, require_equals = true, default_missing_value = "papers")]
    results: Option<PathBuf>,
    /// Omit pictures of the scenes, heat maps and error maps, which take time to render
    #[arg(long, help_heading = OUTPUT)]
    no_pictures: bool,
}

pub fn run(suite: &Suite, args: &Args, terminal: &Terminal) -> anyhow::Result<Status> {
    let folder = args.output.as_deref().map(OutputFolder::check).transpose()?;
    let results = args.results.as_deref().map(ResultsFolder::check).transpose()?;
    anyhow::ensure!(
        !args.runs.is_empty() || Path::new(RUNS).exists(),
        "there is no folder {RUNS} here: measure with `sahara compare --dir {RUNS}`, or name export files \
         (`--export-json`) or folders"
    );
    let paths = if args.runs.is_empty() { vec![PathBuf::from(RUNS)] } else { args.runs.clone() };
    let runs = Runs::read(&paths, &suite.studies)?;

    let mut pictures = left_out();
    if folder.is_some() && !args.no_pictures {
        let waiting = spinner("loading scenes", terminal);
        pictures = draw(&runs, &suite.registry, &mut |what| waiting.set_message(what));
    }
    let document = document(&runs, &suite.studies, if folder.is_some() { pictures } else { vec![] });
    if let Some(results) = &results {
        results.write(Results::new(&document, &runs)?, &suite.studies)?;
    }
    if let Some(folder) = &folder {
        folder.write(&files(&document, &runs))?;
    }

    if !document.answer.banner.is_empty() {
        terminal.print_lines([&document.answer.banner]);
    }
    terminal.print(&format!("{} {}.\n", document.title, document.answer.verdict));
    for number in &document.answer.numbers {
        terminal.print(&format!("  {}: {} {}\n", number.label, number.number, number.interval));
    }
    terminal.print_notes(runs.notes.clone());
    match &document.missing()[..] {
        [] => {}
        [one] => terminal.print(&format!("not measured: {}: {}\n", one.what, one.command)),
        all => terminal.print(&format!(
            "not measured: {} other parts (the end of the page lists their commands); `sahara study all` measures \
             all\n",
            all.len()
        )),
    }
    if let Some(folder) = folder {
        terminal.print(&format!("{}\n", folder.path.join("index.html").escaped()));
    }
    if let Some(ResultsFolder { paper, data, readme, .. }) = results {
        for file in [paper, data].into_iter().chain(readme.map(|(file, _)| file)) {
            terminal.print(&format!("{}\n", file.path.escaped()));
        }
    }
    Ok(Status::Right)
}

struct ResultsFolder {
    figures: OutputFolder,
    tables: OutputFolder,
    paper: OutputFile,
    data: OutputFile,
    /// README.md and its text. `None` if the file is missing or has no marks for generated numbers.
    readme: Option<(OutputFile, String)>,
}

impl ResultsFolder {
    fn check(folder: &Path) -> anyhow::Result<Self> {
        anyhow::ensure!(
            folder.is_dir(),
            "there is no folder {}: create it, or name another one with --results=DIR",
            folder.escaped()
        );
        let readme = folder.canonicalize()?.with_file_name("README.md");
        let text = fs::read_to_string(&readme).ok().filter(|text| text.contains(results::OPEN));
        Ok(Self {
            figures: OutputFolder::check(&folder.join(results::FIGURES))?,
            tables: OutputFolder::check(&folder.join(results::TABLES))?,
            paper: OutputFile::check(&folder.join(results::PAPER))?,
            data: OutputFile::check(&folder.join(results::DATA))?,
            readme: text.map(|text| anyhow::Ok((OutputFile::check(&readme)?, text))).transpose()?,
        })
    }

    fn write(&self, mut results: Results, studies: &Studies) -> anyhow::Result<()> {
        // Fill in README.md first, because `fill` also adds statements to the data.
        let filled = self.readme.as_ref().map(|(_, text)| results.fill(text, studies)).transpose()?;
        self.figures.write(&results.figures)?;
        self.tables.write(&results.tables)?;
        self.paper.write(results.paper.as_bytes())?;
        self.data.write(&results.json())?;
        if let (Some((file, _)), Some(text)) = (&self.readme, filled) {
            file.write(text.as_bytes())?;
        }
        Ok(())
    }
}
