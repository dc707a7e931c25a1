//! `study partitions`.

use std::path::PathBuf;

use crate::cli::progress::Progress;
use crate::cli::rays::rays_or_all;
use crate::cli::terminal::Terminal;
use crate::cli::{Verdict, sources};
use crate::measure::{Provenance, SystemClock, Threads};
use crate::output::OutputFile;
use crate::registry::Registry;
use crate::report::{Record, to_json, to_markdown};
use crate::scene::WorkloadKind;
use crate::study::compare::{Compared, Settings, Trials};
use crate::study::documented_defect;
use crate::study::partitions::{LEGEND, rows, structures, tables};

#[derive(Debug, clap::Args)]
pub struct Args {
    /// Built-in scenes, scene files (.toml) and mesh files (.obj, .ply, .gltf, .glb) [default: dragon, lucy, sponza]
    #[arg(value_name = "SCENE|FILE")]
    scenes: Vec<String>,
    /// The triangle test of ours; obvhs has its own, which is Möller and Trumbore's in f32 as well
    #[arg(long, value_name = "NAME", default_value = "moller-trumbore")]
    test: String,
    /// Keys of the wide trees that differ from their defaults, as in batch=packets,quality=high
    #[arg(long, value_name = "key=value,..", default_value = "")]
    keys: String,
    /// A kind of rays; may be repeated [default: primary, shadow, diffuse, random]
    #[arg(long, short, value_name = "KIND")]
    workload: Vec<WorkloadKind>,
    /// Samples of every case
    #[arg(long, value_name = "N", default_value_t = 15, value_parser = clap::value_parser!(u16).range(1..))]
    runs: u16,
    /// How often everything is built anew; the samples are spread over them
    #[arg(long, value_name = "N", default_value_t = 3, value_parser = clap::value_parser!(u16).range(1..))]
    epochs: u16,
    /// Rays of a workload that are timed, at most, in whole tiles of the scene's picture
    #[arg(long, value_name = "N|all", default_value = "all", value_parser = rays_or_all)]
    rays: usize,
    /// Threads that build and trace; 1 is the unit of comparison
    #[arg(long, value_name = "N", default_value_t = 1, value_parser = clap::value_parser!(u16).range(1..=1024))]
    threads: u16,
    /// Seconds that a scene may take: slow cases are timed on fewer rays to keep within them
    #[arg(long, value_name = "SECONDS", default_value_t = 120, value_parser = clap::value_parser!(u32).range(1..=86400))]
    budget: u32,
    /// Seed of the rays and of the order of samples
    #[arg(long, value_name = "N", default_value_t = 1)]
    seed: u64,
    /// Write one record per case as JSON, as `partitions`
    #[arg(long, value_name = "FILE")]
    export_json: Option<PathBuf>,
    /// Write the tables as Markdown
    #[arg(long, value_name = "FILE")]
    export_markdown: Option<PathBuf>,
}

pub fn run(registry: &Registry, args: &Args, terminal: &Terminal) -> anyhow::Result<Verdict> {
    let keys = if args.keys.is_empty() { String::new() } else { format!(",{}", args.keys) };
    let structures = structures(registry, &args.test, &keys)?;
    let names = if args.scenes.is_empty() {
        ["dragon", "lucy", "sponza"].map(String::from).into()
    } else {
        args.scenes.clone()
    };
    let scenes = sources::scenes(&names)?;
    let check = |path: &Option<PathBuf>| path.as_deref().map(OutputFile::check).transpose();
    let (json, markdown) = (check(&args.export_json)?, check(&args.export_markdown)?);
    let workloads = [WorkloadKind::Primary, WorkloadKind::Shadow, WorkloadKind::Diffuse, WorkloadKind::Random];
    let settings = Settings {
        structures,
        guide: sources::guide(registry)?,
        workloads: if args.workload.is_empty() { workloads.into() } else { args.workload.clone() },
        replayed: None,
        rays: args.rays,
        runs: args.runs.into(),
        epochs: args.epochs.into(),
        twin: true,
        budget_ns: u64::from(args.budget) * 1_000_000_000,
        epoch_ns: None,
        seed: args.seed,
        threads: Threads::pinned(args.threads.into()).map_err(anyhow::Error::msg)?,
    };

    let clock = SystemClock::start();
    let epochs = settings.epochs;
    let mut progress = Progress::over(scenes.len() * (epochs + 1), terminal);
    let mut trials = Trials::new(&scenes, &settings, &clock, &mut |scene, stage| progress.part(scene, &stage))?;
    for epoch in 1..=epochs {
        trials.epoch(&mut |scene, stage| progress.part(&format!("epoch {epoch} of {epochs}: {scene}"), &stage))?;
    }
    let records = Compared::joined(trials.results()).records;
    progress.warn(records.iter().flat_map(|record| &record.provenance.warnings));
    for table in tables(&rows(&records)) {
        progress.aside(|| terminal.print_table(&table))?;
    }
    progress.finish();
    let mut foot: Vec<String> = LEGEND.map(String::from).into();
    foot.push(Provenance::of(&settings.threads).line());
    terminal.print_lines(&foot)?;
    if let Some(file) = json {
        file.write(&to_json(&serde_json::json!({
            "schema": Record::SCHEMA,
            "provenance": Provenance::of(&settings.threads),
            "partitions": records,
        })))?;
    }
    if let Some(file) = markdown {
        file.write(&to_markdown(&tables(&rows(&records)), &foot))?;
    }
    let wrong = records.iter().any(|r| r.is_disqualified() && documented_defect(&r.structure).is_none());
    Ok(if wrong { Verdict::Wrong } else { Verdict::Right })
}
