//! Pictures of the scenes, of the work of structures and of their wrong hits. They are drawn for each report.

mod camera_rays;
mod errors;
mod heat;
mod inspect;
mod loaded_scene;
mod scenes;

use std::ffi::OsStr;

use super::document::Section;
use super::runs::Runs;
use crate::registry::Registry;
use crate::report::Block;
use crate::request::is_large;

use camera_rays::CameraRays;
use loaded_scene::LoadedScene;

/// The number of scenes with heat maps and pictures of errors: the largest of those whose structures can be rebuilt in
/// seconds.
const LARGEST: usize = 3;

/// The sections of scenes, heat maps and errors. `progress` receives each step.
pub fn draw(runs: &Runs, registry: &Registry, progress: &mut dyn FnMut(String)) -> Vec<Section> {
    let (mut loaded, mut lost): (Vec<LoadedScene>, Vec<String>) = (vec![], vec![]);
    // A generator has many scenes, which look the same.
    let is_generated = |word: &OsStr| {
        let parts = word.to_str().and_then(|word| word.split_once(':'));
        parts.is_some_and(|(name, _)| registry.has_generator(name))
    };
    for request in runs.scenes().into_iter().filter(|request| !is_generated(&request.word)) {
        progress(format!("loads {}", request.name));
        match request.load(registry) {
            Ok(scene) => loaded.push(LoadedScene { scene, request }),
            Err(_) => lost.push(request.name),
        }
    }
    let mut pictures = vec![];
    for own in &loaded {
        progress(format!("draws {}", own.scene.name));
        match scenes::picture(own, registry) {
            Some(picture) => pictures.push(picture),
            None => lost.push(own.scene.name.clone()),
        }
    }
    let mut largest: Vec<&LoadedScene> = loaded.iter().filter(|own| !is_large(own.scene.mesh.len())).collect();
    largest.sort_by_key(|own| std::cmp::Reverse(own.scene.mesh.len()));
    let (mut heat, mut errors) = (vec![], vec![]);
    for own in largest.into_iter().take(LARGEST) {
        progress(format!("drawing heat and errors of {}", own.scene.name));
        let rays = CameraRays::new(own, runs, registry);
        heat.extend(heat::block(&rays));
        errors.extend(errors::block(&rays));
    }
    vec![scenes::section(pictures, &loaded, &lost), heat::section(heat), errors::section(errors)]
}

fn hex([r, g, b]: [u8; 3]) -> String {
    format!("#{r:02x}{g:02x}{b:02x}")
}

/// The blocks of `found` after an introductory sentence, with their commands; without blocks, a note that these
/// pictures are missing.
fn introduced(pictures: &str, sentence: &str, found: Vec<(Block, String)>) -> (Vec<Block>, String) {
    let note = "Scenes of more than four million triangles are left out; `sahara render` draws them.";
    let first = match found.is_empty() {
        true => Block::missing(pictures, "sahara compare --dir runs"),
        false => Block::Text(format!("{sentence} {note}")),
    };
    let (found, mut commands): (Vec<Block>, Vec<String>) = found.into_iter().unzip();
    commands.retain(|command| !command.is_empty());
    (std::iter::once(first).chain(found).collect(), commands.join("\n"))
}

/// The sections of a report without pictures, with a note.
pub fn left_out() -> Vec<Section> {
    let section = |id, title, what| {
        let blocks = vec![Block::missing(what, "sahara report, without --no-pictures")];
        Section { id, title, blocks, ..Section::default() }
    };
    vec![
        section("scenes", scenes::TITLE, "Pictures of the scenes"),
        section("heat", heat::TITLE, "Heat maps of the structures"),
        section("errors", errors::TITLE, "Pictures of wrong hits"),
    ]
}
