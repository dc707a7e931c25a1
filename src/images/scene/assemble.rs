//! Makes a scene from a scene file.

use std::path::Path;
use std::sync::Arc;

use super::format::{LightFile, ObjectFile, RealMesh, SceneFile};
use super::{Camera, CornerNormals, Light, Material, Model, Offset, Scene, SceneError, load, meshes};
use crate::escaped::Escaped as _;
use crate::geometry::{Mesh, Transform};
use crate::names::suggestion;

pub(super) struct Origin<'a> {
    /// The name of the scene file in messages.
    pub file: &'a str,
    /// A `mesh` path in the file is relative to this folder. `None` for a built-in scene.
    pub folder: Option<&'a Path>,
    /// The folder of downloaded meshes. With `None`, no object uses a downloaded mesh.
    pub real_meshes: Option<&'a Path>,
}

impl Origin<'_> {
    fn value(&self, key: &str, problem: String) -> SceneError {
        SceneError::Value { file: self.file.into(), key: key.into(), problem }
    }
}

impl Scene {
    /// Reads a scene file. `real_meshes` is the folder of downloaded meshes. With `None`, no object uses a downloaded
    /// mesh.
    ///
    /// # Errors
    /// If the scene file or a mesh file cannot be read or is invalid.
    pub fn read(path: &Path, real_meshes: Option<&Path>) -> Result<Self, SceneError> {
        let text =
            std::fs::read_to_string(path).map_err(|cause| SceneError::Unreadable { file: path.into(), cause })?;
        let folder = Some(path.parent().unwrap_or(Path::new("")));
        Self::from_text(&text, &path.escaped().to_string(), folder, real_meshes)
    }

    /// Reads the text of a scene file. `file` is the name of the text in error messages. A `mesh` path in the text is
    /// relative to `folder`. Without `folder`, a `mesh` path is an error.
    ///
    /// # Errors
    /// If the text or a mesh file is invalid, or a mesh file cannot be read.
    pub fn from_text(
        text: &str,
        file: &str,
        folder: Option<&Path>,
        real_meshes: Option<&Path>,
    ) -> Result<Self, SceneError> {
        assemble(&SceneFile::parse(text, file)?, &Origin { file, folder, real_meshes })
    }
}

pub(super) fn assemble(file: &SceneFile, origin: &Origin) -> Result<Scene, SceneError> {
    let mut parts = SceneBuilder::new(file);
    for (i, object) in file.objects.iter().enumerate() {
        parts.add(object, &format!("objects[{i}]"), origin)?;
    }

    if let Some(wanted) = file.triangles.filter(|_| !parts.replaced) {
        let count = parts.all.triangles.len();
        let problem = format!("the file states {wanted} triangles, but its objects have {count}: correct one of them");
        if count != wanted {
            return Err(origin.value("triangles", problem));
        }
    }
    let mesh = Mesh::new(parts.all.positions, parts.all.triangles)
        .map_err(|cause| SceneError::Mesh { file: origin.file.into(), cause })?;
    let c = &file.camera;
    let camera = Camera::new(c.eye.into(), c.target.into(), c.up.into(), c.vertical_fov)
        .map_err(|cause| SceneError::Camera { file: origin.file.into(), cause })?;
    let light = |l: &LightFile| Light { position: l.pos.into(), colour: l.col.into(), linear: l.lat, quadratic: l.qat };
    let smooth = parts.all.normal_indices.iter().any(|&n| n != CornerNormals::FLAT);
    Ok(Scene {
        name: file.name.clone(),
        normals: smooth.then(|| CornerNormals::new(parts.all.normals, parts.all.normal_indices)),
        materials: parts.all.materials,
        material_of: parts.all.material_of,
        lights: file.lights.iter().map(light).collect(),
        camera,
        background: file.background.into(),
        recursion_limit: file.recursion_limit,
        shadow_terminator_fix: file.shadow_terminator_fix,
        offset: file.ray_offset.map_or(Offset::ErrorBounded, Offset::Direction),
        size: file.size,
        is_framed: false,
        stand_ins: parts.stand_ins,
        notes: parts.all.notes,
        warnings: vec![],
        mesh: Arc::new(mesh),
    })
}

#[derive(Default)]
struct SceneBuilder {
    /// The added objects, in world space, with unit normals.
    all: Model,
    stand_ins: Vec<String>,
    /// Whether a downloaded mesh replaces the `mesh` of an object.
    replaced: bool,
}

