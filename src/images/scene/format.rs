#![doc = include_str!("SCENE.md")]

use std::collections::BTreeMap;

use serde::Deserialize;

use super::SceneError;
use crate::scene::Material;
use crate::scene::meshes::Terrain;

/// The contents of a scene file.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct SceneFile {
    pub name: String,
    /// A note on the origin of the scene.
    pub source: Option<String>,
    /// The expected number of triangles. It is not checked if a `real` file replaces a `mesh`.
    pub triangles: Option<usize>,
    /// Width and height of the image, 1 to 16384.
    #[serde(default = "default_size")]
    pub size: [u32; 2],
    /// Linear RGB.
    #[serde(default)]
    pub background: [f32; 3],
    /// The maximum depth of mirror rays, 0 to 64.
    #[serde(default = "default_recursion_limit")]
    pub recursion_limit: u32,
    /// See [`super::Scene::shadow_terminator_fix`].
    #[serde(default = "yes")]
    pub shadow_terminator_fix: bool,
    /// Moves the origin of every ray, including camera rays, by this distance along the ray. Without this
    /// key, [`super::Offset::ErrorBounded`] applies.
    pub ray_offset: Option<f32>,
    pub camera: CameraFile,
    #[serde(default)]
    pub lights: Vec<LightFile>,
    pub objects: Vec<ObjectFile>,
    #[serde(default)]
    pub materials: BTreeMap<String, MaterialFile>,
}

#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct CameraFile {
    pub eye: [f32; 3],
    pub target: [f32; 3],
    #[serde(default = "default_up")]
    pub up: [f32; 3],
    /// The full vertical field of view in degrees.
    pub vertical_fov: f32,
}

/// See [`super::Light`].
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct LightFile {
    pub pos: [f32; 3],
    pub col: [f32; 3],
    #[serde(default)]
    pub lat: f32,
    #[serde(default)]
    pub qat: f32,
}

/// See [`Material`]. Textures are ignored.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
#[allow(non_snake_case, reason = "the keys have the names of MTL")]
pub struct MaterialFile {
    pub Ka: [f32; 3],
    pub Kd: [f32; 3],
    pub Ks: [f32; 3],
    #[serde(default)]
    pub Ns: f32,
    #[serde(default)]
    pub r: f32,
    pub texture: Option<String>,
    pub normal_map: Option<String>,
}

impl MaterialFile {
    pub(super) fn material(&self, name: &str) -> Material {
        Material {
            name: name.into(),
            ambient: self.Ka.into(),
            diffuse: self.Kd.into(),
            specular: self.Ks.into(),
            shininess: self.Ns,
            mirror: self.r,
        }
    }
}

#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ObjectFile {
    /// A name in [`super::meshes::GENERATORS`], or a path relative to the folder of the scene file.
    pub mesh: Option<String>,
    /// Generated ground instead of a mesh.
    pub terrain: Option<Terrain>,
    /// The material of the whole mesh.
    pub material: Option<String>,
    /// Maps a material name in the mesh to a material name in the scene file.
    pub materials: Option<BTreeMap<String, String>>,
    /// Angles about x, y and z in degrees. See [`crate::geometry::Transform::new`].
    #[serde(default)]
    pub rot: [f32; 3],
    #[serde(default = "ones")]
    pub sca: [f32; 3],
    #[serde(default)]
    pub tra: [f32; 3],
    pub stands_in_for: Option<String>,
    /// A mesh file that replaces `mesh` if the file exists. Without `mesh`, the file must exist.
    pub real: Option<RealMesh>,
}

