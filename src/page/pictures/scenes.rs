//! Shaded pictures of the scenes.

use image::{Rgb, RgbImage};

use crate::escaped::quoted;
use crate::registry::Registry;
use crate::render::{ViewKind, draw, png, size_of};
use crate::report::number::count;
use crate::report::words::{listed, scene_name};
use crate::report::{Art, Block, Cell, Figure, Picture, Table};
use crate::request::{SceneRequest, secondary_ray_structure};
use crate::scene::Scene;
use crate::study::measure::guarded;

const SIDE: u32 = 208;

pub struct LoadedScene {
    pub scene: Scene,
    pub request: SceneRequest,
}

impl LoadedScene {
    /// The shell-quoted arguments that select the scene and the view.
    pub fn words(&self) -> String {
        let view = self.request.view.words();
        [quoted(&self.request.word), view].into_iter().filter(|word| !word.is_empty()).collect::<Vec<_>>().join(" ")
    }

    #[cfg(test)]
    pub fn cube(word: &str, name: &str, view: &str) -> Self {
        let scene = Scene { name: name.into(), ..crate::builtin::Builtin::find("cube").unwrap().scene(None).unwrap() };
        let request = SceneRequest::new(word, &serde_json::from_str(view).unwrap(), &scene);
        Self { scene, request }
    }
}

pub fn picture(loaded: &LoadedScene, registry: &Registry) -> Option<Picture> {
    let scene = &loaded.scene;
    let accel = secondary_ray_structure(registry).ok()?.build(&scene.mesh).ok()?;
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
    let view = |own: &LoadedScene| Some(format!("{} ({})", own.scene.name, own.request.view.looks_from()?));
    let views: Vec<String> = loaded.iter().filter_map(view).collect();
    let views = if views.is_empty() { String::new() } else { format!("; other views: {}", listed(&views)) };
    format!(
        "The traced scenes, rendered by sahara. Built-in scenes use the source report's cameras, lights and \
         materials; the default camera of a mesh shows all of it{views}."
    )
}

/// `lost` contains the names of the scenes that cannot be loaded or drawn.
pub fn blocks(pictures: Vec<Picture>, loaded: &[LoadedScene], lost: &[String]) -> (Vec<Block>, String) {
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
        let what = format!("A picture of {name}: the scene is missing, or has changed since the measurement");
        blocks.push(Block::missing(&what, "sahara render FILE -o F.png"));
    }
    (blocks, command)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_scene_that_is_seen_from_elsewhere_is_named() {
        let caption = |view: &str| super::caption(&[LoadedScene::cube("cube", "Cube", view)]);
        assert!(caption("{}").ends_with("shows all of it."));
        assert!(caption(r#"{"inside":true}"#).ends_with("; other views: Cube (--inside)."));
    }
}
