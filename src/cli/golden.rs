//! `golden`.

use anyhow::Context;
use clap::ValueEnum;

use super::terminal::Terminal;
use crate::accel::DynAccel;
use crate::escaped::Escaped as _;
use crate::golden::{GoldenError, Goldens, SIZE, TRIANGLE_TEST};
use crate::registry::{Choice, Registry};
use crate::report::number::count;
use crate::report::words::each_once_by;
use crate::request::{BRUTE_FORCE, known_defect};
use crate::scene::{BUILTIN, Builtin, Scene, View};
use crate::study::Status;
use crate::validate::{Reference, validate};

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
    /// Hold every structure over the exact triangle test against them, byte for byte
    Check,
    /// Make them anew, by brute force
    Update,
}

pub fn run(registry: &Registry, args: &Args, terminal: &Terminal) -> anyhow::Result<Status> {
    let scenes: Vec<&Builtin> = if args.scenes.is_empty() {
        BUILTIN.iter().collect()
    } else {
        let find =
            |name: &String| Builtin::find(name).context("golden images are of built-in scenes alone, not of files");
        args.scenes.iter().map(find).collect::<anyhow::Result<_>>()?
    };
    // What is named twice counts once.
    let scenes = each_once_by(scenes, |one, other| one.name == other.name);
    // A golden image belongs to the scene: all structures with one triangle test owe it the same bytes.
    let all = registry.all();
    let common: Vec<&Choice> = all.iter().filter(|choice| choice.triangle_test() == TRIANGLE_TEST).collect();
    let goldens = Goldens::builtin();
    let mut verdict = Status::Right;
    for builtin in scenes {
        // Real meshes that happen to be there must not change the picture.
        let scene = builtin.scene(None)?;
        match args.action {
            Action::Update => {
                let brute_force = registry.choose(&format!("{BRUTE_FORCE}:test={}", TRIANGLE_TEST))?;
                let changed = goldens.update(&scene, brute_force.build(&scene.mesh)?.as_ref())?;
                let what = if changed { "made anew" } else { "as it was" };
                terminal.print(&format!("{}: {what}, {}\n", scene.name, goldens.path(&scene).escaped()));
            }
            Action::Check => {
                let mut right = vec![];
                for choice in &common {
                    let accel = choice.build(&scene.mesh)?;
                    match goldens.check(&scene, &choice.label, accel.as_ref()) {
                        Ok(()) => right.push(choice.label.as_str()),
                        Err(error @ (GoldenError::Differs { .. } | GoldenError::NotShown { .. })) => {
                            terminal.print(&format!("{error}\n  {}\n", cause(&scene, accel.as_ref())?));
                            if known_defect(&choice.entry.name).is_none() {
                                verdict = Status::Wrong;
                            }
                        }
                        Err(error) => return Err(error.into()),
                    }
                }
                terminal.print(&format!("{}: byte for byte the same with {}\n", scene.name, right.join(", ")));
            }
        }
    }
    Ok(verdict)
}

/// Why a picture differs: wrong answers are a fault, another triangle at the same `t` is within the contract.
fn cause(scene: &Scene, accel: &dyn DynAccel) -> anyhow::Result<String> {
    let rays = scene.primary_rays(SIZE, View::CENTRE, 0..SIZE[0] * SIZE[1]);
    let found = validate(accel, &Reference::of_test(TRIANGLE_TEST, &scene.mesh)?, &scene.mesh, &rays);
    let (wrong, ties) = (count(found.errors()), count(found.ties));
    let test_errors = count(found.test_errors);
    Ok(format!(
        "of the primary rays {wrong} are answered wrong, {ties} by another triangle at the same t, {test_errors} otherwise for \
         the triangle test's own reasons"
    ))
}
