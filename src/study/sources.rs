//! Scenes, structures and kinds of rays from what the command line names.

use std::ffi::{OsStr, OsString};
use std::path::Path;
use std::sync::OnceLock;

use anyhow::Context;
use rayon::prelude::*;

use super::SAH_TREE;
use crate::escaped::{Escaped as _, stem};
use crate::names::suggestion;
use crate::output::OutputFile;
use crate::registry::{Choice, Registry};
use crate::report::words::each_once_by;
use crate::scene::format::SceneFile;
use crate::scene::{BUILTIN, Builtin, Scene, load, real_mesh_folder};

/// The scenes named, or all built-in ones.
///
/// # Errors
/// If a name is not known, a file cannot be loaded, or two different scenes have one name.
pub fn scenes(named: &[OsString]) -> anyhow::Result<Vec<Scene>> {
    let all: Vec<OsString> = BUILTIN.iter().map(|builtin| builtin.name.into()).collect();
    let named = wanted(if named.is_empty() { &all } else { named });
    // Large meshes take seconds to load; the first one that cannot be is named.
    let scenes: Vec<_> = named.collect::<Vec<_>>().into_par_iter().map(scene).collect();
    distinct(scenes.into_iter().collect::<anyhow::Result<Vec<Scene>>>()?)
}

static ONLY: OnceLock<String> = OnceLock::new();

/// From now on no scene of another name is loaded where several are named.
pub fn load_only(scene: &str) {
    ONLY.get_or_init(|| scene.into());
}

/// Whether this process measures for a run, which has loaded all scenes and says what is to be known of them.
pub fn is_process_of_run() -> bool {
    ONLY.get().is_some()
}

/// What is loaded of what is named.
pub fn wanted<S: AsRef<OsStr>>(named: &[S]) -> impl Iterator<Item = &S> {
    let is_only = |named: &OsStr| ONLY.get().is_none_or(|only| name_of(named).is_none_or(|name| name == *only));
    named.iter().filter(move |named| is_only(named.as_ref()))
}

/// The name of a scene that is not loaded yet, where that can be told.
fn name_of(named: &OsStr) -> Option<String> {
    let path = Path::new(named);
    match Builtin::find(named) {
        Ok(builtin) => Some(builtin.name.into()),
        Err(_) if is_scene_file(path) => Some(SceneFile::parse(&text(path).ok()?, "").ok()?.name),
        Err(_) => Some(stem(path)),
    }
}

fn is_scene_file(path: &Path) -> bool {
    path.extension().is_some_and(|ending| ending.eq_ignore_ascii_case("toml"))
}

fn same_name(one: &Scene, other: &Scene) -> bool {
    one.name.eq_ignore_ascii_case(&other.name) && one.stand_ins.is_empty() == other.stand_ins.is_empty()
}

/// Each of the scenes once, however often it is named.
///
/// # Errors
/// If there are two different ones of one name, naming them: no table could tell them apart.
pub fn distinct(scenes: Vec<Scene>) -> anyhow::Result<Vec<Scene>> {
    let mut each: Vec<Scene> = vec![];
    for scene in scenes {
        let Some(other) = each.iter().find(|other| same_name(other, &scene)) else {
            each.push(scene);
            continue;
        };
        anyhow::ensure!(
            other.hash() == scene.hash(),
            "two different scenes are called {}: tables could not tell them apart; rename one",
            scene.name
        );
    }
    Ok(each)
}

/// A built-in scene by its name in any case, a scene file, or a scene around a mesh file. What is neither a known name nor
/// looks like a path is taken for a name.
///
/// # Errors
/// If there is no such scene, or a file cannot be loaded.
pub fn scene(name: impl AsRef<OsStr>) -> anyhow::Result<Scene> {
    let real_meshes = real_mesh_folder();
    let path = Path::new(name.as_ref());
    match Builtin::find(path) {
        Ok(builtin) => Ok(builtin.scene(Some(&real_meshes))?),
        Err(unknown) if path.extension().is_none() && path.components().count() < 2 && !path.exists() => {
            Err(unknown.into())
        }
        Err(_) if is_scene_file(path) => Ok(Scene::read(path, Some(&real_meshes))?),
        Err(_) => Ok(Scene::framed(&stem(path), load(path)?)?),
    }
}

/// The file `path` for results, which is none of those read: scenes that are files, and `others`.
///
/// # Errors
/// If it cannot be written, or is one of them.
pub fn output<'a>(
    path: &Path,
    scenes: &'a [OsString],
    others: impl IntoIterator<Item = &'a Path>,
) -> anyhow::Result<OutputFile> {
    let files = scenes.iter().filter(|name| Builtin::find(name).is_err()).map(Path::new);
    Ok(OutputFile::check(path)?.apart_from(files.chain(others))?)
}