impl SceneBuilder {
    fn new(file: &SceneFile) -> Self {
        let materials = file.materials.iter().map(|(name, m)| m.material(name)).collect();
        let textures: Vec<&str> =
            file.materials.values().flat_map(|m| m.texture.iter().chain(&m.normal_map)).map(String::as_str).collect();
        let mut all = Model { materials, ..Model::default() };
        if !textures.is_empty() {
            all.notes.push(format!("textures ignored (materials use Kd): {}", textures.join(", ")));
        }
        Self { all, ..Self::default() }
    }

    fn add(&mut self, object: &ObjectFile, key: &str, origin: &Origin) -> Result<(), SceneError> {
        let (mut model, placement) = self.choose(object, key, origin)?;
        self.all.notes.append(&mut model.notes);

        let (first, before) = (self.all.positions.len(), self.all.triangles.len());
        let is_mirrored = placement.is_mirror();
        let shifted = |&indices: &[u32; 3], by: usize| Model::placed(indices, is_mirrored).map(|i| i + by as u32);
        if (first + model.positions.len()).max(self.all.normals.len() + model.normals.len()) > i32::MAX as usize {
            return Err(origin.value(key, "the scene has more than 2^31 vertices or normals: split it".into()));
        }
        model.positions.iter_mut().for_each(|p| *p = placement.point(*p));
        append(&mut self.all.positions, std::mem::take(&mut model.positions));
        model.triangles.iter_mut().for_each(|t| *t = shifted(t, first));
        append(&mut self.all.triangles, std::mem::take(&mut model.triangles));

        let first = self.all.normals.len();
        self.all.normals.extend(model.normals.iter().map(|&n| placement.normal(n)));
        // `normal_indices` stays empty until a mesh has normals.
        if !model.normal_indices.is_empty() {
            let flat = |n: &[u32; 3]| n.contains(&Model::FLAT);
            let placed = |n| if flat(n) { CornerNormals::FLAT } else { shifted(n, first) };
            self.all.normal_indices.resize(before, CornerNormals::FLAT);
            self.all.normal_indices.extend(model.normal_indices.iter().map(placed));
        } else if !self.all.normal_indices.is_empty() {
            self.all.normal_indices.resize(self.all.triangles.len(), CornerNormals::FLAT);
        }
        self.paint(object, &model, key, origin)
    }

    fn choose(&mut self, object: &ObjectFile, key: &str, origin: &Origin) -> Result<(Model, Transform), SceneError> {
        if let (Some(real), Some(folder)) = (&object.real, origin.real_meshes) {
            let path = folder.join(&real.file);
            if path.is_file() {
                let model = load_file(&path, &format!("{key}.real.file"), origin)?;
                let placement = Transform::new(real.rot.into(), real.sca.into(), real.tra.into());
                self.replaced |= object.mesh.is_some();
                let model = self.take_real(real, &path, model);
                if model.triangles.is_empty() {
                    let problem = format!("{} has no triangle left: exclude fewer materials", real.file);
                    return Err(origin.value(&format!("{key}.real.exclude_materials"), problem));
                }
                return Ok((model, placement));
            }
        }
        let placement = Transform::new(object.rot.into(), object.sca.into(), object.tra.into());
        if let Some(terrain) = object.terrain {
            return Ok((terrain.model(), placement));
        }
        let mesh = match (&object.mesh, &object.real) {
            (Some(mesh), _) => mesh,
            (None, Some(real)) => return Err(missing(real, key, origin)),
            (None, None) => return Err(origin.value(&format!("{key}.mesh"), "name a mesh or a file".into())),
        };
        if let Some(whole) = &object.stands_in_for {
            self.stand_ins.push(mesh.clone());
            self.all.notes.push(format!("mesh `{mesh}` stands in for {whole}"));
        }

        let key = format!("{key}.mesh");
        let is_file = Path::new(mesh).extension().is_some();
        match (is_file, origin.folder) {
            (true, Some(folder)) => Ok((load_file(&folder.join(mesh), &key, origin)?, placement)),
            _ => {
                let names: Vec<&str> = meshes::GENERATORS.iter().map(|g| g.name).collect();
                let meant = suggestion(mesh, names.iter().copied());
                let problem = format!("there is no mesh `{mesh}`{meant}; name a file or one of {}", names.join(", "));
                let model = meshes::by_name(mesh).ok_or_else(|| origin.value(&key, problem))?;
                Ok((model, placement))
            }
        }
    }

