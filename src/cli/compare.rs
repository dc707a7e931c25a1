//! `compare`.

use std::path::PathBuf;

use clap::Parser;

use super::progress::Progress;
use super::rays::{RaySource, replayed};
use super::terminal::Terminal;
use super::{Verdict, sources};
use crate::measure::{Provenance, SystemClock, Threads, instructions};
use crate::registry::Registry;
use crate::report::{Record, Table, to_csv, to_json, to_markdown};
use crate::scene::WorkloadKind;
use crate::study::compare::{Reference, Settings, Trials, legend, mean_table, scene_table, winner};
use crate::study::documented_defect;

#[derive(Debug, Parser)]
pub struct Args {
    /// Built-in scenes, scene files (.toml) and mesh files (.obj, .ply, .gltf, .glb); all built-in scenes if none is named
    #[arg(value_name = "SCENE|FILE")]
    scenes: Vec<String>,
    /// A structure, with keys that differ from their defaults; may be repeated [default: all, one of each name]
    #[arg(long, short, value_name = "NAME[:key=value,..]")]
    structure: Vec<String>,
    /// How much time the builds of eight-wide trees may take, where a structure is named without a quality of its own
    #[arg(long, value_parser = sources::QUALITIES)]
    quality: Option<String>,
    /// The structure that speeds are related to; takes part even if it is not among those named [default: median-kd and the better
    /// BVH of obvhs; without them the first one]
    #[arg(long, value_name = "NAME[:key=value,..]")]
    reference: Option<String>,
    /// A kind of rays; may be repeated [default: primary, shadow, diffuse, random]
    #[arg(long, short, value_name = "KIND")]
    workload: Vec<WorkloadKind>,
    /// Threads that build and trace; 1 is the unit of comparison
    #[arg(long, value_name = "N", default_value_t = 1, value_parser = clap::value_parser!(u16).range(1..=1024))]
    threads: u16,
    /// Samples of every case, as many in each epoch; fewer where there is not time for them all
    #[arg(long, value_name = "N", default_value_t = 4, value_parser = clap::value_parser!(u16).range(1..))]
    runs: u16,
    /// How often everything is built anew, so that the luck of placement is in the samples
    #[arg(long, value_name = "N", default_value_t = 4, value_parser = clap::value_parser!(u16).range(1..))]
    epochs: u16,
    /// Rays of a workload that are timed, at most, in whole tiles of the scene's picture; or a file of rays to replay
    #[arg(long, value_name = "N|all|F.rays", default_value = "all")]
    rays: RaySource,
    /// Seconds that a scene may take: to keep within them slow cases are timed on fewer rays, then all are timed less often
    #[arg(long, value_name = "SECONDS", default_value_t = 18, value_parser = clap::value_parser!(u32).range(1..=86400))]
    budget: u32,
    /// Seed of the rays and of the order of samples
    #[arg(long, value_name = "N", default_value_t = 1)]
    seed: u64,
    /// Write one record per case as JSON
    #[arg(long, value_name = "FILE")]
    export_json: Option<PathBuf>,
    /// Write one row per case as CSV
    #[arg(long, value_name = "FILE")]
    export_csv: Option<PathBuf>,
    /// Write the tables as Markdown
    #[arg(long, value_name = "FILE")]
    export_markdown: Option<PathBuf>,
}

impl Default for Args {
    fn default() -> Self {
        Self::parse_from(["compare"])
    }
}

/// Without `--workload`.
const DEFAULT_WORKLOADS: [WorkloadKind; 4] =
    [WorkloadKind::Primary, WorkloadKind::Shadow, WorkloadKind::Diffuse, WorkloadKind::Random];

