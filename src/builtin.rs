//! The twelve built-in scenes and their golden images, compiled into the program.

use std::ffi::OsStr;
use std::path::{Path, PathBuf};

use crate::escaped::Escaped as _;
use crate::golden::SceneGolden;
use crate::names::{named, suggestion};
use crate::scene::format::SceneFile;
use crate::scene::{Scene, SceneError};

#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Difficulty {
    Easy,
    Normal,
    Hard,
}

#[derive(Debug)]
pub struct Builtin {
    pub name: &'static str,
    pub difficulty: Difficulty,
    pub text: &'static str,
    golden: &'static [u8],
    golden_file: &'static str,
}

macro_rules! builtin {
    ($($difficulty:ident $name:literal $folder:literal;)*) => {
        &[$(Builtin {
            name: $name,
            difficulty: Difficulty::$difficulty,
            text: include_str!(concat!("../scenes/", $folder, "/scene.toml")),
            golden: include_bytes!(concat!("../scenes/", $folder, "/golden.png")),
            golden_file: concat!("scenes/", $folder, "/golden.png"),
        }),*]
    };
}

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
    /// Finds a scene by name, ignoring case.
    ///
    /// # Errors
    /// [`SceneError::Unknown`] if no scene has this name.
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

    pub fn file(&self) -> SceneFile {
        SceneFile::parse(self.text, self.name).expect("a test reads all built-in scenes")
    }

    /// Generated meshes replace real meshes that are missing in the folder `real_meshes`. If `real_meshes` is `None`,
    /// generated meshes replace all real meshes.
    ///
    /// # Errors
    /// If a file in `real_meshes` cannot be loaded.
    pub fn scene(&self, real_meshes: Option<&Path>) -> Result<Scene, SceneError> {
        Scene::from_text(self.text, self.name, None, real_meshes)
    }

    /// The golden image in the shaded view, 160 x 160 pixels.
    pub fn golden(&self) -> SceneGolden {
        SceneGolden::in_program(self.golden, Path::new(env!("CARGO_MANIFEST_DIR")), Path::new(self.golden_file))
    }
}

/// The folder of real meshes. The folder may be missing.
pub fn real_mesh_folder() -> PathBuf {
    std::env::var_os("SAHARA_DATA").filter(|v| !v.is_empty()).map_or_else(|| "scenes/data".into(), PathBuf::from)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::accel::Accel;
    use crate::golden::{self, GoldenError, Overwrite};
    use crate::kdtree::{KdConfig, KdTree};
    use crate::scene::Offset;
    use crate::triangle::Exact;

    #[test]
    fn all_twelve_have_the_triangles_and_cameras_of_the_report() {
        let expected: [(&str, [usize; 3], bool, &[&str]); 12] = [
            ("Cube", [12, 0, 1], false, &[]),
            ("Sphere", [1280, 0, 1], false, &[]),
            ("Torus", [2304, 0, 1], false, &[]),
            ("Teapot", [4032, 0, 1], false, &[]),
            ("Billards", [4164, 160, 4], true, &[]),
            ("Cornellbox", [5130, 0, 3], true, &[]),
            ("Infinitycandy", [140, 0, 1], true, &[]),
            ("Metallic", [7682, 0, 2], true, &[]),
            ("Starters", [4480, 0, 1], true, &["rabbit", "fox", "elephant"]),
            ("Dragon", [130_862, 0, 1], true, &["dragon"]),
            ("Lucy", [275_694, 0, 1], false, &["lucy"]),
            ("Sponza", [174_840, 0, 1], false, &["sponza"]),
        ];
        assert_eq!(BUILTIN.len(), expected.len());
        for (builtin, (name, [triangles, degenerate, lights], has_mirrors, stand_ins)) in BUILTIN.iter().zip(expected) {
            let scene = builtin.scene(None).unwrap();
            assert_eq!([builtin.name, &scene.name], [name; 2]);
            let counts = [scene.mesh.len(), scene.mesh.degenerate().len(), scene.lights.len()];
            assert_eq!(counts, [triangles, degenerate, lights], "{name}");
            assert_eq!((builtin.file().triangles, scene.material_of.len()), (Some(triangles), triangles), "{name}");
            assert_eq!((scene.size, scene.offset), ([512, 512], Offset::Direction(0.01)), "{name}");
            let shading = if name == "Dragon" { (1, false) } else { (8, true) };
            assert_eq!((scene.recursion_limit, scene.shadow_terminator_fix), shading, "{name}");
            assert_eq!(scene.has_mirrors(), has_mirrors, "{name}");
            assert_eq!(scene.stand_ins, stand_ins, "{name}");
        }
    }

    #[test]
    fn golden_images_are_those_of_the_source_tree_and_an_installed_program_only_checks_them() {
        for builtin in BUILTIN {
            let golden = builtin.golden();
            assert_eq!(golden.expected().unwrap(), golden::read(golden.path()).unwrap(), "{}", builtin.name);
        }
        let cube = Builtin::find("cube").unwrap();
        let (scene, sources) = (cube.scene(None).unwrap(), Path::new("/no/such/folder"));
        let tree = KdTree::<Exact>::build(&scene.mesh, &KdConfig::SAH).unwrap();
        let installed = SceneGolden::in_program(cube.golden, sources, Path::new(cube.golden_file));
        installed.check(&scene, "sah-kd", &tree, Path::new("/no/such/out")).unwrap();
        let refused = installed.update(&scene, &tree, Overwrite::Any).unwrap_err();
        assert!(matches!(refused, GoldenError::NoSources), "{refused}");
    }
}