/// A mesh file that is not part of sahara.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct RealMesh {
    /// The name of the file in the folder of downloaded meshes.
    pub file: String,
    /// The URL of the file. If `unpack` is set, the URL of an archive.
    pub url: String,
    pub unpack: Option<String>,
    pub licence: String,
    pub origin: String,
    /// The SHA-256 of the file in hexadecimal. If `sha256` is `None`, `sahara fetch` does not download the file.
    pub sha256: Option<String>,
    pub bytes: Option<u64>,
    /// The number of triangles that the source report states for this mesh.
    pub reported_triangles: Option<usize>,
    /// `rot`, `sca` and `tra` replace the fields of the same names in [`ObjectFile`].
    #[serde(default)]
    pub rot: [f32; 3],
    #[serde(default = "ones")]
    pub sca: [f32; 3],
    #[serde(default)]
    pub tra: [f32; 3],
    #[serde(default)]
    pub exclude_materials: Vec<String>,
}

fn default_size() -> [u32; 2] {
    [512, 512]
}

fn default_recursion_limit() -> u32 {
    8
}

fn default_up() -> [f32; 3] {
    [0.0, 1.0, 0.0]
}

fn ones() -> [f32; 3] {
    [1.0; 3]
}

fn yes() -> bool {
    true
}

impl SceneFile {
    /// `file` is the file name for error messages.
    ///
    /// # Errors
    /// If the text is not a valid scene file.
    pub fn parse(text: &str, file: &str) -> Result<Self, SceneError> {
        let scene: Self = toml::from_str(text).map_err(|error| SceneError::Syntax {
            file: file.into(),
            line: error.span().map_or(1, |span| 1 + text[..span.start].matches('\n').count()),
            problem: error.message().trim().replace('\n', "; "),
        })?;
        scene.check().map_err(|(key, problem)| SceneError::Value { file: file.into(), key, problem })?;
        Ok(scene)
    }

    fn check(&self) -> Result<(), (String, String)> {
        // Tables print the name, and file names contain it.
        let is_word = !self.name.trim().is_empty() && !self.name.contains(char::is_control);
        demand(is_word, "name", "give a name on one line without control characters")?;
        let in_size = self.size.iter().all(|n| (1..=16384).contains(n));
        demand(in_size, "size", "width and height must be between 1 and 16384")?;
        demand(self.recursion_limit <= 64, "recursion_limit", "give at most 64")?;
        let offset = self.ray_offset.unwrap_or(0.0);
        demand(offset.is_finite() && offset >= 0.0, "ray_offset", "give a distance of at least 0")?;
        demand(!self.objects.is_empty(), "objects", "a scene needs at least one object: add one")?;
        numbers(&self.background, 0.0, "background")?;

        for (i, light) in self.lights.iter().enumerate() {
            numbers(&light.pos, f32::MIN, &format!("lights[{i}].pos"))?;
            numbers(&light.col, 0.0, &format!("lights[{i}].col"))?;
            numbers(&[light.lat, light.qat], 0.0, &format!("lights[{i}].lat or qat"))?;
        }
        for (name, material) in &self.materials {
            for (key, colour) in [("Ka", material.Ka), ("Kd", material.Kd), ("Ks", material.Ks)] {
                numbers(&colour, 0.0, &format!("materials.{name}.{key}"))?;
            }
            numbers(&[material.Ns], 0.0, &format!("materials.{name}.Ns"))?;
            let is_share = (0.0..=1.0).contains(&material.r);
            demand(is_share, &format!("materials.{name}.r"), "give a number from 0 to 1")?;
        }
        for (i, object) in self.objects.iter().enumerate() {
            let placements =
                [Some((object.rot, object.sca, object.tra)), object.real.as_ref().map(|r| (r.rot, r.sca, r.tra))];
            for (rot, sca, tra) in placements.into_iter().flatten() {
                numbers(&[rot, sca, tra].concat(), f32::MIN, &format!("objects[{i}].rot, sca or tra"))?;
            }
            if let Some(terrain) = object.terrain {
                let alone = object.mesh.is_none() && object.real.is_none() && object.stands_in_for.is_none();
                let problem = "it excludes `mesh`, `real` and `stands_in_for`: remove them";
                demand(alone, &format!("objects[{i}].terrain"), problem)?;
                let key = format!("objects[{i}].terrain.triangles");
                demand((1..=Terrain::MOST).contains(&terrain.triangles), &key, "give 1 to 134217728 (2^27)")?;
            } else if object.mesh.is_none() {
                let problem = "name a mesh or a file, or give `terrain` or `real`";
                demand(object.real.is_some(), &format!("objects[{i}].mesh"), problem)?;
                let placed = (object.rot, object.sca, object.tra) != ([0.0; 3], [1.0; 3], [0.0; 3]);
                let problem = "there is no `mesh` that it could apply to: move it into `real`, or remove it";
                demand(!placed, &format!("objects[{i}].rot, sca or tra"), problem)?;
                demand(object.stands_in_for.is_none(), &format!("objects[{i}].stands_in_for"), problem)?;
            }
            let both = object.material.is_some() && object.materials.is_some();
            demand(!both, &format!("objects[{i}].materials"), "give `material` or `materials`, not both")?;
            let named = object.material.iter().chain(object.materials.iter().flat_map(BTreeMap::values));
            for name in named {
                let problem = format!("the file has no material `{name}`: add `materials.{name}`");
                demand(self.materials.contains_key(name), &format!("objects[{i}].material"), &problem)?;
            }
            if let Some(real) = &object.real {
                let plain = !real.file.contains(['/', '\\']) && !["", ".", ".."].contains(&real.file.as_str());
                demand(plain, &format!("objects[{i}].real.file"), "give a file name without folders")?;
                let digits = |hash: &str| hash.len() == 64 && hash.bytes().all(|byte| byte.is_ascii_hexdigit());
                let whole = real.sha256.as_deref().is_none_or(digits);
                demand(whole, &format!("objects[{i}].real.sha256"), "give its 64 hexadecimal digits")?;
            }
        }
        Ok(())
    }
}