pub fn run(registry: &Registry, args: &Args, terminal: &Terminal) -> anyhow::Result<Verdict> {
    // Everything that can be refused is refused before the long run.
    let mut structures = sources::structures_at(registry, &args.structure, args.quality.as_deref())?;
    let reference = args.reference.as_ref().map(|spec| {
        let choice = sources::structures_at(registry, std::slice::from_ref(spec), args.quality.as_deref())?.remove(0);
        if structures.iter().all(|other| other.label != choice.label) {
            structures.push(choice.clone());
        }
        anyhow::Ok(choice.label)
    });
    let reference = reference.transpose()?;
    let threads = Threads::pinned(args.threads.into()).map_err(anyhow::Error::msg)?;
    let output = |path: &PathBuf| sources::output(path, &args.scenes, args.rays.file());
    let check = |path: &Option<PathBuf>| path.as_ref().map(output).transpose();
    let (json, csv, markdown) = (check(&args.export_json)?, check(&args.export_csv)?, check(&args.export_markdown)?);
    let (scenes, replayed) = match replayed(&args.rays, &args.scenes)? {
        Some((scene, file)) => {
            anyhow::ensure!(args.workload.is_empty(), "the rays are those of the file: leave --workload out");
            (vec![scene], Some(file.workload))
        }
        None => (sources::scenes(&args.scenes)?, None),
    };
    let settings = Settings {
        structures,
        guide: sources::guide(registry)?,
        workloads: if args.workload.is_empty() { DEFAULT_WORKLOADS.to_vec() } else { args.workload.clone() },
        replayed,
        rays: args.rays.count(),
        runs: args.runs.into(),
        epochs: args.epochs.into(),
        twin: true,
        budget_ns: u64::from(args.budget) * 1_000_000_000,
        epoch_ns: None,
        seed: args.seed,
        threads,
    };

    let clock = SystemClock::start();
    let epochs = settings.epochs;
    let mut progress = Progress::over(scenes.len() * (epochs + 1), terminal);
    let mut trials = Trials::new(&scenes, &settings, &clock, &mut |scene, stage| progress.part(scene, &stage))?;
    let mut failure = None;
    for epoch in 1..=epochs {
        let done =
            trials.epoch(&mut |scene, stage| progress.part(&format!("epoch {epoch} of {epochs}: {scene}"), &stage));
        // What is measured of the other scenes is not lost: it is printed and exported before the run ends.
        failure = failure.or(done.err());
    }
    let references = |records: &[Record]| Reference::of(records, reference.as_deref());
    let (mut records, mut tables): (Vec<Record>, Vec<Table>) = (vec![], vec![]);
    let mut refused = false;
    for (name, of_scene) in trials.results() {
        progress.warn(of_scene.records.first().iter().flat_map(|record| &record.provenance.warnings));
        let notes = scenes.iter().find(|scene| scene.name == name).map_or(&[][..], |scene| &scene.notes);
        let mut table = scene_table(&of_scene.records, &references(&of_scene.records), &of_scene.refused, notes);
        refused |= !of_scene.refused.is_empty();
        if of_scene.records.is_empty() && of_scene.refused.is_empty() {
            table.title = format!("{name}: none of the workloads asked for has a ray in this scene");
        }
        if of_scene.records.is_empty() && !of_scene.refused.is_empty() {
            table.title = format!("{name}: every structure is refused, or no ray is left");
        }
        progress.aside(|| terminal.print_table(&table))?;
        records.extend(of_scene.records);
        tables.push(table);
    }
    progress.finish();

    if tables.len() > 1 {
        let means = mean_table(&records, &references(&records));
        if means.says_something() {
            terminal.print_table(&means)?;
            tables.push(means);
        }
    }
    let mut foot = records.first().map_or(vec![], |first| legend(&first.workload, &references(&records)));
    if !records.is_empty() && records.iter().all(|r| r.instructions_per_ray.is_none()) {
        foot.push(instructions::ABSENT.into());
    }
    foot.push(Provenance::of(&settings.threads).line());
    foot.extend(winner(&records, reference.as_deref()));
    terminal.print_lines(&foot)?;

    if let Some(file) = json {
        file.write(&to_json(&records))?;
    }
    if let Some(file) = csv {
        file.write(&to_csv(&records))?;
    }
    if let Some(file) = markdown {
        file.write(&to_markdown(&tables, &foot))?;
    }
    if let Some(error) = failure {
        return Err(error.into());
    }
    Ok(match (records.iter().any(unexpected), refused) {
        (true, _) => Verdict::Wrong,
        (false, true) => Verdict::Refused,
        (false, false) => Verdict::Right,
    })
}

/// Whether a structure gives wrong answers that nothing explains: then the run fails. What a baseline is documented to get
/// wrong is shown, gets no time, and does not.
fn unexpected(record: &Record) -> bool {
    record.is_disqualified() && documented_defect(&record.structure).is_none()
}
