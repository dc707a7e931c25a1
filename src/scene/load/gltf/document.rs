//! The part of a glTF document that is read.

use serde::Deserialize;
use serde::de::IgnoredAny;

use crate::scene::load::error::{Fault, quoted};

/// The modes of primitives that are triangles; those below are points and lines.
pub(super) const TRIANGLES: u32 = 4;
pub(super) const TRIANGLE_STRIP: u32 = 5;
pub(super) const TRIANGLE_FAN: u32 = 6;

#[derive(Deserialize)]
#[serde(rename_all = "camelCase")]
pub(super) struct Document {
    #[serde(rename = "asset")]
    _asset: IgnoredAny,
    #[serde(default)]
    extensions_required: Vec<String>,
    #[serde(default)]
    pub buffers: Vec<Buffer>,
    #[serde(default)]
    pub buffer_views: Vec<BufferView>,
    #[serde(default)]
    pub accessors: Vec<Accessor>,
    #[serde(default)]
    pub materials: Vec<Material>,
    #[serde(default)]
    pub meshes: Vec<Mesh>,
    #[serde(default)]
    pub nodes: Vec<Node>,
    #[serde(default)]
    pub scenes: Vec<Scene>,
    pub scene: Option<usize>,
}

#[derive(Deserialize)]
#[serde(rename_all = "camelCase")]
pub(super) struct Buffer {
    pub uri: Option<String>,
    pub byte_length: u64,
}

#[derive(Deserialize)]
#[serde(rename_all = "camelCase")]
pub(super) struct BufferView {
    pub buffer: usize,
    #[serde(default)]
    pub byte_offset: usize,
    pub byte_length: usize,
    pub byte_stride: Option<usize>,
}

#[derive(Deserialize)]
#[serde(rename_all = "camelCase")]
pub(super) struct Accessor {
    pub buffer_view: Option<usize>,
    #[serde(default)]
    pub byte_offset: usize,
    pub component_type: u32,
    #[serde(rename = "type")]
    pub dimensions: String,
    pub count: usize,
    pub sparse: Option<Sparse>,
}

#[derive(Deserialize)]
pub(super) struct Sparse {
    pub count: usize,
    pub indices: SparseData,
    pub values: SparseData,
}

#[derive(Deserialize)]
#[serde(rename_all = "camelCase")]
pub(super) struct SparseData {
    pub buffer_view: usize,
    #[serde(default)]
    pub byte_offset: usize,
    /// None for values: their type is that of the accessor.
    pub component_type: Option<u32>,
}

#[derive(Deserialize)]
pub(super) struct Mesh {
    pub primitives: Vec<Primitive>,
}

#[derive(Deserialize)]
pub(super) struct Primitive {
    pub attributes: Attributes,
    pub indices: Option<usize>,
    pub material: Option<usize>,
    #[serde(default = "triangles")]
    pub mode: u32,
    #[serde(default)]
    pub targets: Vec<IgnoredAny>,
}

fn triangles() -> u32 {
    TRIANGLES
}

#[derive(Deserialize)]
#[serde(rename_all = "UPPERCASE")]
pub(super) struct Attributes {
    pub position: Option<usize>,
    pub normal: Option<usize>,
}

#[derive(Deserialize)]
pub(super) struct Node {
    #[serde(default)]
    pub children: Vec<usize>,
    pub mesh: Option<usize>,
    pub skin: Option<IgnoredAny>,
    pub matrix: Option<[f32; 16]>,
    pub translation: Option<[f32; 3]>,
    pub rotation: Option<[f32; 4]>,
    pub scale: Option<[f32; 3]>,
}

#[derive(Deserialize)]
pub(super) struct Scene {
    #[serde(default)]
    pub nodes: Vec<usize>,
}

#[derive(Deserialize)]
#[serde(rename_all = "camelCase")]
pub(super) struct Material {
    pub name: Option<String>,
    #[serde(default)]
    pub pbr_metallic_roughness: Pbr,
    normal_texture: Option<IgnoredAny>,
    occlusion_texture: Option<IgnoredAny>,
    emissive_texture: Option<IgnoredAny>,
}

#[derive(Default, Deserialize)]
#[serde(rename_all = "camelCase")]
pub(super) struct Pbr {
    pub base_color_factor: Option<[f32; 4]>,
    base_color_texture: Option<IgnoredAny>,
    metallic_roughness_texture: Option<IgnoredAny>,
}

impl Material {
    pub fn is_textured(&self) -> bool {
        let pbr = &self.pbr_metallic_roughness;
        let textures = [&pbr.base_color_texture, &pbr.metallic_roughness_texture];
        let others = [&self.normal_texture, &self.occlusion_texture, &self.emissive_texture];
        textures.iter().chain(&others).any(|texture| texture.is_some())
    }
}

impl Document {
    /// Checks that the document is supported, and that all its indices are in range.
    pub fn check(&self) -> Result<(), Fault> {
        if !self.extensions_required.is_empty() {
            let names: Vec<_> = self.extensions_required.iter().map(quoted).collect();
            let problem = format!("it requires {}, not supported here: export it without", names.join(", "));
            return Err(Fault::file(problem));
        }
        let scenes = self.scenes.len();
        if let Some(scene) = self.scene.filter(|&scene| scene >= scenes) {
            return Err(Fault::part("scene", format!("it names scene {scene}, but the file has {scenes} scenes")));
        }
        let within = |index: usize, list: usize, place: &dyn Fn() -> String| {
            let problem =
                || format!("index {index} is out of bounds, there are {list}, counted from 0: export the file again");
            if index < list { Ok(()) } else { Err(Fault::part(place(), problem())) }
        };
        for (s, scene) in self.scenes.iter().enumerate() {
            for (i, &node) in scene.nodes.iter().enumerate() {
                within(node, self.nodes.len(), &|| format!("scenes[{s}].nodes[{i}]"))?;
            }
        }
        for (n, node) in self.nodes.iter().enumerate() {
            for (i, &child) in node.children.iter().enumerate() {
                within(child, self.nodes.len(), &|| format!("nodes[{n}].children[{i}]"))?;
            }
            node.mesh.map_or(Ok(()), |mesh| within(mesh, self.meshes.len(), &|| format!("nodes[{n}].mesh")))?;
        }
        for (m, mesh) in self.meshes.iter().enumerate() {
            for (i, primitive) in mesh.primitives.iter().enumerate() {
                let place = |key: &str| format!("meshes[{m}].primitives[{i}].{key}");
                let accessors = [
                    (primitive.attributes.position, "attributes.POSITION"),
                    (primitive.attributes.normal, "attributes.NORMAL"),
                    (primitive.indices, "indices"),
                ];
                for (accessor, key) in accessors {
                    accessor.map_or(Ok(()), |accessor| within(accessor, self.accessors.len(), &|| place(key)))?;
                }
                let materials = self.materials.len();
                primitive.material.map_or(Ok(()), |material| within(material, materials, &|| place("material")))?;
                if primitive.mode > TRIANGLE_FAN {
                    let problem = format!("{} is an invalid value: export the file again", primitive.mode);
                    return Err(Fault::part(place("mode"), problem));
                }
            }
        }
        Ok(())
    }
}
