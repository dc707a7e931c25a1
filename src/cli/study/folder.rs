//! What all resumable studies share on the command line.

use std::path::PathBuf;

use crate::cli::terminal::Terminal;
use crate::measure::Provenance;
use crate::output::OutputFile;
use crate::report::{Export, Table, to_json, to_markdown};
use crate::study::journal::{Header, Journal, JournalError};

/// Where a study keeps its journal.
#[derive(Clone, Debug, clap::Args)]
pub struct Folder {
    /// The folder of journals: the same command again goes on where the last one stopped
    #[arg(long, value_name = "DIR", default_value = "runs")]
    pub dir: PathBuf,
    /// Throw away what was measured before, and start anew
    #[arg(long)]
    pub fresh: bool,
}

impl Folder {
    /// The journal of the study `name`.
    ///
    /// # Errors
    /// As [`Journal::open`].
    pub fn journal<C: serde::Serialize + serde::de::DeserializeOwned>(
        &self,
        name: &str,
        settings: &impl serde::Serialize,
        provenance: Provenance,
    ) -> Result<Journal<C>, JournalError> {
        Journal::open(&self.path(name), Header::new(name, settings, provenance), self.fresh)
    }

    /// The file of that journal.
    pub fn path(&self, name: &str) -> PathBuf {
        self.dir.join(format!("{name}.jsonl"))
    }
}

/// Where results go besides the terminal.
#[derive(Clone, Debug, Default, clap::Args)]
pub struct Exports {
    /// Write the result as JSON
    #[arg(long, value_name = "FILE")]
    pub export_json: Option<PathBuf>,
    /// Write one row per measured thing as CSV
    #[arg(long, value_name = "FILE")]
    pub export_csv: Option<PathBuf>,
    /// Write the tables as Markdown
    #[arg(long, value_name = "FILE")]
    pub export_markdown: Option<PathBuf>,
}

/// Files that can be written.
pub struct Files {
    json: Option<OutputFile>,
    csv: Option<OutputFile>,
    markdown: Option<OutputFile>,
}

impl Exports {
    /// Checks all files before the long run.
    ///
    /// # Errors
    /// If one cannot be written.
    pub fn check(&self) -> anyhow::Result<Files> {
        let check = |path: &Option<PathBuf>| path.as_deref().map(OutputFile::check).transpose();
        let (json, csv, markdown) =
            (check(&self.export_json)?, check(&self.export_csv)?, check(&self.export_markdown)?);
        Ok(Files { json, csv, markdown })
    }
}

impl Files {
    /// Prints `tables` and what is to be said below them, and writes the files that were asked for: `result` as JSON, `rows` as CSV,
    /// both with the name of the `study` and with `provenance`.
    ///
    /// # Errors
    /// If one cannot be written.
    pub fn tell(
        &self,
        terminal: &Terminal,
        (study, provenance): (&str, &Provenance),
        result: &impl serde::Serialize,
        rows: &[impl serde::Serialize],
        tables: &[Table],
        foot: &[String],
    ) -> anyhow::Result<()> {
        for table in tables {
            terminal.print_table(table)?;
        }
        terminal.print_lines(foot)?;
        if let Some(file) = &self.json {
            file.write(&to_json(&Export::new(study, provenance, result)))?;
        }
        if let Some(file) = &self.csv {
            file.write(&Export::new(study, provenance, rows).to_csv())?;
        }
        if let Some(file) = &self.markdown {
            file.write(&to_markdown(tables, foot))?;
        }
        Ok(())
    }
}