fn demand(met: bool, key: &str, problem: &str) -> Result<(), (String, String)> {
    if met { Ok(()) } else { Err((key.into(), problem.into())) }
}

fn numbers(values: &[f32], least: f32, key: &str) -> Result<(), (String, String)> {
    let problem = if least == 0.0 { "give finite numbers that are not negative" } else { "give finite numbers" };
    demand(values.iter().all(|v| v.is_finite() && *v >= least), key, problem)
}

#[cfg(test)]
mod tests {
    use super::*;

    const DOCUMENT: &str = include_str!("SCENE.md");

    fn documented(heading: &str) -> Vec<&'static str> {
        let (_, part) = DOCUMENT.split_once(&format!("\n## {heading}\n")).unwrap_or_else(|| panic!("no {heading}"));
        let part = part.split("\n## ").next().unwrap_or(part);
        part.lines().filter_map(|line| line.strip_prefix("| `")?.split_once('`').map(|(key, _)| key)).collect()
    }

    /// The keys that the parser accepts, taken from the error for an unknown key.
    fn known(table: &str) -> Vec<String> {
        let error = SceneFile::parse(&format!("{table}nobodys_key = 1\n"), "x").unwrap_err().to_string();
        let (_, list) = error.split_once("expected ").unwrap_or_else(|| panic!("{error}"));
        list.split('`').skip(1).step_by(2).map(String::from).collect()
    }

    #[test]
    fn the_document_lists_the_keys_that_the_parser_knows() {
        for (heading, table) in [
            ("The scene", ""),
            ("`[camera]`", "[camera]\n"),
            ("`[[lights]]`", "[[lights]]\n"),
            ("`[[objects]]`", "[[objects]]\n"),
            ("`[objects.terrain]`", "[[objects]]\n[objects.terrain]\n"),
            ("`[objects.real]`", "[[objects]]\n[objects.real]\n"),
            ("`[materials.NAME]`", "[materials.X]\n"),
        ] {
            assert_eq!(documented(heading), known(table), "{heading}");
        }
    }

    #[test]
    fn the_example_of_the_document_is_a_scene() {
        let text = DOCUMENT.split("```toml\n").nth(1).and_then(|rest| rest.split("```").next()).unwrap();
        let file = SceneFile::parse(text, "SCENE.md").unwrap();
        assert_eq!((file.name.as_str(), file.objects.len(), file.size), ("Mine", 2, [512, 512]));
    }
}
