//! Real meshes, stand-ins, or both.

use clap::ValueEnum;

use crate::cli::sources;
use crate::scene::{BUILTIN, Builtin, Scene};

/// Which meshes the built-in scenes are measured with.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, ValueEnum)]
pub enum Meshes {
    /// Stand-ins, and the real meshes where they have been fetched
    #[default]
    Both,
    /// Real meshes where they have been fetched, else stand-ins
    Real,
    /// Stand-ins alone
    StandIns,
}

/// The scenes named, all built-in ones without a name; of those with a stand-in both forms, if `meshes` says so.
///
/// # Errors
/// As [`sources::scene`].
pub fn scenes(named: &[String], meshes: Meshes) -> anyhow::Result<Vec<Scene>> {
    let all: Vec<String> = BUILTIN.iter().map(|builtin| builtin.name.to_owned()).collect();
    let mut scenes: Vec<Scene> = vec![];
    for name in if named.is_empty() { &all } else { named } {
        let mut forms = vec![];
        if let (Ok(builtin), true) = (Builtin::find(name), meshes != Meshes::Real) {
            forms.push(builtin.scene(None)?);
        }
        if forms.is_empty() || meshes == Meshes::Both {
            forms.push(sources::scene(name)?);
        }
        // The same scene twice, or a scene without a real mesh, is measured once.
        for scene in forms {
            let same = |other: &Scene| other.name == scene.name && other.hash() == scene.hash();
            if !scenes.iter().any(same) {
                scenes.push(scene);
            }
        }
    }
    Ok(scenes)
}

/// A note where a real mesh could have been measured and is not there.
pub fn note(scenes: &[Scene], meshes: Meshes) -> Option<String> {
    let alone = |scene: &&Scene| {
        !scene.stand_ins.is_empty()
            && !scenes.iter().any(|other| other.name == scene.name && other.stand_ins.is_empty())
    };
    let names: Vec<&str> = scenes.iter().filter(alone).map(|scene| scene.name.as_str()).collect();
    (!names.is_empty() && meshes != Meshes::StandIns).then(|| {
        format!(
            "The real meshes of {} are not there: `sahara fetch` gets them, SAHARA_DATA names their folder.",
            names.join(", ")
        )
    })
}
