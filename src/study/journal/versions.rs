//! Scenes that have changed since some of their cases were measured.

use super::CaseFile;
use crate::report::number::plural;
use crate::report::words::scene_name;
use crate::study::grouped::grouped;
use crate::study::plan::scene_of_key;

/// The cases of the last version of each scene, in their order, and a sentence for each scene of which older ones are left out: with
/// another mesh, camera or light a scene has another hash. Where `both_meshes` are shown a stand-in is a scene beside the real mesh, and
/// else another version of it.
pub fn newest<'a, C>(files: &'a [CaseFile<C>], both_meshes: bool) -> (Vec<&'a CaseFile<C>>, Vec<String>) {
    let stand_in = scene_name("", true);
    let version = |file: &'a CaseFile<C>| -> Option<(&'a str, &'a str)> {
        let (name, hash) = scene_of_key(&file.key)?;
        Some((name.strip_suffix(stand_in.as_str()).filter(|_| !both_meshes).unwrap_or(name), hash))
    };
    let known = files.iter().filter_map(|file| Some((version(file)?, &file.header.provenance.date)));
    let (mut last, mut notes) = (vec![], vec![]);
    for scene in grouped(known, |((one, _), _), ((other, _), _)| one == other) {
        let ((name, newest), _) = scene.iter().max_by_key(|(_, date)| *date).expect("a group has a case");
        let older = scene.iter().filter(|((_, hash), _)| hash != newest).count();
        if older > 0 {
            notes.push(format!("{name}: left out, for the scene has changed since: {}.", plural(older, "case")));
        }
        last.push((*name, *newest));
    }
    let kept = files.iter().filter(|&file| version(file).is_none_or(|version| last.contains(&version)));
    (kept.collect(), notes)
}
