//! The twelve scenes of the source report.

use std::ffi::OsStr;
use std::path::{Path, PathBuf};

use super::assemble::{Origin, assemble};
use super::format::SceneFile;
use super::{Scene, SceneError};
use crate::escaped::Escaped as _;
use crate::names::{named, suggestion};

/// How the source report groups its scenes.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Difficulty {
    Easy,
    Normal,
    Hard,
}

/// A scene that is part of the program.
#[derive(Debug)]
pub struct Builtin {
    pub name: &'static str,
    pub difficulty: Difficulty,
    /// The text of its scene file.
    pub text: &'static str,
}

macro_rules! builtin {
    ($($difficulty:ident $name:literal $folder:literal;)*) => {
        &[$(Builtin {
            name: $name,
            difficulty: Difficulty::$difficulty,
            text: include_str!(concat!("../../scenes/", $folder, "/scene.toml")),
        }),*]
    };
}

/// All built-in scenes, in the order of the report.
pub const BUILTIN: &[Builtin] = builtin! {
    Easy "Cube" "cube";
    Easy "Sphere" "sphere";
    Easy "Torus" "torus";
    Easy "Teapot" "teapot";
    Normal "Billards" "billards";
    Normal "Cornellbox" "cornellbox";
    Normal "Infinitycandy" "infinitycandy";
    Normal "Metallic" "metallic";
    Normal "Starters" "starters";
    Hard "Dragon" "dragon";
    Hard "Lucy" "lucy";
    Hard "Sponza" "sponza";
};

impl Builtin {
    /// The scene called `name`, in upper or lower case.
    ///
    /// # Errors
    /// [`SceneError::Unknown`], which suggests a name and lists all.
    pub fn find(name: impl AsRef<OsStr>) -> Result<&'static Self, SceneError> {
        let name = name.escaped().to_string();
        named(BUILTIN, &name, |builtin| builtin.name).ok_or_else(|| {
            let all = || BUILTIN.iter().map(|builtin| builtin.name);
            SceneError::Unknown {
                suggestion: suggestion(&name, all()),
                name: name.chars().take(60).collect(),
                all: all().collect::<Vec<_>>().join(", "),
            }
        })
    }

    /// Its scene file, parsed.
    pub fn file(&self) -> SceneFile {
        SceneFile::parse(self.text, self.name).expect("a test reads all built-in scenes")
    }

    /// Makes the scene with the real meshes in the folder `real_meshes`; `None` for generated meshes only.
    ///
    /// # Errors
    /// A file of `real_meshes` that cannot be loaded.
    pub fn scene(&self, real_meshes: Option<&Path>) -> Result<Scene, SceneError> {
        assemble(&self.file(), &Origin { file: self.name, folder: None, real_meshes })
    }
}

impl Scene {
    /// The scene in a scene file; `real_meshes` as in [`Builtin::scene`].
    ///
    /// # Errors
    /// A file that cannot be read, an invalid key or value, a mesh that cannot be loaded, or a missing real mesh
    /// without a stand-in.
    pub fn read(path: &Path, real_meshes: Option<&Path>) -> Result<Self, SceneError> {
        let text =
            std::fs::read_to_string(path).map_err(|cause| SceneError::Unreadable { file: path.into(), cause })?;
        let file = path.escaped().to_string();
        let folder = Some(path.parent().unwrap_or(Path::new("")));
        assemble(&SceneFile::parse(&text, &file)?, &Origin { file: &file, folder, real_meshes })
    }
}

/// The folder of real meshes: the environment variable `SAHARA_DATA`, or `scenes/data`. It need not exist.
pub fn real_mesh_folder() -> PathBuf {
    std::env::var_os("SAHARA_DATA").filter(|v| !v.is_empty()).map_or_else(|| "scenes/data".into(), PathBuf::from)
}
