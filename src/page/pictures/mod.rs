//! Pictures of the scenes, of the work that structures do on them and of their wrong answers: drawn when the report is
//! made.

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

/// Scenes with heat maps and pictures of errors: the largest.
const LARGEST: usize = 3;

/// The sections of scenes, heat maps and errors. `progress` is told what is done.
pub fn draw(runs: &Runs, registry: &Registry, progress: &mut dyn FnMut(String)) -> Vec<Section> {
    let (mut loaded, mut lost): (Vec<LoadedScene>, Vec<String>) = (vec![], vec![]);
    // The scenes of a generator are many, and look alike.
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
    let mut largest: Vec<&LoadedScene> = loaded.iter().collect();
    largest.sort_by_key(|own| std::cmp::Reverse(own.scene.mesh.len()));
    let (too_large, largest): (Vec<&LoadedScene>, Vec<_>) =
        largest.into_iter().partition(|own| is_large(own.scene.mesh.len()));
    let (mut heat, mut errors) = (vec![], vec![]);
    for own in largest.into_iter().take(LARGEST) {
        progress(format!("draws heat and errors of {}", own.scene.name));
        let rays = CameraRays::new(own, runs, registry);
        heat.extend(heat::block(&rays));
        errors.extend(errors::block(&rays));
    }
    vec![
        scenes::section(pictures, &loaded, &lost),
        heat::section(heat, without(&too_large, "heat")),
        errors::section(errors, without(&too_large, "error")),
    ]
}

/// What is said of scenes with so many triangles that it would take minutes to build all structures again for a
/// picture.
fn without(too_large: &[&LoadedScene], view: &str) -> Vec<Block> {
    let block = |own: &&LoadedScene| {
        let what = format!(
            "A picture of the {view} view of {}: to build all structures again among so many triangles would take \
             minutes",
            own.scene.name
        );
        Block::missing(&what, &format!("sahara render {} --view {view} --structure NAME -o NAME.png", own.words()))
    };
    too_large.iter().map(block).collect()
}

fn hex([r, g, b]: [u8; 3]) -> String {
    format!("#{r:02x}{g:02x}{b:02x}")
}

/// What was `found`, introduced by a sentence, then what was left out; where there is neither, that these pictures are
/// missing. With the commands of what was found.
fn introduced(
    pictures: &str,
    sentence: &str,
    found: Vec<(Block, String)>,
    left_out: Vec<Block>,
) -> (Vec<Block>, String) {
    let first = match (found.is_empty(), left_out.is_empty()) {
        (true, true) => Some(Block::missing(pictures, "sahara compare --dir runs")),
        (true, false) => None,
        (false, _) => Some(Block::Text(sentence.into())),
    };
    let (found, mut commands): (Vec<Block>, Vec<String>) = found.into_iter().unzip();
    commands.retain(|command| !command.is_empty());
    (first.into_iter().chain(found).chain(left_out).collect(), commands.join("\n"))
}

/// The sections of a report without pictures, which say so.
pub fn left_out() -> Vec<Section> {
    let section = |id, title, what| {
        let blocks = vec![Block::missing(what, "sahara report, without --no-pictures")];
        Section { id, title, blocks, ..Section::default() }
    };
    vec![
        section("scenes", scenes::TITLE, "Pictures of the scenes"),
        section("heat", heat::TITLE, "Heat maps of the structures"),
        section("errors", errors::TITLE, "Pictures of wrong answers"),
    ]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_scene_that_is_too_large_to_be_built_again_is_named_with_a_command() {
        let loaded = LoadedScene::cube("cube", "Cube", r#"{"inside":true}"#);
        for (section, view) in [
            (heat::section(vec![], without(&[&loaded], "heat")), "heat"),
            (errors::section(vec![], without(&[&loaded], "error")), "error"),
        ] {
            let [Block::Missing(missing)] = &section.blocks[..] else { panic!("{:?}", section.blocks) };
            assert!(missing.what.contains(&format!("{view} view of Cube")), "{}", missing.what);
            let command = format!("sahara render cube --inside --view {view} ");
            assert!(missing.command.starts_with(&command), "{}", missing.command);
        }
    }
}
