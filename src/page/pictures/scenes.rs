//! The scenes, as the report's course shades them.

use image::{Rgb, RgbImage};

use super::loaded_scene::LoadedScene;
use crate::page::document::Section;
use crate::registry::Registry;
use crate::render::{ViewKind, draw, png, size_of};
use crate::report::number::count;
use crate::report::words::{listed, scene_name};
use crate::report::{Art, Block, Cell, Figure, Picture, Table};
use crate::request::guide;
use crate::scene::Builtin;
use crate::study::measure::guarded;

const SIDE: u32 = 208;

pub const TITLE: &str = "The scenes";

/// The scene as the report's course shades it, four rays a pixel.
pub fn picture(loaded: &LoadedScene, registry: &Registry) -> Option<Picture> {
    let scene = &loaded.scene;
    let accel = guide(registry).ok()?.build(&scene.mesh).ok()?;
    let size = size_of(scene, SIDE);
    let fine =
        guarded(|| draw(scene, accel.as_ref(), ViewKind::Shaded, size.map(|side| 2 * side), 1)).and_then(Result::ok)?;
    let name = scene_name(&scene.name, !scene.stand_ins.is_empty());
    Some(Picture {
        alt: format!("{name}, rendered"),
        note: format!("{} triangles", count(scene.mesh.len() as u64)),
        name,
        png: png(&halved(&fine)),
        size,
    })
}

fn halved(fine: &RgbImage) -> RgbImage {
    RgbImage::from_fn(fine.width() / 2, fine.height() / 2, |x, y| {
        let four = [[0, 0], [1, 0], [0, 1], [1, 1]].map(|[right, down]| fine.get_pixel(2 * x + right, 2 * y + down));
        Rgb(std::array::from_fn(|c| four.iter().map(|pixel| u32::from(pixel[c])).sum::<u32>().div_ceil(4) as u8))
    })
}

fn caption(loaded: &[LoadedScene]) -> String {
    let is_builtin = |own: &LoadedScene| {
        let name = own.request.word.to_str().and_then(|word| word.split(':').next());
        Builtin::find(name.unwrap_or_default()).is_ok()
    };
    let all_builtin = loaded.iter().all(is_builtin);
    let cameras = if all_builtin {
        "with the source report's cameras, lights and materials"
    } else {
        "the built-in ones with the source report's cameras, lights and materials, those of scene files with their \
         own, and meshes with a camera that has them whole in view"
    };
    let asked = loaded.iter().filter_map(|own| {
        let view = own.request.view.looks_from()?;
        let from = if view == "--inside" { "within" } else { "where its command says" };
        Some(format!("{} is seen from {from} ({view})", own.scene.name))
    });
    let asked: Vec<String> = asked.collect();
    let asked = if asked.is_empty() { String::new() } else { format!("; {}", listed(&asked)) };
    let colon = if all_builtin { "" } else { ":" };
    format!("The scenes as they were traced, rendered by sahara{colon} {cameras}{asked}.")
}

/// `lost` are the scenes without a picture.
pub fn section(pictures: Vec<Picture>, loaded: &[LoadedScene], lost: &[String]) -> Section {
    let (mut blocks, mut command) = (vec![], String::new());
    if !pictures.is_empty() {
        let name = |own: &LoadedScene| scene_name(&own.scene.name, own.request.stand_in);
        let rows = loaded.iter().map(|own| vec![name(own).into(), Cell::from(own.scene.mesh.len())]);
        command = "sahara render SCENE -o SCENE.png".into();
        blocks.push(Block::figure(Figure {
            id: "scenes".into(),
            caption: caption(loaded),
            alt: String::new(),
            data: Table::new("", ["scene", "triangles"], rows),
            art: Art::Gallery(pictures),
        }));
    }
    for name in lost {
        let what = format!("A picture of {name}: it is not here, or is not what was measured");
        blocks.push(Block::missing(&what, "sahara render FILE -o F.png"));
    }
    Section { id: "scenes", title: TITLE, command, blocks }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_built_in_scenes_have_the_cameras_of_the_source_report() {
        let caption = |word: &str, name: &str, view: &str| super::caption(&[LoadedScene::cube(word, name, view)]);
        let cube = caption("cube", "Cube", "{}");
        assert!(cube.contains("rendered by sahara with the source report's cameras") && !cube.contains("--"), "{cube}");
        assert_eq!(caption("cube:stand-in", "Cube", "{}"), cube);
        let mine = caption("mine.ply", "mine", "{}");
        assert!(
            mine.contains("the built-in ones with the source report's") && mine.contains("whole in view"),
            "{mine}"
        );
        let inside = caption("mine.ply", "mine", r#"{"inside":true}"#);
        assert!(inside.ends_with("whole in view; mine is seen from within (--inside)."), "{inside}");
        let looked = caption("cube", "Cube", r#"{"camera":"0,0,9 0,0,0"}"#);
        assert!(looked.ends_with("; Cube is seen from where its command says (--camera)."), "{looked}");
    }
}
