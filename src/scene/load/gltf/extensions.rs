//! Extensions of glTF: which are read, and what becomes of the others.

use serde_json::Value;

use crate::scene::load::error::{Fault, quoted};
use crate::scene::load::notes::Notes;

const READ: [&str; 2] = ["EXT_mesh_gpu_instancing", "KHR_mesh_quantization"];

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
pub(super) fn check(required: &Value, used: &Value, notes: &mut Notes) -> Result<(), Fault> {
    let others = |list| {
        let names = Value::as_array(list).into_iter().flatten().filter_map(Value::as_str);
        names.filter(|name| !READ.contains(name)).map(|name| {
            let is_shading = SHADING.split_whitespace().any(|start| name.starts_with(start));
            (name, is_shading, COMPRESSION.iter().find(|(compression, _)| *compression == name))
        })
    };
    for (name, is_shading, compression) in others(required) {
        if is_shading {
            notes.add(format!("the required extension {} changes no triangle and is ignored", quoted(name)));
            continue;
        }
        let remedy = match compression {
            Some((_, tool)) => format!("decompress the file with {tool}"),
            None => "export the file without it".to_owned(),
        };
        let problem = format!("the file requires {}, which sahara does not support: {remedy}", quoted(name));
        return Err(Fault::part("extensionsRequired", problem));
    }
    for (name, is_shading, compression) in others(used) {
        // Compressed data that are not required exist uncompressed as well.
        if !is_shading && compression.is_none() {
            notes.add(format!("the extension {} is ignored, with what it changes", quoted(name)));
        }
    }
    Ok(())
}

/// The accessors of translations, rotations and scales of the instances of a node, as far as there are such.
pub(super) fn instances(node: &Value) -> [Option<usize>; 3] {
    let attributes = node.pointer("/extensions/EXT_mesh_gpu_instancing/attributes");
    let number = |accessor: &Value| accessor.as_u64().map_or(usize::MAX, |number| number as usize);
    ["TRANSLATION", "ROTATION", "SCALE"].map(|key| attributes.and_then(|all| all.get(key)).map(number))
}
