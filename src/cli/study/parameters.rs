//! `study parameters`.

use super::epochs::{Options, measured};
use crate::cli::Verdict;
use crate::cli::terminal::Terminal;
use crate::registry::Registry;
use crate::scene::{Builtin, Scene};
use crate::study::epoch::Asked;
use crate::study::parameters::{NAME, result, rows, scenes, structures, tables};

#[derive(Clone, Debug, clap::Args)]
pub struct Args {
    /// Scenes of the report's sweep; all of them if none is named
    #[arg(value_name = "SCENE")]
    pub scenes: Vec<String>,
    #[command(flatten)]
    pub options: Options,
}

pub fn run(registry: &Registry, args: &Args, terminal: &Terminal) -> anyhow::Result<Verdict> {
    let files = args.options.exports.check()?;
    let settings = args.options.settings(registry, structures(registry)?, Asked::Picture)?;
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
    let Some((epochs, provenance)) = measured(NAME, &args.options, &settings, &chosen, terminal)? else {
        return Ok(Verdict::Wrong);
    };
    let result = result(&epochs);
    let shown = tables(&result);
    files.tell(terminal, (NAME, &provenance), &result, rows(&result), &shown, &[provenance.line()])?;
    Ok(Verdict::Right)
}
