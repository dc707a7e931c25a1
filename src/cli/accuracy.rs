//! `accuracy`.

use std::path::PathBuf;

use anyhow::Context;

use super::progress::Progress;
use super::rays::{RaySource, replayed};
use super::terminal::Terminal;
use super::{Verdict, sources};
use crate::measure::SystemClock;
use crate::registry::{Choice, Registry};
use crate::report::number::count;
use crate::report::plot::Format;
use crate::report::to_json;
use crate::scene::Scene;
use crate::study::accuracy::{AccuracyRecord, RayKind, Settings, accuracy_scene, figure, legend, tables};
use crate::study::{BRUTE_FORCE, documented_defect};
use crate::triangle::{Exact, TriangleTest};

#[derive(Debug, clap::Args)]
pub struct Args {
    /// Built-in scenes, scene files (.toml) and mesh files (.obj, .ply, .gltf, .glb); all built-in scenes if none is named
    #[arg(value_name = "SCENE|FILE")]
    scenes: Vec<String>,
    /// A structure, over every triangle test unless it names one; may be repeated [default: all; brute-force only on
    /// meshes of at most 5,000 triangles]
    #[arg(long, short, value_name = "NAME[:key=value,..]")]
    structure: Vec<String>,
    /// A triangle test; may be repeated [default: all]
    #[arg(long, short, value_name = "NAME")]
    test: Vec<String>,
    /// A kind of rays: uniform, edge, vertex, axis, grazing, scale or offset; may be repeated [default: all]
    #[arg(long, value_name = "KIND")]
    stratum: Vec<RayKind>,
    /// Rays of each kind: without an error among n, the error is below about 3/n with 95 % confidence; or a file of rays to
    /// replay, in place of kinds
    #[arg(long, value_name = "N|F.rays", default_value = "20000")]
    rays: RaySource,
    /// Samples of every case
    #[arg(long, value_name = "N", default_value_t = 7, value_parser = clap::value_parser!(u16).range(1..))]
    runs: u16,
    /// Seconds that the samples of a scene may take: slow cases run on a part of the rays to keep within them
    #[arg(long, value_name = "SECONDS", default_value_t = 40, value_parser = clap::value_parser!(u32).range(1..=86400))]
    budget: u32,
    /// Seed of the rays and of the order of samples
    #[arg(long, value_name = "N", default_value_t = 1)]
    seed: u64,
    /// Write one record per case as JSON
    #[arg(long, value_name = "FILE")]
    export_json: Option<PathBuf>,
    /// Draw error against time, one panel for each scene and kind of rays; may be repeated
    #[arg(long, value_name = "F.svg|F.png")]
    plot: Vec<PathBuf>,
}

/// Brute force takes part in meshes up to this size, unless it is asked for.
const SMALL: usize = 5000;

