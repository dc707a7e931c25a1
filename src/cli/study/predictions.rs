//! `study predictions`.

use super::folder::{Exports, Folder};
use crate::cli::Verdict;
use crate::cli::progress::Progress;
use crate::cli::terminal::Terminal;
use crate::measure::{Provenance, SystemClock, Threads};
use crate::output::OutputFile;
use crate::registry::Registry;
use crate::report::to_json;
use crate::scene::{Builtin, Scene};
use crate::study::journal::Journal;
use crate::study::predictions::{Case, Finding, NAME, Prediction, key, measure, read, result, scenes, table};

#[derive(Clone, Debug, clap::Args)]
pub struct Args {
    /// Seed of the intervals
    #[arg(long, value_name = "N", default_value_t = 1)]
    pub seed: u64,
    #[command(flatten)]
    pub folder: Folder,
    #[command(flatten)]
    pub exports: Exports,
}

/// What is written into the folder.
#[derive(serde::Serialize)]
struct File<'a> {
    schema: u32,
    predictions: &'a [Prediction],
    provenance: Provenance,
}

/// One finding, for tables that machines read.
#[derive(serde::Serialize)]
struct Row<'a> {
    prediction: u8,
    verdict: &'static str,
    #[serde(flatten)]
    finding: &'a Finding,
}

pub fn run(registry: &Registry, args: &Args, terminal: &Terminal) -> anyhow::Result<Verdict> {
    let files = args.exports.check()?;
    let threads = Threads::pinned(1).map_err(anyhow::Error::msg)?;
    let provenance = Provenance::capture(1);
    let settings = serde_json::Map::new();
    let mut journal: Journal<Case> = args.folder.journal(NAME, &settings, provenance.clone())?;
    let scenes = scenes()
        .into_iter()
        .map(|name| Ok(Builtin::find(name)?.scene(None)?))
        .collect::<anyhow::Result<Vec<Scene>>>()?;
    let keys: Vec<String> = scenes.iter().map(key).collect();
    let left = journal.left(keys.iter().map(String::as_str));
    let clock = SystemClock::start();
    let mut progress = Progress::over(left.len(), terminal);
    for (scene, key) in scenes.iter().zip(&keys) {
        if journal.get(key).is_some() {
            continue;
        }
        progress.scene(&scene.name);
        let case = measure(registry, scene, &threads, &clock, &mut |stage| progress.stage(&stage))?;
        journal.append(key, case)?;
        progress.scene_done();
    }
    progress.finish();

    let mut inputs = read(&args.folder.dir, args.seed)?;
    inputs.counted = keys.iter().filter_map(|key| journal.get(key).cloned()).collect();
    let predictions = result(&inputs);
    let shown = [table(&predictions)];
    let rows: Vec<Row> = predictions
        .iter()
        .flat_map(|p| {
            p.findings.iter().map(|finding| Row { prediction: p.number, verdict: p.verdict.words(), finding })
        })
        .collect();
    files.tell(terminal, (NAME, &provenance), &predictions, &rows, &shown, &[])?;
    let file = File { schema: 1, predictions: &predictions, provenance };
    OutputFile::check(&args.folder.dir.join("predictions.json"))?.write(&to_json(&file))?;
    Ok(Verdict::Right)
}