    fn take_real(&mut self, real: &RealMesh, path: &Path, mut model: Model) -> Model {
        let before = model.triangles.len();
        without_materials(&mut model, &real.exclude_materials);
        let count = model.triangles.len();
        let left_out = before - count;
        let instead = real.reported_triangles.map_or(String::new(), |n| format!(" instead of the report's {n}"));
        self.all.notes.push(format!("real mesh {}: {count} triangles{instead}", path.escaped()));
        if left_out > 0 {
            let materials = real.exclude_materials.join(", ");
            self.all.notes.push(format!("{left_out} triangles of the real mesh excluded (materials {materials})"));
        }
        model
    }

    fn paint(&mut self, object: &ObjectFile, model: &Model, key: &str, origin: &Origin) -> Result<(), SceneError> {
        // The materials of the scene file come first in `materials`. The parser rejects unknown material names.
        let number = |materials: &[Material], name: &str| {
            materials.iter().position(|m| m.name == name).expect("the file names its materials") as u32
        };
        let own = model.materials.len().max(1);
        let numbers: Vec<u32> = if let Some(name) = &object.material {
            vec![number(&self.all.materials, name); own]
        } else if let Some(by_part) = &object.materials {
            let part_names: Vec<&str> = model.materials.iter().map(|m| m.name.as_str()).collect();
            let key = format!("{key}.materials");
            if let Some(name) = by_part.keys().find(|name| !part_names.contains(&name.as_str())) {
                let problem = format!("the mesh has no part `{name}`, only: {}", part_names.join(", "));
                return Err(origin.value(&key, problem));
            }
            let chosen = |part: &&str| {
                let name = by_part.get(*part);
                let problem = || origin.value(&key, format!("part `{part}` has no material: add one"));
                name.map(|name| number(&self.all.materials, name)).ok_or_else(problem)
            };
            part_names.iter().map(chosen).collect::<Result<_, _>>()?
        } else {
            let first = self.all.materials.len() as u32;
            self.all.materials.extend(model.materials.iter().cloned());
            if model.materials.is_empty() {
                self.all.materials.push(Material::named("grey"));
            }
            (first..self.all.materials.len() as u32).collect()
        };

        if model.material_of.is_empty() {
            self.all.material_of.resize(self.all.triangles.len(), numbers[0]);
        } else {
            self.all.material_of.extend(model.material_of.iter().map(|&part| numbers[part as usize]));
        }
        Ok(())
    }
}

/// Avoids a copy if `all` is empty.
fn append<T>(all: &mut Vec<T>, mut more: Vec<T>) {
    if all.is_empty() {
        *all = more;
    } else {
        all.append(&mut more);
    }
}

fn missing(real: &RealMesh, key: &str, origin: &Origin) -> SceneError {
    let problem = match origin.real_meshes {
        Some(folder) => format!(
            "{} is not in {}: `sahara fetch {}` downloads it or says how; SAHARA_DATA sets the folder",
            real.file,
            folder.escaped(),
            origin.file
        ),
        None => format!("{} is a real mesh, but no folder of real meshes is set: set one, or name a `mesh`", real.file),
    };
    origin.value(&format!("{key}.real.file"), problem)
}

fn load_file(path: &Path, key: &str, origin: &Origin) -> Result<Model, SceneError> {
    load(path).map_err(|cause| SceneError::Load { file: origin.file.into(), key: key.into(), cause })
}

/// Removes the triangles whose material is in `names`. All vertices and materials stay in the model.
fn without_materials(model: &mut Model, names: &[String]) {
    let dropped: Vec<bool> = model.materials.iter().map(|m| names.contains(&m.name)).collect();
    let of = |t: usize| model.material_of.get(t).map_or(0, |&m| m as usize);
    let kept: Vec<bool> = (0..model.triangles.len()).map(|t| !dropped.get(of(t)).is_some_and(|&d| d)).collect();
    fn keep<T>(values: &mut Vec<T>, kept: &[bool]) {
        let mut kept = kept.iter();
        values.retain(|_| *kept.next().unwrap_or(&true));
    }
    keep(&mut model.triangles, &kept);
    keep(&mut model.normal_indices, &kept);
    keep(&mut model.material_of, &kept);
}
