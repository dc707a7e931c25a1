//! Real meshes, stand-ins, or both.

use clap::ValueEnum;

use crate::cli::sources;
use crate::report::words::listed;
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

/// Scenes and their meshes, as a study takes them.
#[derive(Clone, Debug, clap::Args)]
pub struct Scenes {
    /// Built-in scenes, scene files (.toml) and mesh files (.obj, .ply, .gltf, .glb); all built-in scenes if none is named
    #[arg(value_name = "SCENE|FILE")]
    scenes: Vec<String>,
    /// Meshes of the built-in scenes
    #[arg(long, value_name = "WHICH", value_enum, default_value_t)]
    meshes: Meshes,
}

impl Scenes {
    /// The scenes named, all built-in ones without a name; of those with a stand-in both forms, if the meshes are to be both.
    ///
    /// # Errors
    /// As [`sources::scene`].
    pub fn read(&self) -> anyhow::Result<Vec<Scene>> {
        let all: Vec<String> = BUILTIN.iter().map(|builtin| builtin.name.to_owned()).collect();
        let mut scenes: Vec<Scene> = vec![];
        for name in if self.scenes.is_empty() { &all } else { &self.scenes } {
            let mut forms = vec![];
            if let (Ok(builtin), true) = (Builtin::find(name), self.meshes != Meshes::Real) {
                forms.push(builtin.scene(None)?);
            }
            if forms.is_empty() || self.meshes == Meshes::Both {
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
        sources::distinct(&scenes)?;
        Ok(scenes)
    }

    /// A note where a real mesh could have been measured and is not there.
    pub fn note(&self, read: &[Scene]) -> Option<String> {
        let alone = |scene: &&Scene| {
            !scene.stand_ins.is_empty()
                && !read.iter().any(|other| other.name == scene.name && other.stand_ins.is_empty())
        };
        let names: Vec<&str> = read.iter().filter(alone).map(|scene| scene.name.as_str()).collect();
        (!names.is_empty() && self.meshes != Meshes::StandIns).then(|| {
            format!(
                "The real meshes of {} are not there: `sahara fetch` gets them, SAHARA_DATA names their folder.",
                listed(&names)
            )
        })
    }
}
