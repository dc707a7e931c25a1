//! `study attribution`.

use super::folder::{Exports, Folder, threads};
use super::meshes::{self, Meshes};
use crate::cli::Verdict;
use crate::cli::progress::Progress;
use crate::cli::terminal::Terminal;
use crate::measure::{Provenance, SystemClock};
use crate::registry::Registry;
use crate::report::{Table, to_tidy_csv};
use crate::scene::WorkloadKind;
use crate::study::StudyError;
use crate::study::attribution::{Case, NAME, Settings, headlines, key, measure, result, rows, scene_name, tables};
use crate::study::journal::Journal;

#[derive(Clone, Debug, clap::Args)]
pub struct Args {
    /// Built-in scenes and mesh files (.obj, .ply, .gltf, .glb); all built-in scenes if none is named
    #[arg(value_name = "SCENE|FILE")]
    pub scenes: Vec<String>,
    /// Meshes of the built-in scenes
    #[arg(long, value_name = "WHICH", value_enum, default_value_t)]
    pub meshes: Meshes,
    /// The kind of rays
    #[arg(long, short, value_name = "KIND", default_value = "primary")]
    pub workload: WorkloadKind,
    /// Rays, at most
    #[arg(long, value_name = "N", default_value_t = 16384, value_parser = clap::value_parser!(u32).range(1..=1 << 24))]
    pub rays: u32,
    /// Epochs: in each all trees are built anew; more of them can be added later
    #[arg(long, value_name = "N", default_value_t = 5, value_parser = clap::value_parser!(u16).range(1..=1000))]
    pub epochs: u16,
    /// Samples of every tree in an epoch
    #[arg(long, value_name = "N", default_value_t = 3, value_parser = clap::value_parser!(u16).range(1..=1000))]
    pub runs: u16,
    /// Seconds that the samples of an epoch of a scene may take: slow trees are timed on fewer rays to keep within them
    #[arg(long, value_name = "SECONDS", default_value_t = 12, value_parser = clap::value_parser!(u32).range(1..=86400))]
    pub budget: u32,
    /// The triangle test of all trees
    #[arg(long, value_name = "NAME", default_value = "filtered-f64")]
    pub test: String,
    /// Threads that build and trace; 1 is the unit of comparison
    #[arg(long, value_name = "N", default_value_t = 1, value_parser = clap::value_parser!(u16).range(1..=1024))]
    pub threads: u16,
    /// Seed of the rays and of the order of samples
    #[arg(long, value_name = "N", default_value_t = 1)]
    pub seed: u64,
    #[command(flatten)]
    pub folder: Folder,
    #[command(flatten)]
    pub exports: Exports,
}

pub fn run(registry: &Registry, args: &Args, terminal: &Terminal) -> anyhow::Result<Verdict> {
    crate::cli::sources::known_tests(registry, std::slice::from_ref(&args.test))?;
    let files = args.exports.check()?;
    let settings = Settings {
        workload: args.workload,
        rays: args.rays,
        runs: args.runs.into(),
        budget_ns: u64::from(args.budget) * 1_000_000_000,
        check_ns: 4_000_000_000,
        test: args.test.clone(),
        seed: args.seed,
        threads: threads(args.threads)?,
    };
    let scenes = meshes::scenes(&args.scenes, args.meshes)?;
    let provenance = Provenance::of(&settings.threads);
    let mut journal: Journal<Case> = args.folder.journal(NAME, &settings.kept(), provenance)?;
    let foot = journal.provenance().line();

    // All scenes of an epoch before the next one: what changes on the machine over hours changes all scenes alike.
    let epochs = 0..usize::from(args.epochs);
    let plan: Vec<_> =
        epochs.flat_map(|epoch| scenes.iter().map(move |scene| (scene, epoch, key(scene, epoch)))).collect();
    let left = journal.left(plan.iter().map(|(_, _, key)| key.as_str()))?.len();
    let clock = SystemClock::start();
    let mut progress = Progress::over(left, terminal);
    for (scene, epoch, key_of_case) in &plan {
        if journal.get(key_of_case).is_some() {
            continue;
        }
        progress.scene(&format!(
            "epoch {} of {}: {}",
            epoch + 1,
            args.epochs,
            scene_name(&scene.name, !scene.stand_ins.is_empty())
        ));
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

    // The journal may hold other scenes as well: those asked for are shown.
    let cases: Vec<Case> = plan.iter().filter_map(|(_, _, key)| journal.get(key).cloned()).collect();
    let results = result(&cases, args.seed);
    let mut shown: Vec<Table> = results.iter().flat_map(tables).collect();
    let mut answer = headlines(&results);
    answer.notes.extend(meshes::note(&scenes, args.meshes));
    shown.push(answer);
    for table in &shown {
        terminal.print_table(table)?;
    }
    terminal.print_lines(std::slice::from_ref(&foot))?;
    files.write(&results, || to_tidy_csv(&rows(&results)), &shown, &[foot])?;
    Ok(Verdict::Right)
}
