//! `render`.

use std::path::{Path, PathBuf};
use std::str::FromStr;

use anyhow::Context;
use glam::Vec3;

use super::terminal::Terminal;
use crate::accel::Observed;
use crate::registry::Registry;
use crate::render::{ErrorMap, ViewError, ViewKind, costs, draw, hottest};
use crate::scene::{Camera, Scene};
use crate::study::{BRUTE_FORCE, PANICKED, SAH_TREE, guarded};
use crate::study::{Status, sources};

#[derive(Debug, clap::Args)]
pub struct Args {
    /// A built-in scene, a scene file (.toml) or a mesh file
    #[arg(value_name = "SCENE|FILE")]
    scene: String,
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
    /// Pixels [default: those of the scene]
    #[arg(long, value_name = "WxH")]
    size: Option<Size>,
    /// Eye, target and vertical field of view in degrees [default: those of the scene]
    #[arg(long, value_name = "ex,ey,ez tx,ty,tz [fov]", allow_hyphen_values = true)]
    camera: Option<View>,
    /// Tests and steps that the heat view shows brightest [default: of the costliest tree of all, so that the pictures of
    /// all structures can be compared]
    #[arg(long, value_name = "N")]
    hottest: Option<u64>,
}

/// Width and height.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
struct Size([u32; 2]);

impl FromStr for Size {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let sides = text.split_once('x').and_then(|(w, h)| Some([w.parse().ok()?, h.parse().ok()?]));
        let admitted = |side: &u32| (1..=16384).contains(side);
        let sides = sides.filter(|sides: &[u32; 2]| sides.iter().all(admitted));
        sides.map(Self).ok_or_else(|| "write WIDTHxHEIGHT, both from 1 to 16384, for example 640x480".into())
    }
}

/// Where to look from, and where to.
#[derive(Clone, Copy, Debug, PartialEq)]
struct View {
    eye: Vec3,
    target: Vec3,
    vertical_fov: Option<f32>,
}

impl FromStr for View {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let refusal = || "write \"ex,ey,ez tx,ty,tz\" and, if you like, a field of view in degrees".to_owned();
        let numbers = |part: &str| part.split(',').map(|n| n.parse().ok()).collect::<Option<Vec<f32>>>();
        let parts: Option<Vec<Vec<f32>>> = text.split_whitespace().map(numbers).collect();
        match parts.ok_or_else(refusal)?.iter().map(Vec::as_slice).collect::<Vec<_>>()[..] {
            [&[ex, ey, ez], &[tx, ty, tz], ref rest @ ..] if rest.iter().all(|r| r.len() == 1) && rest.len() < 2 => {
                let vertical_fov = rest.first().map(|fov| fov[0]);
                Ok(Self { eye: Vec3::new(ex, ey, ez), target: Vec3::new(tx, ty, tz), vertical_fov })
            }
            _ => Err(refusal()),
        }
    }
}

pub fn run(registry: &Registry, args: &Args, terminal: &Terminal) -> anyhow::Result<Status> {
    let choice = sources::structure(registry, &args.structure)?;
    let file = sources::output(&args.output, std::slice::from_ref(&args.scene), None)?;
    is_png(&args.output)?;
    let mut scene = sources::scene(&args.scene)?;
    if let Some(View { eye, target, vertical_fov }) = args.camera {
        let vertical_fov = vertical_fov.unwrap_or(scene.camera.vertical_fov());
        scene.camera = Camera::new(eye, target, scene.camera.up(), vertical_fov).context("--camera")?;
    }
    let size = args.size.map_or(scene.size, |size| size.0);

    let accel = choice.build(&scene.mesh)?;
    let scale = match (args.view, args.hottest) {
        (ViewKind::Heat, None) => common_scale(registry, &scene, size)?,
        (_, hottest) => hottest.unwrap_or(1).max(1),
    };
    let drawn = guarded(|| -> Result<_, ViewError> {
        let errors = (args.view == ViewKind::Error).then(|| ErrorMap::new(&scene, accel.as_ref(), size));
        let picture = match &errors {
            Some(errors) => errors.picture(),
            None => draw(&scene, accel.as_ref(), args.view, size, scale)?,
        };
        Ok((picture, errors))
    });
    let (picture, errors) = drawn.with_context(|| format!("{}: {PANICKED}", choice.label))??;
    file.write(&picture.png())?;

    let scale = if args.view == ViewKind::Heat { format!(", brightest at {scale} tests and steps") } else { "".into() };
    let what = format!("{} view of {} by {}", args.view.name(), scene.name, choice.label);
    terminal.print(&format!("{}: {} x {} pixels, {what}{scale}\n", args.output.display(), size[0], size[1]))?;
    let notes: Vec<String> = scene.notes.iter().map(|note| format!("{}: {note}", scene.name)).collect();
    terminal.print_lines(&notes)?;
    if let Some(errors) = errors {
        terminal.print(&format!("{}\n", errors.legend()))?;
    }
    Ok(Status::Right)
}

/// Refuses a name that promises another form than the one that is written.
fn is_png(path: &Path) -> anyhow::Result<()> {
    let ending = path.extension().filter(|ending| !ending.eq_ignore_ascii_case("png"));
    match ending {
        Some(ending) => anyhow::bail!(
            "cannot write {} as {}: pictures are PNG files: end the name in .png, or give - for standard output",
            path.display(),
            ending.to_string_lossy()
        ),
        None => Ok(()),
    }
}

/// One scale for the heat of all structures: the hottest of the trees. Brute force would darken all of them.
fn common_scale(registry: &Registry, scene: &Scene, size: [u32; 2]) -> anyhow::Result<u64> {
    let mut scale = 1;
    for choice in sources::structures(registry, &[])? {
        if choice.entry.name != BRUTE_FORCE && choice.entry.observed == Observed::ALL {
            scale = scale.max(hottest(&costs(scene, choice.build(&scene.mesh)?.as_ref(), size)?));
        }
    }
    Ok(scale)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sizes() {
        assert_eq!("640x480".parse(), Ok(Size([640, 480])));
        for wrong in ["640", "0x5", "5x0", "99999x5", "axb", "-1x2", "1x2x3"] {
            assert!(wrong.parse::<Size>().is_err(), "{wrong}");
        }
    }

    #[test]
    fn cameras() {
        let (eye, target) = (Vec3::new(-1.0, 2.0, 3.5), Vec3::ZERO);
        assert_eq!("-1,2,3.5 0,0,0".parse(), Ok(View { eye, target, vertical_fov: None }));
        assert_eq!("-1,2,3.5 0,0,0 45".parse(), Ok(View { eye, target, vertical_fov: Some(45.0) }));
        for wrong in ["", "1,2,3", "1,2 3,4,5", "1,2,3 4,5,6 7 8", "1,2,3 4,5,6 7,8", "a,b,c 1,2,3"] {
            assert!(wrong.parse::<View>().is_err(), "{wrong}");
        }
    }
}
