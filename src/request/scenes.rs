//! Built-in scenes, generated scenes, and scenes from files.

use std::ffi::{OsStr, OsString};
use std::path::{Path, PathBuf};

use anyhow::Context;
use rayon::prelude::*;
use serde::{Deserialize, Serialize};

use super::ViewArgs;
use crate::builtin::{BUILTIN, Builtin, real_mesh_folder};
use crate::escaped::{Escaped as _, stem};
use crate::output::OutputFile;
use crate::registry::Registry;
use crate::scene::{Scene, load};

#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct SceneRequest {
    /// A built-in scene, `NAME:stand-in`, a generated scene such as `icosphere:7`, or a file.
    #[serde(with = "super::os_text")]
    pub word: OsString,
    #[serde(default, skip_serializing_if = "ViewArgs::is_default")]
    pub view: ViewArgs,
    pub name: String,
    /// The first 16 digits of [`Scene::hash`]. The hash of the loaded scene must begin with these digits.
    pub hash: String,
    /// Whether a generated mesh replaces a real mesh.
    pub stand_in: bool,
    pub triangles: usize,
}

/// Suffix after `NAME:` that selects the stand-in mesh of a built-in scene.
const STAND_IN: &str = "stand-in";

pub fn stand_in(name: impl AsRef<OsStr>) -> OsString {
    [name.as_ref(), OsStr::new(":"), OsStr::new(STAND_IN)].into_iter().collect()
}

impl SceneRequest {
    /// `word` is the name of the scene on the command line.
    pub fn new(word: impl Into<OsString>, view: &ViewArgs, scene: &Scene) -> Self {
        Self {
            word: word.into(),
            view: view.clone(),
            name: scene.name.clone(),
            hash: scene.hash()[..16].into(),
            stand_in: !scene.stand_ins.is_empty(),
            triangles: scene.mesh.len(),
        }
    }

    pub fn load(&self, registry: &Registry) -> anyhow::Result<Scene> {
        let scene = self.view.of(scene(registry, &self.word)?)?;
        anyhow::ensure!(
            scene.hash().starts_with(&self.hash),
            "the scene {} has changed since it was planned: plan it again (Snakemake: remove plan.txt)",
            self.word.escaped()
        );
        Ok(scene)
    }
}

/// Loads all built-in scenes if `named` is empty.
pub fn scenes(registry: &Registry, named: &[OsString]) -> anyhow::Result<Vec<Scene>> {
    Ok(loaded(registry, &words(named))?.into_iter().map(|(_, scene)| scene).collect())
}

pub fn words(named: &[OsString]) -> Vec<OsString> {
    if named.is_empty() { BUILTIN.iter().map(|builtin| builtin.name.into()).collect() } else { named.to_vec() }
}

fn loaded(registry: &Registry, words: &[OsString]) -> anyhow::Result<Vec<(OsString, Scene)>> {
    // Scenes are loaded in parallel, because a large mesh takes seconds to load.
    let scenes: Vec<_> = words.par_iter().map(|word| scene(registry, word)).collect();
    let mut each: Vec<(OsString, Scene)> = vec![];
    for (word, scene) in words.iter().zip(scenes) {
        let scene = scene?;
        let is_namesake = |(_, other): &&(OsString, Scene)| {
            other.name.eq_ignore_ascii_case(&scene.name) && other.stand_ins.is_empty() == scene.stand_ins.is_empty()
        };
        match each.iter().find(is_namesake) {
            None => each.push((word.clone(), scene)),
            Some((_, other)) if other.hash() == scene.hash() => {}
            Some(_) => anyhow::bail!("two different scenes have the name {}: rename one", scene.name),
        }
    }
    Ok(each)
}

