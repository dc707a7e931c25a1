//! `study attribution`.

use super::epochs::{Options, measured};
use super::meshes::Scenes;
use crate::cli::Verdict;
use crate::cli::rays::rays_or_all;
use crate::cli::terminal::Terminal;
use crate::registry::Registry;
use crate::report::Table;
use crate::scene::WorkloadKind;
use crate::study::attribution::{NAME, headlines, result, rows, structures, tables};
use crate::study::epoch::Asked;

#[derive(Clone, Debug, clap::Args)]
pub struct Args {
    #[command(flatten)]
    pub scenes: Scenes,
    /// The kind of rays
    #[arg(long, short, value_name = "KIND", default_value = "primary")]
    pub workload: WorkloadKind,
    /// Rays of a workload that are timed, at most, in whole tiles of the scene's picture
    #[arg(long, value_name = "N|all", default_value = "all", value_parser = rays_or_all)]
    pub rays: usize,
    /// The triangle test of all trees
    #[arg(long, value_name = "NAME", default_value = "filtered-f64")]
    pub test: String,
    #[command(flatten)]
    pub options: Options,
}

pub fn run(registry: &Registry, args: &Args, terminal: &Terminal) -> anyhow::Result<Verdict> {
    crate::cli::sources::known_tests(registry, std::slice::from_ref(&args.test))?;
    let files = args.options.exports.check()?;
    let asked = Asked::Kinds(vec![args.workload], args.rays);
    let settings = args.options.settings(registry, structures(registry, &args.test)?, asked)?;
    let scenes = args.scenes.read()?;
    let Some((epochs, provenance)) = measured(NAME, &args.options, &settings, &scenes, terminal)? else {
        return Ok(Verdict::Wrong);
    };
    let results = result(&epochs);
    let mut shown: Vec<Table> = results.iter().flat_map(tables).collect();
    let mut answer = headlines(&results);
    answer.notes.extend(args.scenes.note(&scenes));
    shown.push(answer);
    files.tell(terminal, (NAME, &provenance), &results, &rows(&results), &shown, &[provenance.line()])?;
    Ok(Verdict::Right)
}
