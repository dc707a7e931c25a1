//! The command `render`: renders a picture of a scene.

use std::ffi::OsString;
use std::path::{Path, PathBuf};

use anyhow::Context;
use indicatif::ProgressBar;

use super::progress::spinner;
use super::terminal::Terminal;
use crate::accel::Observed;
use crate::escaped::Escaped as _;
use crate::registry::Registry;
use crate::render::{ErrorMap, ViewError, ViewKind, coarse_size, costs, draw, hottest, png, with_heat_bar};
use crate::report::number::count;
use crate::request::{self, BRUTE_FORCE, OUTPUT, SAH_TREE, STRUCTURES, ViewArgs, is_large};
use crate::scene::Scene;
use crate::study::Status;
use crate::study::measure::{PANICKED, guarded};

#[derive(Debug, clap::Args)]
pub struct Args {
    /// Built-in scene, scene file (.toml) or mesh file
    #[arg(value_name = "SCENE|FILE")]
    scene: OsString,
    /// PNG file to write; - is standard output
    #[arg(long, short, help_heading = OUTPUT, value_name = "F.png")]
    output: PathBuf,
    /// shaded, depth, normal, primitive, heat (tests and steps per pixel) or error (wrong hits, by exact arithmetic)
    #[arg(long, help_heading = OUTPUT, default_value = "shaded", value_name = "VIEW")]
    view: ViewKind,
    /// Structure that traces the rays
    #[arg(long, short, help_heading = STRUCTURES, default_value = SAH_TREE, value_name = "NAME[:key=value,..]")]
    structure: String,
    #[command(flatten)]
    from: ViewArgs,
    /// Tests and steps at the bright end of the heat scale [default: the maximum over all trees, which makes pictures of
    /// all structures comparable; on very large meshes, the maximum of this structure]
    #[arg(long, help_heading = OUTPUT, value_name = "N", value_parser = clap::value_parser!(u64).range(1..))]
    hottest: Option<u64>,
}

pub fn run(registry: &Registry, args: &Args, terminal: &Terminal) -> anyhow::Result<Status> {
    anyhow::ensure!(
        args.hottest.is_none() || args.view == ViewKind::Heat,
        "--hottest sets the scale of --view heat: omit it, or add --view heat"
    );
    let choice = registry.choose(&args.structure)?;
    let file = request::output(registry, &args.output, std::slice::from_ref(&args.scene), None)?;
    is_png(&args.output)?;
    let waiting = spinner(format!("loading {}", args.scene.escaped()), terminal);
    let scene = args.from.of(request::scene(registry, &args.scene)?)?;
    let size = scene.size;

    waiting.set_message(format!("{}: building {}", scene.name, choice.label));
    let accel = choice.build(&scene.mesh)?;
    let scaled_alone = args.hottest.is_none() && is_large(scene.mesh.len());
    let scale = match (args.view, args.hottest) {
        (ViewKind::Heat, None) if scaled_alone => {
            let costs = guarded(|| costs(&scene, accel.as_ref(), coarse_size(&scene)));
            hottest(&costs.with_context(|| format!("{}: {PANICKED}", choice.label))??).max(1)
        }
        (ViewKind::Heat, None) => common_scale(registry, &scene, &waiting)?,
        (_, hottest) => hottest.unwrap_or(1),
    };
    waiting.set_message(format!("{}: drawing with {}", scene.name, choice.label));
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
        let most = count(scale);
        legend =
            format!("; the colour bar runs from 0 to {most} tests and steps, with ticks at 1 and every power of ten");
    }
    file.write(&png(&picture))?;

    let what = format!("{} view of {} by {}", args.view.name(), scene.name, choice.label);
    let (file, width, height) = (args.output.escaped(), picture.width(), picture.height());
    terminal.print(&format!("{file}: {width} x {height} pixels, {what}{legend}\n"));
    terminal.print_notes(scene.notes.iter().map(|note| format!("{}: {note}", scene.name)));
    if args.view == ViewKind::Heat && scaled_alone {
        terminal.print_lines([format!(
            "{}: the scale is this structure's own (building all structures would take minutes); --hottest sets a common \
             scale",
            scene.name
        )]);
    }
    if let Some(errors) = errors {
        terminal.print(&format!("{}\n", errors.legend()));
    }
    Ok(Status::Right)
}

fn is_png(path: &Path) -> anyhow::Result<()> {
    let ending = path.extension().unwrap_or("png".as_ref());
    let (path, format) = (path.escaped(), ending.escaped());
    anyhow::ensure!(
        ending.eq_ignore_ascii_case("png"),
        "cannot write {path} as {format}: pictures are PNG files; end the name in .png, or pass - for standard output"
    );
    Ok(())
}

/// The heat scale for pictures of all trees. Brute force is excluded, because its high cost would darken all pictures.
fn common_scale(registry: &Registry, scene: &Scene, waiting: &ProgressBar) -> anyhow::Result<u64> {
    let size = coarse_size(scene);
    let mut scale = 1;
    for choice in request::structures(registry, &[])? {
        if choice.entry.name != BRUTE_FORCE && choice.entry.observed == Observed::ALL {
            waiting.set_message(format!("{}: building {} for the scale", scene.name, choice.label));
            scale = scale.max(hottest(&costs(scene, choice.build(&scene.mesh)?.as_ref(), size)?));
        }
    }
    Ok(scale)
}