/// Stands for one structure of every name.
pub const ALL: &str = "all";

/// What is named, with [`ALL`] spelt out; every name if there is nothing.
pub fn specs(registry: &Registry, named: &[String]) -> Vec<String> {
    let names = || registry.names().into_iter().map(String::from);
    if named.is_empty() {
        return names().collect();
    }
    named
        .iter()
        .flat_map(|spec| if spec.eq_ignore_ascii_case(ALL) { names().collect() } else { vec![spec.clone()] })
        .collect()
}

/// The text of a scene file.
///
/// # Errors
/// If it cannot be read.
pub fn text(path: &Path) -> anyhow::Result<String> {
    std::fs::read_to_string(path).with_context(|| format!("cannot read {}", path.escaped()))
}

/// The structures named, or the first of every name; the same one twice would only take time.
///
/// # Errors
/// If a name, key or value is not known.
pub fn structures(registry: &Registry, specs: &[String]) -> anyhow::Result<Vec<Choice>> {
    let specs = self::specs(registry, specs);
    let choices = specs.iter().map(|spec| structure(registry, spec)).collect::<anyhow::Result<Vec<_>>>()?;
    Ok(each_once_by(choices, |one, other| one.label == other.label))
}

/// The qualities that `--quality` takes.
pub const QUALITIES: [&str; 3] = ["fast", "balanced", "high"];

/// As [`structures`]; those that have the quality and are named without one get it, as if it had been named.
///
/// # Errors
/// As [`structures`].
pub fn structures_at(registry: &Registry, specs: &[String], quality: Option<&str>) -> anyhow::Result<Vec<Choice>> {
    let Some(quality) = quality else { return structures(registry, specs) };
    let at = |spec: String| {
        let separator = if spec.contains(':') { ',' } else { ':' };
        let better = format!("{spec}{separator}quality={quality}");
        if spec.contains("quality=") || registry.choose(&better).is_err() { spec } else { better }
    };
    let specs: Vec<String> = self::specs(registry, specs).into_iter().map(at).collect();
    structures(registry, &specs)
}

/// One structure.
///
/// # Errors
/// As [`structures`].
pub fn structure(registry: &Registry, spec: &str) -> anyhow::Result<Choice> {
    Ok(registry.choose(spec)?)
}

/// Refuses names that are no triangle test of any structure.
///
/// # Errors
/// If there is one, listing those there are.
pub fn known_tests(registry: &Registry, tests: &[String]) -> anyhow::Result<()> {
    let mut known: Vec<&str> = registry.entries().iter().map(|entry| entry.triangle_test).collect();
    known.sort_unstable();
    known.dedup();
    for test in tests {
        anyhow::ensure!(
            known.iter().any(|known| known.eq_ignore_ascii_case(test)),
            "there is no triangle test {test:?}{}; there are: {}",
            suggestion(test, known.iter().copied()),
            known.join(", ")
        );
    }
    Ok(())
}

/// The structure that tells where secondary rays start: the SAH tree, or the first of a registry without it.
///
/// # Errors
/// If the registry is empty.
pub fn guide(registry: &Registry) -> anyhow::Result<Choice> {
    let guide = registry.choose(SAH_TREE).ok().or_else(|| registry.all().into_iter().next());
    guide.context("no structure is registered: there is nothing to run")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_quality_is_that_of_the_trees_that_are_named_without_one() {
        let registry = Registry::builtin();
        let labels = |specs: &[&str], quality| -> Vec<String> {
            let specs: Vec<String> = specs.iter().map(|&spec| spec.into()).collect();
            let chosen = structures_at(&registry, &specs, quality).unwrap();
            // What is kept of a choice is its label.
            assert!(chosen.iter().all(|choice| registry.choose(&choice.label).unwrap().config == choice.config));
            chosen.into_iter().map(|choice| choice.label).collect()
        };
        let named = ["median-kd", "sah-hybrid", "sah-bvh:batch=packets", "sah-kd-wide:quality=balanced"];
        let fast = ["median-kd", "sah-hybrid:quality=fast", "sah-bvh:batch=packets,quality=fast", "sah-kd-wide"];
        assert_eq!(labels(&named, Some("fast")), fast);
        for quality in QUALITIES {
            let all = labels(&[ALL], Some(quality));
            assert_eq!(
                all.iter().filter(|label| label.contains(quality)).count(),
                if quality == "balanced" { 0 } else { 4 }
            );
            assert!(all.iter().filter(|label| label.starts_with("sah-")).count() == 5);
        }
        assert_eq!(labels(&[ALL], None), labels(&[ALL], Some("balanced")));
        assert!(structures_at(&registry, &["octree".into()], Some("fast")).is_err());
    }
}