pub fn run(registry: &Registry, args: &Args, terminal: &Terminal) -> anyhow::Result<Verdict> {
    // Everything that can be refused is refused before the long run.
    let choices = choices(registry, &args.structure, &args.test)?;
    let output = |path: &PathBuf| sources::output(path, &args.scenes, args.rays.file());
    let json = args.export_json.as_ref().map(output).transpose()?;
    let mut plots = vec![];
    for path in &args.plot {
        plots.push((output(path)?, Format::of(path)?));
    }
    let (scenes, replayed) = match replayed(&args.rays, &args.scenes)? {
        Some((scene, file)) => {
            anyhow::ensure!(args.stratum.is_empty(), "the rays are those of the file: leave --stratum out");
            (vec![scene], Some(file.workload))
        }
        None => (sources::scenes(&args.scenes)?, None),
    };

    let clock = SystemClock::start();
    let mut progress = Progress::over(scenes.len(), terminal);
    let (mut records, mut any_refused): (Vec<AccuracyRecord>, bool) = (vec![], false);
    for scene in &scenes {
        progress.scene(&scene.name);
        let (choices, note) = fitting(&choices, scene, args.structure.is_empty());
        let settings = Settings {
            choices,
            kinds: if args.stratum.is_empty() { RayKind::ALL.into() } else { args.stratum.clone() },
            replayed: replayed.clone(),
            rays: args.rays.number()?,
            runs: args.runs.into(),
            budget_ns: u64::from(args.budget) * 1_000_000_000,
            seed: args.seed,
        };
        let (of_scene, refused) = accuracy_scene(scene, &settings, &clock, &mut |stage| progress.stage(&stage))?;
        progress.scene_done();
        any_refused |= !refused.is_empty();
        let refused = refused.iter().map(|refused| format!("{} is refused: {}", refused.label, refused.reason));
        let notes: Vec<String> = scene.notes.iter().cloned().chain(note).chain(refused).collect();
        if of_scene.is_empty() {
            progress.aside(|| terminal.print_lines(&notes))?;
        }
        for table in tables(&of_scene, &notes) {
            progress.aside(|| terminal.print_table(&table))?;
        }
        records.extend(of_scene);
    }
    progress.finish();
    let mut foot = legend();
    foot.extend(records.first().map(|record| record.provenance.line()));
    terminal.print_lines(&foot)?;

    if let Some(file) = json {
        file.write(&to_json(&records))?;
    }
    let figure = figure(&records);
    for (file, format) in plots {
        file.write(&figure.bytes(format))?;
    }
    // Only one test promises the truth, and only in a structure that loses nothing.
    let owed = |r: &AccuracyRecord| r.triangle_test == Exact::NAME && documented_defect(&r.structure).is_none();
    let broken = |r: &AccuracyRecord| owed(r) && r.errors() + r.wrong_primitive > 0;
    Ok(match (records.iter().any(broken), any_refused) {
        (true, _) => Verdict::Wrong,
        (false, true) => Verdict::Refused,
        (false, false) => Verdict::Right,
    })
}

/// Every structure over every triangle test that it is offered with and that is asked for.
fn choices(registry: &Registry, structures: &[String], tests: &[String]) -> anyhow::Result<Vec<Choice>> {
    sources::known_tests(registry, tests)?;
    let mut choices: Vec<Choice> = vec![];
    for spec in sources::specs(registry, structures) {
        let choice = sources::structure(registry, &spec)?;
        let keys = spec.split_once(':').map_or("", |(_, keys)| keys);
        let names_test = keys.split(',').any(|key| key.starts_with("test="));
        for entry in registry.entries().iter().filter(|entry| entry.name == choice.entry.name) {
            let asked = if names_test { entry.triangle_test == choice.triangle_test() } else { true };
            if !asked || !tests.is_empty() && !tests.iter().any(|test| test.eq_ignore_ascii_case(entry.triangle_test)) {
                continue;
            }
            let with_test = match (names_test, keys) {
                (true, _) => spec.clone(),
                (false, "") => format!("{}:test={}", entry.name, entry.triangle_test),
                (false, keys) => format!("{}:{keys},test={}", entry.name, entry.triangle_test),
            };
            let choice = sources::structure(registry, &with_test)?;
            if choices.iter().all(|other| other.label != choice.label) {
                choices.push(choice);
            }
        }
    }
    choices
        .first()
        .context("none of the structures is offered over the triangle tests asked for: see `sahara list`")?;
    Ok(choices)
}

/// The choices that take part in `scene`, and what is to be said about those that do not.
fn fitting(choices: &[Choice], scene: &Scene, is_default: bool) -> (Vec<Choice>, Option<String>) {
    let mut fitting = choices.to_vec();
    if !is_default || scene.mesh.len() <= SMALL {
        return (fitting, None);
    }
    fitting.retain(|choice| choice.entry.name != BRUTE_FORCE);
    let left_out = fitting.len() < choices.len();
    let note = format!(
        "brute-force is left out of meshes with more than {} triangles: --structure brute-force runs it, on a part of the rays",
        count(SMALL as u64)
    );
    (fitting, left_out.then_some(note))
}
