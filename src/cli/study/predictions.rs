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
use crate::study::predictions::{
    Case, Claim, NAME, Prediction, Tally, key, measure, read, result, scenes, table, tally,
};

#[derive(Clone, Debug, clap::Args)]
pub struct Args {
    #[command(flatten)]
    pub folder: Folder,
    #[command(flatten)]
    pub exports: Exports,
}

/// What is written into the folder.
#[derive(serde::Serialize)]
struct File<'a> {
    schema: u32,
    tally: Tally,
    predictions: &'a [Prediction],
    provenance: Provenance,
}

/// One claim, for tables that machines read.
#[derive(serde::Serialize)]
struct Row<'a> {
    prediction: u8,
    #[serde(flatten)]
    claim: &'a Claim,
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

    let mut inputs = read(&args.folder.dir)?;
    inputs.counted = keys.iter().filter_map(|key| journal.get(key).cloned()).collect();
    let predictions = result(&inputs);
    let shown = [table(&predictions)];
    let rows: Vec<Row> =
        predictions.iter().flat_map(|p| p.claims.iter().map(|claim| Row { prediction: p.number, claim })).collect();
    files.tell(terminal, (NAME, &provenance), &predictions, &rows, &shown, &[])?;
    let file = File { schema: 2, tally: tally(&predictions), predictions: &predictions, provenance };
    OutputFile::check(&args.folder.dir.join("predictions.json"))?.write(&to_json(&file))?;
    Ok(Verdict::Right)
}
