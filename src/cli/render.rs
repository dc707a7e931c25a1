//! `render`.

use std::ffi::OsString;
use std::path::{Path, PathBuf};

use anyhow::Context;
use indicatif::ProgressBar;

use super::progress::spinner;
use super::terminal::Terminal;
use crate::accel::{DynAccel, Observed};
use crate::escaped::Escaped as _;
use crate::registry::{Choice, Registry};
use crate::render::{ErrorMap, ViewError, ViewKind, coarse_size, costs, draw, hottest, png, with_heat_bar};
use crate::report::number::count;
use crate::request::{self, BRUTE_FORCE, SAH_TREE, ViewArgs, is_large};
use crate::scene::Scene;
use crate::study::Status;
use crate::study::measure::{PANICKED, guarded};

#[derive(Debug, clap::Args)]
pub struct Args {
    /// A built-in scene, a scene file (.toml) or a mesh file
    #[arg(value_name = "SCENE|FILE")]
    scene: OsString,
    /// The picture, a PNG file; - is standard output
    #[arg(long, short, value_name = "F.png")]
    output: PathBuf,
    /// shaded, depth, normal, primitive, heat (tests and steps of each pixel) or error (where answers are wrong, by exact
    /// arithmetic)
    #[arg(long, default_value = "shaded", value_name = "VIEW")]
    view: ViewKind,
    /// The structure that answers
    #[arg(long, short, default_value = SAH_TREE, value_name = "NAME[:key=value,..]")]
    structure: String,
    #[command(flatten)]
    from: ViewArgs,
    /// Tests and steps that the heat view shows brightest [default: of the costliest tree of all, so that the pictures of
    /// all structures can be compared; where building all of them would take minutes, of the one that answers]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u64).range(1..))]
    hottest: Option<u64>,
}

pub fn run(registry: &Registry, args: &Args, terminal: &Terminal) -> anyhow::Result<Status> {
    anyhow::ensure!(
        args.hottest.is_none() || args.view == ViewKind::Heat,
        "--hottest is the scale of --view heat: leave it out, or ask for that view"
    );
    let choice = request::structure(registry, &args.structure)?;
    let file = request::output(registry, &args.output, std::slice::from_ref(&args.scene), None)?;
    is_png(&args.output)?;
    let waiting = spinner(format!("loads {}", args.scene.escaped()), terminal);
    let scene = args.from.of(request::scene(registry, &args.scene)?)?;
    let size = scene.size;

    waiting.set_message(format!("{} builds {}", scene.name, choice.label));
    let accel = choice.build(&scene.mesh)?;
    let scaled_alone = args.hottest.is_none() && is_large(scene.mesh.len());
    let scale = match (args.view, args.hottest) {
        (ViewKind::Heat, None) if scaled_alone => own_scale(&choice, &scene, accel.as_ref())?,
        (ViewKind::Heat, None) => common_scale(registry, &scene, &waiting)?,
        (_, hottest) => hottest.unwrap_or(1),
    };
    waiting.set_message(format!("{} is drawn by {}", scene.name, choice.label));
    let drawn = guarded(|| -> Result<_, ViewError> {
        let errors = (args.view == ViewKind::Error).then(|| ErrorMap::new(&scene, accel.as_ref(), size));
        let picture = match &errors {
            Some(errors) => errors.picture(),
            None => draw(&scene, accel.as_ref(), args.view, size, scale)?,
        };
        Ok((picture, errors))
    });
    drop(waiting);
    let (mut picture, errors) = drawn.with_context(|| format!("{}: {PANICKED}", choice.label))??;
    let mut legend = String::new();
    if args.view == ViewKind::Heat {
        picture = with_heat_bar(picture, scale);
        legend = format!(
            "; below it the colours from 0 to {} tests and steps, marked at 1 and each power of ten",
            count(scale)
        );
    }
    file.write(&png(&picture))?;

    let what = format!("{} view of {} by {}", args.view.name(), scene.name, choice.label);
    terminal.print(&format!(
        "{}: {} x {} pixels, {what}{legend}\n",
        args.output.escaped(),
        picture.width(),
        picture.height()
    ));
    let notes: Vec<String> = scene.notes.iter().map(|note| format!("{}: {note}", scene.name)).collect();
    terminal.print_lines(&notes);
    if args.view == ViewKind::Heat && scaled_alone {
        terminal.print_lines(&[format!(
            "{}: the scale is that of this structure alone, since it would take minutes to build all among so many triangles: --hottest \
             gives several pictures one scale",
            scene.name
        )]);
    }
    if let Some(errors) = errors {
        terminal.print(&format!("{}\n", errors.legend()));
    }
    Ok(Status::Right)
}

/// Refuses a name that promises another form than the one that is written.
fn is_png(path: &Path) -> anyhow::Result<()> {
    let ending = path.extension().unwrap_or("png".as_ref());
    anyhow::ensure!(
        ending.eq_ignore_ascii_case("png"),
        "cannot write {} as {}: pictures are PNG files: end the name in .png, or give - for standard output",
        path.escaped(),
        ending.escaped()
    );
    Ok(())
}

fn own_scale(choice: &Choice, scene: &Scene, accel: &dyn DynAccel) -> anyhow::Result<u64> {
    let costs =
        guarded(|| costs(scene, accel, coarse_size(scene))).with_context(|| format!("{}: {PANICKED}", choice.label))?;
    Ok(hottest(&costs?).max(1))
}

/// One scale for the heat of all structures: the hottest of the trees. Brute force would darken all of them.
fn common_scale(registry: &Registry, scene: &Scene, waiting: &ProgressBar) -> anyhow::Result<u64> {
    let size = coarse_size(scene);
    let mut scale = 1;
    for choice in request::structures(registry, &[])? {
        if choice.entry.name != BRUTE_FORCE && choice.entry.observed == Observed::ALL {
            waiting.set_message(format!("{} builds {} for the scale", scene.name, choice.label));
            scale = scale.max(hottest(&costs(scene, choice.build(&scene.mesh)?.as_ref(), size)?));
        }
    }
    Ok(scale)
}