/// Loads a built-in scene, a generated scene, a scene file, or a mesh file.
pub fn scene(registry: &Registry, word: impl AsRef<OsStr>) -> anyhow::Result<Scene> {
    let (path, real_meshes) = (Path::new(word.as_ref()), real_mesh_folder());
    let is_scene_file = || path.extension().is_some_and(|ending| ending.eq_ignore_ascii_case("toml"));
    let parts = path.to_str().and_then(|word| word.split_once(':'));
    if let Some((name, parameters)) = parts.filter(|_| !path.exists()) {
        if let (Ok(builtin), STAND_IN) = (Builtin::find(name), parameters) {
            return Ok(builtin.scene(None)?);
        }
        if let Some(scene) = registry.generated(name, parameters) {
            return scene.with_context(|| format!("{path:?}"));
        }
    }
    match Builtin::find(path) {
        Ok(builtin) => Ok(builtin.scene(Some(&real_meshes))?),
        Err(unknown) if path.extension().is_none() && path.components().count() < 2 && !path.exists() => {
            Err(unknown.into())
        }
        Err(_) if is_scene_file() => Ok(Scene::read(path, Some(&real_meshes))?),
        Err(_) => Ok(Scene::framed(&stem(path), load(path)?)?),
    }
}

pub fn scene_files(registry: &Registry, words: &[OsString]) -> Vec<PathBuf> {
    let is_name = |word: &str| {
        let name = word.split(':').next().unwrap_or(word);
        Builtin::find(name).is_ok() || registry.has_generator(name)
    };
    words.iter().filter(|word| !word.to_str().is_some_and(is_name)).map(PathBuf::from).collect()
}

/// Rejects an output file that is also an input file.
pub fn output<'a>(
    registry: &Registry,
    path: &Path,
    scenes: &[OsString],
    others: impl IntoIterator<Item = &'a Path>,
) -> anyhow::Result<OutputFile> {
    let files = scene_files(registry, scenes);
    Ok(OutputFile::check(path)?.apart_from(files.iter().map(PathBuf::as_path))?.apart_from(others)?)
}

pub fn named_notes<'a>(scenes: impl IntoIterator<Item = &'a Scene>, of: fn(&Scene) -> &Vec<String>) -> Vec<String> {
    scenes.into_iter().flat_map(|scene| of(scene).iter().map(|note| format!("{}: {note}", scene.name))).collect()
}

/// Scenes on the command line.
#[derive(Clone, Debug, Default, clap::Args)]
pub struct Scenes {
    /// Built-in scenes, scene files (.toml), mesh files (.obj, .ply, .gltf, .glb) and generated scenes
    /// (icosphere:LEVEL) [default: all built-in scenes; in `scaling`, which always adds icospheres: dragon, lucy and
    /// sponza]
    #[arg(value_name = "SCENE|FILE")]
    pub scenes: Vec<OsString>,
}

impl Scenes {
    /// Loads `own` if the command line names no scene. An empty `own` selects all built-in scenes.
    pub fn read(&self, registry: &Registry, own: &[&str]) -> anyhow::Result<Vec<(OsString, Scene)>> {
        let own: Vec<OsString> = own.iter().map(|&name| name.into()).collect();
        loaded(registry, &words(if self.scenes.is_empty() { &own } else { &self.scenes }))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_request_loads_what_was_planned_and_refuses_another_scene() {
        let registry = Registry::builtin();
        for word in ["cube", "dragon:stand-in", "icosphere:1"] {
            let planned = scene(&registry, word).unwrap();
            let request = SceneRequest::new(word, &ViewArgs::default(), &planned);
            let text = serde_json::to_string(&request).unwrap();
            let read: SceneRequest = serde_json::from_str(&text).unwrap();
            assert_eq!((&read, read.load(&registry).unwrap().hash()), (&request, planned.hash()));
            let other = SceneRequest { hash: "0".repeat(16), ..request };
            let refused = other.load(&registry).unwrap_err().to_string();
            assert!(refused.contains(word) && refused.contains("plan it again"), "{refused}");
        }
        assert!(scene(&registry, "icosphere:99").is_err() && scene(&registry, "icosphere:").is_err());
        let words = ["cube", "icosphere:1", "a.ply"].map(Into::into);
        assert_eq!(scene_files(&registry, &words), [Path::new("a.ply")]);
    }
}
