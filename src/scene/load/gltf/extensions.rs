//! Extensions of glTF: which are read, and what becomes of the others.

use serde_json::Value;

use crate::scene::load::error::{Fault, quoted};
use crate::scene::load::notes::Notes;

const INSTANCING: &str = "EXT_mesh_gpu_instancing";

const READ: [&str; 2] = [INSTANCING, "KHR_mesh_quantization"];

/// Extensions without which there may be no triangles, and what removes them.
const COMPRESSION: [(&str, &str); 3] = [
    ("EXT_meshopt_compression", "`gltfpack -noq -i IN -o OUT` or `gltf-transform cp IN OUT`"),
    ("KHR_meshopt_compression", "`gltfpack -noq -i IN -o OUT` or `gltf-transform cp IN OUT`"),
    ("KHR_draco_mesh_compression", "`gltf-transform cp IN OUT`"),
];

/// Extensions that change no triangle, by how their names begin.
const SHADING: &str = "ADOBE_materials_ EXT_lights_ EXT_materials_ EXT_mesh_features EXT_structural_metadata EXT_texture_ \
    FB_ngon_encoding KHR_animation_ KHR_lights_ KHR_materials_ KHR_texture_ KHR_xmp MSFT_packing_ MSFT_texture_";

/// Notes which extensions are left out.
///
/// # Errors
/// A document that requires an extension without which its triangles cannot be read, or an unknown one.
pub(super) fn check(document: &Value, notes: &mut Notes) -> Result<(), Fault> {
    let is_shading = |name: &str| SHADING.split_whitespace().any(|start| name.starts_with(start));
    let names = |list: &str| -> Vec<String> {
        let list = document.get(list).and_then(Value::as_array).into_iter().flatten();
        list.filter_map(Value::as_str).map(str::to_owned).collect()
    };
    let compression = |name: &str| COMPRESSION.iter().find(|(compression, _)| *compression == name);
    for name in names("extensionsRequired").iter().filter(|name| !READ.contains(&name.as_str())) {
        let remedy = match compression(name) {
            _ if is_shading(name) => {
                notes.add(format!("the required extension {} changes no triangle and is left out", quoted(name)));
                continue;
            }
            Some((_, tool)) => format!("decompress the file with {tool}"),
            None => "export the file without it".to_owned(),
        };
        let problem = format!("the file requires {}, which is not read: {remedy}", quoted(name));
        return Err(Fault::part("extensionsRequired", problem));
    }
    for name in names("extensionsUsed") {
        // What is compressed and not required is there uncompressed as well.
        if !READ.contains(&name.as_str()) && compression(&name).is_none() && !is_shading(&name) {
            notes.add(format!("the extension {} is left out: what it changes is missing", quoted(name)));
        }
    }
    Ok(())
}

/// The accessors of translations, rotations and scales of the instances of a node, as far as there are such.
pub(super) fn instances(node: &Value) -> [Option<&Value>; 3] {
    let instancing = node.get("extensions").and_then(|extensions| extensions.get(INSTANCING));
    let attributes = instancing.and_then(|instancing| instancing.get("attributes"));
    ["TRANSLATION", "ROTATION", "SCALE"].map(|key| attributes.and_then(|attributes| attributes.get(key)))
}
