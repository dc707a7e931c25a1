//! `bench`.

use std::path::PathBuf;

use anyhow::Context;

use super::progress::Progress;
use super::rays::rays_or_all;
use super::terminal::Terminal;
use super::{Verdict, sources};
use crate::measure::{Provenance, SystemClock, Threads};
use crate::output::OutputFile;
use crate::registry::Registry;
use crate::report::{Record, to_json};
use crate::scene::WorkloadKind;
use crate::study::bench::{SCENES, against, new_baseline_path, read_baseline, verdict};
use crate::study::compare::{Compared, Reference, Settings, Trials, scene_table};
use crate::study::regression::{Comparison, tables};
use crate::study::{BRUTE_FORCE, Refused, bench, documented_defect};

#[derive(Debug, clap::Args)]
pub struct Args {
    /// Built-in scenes, scene files (.toml) and mesh files (.obj, .ply, .gltf, .glb) [default: teapot, starters, cornellbox]
    #[arg(value_name = "SCENE|FILE")]
    scenes: Vec<String>,
    /// A structure, with keys that differ from their defaults; may be repeated [default: one of each name but brute-force]
    #[arg(long, short, value_name = "NAME[:key=value,..]")]
    structure: Vec<String>,
    /// How much time the builds of eight-wide trees may take, where a structure is named without a quality of its own
    #[arg(long, value_parser = sources::QUALITIES)]
    quality: Option<String>,
    /// A kind of rays; may be repeated [default: primary, shadow, diffuse]
    #[arg(long, short, value_name = "KIND")]
    workload: Vec<WorkloadKind>,
    /// Keep this run under a name, unless answers are wrong
    #[arg(long, value_name = "NAME")]
    save_baseline: Option<String>,
    /// Hold this run against one that was kept
    #[arg(long, value_name = "NAME")]
    baseline: Option<String>,
    /// Fail, with status 3, if a structure is slower than in the baseline by more than so many per cent; with 4 if that cannot be told
    #[arg(long, value_name = "PCT", requires = "baseline", value_parser = percent)]
    fail_on_regression: Option<f64>,
    /// Folder of runs; baselines are in its folder `baselines`
    #[arg(long, value_name = "DIR", default_value = "runs")]
    dir: PathBuf,
    /// How often everything is built anew; four times as often for a baseline that is kept, which no later run can make more certain,
    /// and up to that where a regression can be neither found nor excluded
    #[arg(long, value_name = "N", default_value_t = 12, value_parser = clap::value_parser!(u16).range(2..))]
    epochs: u16,
    /// Samples of every case in each epoch
    #[arg(long, value_name = "N", default_value_t = 3, value_parser = clap::value_parser!(u16).range(1..))]
    runs: u16,
    /// Rays of a workload that are timed, at most, in whole tiles of the scene's picture
    #[arg(long, value_name = "N|all", default_value = "all", value_parser = rays_or_all)]
    rays: usize,
    /// Threads that build and trace; 1 is the unit of comparison
    #[arg(long, value_name = "N", default_value_t = 1, value_parser = clap::value_parser!(u16).range(1..=1024))]
    threads: u16,
    /// Seed of the rays and of the order of samples
    #[arg(long, value_name = "N", default_value_t = 1)]
    seed: u64,
    /// Write one record per case as JSON
    #[arg(long, value_name = "FILE")]
    export_json: Option<PathBuf>,
}

/// Without `--workload`.
const WORKLOADS: [WorkloadKind; 3] = [WorkloadKind::Primary, WorkloadKind::Shadow, WorkloadKind::Diffuse];

/// What the checks of a scene's answers may take is a twentieth of this, nanoseconds.
const CHECKS_NS: u64 = 20_000_000_000;

/// Samples are never cut short by a budget: another run must take the same rays.
const EPOCH_NS: u64 = u64::MAX;

/// Epochs of a baseline that is kept, and the most where nothing is decided, as a multiple of those asked for.
const MOST: u16 = 4;

/// More epochs are taken so many at a time.
const STEP: u16 = 4;

fn percent(text: &str) -> Result<f64, String> {
    let percent = text.trim_end_matches('%').parse::<f64>().map_err(|error| error.to_string())?;
    if percent > 0.0 && percent <= 1000.0 { Ok(percent) } else { Err("it must lie above 0 and be at most 1000".into()) }
}

