//! `counts`.

use std::path::PathBuf;

use super::progress::Progress;
use super::terminal::Terminal;
use super::{Verdict, sources};
use crate::measure::{Provenance, Threads};
use crate::registry::Registry;
use crate::report::{Export, Table, to_json, to_markdown};
use crate::scene::WorkloadKind;
use crate::study::counts::{LEGEND, Measures, Settings, count_scene, histogram_tables, tables};

#[derive(Debug, clap::Args)]
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
    /// A kind of rays; may be repeated [default: primary, shadow, diffuse, random]
    #[arg(long, short, value_name = "KIND")]
    workload: Vec<WorkloadKind>,
    /// Rays of a workload, at most
    #[arg(long, value_name = "N", default_value_t = 16384, value_parser = clap::value_parser!(u32).range(1..=1 << 24))]
    rays: u32,
    /// Seed of the rays
    #[arg(long, value_name = "N", default_value_t = 1)]
    seed: u64,
    /// Threads that build; the trees do not depend on it
    #[arg(long, value_name = "N", default_value_t = 1, value_parser = clap::value_parser!(u16).range(1..=1024))]
    threads: u16,
    /// Leave out end-point overlap, which takes seconds for a million triangles
    #[arg(long)]
    no_overlap: bool,
    /// Print the leaves by size and by depth in numbers
    #[arg(long)]
    histograms: bool,
    /// Write everything counted as JSON
    #[arg(long, value_name = "FILE")]
    export_json: Option<PathBuf>,
    /// Write the tables as Markdown
    #[arg(long, value_name = "FILE")]
    export_markdown: Option<PathBuf>,
}

/// Without `--workload`.
const DEFAULT_WORKLOADS: [WorkloadKind; 4] =
    [WorkloadKind::Primary, WorkloadKind::Shadow, WorkloadKind::Diffuse, WorkloadKind::Random];

pub fn run(registry: &Registry, args: &Args, terminal: &Terminal) -> anyhow::Result<Verdict> {
    let structures = sources::structures_at(registry, &args.structure, args.quality.as_deref())?;
    let check =
        |path: &Option<PathBuf>| path.as_deref().map(|path| sources::output(path, &args.scenes, [])).transpose();
    let (json, markdown) = (check(&args.export_json)?, check(&args.export_markdown)?);
    let scenes = sources::scenes(&args.scenes)?;
    let settings = Settings {
        structures,
        guide: sources::guide(registry)?,
        workloads: if args.workload.is_empty() { DEFAULT_WORKLOADS.into() } else { args.workload.clone() },
        rays: args.rays,
        seed: args.seed,
        threads: Threads::new(args.threads.into()).map_err(anyhow::Error::msg)?,
        overlap: !args.no_overlap,
    };

    let mut progress = Progress::over(scenes.len(), terminal);
    let (mut measures, mut printed): (Vec<Measures>, Vec<Table>) = (vec![], vec![]);
    let mut refused = false;
    for scene in &scenes {
        progress.scene(&scene.name);
        let counts = count_scene(scene, &settings, &mut |stage| progress.stage(&stage))?;
        progress.scene_done();
        refused |= !counts.refused.is_empty();
        let mut tables = tables(&counts.measures, &counts.refused);
        if args.histograms {
            tables.extend(histogram_tables(&counts.measures));
        }
        if let Some(first) = tables.first_mut() {
            first.notes.splice(0..0, scene.notes.iter().cloned());
        }
        progress.aside(|| tables.iter().try_for_each(|table| terminal.print_table(table)))?;
        measures.extend(counts.measures);
        printed.extend(tables);
    }
    progress.finish();
    let foot = LEGEND.map(String::from);
    terminal.print_lines(&foot)?;
    if let Some(file) = json {
        file.write(&to_json(&Export::new("counts", &Provenance::of(&settings.threads), &measures)))?;
    }
    if let Some(file) = markdown {
        file.write(&to_markdown(&printed, &foot))?;
    }
    Ok(if refused { Verdict::Refused } else { Verdict::Right })
}
