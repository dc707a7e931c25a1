//! `study scaling`.

use super::epochs::{Field, cases, verdict};
use crate::cli::terminal::Terminal;
use crate::cli::{Verdict, sources};
use crate::registry::Registry;
use crate::scene::{Scene, WorkloadKind};
use crate::study::scaling::{Case, Family, LEVELS, NAME, STRUCTURES, result, rows, sphere, tables};

#[derive(Clone, Debug, clap::Args)]
pub struct Args {
    /// Built-in scenes, scene files (.toml) and mesh files (.obj, .ply, .gltf, .glb), beside the icospheres [default: dragon,
    /// lucy, sponza]
    #[arg(value_name = "SCENE|FILE")]
    pub scenes: Vec<String>,
    /// The finest icosphere, of 20 times 4 to that power triangles
    #[arg(long, value_name = "LEVEL", default_value_t = *LEVELS.end(), value_parser = clap::value_parser!(u32).range(0..=10))]
    pub finest: u32,
    #[command(flatten)]
    pub field: Field,
}

pub fn run(registry: &Registry, args: &Args, terminal: &Terminal) -> anyhow::Result<Verdict> {
    let options = &args.field.options;
    let files = options.exports.check()?;
    let settings = args.field.settings(registry, &STRUCTURES, &[WorkloadKind::Primary, WorkloadKind::Random])?;
    let mut scenes: Vec<Scene> = (0..=args.finest).map(sphere).collect::<Result<_, _>>()?;
    let spheres = scenes.len();
    let default = ["dragon", "lucy", "sponza"].map(String::from);
    scenes.extend(sources::scenes(if args.scenes.is_empty() { &default } else { &args.scenes })?);

    let wrap = |s: usize, epoch| Ok(Case { family: if s < spheres { Family::Spheres } else { Family::Meshes }, epoch });
    let (cases, provenance) = cases(NAME, options, &settings, &scenes, terminal, wrap, |case: &Case| &case.epoch)?;
    let growths = result(&cases);
    let shown = tables(&growths);
    let (mut foot, verdict) = verdict(cases.iter().map(|case| &case.epoch));
    foot.push(provenance.line());
    files.tell(terminal, (NAME, &provenance), &growths, &rows(&growths), &shown, &foot)?;
    Ok(verdict)
}