pub fn run(registry: &Registry, args: &Args, terminal: &Terminal) -> anyhow::Result<Verdict> {
    let names: Vec<String> = if args.scenes.is_empty() { SCENES.map(String::from).into() } else { args.scenes.clone() };
    let mut structures = sources::structures_at(registry, &args.structure, args.quality.as_deref())?;
    if args.structure.is_empty() {
        structures.retain(|choice| choice.entry.name != BRUTE_FORCE);
    }
    let baseline = args.baseline.as_deref().map(|name| read_baseline(&args.dir, name)).transpose()?;
    let kept = args.save_baseline.as_deref().map(|name| new_baseline_path(&args.dir, name)).transpose()?;
    let kept = kept.as_deref().map(OutputFile::check).transpose()?;
    let json = args.export_json.as_ref().map(|path| sources::output(path, &args.scenes, [])).transpose()?;
    let scenes = sources::scenes(&names)?;
    let most = args.epochs.saturating_mul(MOST);
    let first = if kept.is_some() { most } else { args.epochs };
    let settings = Settings {
        structures,
        guide: sources::guide(registry)?,
        workloads: if args.workload.is_empty() { WORKLOADS.to_vec() } else { args.workload.clone() },
        replayed: None,
        rays: args.rays,
        runs: usize::from(first) * usize::from(args.runs),
        epochs: first.into(),
        twin: true,
        budget_ns: CHECKS_NS,
        epoch_ns: Some(EPOCH_NS),
        seed: args.seed,
        threads: Threads::pinned(args.threads.into()).map_err(anyhow::Error::msg)?,
    };

    let clock = SystemClock::start();
    let mut progress = Progress::over(1, terminal);
    let mut trials = Trials::new(&scenes, &settings, &clock, &mut |scene, stage| {
        progress.scene(scene);
        progress.stage(&stage);
    })?;
    let mut epochs = 0;
    // Where nothing is decided there are more epochs and another look.
    let looks = 1 + usize::from(most - first).div_ceil(STEP.into());
    let (run, comparison) = loop {
        let step = if epochs == 0 { first } else { STEP };
        for _ in 0..step {
            trials.epoch(&mut |scene, stage| {
                progress.scene(scene);
                progress.stage(&stage);
            })?;
        }
        epochs += step;
        let run = Compared::joined(trials.results());
        let compare = |old: &Vec<Record>| against(old, &run, args.fail_on_regression, looks);
        let comparison = baseline.as_ref().map(compare).transpose()?;
        let open = comparison.as_ref().is_some_and(|c| verdict(c) == bench::Verdict::Undecided);
        if !open || epochs >= most {
            break (run, comparison);
        }
    };
    anyhow::ensure!(!run.records.is_empty(), "nothing was measured: these scenes have no rays of the kinds asked for");
    progress.scene_done();
    progress.warn(run.records.iter().flat_map(|record| &record.provenance.warnings));
    progress.finish();

    print(&run, comparison.as_ref(), &settings, terminal)?;
    if let Some(file) = json {
        file.write(&to_json(&run.records))?;
    }
    let found = found(&run, comparison.as_ref());
    match (kept, found) {
        (Some(_), Verdict::Wrong) => {
            terminal.print_lines(&["Not kept as a baseline: answers are wrong.".into()])?;
        }
        (Some(file), _) => {
            file.write(&to_json(&run.records))?;
            let name = args.save_baseline.as_deref().context("a file of a name")?;
            terminal.print_lines(&[format!("Kept as baseline {name}: {}.", file.path().display())])?;
        }
        (None, _) => {}
    }
    Ok(found)
}

fn print(
    run: &Compared,
    comparison: Option<&Comparison>,
    settings: &Settings,
    terminal: &Terminal,
) -> anyhow::Result<()> {
    match comparison {
        Some(comparison) => tables(comparison).iter().try_for_each(|table| terminal.print_table(table))?,
        None => {
            let mut scenes: Vec<&str> = run.records.iter().map(|record| record.scene.as_str()).collect();
            scenes.dedup();
            for scene in scenes {
                let of: Vec<Record> = run.records.iter().filter(|record| record.scene == scene).cloned().collect();
                let refused: Vec<Refused> = run.refused.iter().filter(|r| r.scene == scene).cloned().collect();
                terminal.print_table(&scene_table(&of, &Reference::of(&of, None), &refused, &[]))?;
            }
        }
    }
    terminal.print_lines(&[Provenance::of(&settings.threads).line()])?;
    Ok(())
}

/// What the run comes to, against the baseline if there is one.
fn found(run: &Compared, comparison: Option<&Comparison>) -> Verdict {
    let unexpected = |record: &Record| record.is_disqualified() && documented_defect(&record.structure).is_none();
    if run.records.iter().any(unexpected) {
        return Verdict::Wrong;
    }
    match comparison.map(verdict) {
        Some(bench::Verdict::Wrong) => Verdict::Wrong,
        Some(bench::Verdict::Refused) => Verdict::Refused,
        Some(bench::Verdict::Regression) => Verdict::Regression,
        Some(bench::Verdict::Undecided) => Verdict::Undecided,
        Some(bench::Verdict::Right) | None if run.refused.is_empty() => Verdict::Right,
        Some(bench::Verdict::Right) | None => Verdict::Refused,
    }
}
