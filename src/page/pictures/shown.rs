//! The scenes of the runs, found again.

use std::path::Path;

use crate::escaped::quoted;
use crate::scene::{Builtin, Scene};
use crate::study::{SceneId, ViewArgs};

/// How a scene that was measured is found again; nothing where it is not to be had.
pub type Find<'a> = &'a dyn Fn(&str) -> Option<Scene>;

/// A scene of the runs.
pub struct Shown {
    pub scene: Scene,
    /// As the command line names it: a built-in scene, or a file.
    pub argument: String,
    /// From where the command sees it.
    pub view: ViewArgs,
    /// Whether it is not the one that was measured: another mesh of the same name, or another view of it.
    pub differs: bool,
}

impl Shown {
    /// As a shell reads it, and as it is seen.
    pub fn quoted(&self) -> String {
        let is_builtin = Builtin::find(&self.argument).is_ok();
        let scene = if is_builtin { self.argument.to_lowercase() } else { quoted(&self.argument) };
        [Some(scene), self.view.looks_from_words()].into_iter().flatten().collect::<Vec<_>>().join(" ")
    }
}

/// The scene as one of the `commands`, a line each, has seen it; else the first of its name.
pub fn found_again(SceneId { name, hash }: &SceneId, commands: &str, find: Find) -> Option<Shown> {
    let mut other = None;
    for command in commands.lines().filter_map(shlex::split) {
        let view = ViewArgs::of_command(&command);
        // Words that are files named as the scene.
        let is_named = |word: &&String| Path::new(word).file_stem().is_some_and(|stem| stem == name.as_str());
        for argument in std::iter::once(name).chain(command.iter().filter(is_named)) {
            let Some(scene) = find(argument).and_then(|scene| view.seen(scene).ok()) else { continue };
            let differs = hash.as_ref().is_some_and(|hash| scene.hash() != *hash);
            let found = Shown { scene, argument: argument.clone(), view: view.clone(), differs };
            if !differs {
                return Some(found);
            }
            other = other.or(Some(found));
        }
    }
    other
}
