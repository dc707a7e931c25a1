//! `study parameters`.

use super::folder::{Exports, Folder, threads};
use crate::cli::Verdict;
use crate::cli::progress::Progress;
use crate::cli::terminal::Terminal;
use crate::measure::{Provenance, SystemClock};
use crate::registry::Registry;
use crate::report::to_tidy_csv;
use crate::scene::{Builtin, Scene};
use crate::study::StudyError;
use crate::study::journal::Journal;
use crate::study::parameters::{Case, NAME, Settings, key, measure, result, rows, scenes, tables};

#[derive(Clone, Debug, clap::Args)]
pub struct Args {
    /// Scenes of the report's sweep; all of them if none is named
    #[arg(value_name = "SCENE")]
    pub scenes: Vec<String>,
    /// Epochs: in each all trees are built anew; more of them can be added later
    #[arg(long, value_name = "N", default_value_t = 5, value_parser = clap::value_parser!(u16).range(1..=1000))]
    pub epochs: u16,
    /// Samples of every setting in an epoch
    #[arg(long, value_name = "N", default_value_t = 3, value_parser = clap::value_parser!(u16).range(1..=1000))]
    pub runs: u16,
    /// Seconds that the samples of an epoch of a scene may take: slow settings are timed on fewer rays to keep within them
    #[arg(long, value_name = "SECONDS", default_value_t = 6, value_parser = clap::value_parser!(u32).range(1..=86400))]
    pub budget: u32,
    /// Threads that build and trace; the report had one
    #[arg(long, value_name = "N", default_value_t = 1, value_parser = clap::value_parser!(u16).range(1..=1024))]
    pub threads: u16,
    /// Seed of the order of samples
    #[arg(long, value_name = "N", default_value_t = 1)]
    pub seed: u64,
    #[command(flatten)]
    pub folder: Folder,
    #[command(flatten)]
    pub exports: Exports,
}

pub fn run(registry: &Registry, args: &Args, terminal: &Terminal) -> anyhow::Result<Verdict> {
    let files = args.exports.check()?;
    let settings = Settings {
        runs: args.runs.into(),
        budget_ns: u64::from(args.budget) * 1_000_000_000,
        check_ns: 1_000_000_000,
        seed: args.seed,
        threads: threads(args.threads)?,
    };
    let named: Vec<&str> =
        if args.scenes.is_empty() { scenes() } else { args.scenes.iter().map(String::as_str).collect() };
    let mut chosen: Vec<Scene> = vec![];
    for name in named {
        let builtin = Builtin::find(name)?;
        let all = scenes();
        anyhow::ensure!(
            all.contains(&builtin.name),
            "{} is not in the report's sweep; in it are: {}",
            builtin.name,
            all.join(", ")
        );
        if chosen.iter().all(|scene| scene.name != builtin.name) {
            chosen.push(builtin.scene(None)?);
        }
    }
    let provenance = Provenance::of(&settings.threads);
    let mut journal: Journal<Case> = args.folder.journal(NAME, &settings.kept(), provenance)?;
    let foot = journal.provenance().line();

    let epochs = 0..usize::from(args.epochs);
    let plan: Vec<_> =
        epochs.flat_map(|epoch| chosen.iter().map(move |scene| (scene, epoch, key(scene, epoch)))).collect();
    let left = journal.left(plan.iter().map(|(_, _, key)| key.as_str()))?.len();
    let clock = SystemClock::start();
    let mut progress = Progress::over(left, terminal);
    for (scene, epoch, key_of_case) in &plan {
        if journal.get(key_of_case).is_some() {
            continue;
        }
        progress.scene(&format!("epoch {} of {}: {}", epoch + 1, args.epochs, scene.name));
        let first = journal.get(&key(scene, 0));
        match measure(registry, scene, &settings, *epoch, first, &clock, &mut |stage| progress.stage(&stage)) {
            Ok(case) => journal.append(key_of_case, case)?,
            Err(error @ (StudyError::Wrong { .. } | StudyError::Changed { .. })) => {
                progress.finish();
                eprintln!("error: {error}");
                return Ok(Verdict::Wrong);
            }
            Err(error) => return Err(error.into()),
        }
        progress.scene_done();
    }
    progress.finish();

    let cases: Vec<Case> = plan.iter().filter_map(|(_, _, key)| journal.get(key).cloned()).collect();
    let result = result(&cases, args.seed);
    let shown = tables(&result);
    for table in &shown {
        terminal.print_table(table)?;
    }
    terminal.print_lines(std::slice::from_ref(&foot))?;
    files.write(&result, || to_tidy_csv(rows(&result)), &shown, &[foot])?;
    Ok(Verdict::Right)
}
