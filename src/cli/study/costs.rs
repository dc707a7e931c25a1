//! `study costs`.

use super::epochs::{Field, cases, verdict};
use super::meshes::{self, Meshes};
use crate::cli::Verdict;
use crate::cli::terminal::Terminal;
use crate::registry::Registry;
use crate::report::to_tidy_csv;
use crate::scene::WorkloadKind;
use crate::study::costs::{LEGEND, NAME, STRUCTURES, result, rows, tables};
use crate::study::epoch::Epoch;

#[derive(Clone, Debug, clap::Args)]
pub struct Args {
    /// Built-in scenes and mesh files (.obj, .ply, .gltf, .glb); all built-in scenes if none is named
    #[arg(value_name = "SCENE|FILE")]
    pub scenes: Vec<String>,
    /// Meshes of the built-in scenes
    #[arg(long, value_name = "WHICH", value_enum, default_value_t)]
    pub meshes: Meshes,
    #[command(flatten)]
    pub field: Field,
}

pub fn run(registry: &Registry, args: &Args, terminal: &Terminal) -> anyhow::Result<Verdict> {
    let options = &args.field.options;
    let files = options.exports.check()?;
    let kinds = [WorkloadKind::Primary, WorkloadKind::Shadow, WorkloadKind::Diffuse, WorkloadKind::Random];
    let settings = args.field.settings(registry, &STRUCTURES, &kinds)?;
    let scenes = meshes::scenes(&args.scenes, args.meshes)?;
    let (epochs, provenance) =
        cases(NAME, options, &settings, &scenes, terminal, |_, epoch| Ok(epoch), |epoch: &Epoch| epoch)?;
    let families = result(&epochs, options.seed);
    let shown = tables(&families);
    for table in &shown {
        terminal.print_table(table)?;
    }
    let (troubles, verdict) = verdict(&epochs);
    let mut foot: Vec<String> = LEGEND.map(String::from).into();
    foot.extend(troubles);
    foot.extend(meshes::note(&scenes, args.meshes));
    foot.push(provenance);
    terminal.print_lines(&foot)?;
    files.write(&families, || to_tidy_csv(&rows(&families)), &shown, &foot)?;
    Ok(verdict)
}
