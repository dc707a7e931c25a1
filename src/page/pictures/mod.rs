//! Renders the pictures of a report: scenes, heat maps and error maps.

mod camera_rays;
mod errors;
mod heat;
mod inspect;
mod maps;
mod scenes;

use std::ffi::OsStr;

use super::document::Section;
use super::runs::Runs;
use crate::registry::Registry;
use crate::report::Block;
use crate::request::is_large;

use camera_rays::CameraRays;
use scenes::LoadedScene;

/// The maximum number of scenes with heat maps and error maps. The maps rebuild all structures, so [large](is_large)
/// scenes have no maps.
const LARGEST: usize = 3;

struct Part {
    id: &'static str,
    title: &'static str,
    /// The name that `Block::missing` receives.
    pictures: &'static str,
    /// The text before the pictures.
    introduction: &'static str,
}

const SCENES: Part = Part { id: "scenes", title: "The scenes", pictures: "Pictures of the scenes", introduction: "" };
const HEAT: Part = Part {
    id: "heat",
    title: "Cost per pixel",
    pictures: "Heat maps of the structures",
    introduction: "Cost per pixel (triangle tests + traversal steps); brighter is more expensive.",
};
const ERRORS: Part = Part {
    id: "errors",
    title: "Wrong hits, pixel by pixel",
    pictures: "Pictures of wrong hits",
    introduction: "Hits of the camera rays of a picture, checked against exact arithmetic.",
};

impl Part {
    fn section(&self, blocks: Vec<Block>) -> Section {
        Section { id: self.id, title: self.title, blocks, ..Section::default() }
    }

    fn introduced(&self, found: Vec<(Block, String)>) -> Section {
        let note = "Scenes of more than four million triangles are left out; `sahara render` draws them.";
        let first = match found.is_empty() {
            true => Block::missing(self.pictures, "sahara compare --dir runs"),
            false => Block::Text(format!("{} {note}", self.introduction)),
        };
        let (blocks, mut commands): (Vec<Block>, Vec<String>) = found.into_iter().unzip();
        commands.retain(|command| !command.is_empty());
        let blocks = std::iter::once(first).chain(blocks).collect();
        Section { command: commands.join("\n"), ..self.section(blocks) }
    }
}

pub fn draw(runs: &Runs, registry: &Registry, progress: &mut dyn FnMut(String)) -> Vec<Section> {
    let (mut loaded, mut lost): (Vec<LoadedScene>, Vec<String>) = (vec![], vec![]);
    // Generated scenes get no pictures, because all scenes of a generator look alike.
    let is_generated = |word: &OsStr| {
        let parts = word.to_str().and_then(|word| word.split_once(':'));
        parts.is_some_and(|(name, _)| registry.has_generator(name))
    };
    for request in runs.scenes().into_iter().filter(|request| !is_generated(&request.word)) {
        progress(format!("loading {}", request.name));
        match request.load(registry) {
            Ok(scene) => loaded.push(LoadedScene { scene, request }),
            Err(_) => lost.push(request.name),
        }
    }
    let mut pictures = vec![];
    for own in &loaded {
        progress(format!("drawing {}", own.scene.name));
        match scenes::picture(own, registry) {
            Some(picture) => pictures.push(picture),
            None => lost.push(own.scene.name.clone()),
        }
    }
    let mut largest: Vec<&LoadedScene> = loaded.iter().filter(|own| !is_large(own.scene.mesh.len())).collect();
    largest.sort_by_key(|own| std::cmp::Reverse(own.scene.mesh.len()));
    let (mut heat, mut errors) = (vec![], vec![]);
    for own in largest.into_iter().take(LARGEST) {
        progress(format!("drawing heat maps and error maps of {}", own.scene.name));
        let rays = CameraRays::new(own, runs, registry);
        heat.extend(heat::maps(&rays).map(|maps| maps.figure(HEAT.id, &rays)));
        errors.extend(errors::maps(&rays).map(|maps| match maps {
            Ok(maps) => maps.figure(ERRORS.id, &rays),
            Err(sentence) => (Block::Text(sentence), String::new()),
        }));
    }
    let (blocks, command) = scenes::blocks(pictures, &loaded, &lost);
    vec![Section { command, ..SCENES.section(blocks) }, HEAT.introduced(heat), ERRORS.introduced(errors)]
}

pub fn left_out() -> Vec<Section> {
    let section =
        |part: &Part| part.section(vec![Block::missing(part.pictures, "sahara report, without --no-pictures")]);
    [SCENES, HEAT, ERRORS].iter().map(section).collect()
}
