//! The scenes, as the report's course shades them.

use super::shown::Shown;
use crate::registry::Registry;
use crate::render::{Picture, ViewKind, draw, size_of};
use crate::report::Table;
use crate::report::document::{Art, Block, Figure, Section, Thumbnail};
use crate::report::number::count;
use crate::report::words::{listed, scene_name};
use crate::scene::Builtin;
use crate::study::{guarded, sources};

/// Longest side of a thumbnail, in pixels.
const THUMBNAIL: u32 = 208;

pub const TITLE: &str = "The scenes";

/// The scene as the report's course shades it, four rays a pixel.
pub fn thumbnail(shown: &Shown, registry: &Registry) -> Option<Thumbnail> {
    let scene = &shown.scene;
    let accel = sources::guide(registry).ok()?.build(&scene.mesh).ok()?;
    let size = size_of(scene, THUMBNAIL);
    let fine =
        guarded(|| draw(scene, accel.as_ref(), ViewKind::Shaded, size.map(|side| 2 * side), 1)).and_then(Result::ok)?;
    let picture = halved(&fine);
    let differs = if shown.differs { "; another mesh or view than the one measured" } else { "" };
    let name = scene_name(&scene.name, !scene.stand_ins.is_empty());
    Some(Thumbnail {
        alt: format!("{name}, rendered"),
        note: format!("{} triangles{differs}", count(scene.mesh.len() as u64)),
        name,
        png: picture.png(),
        size,
    })
}

/// The mean of each two by two pixels.
fn halved(fine: &Picture) -> Picture {
    let [width, height] = fine.size().map(|side| side / 2);
    let pixel = |x: u32, y: u32| fine.pixels()[(y * fine.size()[0] + x) as usize];
    let mean = |x: u32, y: u32| {
        let four = [pixel(x, y), pixel(x + 1, y), pixel(x, y + 1), pixel(x + 1, y + 1)];
        std::array::from_fn(|c| (four.iter().map(|p| u32::from(p[c])).sum::<u32>().div_ceil(4)).min(255) as u8)
    };
    let pixels = (0..height).flat_map(|y| (0..width).map(move |x| mean(2 * x, 2 * y)));
    Picture::new([width, height], pixels.collect())
}

/// From where the scenes are seen.
fn caption(shown: &[Shown]) -> String {
    let all_builtin = shown.iter().all(|one| Builtin::find(&one.argument).is_ok());
    let cameras = if all_builtin {
        "with the source report's cameras, lights and materials"
    } else {
        "the built-in ones with the source report's cameras, lights and materials, those of scene files with their own, and meshes with \
         a camera that has them whole in view"
    };
    let asked = shown.iter().filter_map(|one| {
        let view = one.view.looks_from()?;
        let from = if view == "--inside" { "within" } else { "where its command says" };
        Some(format!("{} is seen from {from} ({view})", one.scene.name))
    });
    let asked: Vec<String> = asked.collect();
    let asked = if asked.is_empty() { String::new() } else { format!("; {}", listed(&asked)) };
    let colon = if all_builtin { "" } else { ":" };
    format!("The scenes as they were traced, rendered by sahara{colon} {cameras}{asked}.")
}

/// `lost` are the scenes without a picture.
pub fn section(thumbnails: Vec<Thumbnail>, shown: &[Shown], lost: &[String]) -> Section {
    let mut blocks = vec![];
    if !thumbnails.is_empty() {
        let rows = thumbnails.iter().map(|t| [t.name.clone(), t.note.clone()]).collect();
        blocks.push(Block::figure(Figure {
            id: "scenes".into(),
            caption: caption(shown),
            alt: String::new(),
            command: "sahara render SCENE -o SCENE.png".into(),
            art: Art::Gallery(thumbnails),
            data: Table::of_texts("", ["scene", "triangles"], rows),
        }));
    }
    for name in lost {
        blocks
            .push(Block::missing(&format!("A picture of {name}: its file is not here"), "sahara render FILE -o F.png"));
    }
    Section { id: "scenes", title: TITLE, blocks }
}
