//! Scenes that have changed since some of their cases were measured.

use super::CaseFile;
use crate::report::number::plural;
use crate::report::words::scene_name;
use crate::study::grouped::grouped;
use crate::study::plan::scene_of_key;

/// The cases of the last version of each scene of which there is an answer, in their order, and a sentence for each
/// scene of which others are left out: with another mesh, camera or light a scene has another hash. Where `both_meshes`
/// are shown a stand-in is a scene beside the real mesh, and else another version of it.
pub fn newest<'a, C>(files: &'a [CaseFile<C>], both_meshes: bool) -> (Vec<&'a CaseFile<C>>, Vec<String>) {
    let stand_in = scene_name("", true);
    let version = |file: &'a CaseFile<C>| -> Option<(&'a str, &'a str)> {
        let (name, hash) = scene_of_key(&file.key)?;
        Some((name.strip_suffix(stand_in.as_str()).filter(|_| !both_meshes).unwrap_or(name), hash))
    };
    let known = files.iter().filter_map(|file| Some((version(file)?, file.key.as_str(), &file.header.provenance.date)));
    let (mut last, mut notes) = (vec![], vec![]);
    for scene in grouped(known, |((one, _), ..), ((other, _), ..)| one == other) {
        let can_answer = |hash: &str| scene.iter().any(|((_, other), key, _)| *other == hash && is_answer(key));
        let newest = scene.iter().max_by_key(|((_, hash), _, date)| (can_answer(hash), *date));
        let ((name, newest), ..) = newest.expect("a group has a case");
        let others = scene.iter().filter(|((_, hash), ..)| hash != newest).count();
        if others > 0 {
            notes.push(format!("{name}: left out, for another version is shown: {}.", plural(others, "case")));
        }
        last.push((*name, *newest));
    }
    let kept = files.iter().filter(|&file| version(file).is_none_or(|version| last.contains(&version)));
    (kept.collect(), notes)
}

/// Whether there is an answer with the case of this key: without epoch 0 there is none of later ones.
fn is_answer(key: &str) -> bool {
    key.rsplit_once(" epoch ").is_none_or(|(_, rest)| rest.split(' ').next() == Some("0"))
}
