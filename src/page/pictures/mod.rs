//! Pictures of the scenes, of the work that structures do on them and of their wrong answers: drawn when the report is made.

mod errors;
mod heat;
mod inspect;
mod scenes;
mod seen;
mod shown;

use crate::page::runs::Runs;
use crate::registry::Registry;
use crate::report::document::{Block, Section};
use crate::study::{Studies, is_large};

use seen::Seen;
use shown::{Find, Shown, found_again};

/// Scenes with heat maps and pictures of errors: the largest.
const LARGEST: usize = 3;

/// The sections of scenes, heat maps and errors. `progress` is told what is done.
pub fn draw(runs: &Runs, suite: (&Registry, &Studies), find: Find, progress: &mut dyn FnMut(String)) -> Vec<Section> {
    let (registry, studies) = suite;
    let (mut shown, mut lost): (Vec<Shown>, Vec<String>) = (vec![], vec![]);
    for (scene, command) in runs.scenes(studies) {
        progress(format!("loads {}", scene.name));
        match found_again(&scene, &command, find) {
            Some(found) => shown.push(found),
            None => lost.push(scene.name),
        }
    }
    let mut thumbnails = vec![];
    for one in &shown {
        progress(format!("draws {}", one.scene.name));
        match scenes::thumbnail(one, registry) {
            Some(thumbnail) => thumbnails.push(thumbnail),
            None => lost.push(one.scene.name.clone()),
        }
    }
    let mut largest: Vec<&Shown> = shown.iter().collect();
    largest.sort_by_key(|one| std::cmp::Reverse(one.scene.mesh.len()));
    let (too_large, largest): (Vec<&Shown>, Vec<_>) =
        largest.into_iter().partition(|one| is_large(one.scene.mesh.len()));
    let (mut heat, mut errors) = (vec![], vec![]);
    for one in largest.into_iter().take(LARGEST) {
        progress(format!("draws heat and errors of {}", one.scene.name));
        let seen = Seen::new(one, runs, registry);
        heat.extend(heat::figure(&seen));
        errors.extend(errors::block(&seen));
    }
    vec![
        scenes::section(thumbnails, &shown, &lost),
        heat::section(heat, without(&too_large, "heat")),
        errors::section(errors, without(&too_large, "error")),
    ]
}

/// What is said of scenes with so many triangles that it would take minutes to build all structures again for a picture.
fn without(too_large: &[&Shown], view: &str) -> Vec<Block> {
    let block = |one: &&Shown| {
        let what = format!(
            "A picture of the {view} view of {}: to build all structures again among so many triangles would take minutes",
            one.scene.name
        );
        Block::missing(&what, &format!("sahara render {} --view {view} --structure NAME -o NAME.png", one.quoted()))
    };
    too_large.iter().map(block).collect()
}

/// A colour of a picture as the page writes it.
fn hex([r, g, b]: [u8; 3]) -> String {
    format!("#{r:02x}{g:02x}{b:02x}")
}

/// What was `found`, introduced by a sentence, then what was left out; where there is neither, that these pictures are missing.
fn told(pictures: &str, sentence: &str, found: Vec<Block>, left_out: Vec<Block>) -> Vec<Block> {
    let first = match (found.is_empty(), left_out.is_empty()) {
        (true, true) => Some(Block::missing(pictures, "sahara compare --dir runs")),
        (true, false) => None,
        (false, _) => Some(Block::Text(sentence.into())),
    };
    first.into_iter().chain(found).chain(left_out).collect()
}

/// The sections of a report without pictures, which say so.
pub fn left_out() -> Vec<Section> {
    let command = "sahara report, without --no-pictures";
    let missing = |what| vec![Block::missing(what, command)];
    vec![
        Section { id: "scenes", title: scenes::TITLE, blocks: missing("Pictures of the scenes") },
        Section { id: "heat", title: heat::TITLE, blocks: missing("Heat maps of the structures") },
        Section { id: "errors", title: errors::TITLE, blocks: missing("Pictures of wrong answers") },
    ]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::Builtin;
    use crate::study::ViewArgs;

    #[test]
    fn a_scene_that_is_too_large_to_be_built_again_is_named_with_a_command() {
        let scene = Builtin::find("cube").unwrap().scene(None).unwrap();
        let view = ViewArgs::of_command(&["--inside".into()]);
        let shown = Shown { scene, argument: "cube".into(), view, differs: false };
        for (section, view) in [
            (heat::section(vec![], without(&[&shown], "heat")), "heat"),
            (errors::section(vec![], without(&[&shown], "error")), "error"),
        ] {
            let [Block::Missing(missing)] = &section.blocks[..] else { panic!("{:?}", section.blocks) };
            assert!(missing.what.contains(&format!("{view} view of Cube")), "{}", missing.what);
            assert!(
                missing.command.starts_with(&format!("sahara render cube --inside --view {view} ")),
                "{}",
                missing.command
            );
        }
    }
}
