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
use crate::study::Studies;

use seen::Seen;
use shown::{Find, Shown, found_again};

/// Scenes with heat maps and pictures of errors: the largest.
const LARGEST: usize = 3;

/// The sections of scenes, heat maps and errors. `progress` is told the scene that is drawn.
pub fn draw(runs: &Runs, suite: (&Registry, &Studies), find: Find, progress: &mut dyn FnMut(&str)) -> Vec<Section> {
    let (registry, studies) = suite;
    let (mut shown, mut lost): (Vec<Shown>, Vec<String>) = (vec![], vec![]);
    for (scene, command) in runs.scenes(studies) {
        match found_again(&scene, &command, find) {
            Some(found) => shown.push(found),
            None => lost.push(scene.name),
        }
    }
    let mut thumbnails = vec![];
    for one in &shown {
        progress(&one.scene.name);
        match scenes::thumbnail(one, registry) {
            Some(thumbnail) => thumbnails.push(thumbnail),
            None => lost.push(one.scene.name.clone()),
        }
    }
    let mut largest: Vec<&Shown> = shown.iter().collect();
    largest.sort_by_key(|one| std::cmp::Reverse(one.scene.mesh.len()));
    let (mut heat, mut errors) = (vec![], vec![]);
    for one in largest.into_iter().take(LARGEST) {
        progress(&one.scene.name);
        let seen = Seen::new(one, runs, registry);
        heat.extend(heat::figure(&seen));
        errors.extend(errors::block(&seen));
    }
    vec![scenes::section(thumbnails, &shown, &lost), heat::section(heat), errors::section(errors)]
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
