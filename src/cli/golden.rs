//! `golden`.

use clap::ValueEnum;

use super::Verdict;
use super::terminal::Terminal;
use crate::golden::{GoldenError, Goldens};
use crate::registry::{Choice, Registry};
use crate::scene::{BUILTIN, Builtin};
use crate::study::{BRUTE_FORCE, documented_defect};
use crate::triangle::{MollerTrumbore, TriangleTest};

#[derive(Debug, clap::Args)]
pub struct Args {
    /// What to do with the golden images
    action: Action,
    /// Built-in scenes; all if none is named
    #[arg(value_name = "SCENE")]
    scenes: Vec<String>,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
enum Action {
    /// Hold every structure with the common triangle test against them, byte for byte
    Check,
    /// Make them anew, by brute force
    Update,
}

pub fn run(registry: &Registry, args: &Args, terminal: &Terminal) -> anyhow::Result<Verdict> {
    let scenes: Vec<&Builtin> = if args.scenes.is_empty() {
        BUILTIN.iter().collect()
    } else {
        args.scenes.iter().map(|name| Builtin::find(name)).collect::<Result<_, _>>()?
    };
    // A golden image belongs to the scene: all structures with one triangle test owe it the same bytes.
    let all = registry.all();
    let common: Vec<&Choice> = all.iter().filter(|choice| choice.triangle_test() == MollerTrumbore::NAME).collect();
    let goldens = Goldens::builtin();
    let mut verdict = Verdict::Right;
    for builtin in scenes {
        // Real meshes that happen to be there must not change the picture.
        let scene = builtin.scene(None)?;
        match args.action {
            Action::Update => {
                let brute_force = registry.choose(&format!("{BRUTE_FORCE}:test={}", MollerTrumbore::NAME))?;
                let changed = goldens.update(&scene, brute_force.build(&scene.mesh)?.as_ref())?;
                let what = if changed { "made anew" } else { "as it was" };
                terminal.print(&format!("{}: {what}, {}\n", scene.name, goldens.path(&scene).display()))?;
            }
            Action::Check => {
                let mut right = vec![];
                for choice in &common {
                    match goldens.check(&scene, &choice.label, choice.build(&scene.mesh)?.as_ref()) {
                        Ok(()) => right.push(choice.label.as_str()),
                        Err(error @ GoldenError::Differs { .. }) => {
                            let defect = documented_defect(&choice.entry.name);
                            let known = defect.map_or(String::new(), |defect| format!(" (known defect: {defect})"));
                            terminal.print(&format!("{error}{known}\n"))?;
                            if defect.is_none() {
                                verdict = Verdict::Wrong;
                            }
                        }
                        Err(error) => return Err(error.into()),
                    }
                }
                terminal.print(&format!("{}: byte for byte the same with {}\n", scene.name, right.join(", ")))?;
            }
        }
    }
    Ok(verdict)
}
