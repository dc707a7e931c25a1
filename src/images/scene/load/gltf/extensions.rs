//! Supported and ignored extensions of glTF.

use serde_json::Value;

use crate::scene::load::error::{Fault, quoted};
use crate::scene::load::notes::Notes;

const READ: [&str; 2] = ["EXT_mesh_gpu_instancing", "KHR_mesh_quantization"];

/// Extensions whose names begin with these prefixes change no triangle.
const SHADING: &str = "ADOBE_materials_ EXT_lights_ EXT_materials_ EXT_mesh_features EXT_structural_metadata EXT_texture_ \
    FB_ngon_encoding KHR_animation_ KHR_lights_ KHR_materials_ KHR_texture_ KHR_xmp MSFT_packing_ MSFT_texture_";

pub(super) fn check(required: &Value, used: &Value, notes: &mut Notes) -> Result<(), Fault> {
    let is_shading = |name: &str| SHADING.split_whitespace().any(|start| name.starts_with(start));
    for name in others(required) {
        if !is_shading(name) {
            let remedy = decompression(name).unwrap_or("export the file without it");
            let problem = format!("the file requires {}, which sahara does not support: {remedy}", quoted(name));
            return Err(Fault::part("extensionsRequired", problem));
        }
        notes.add(format!("the required extension {} changes no triangle and is ignored", quoted(name)));
    }
    // If compression is not required, the file also contains the uncompressed data.
    for name in others(used).filter(|name| !is_shading(name) && decompression(name).is_none()) {
        notes.add(format!("the extension {} is ignored: its changes to the scene are missing", quoted(name)));
    }
    Ok(())
}

fn others(list: &Value) -> impl Iterator<Item = &str> {
    list.as_array().into_iter().flatten().filter_map(Value::as_str).filter(|name| !READ.contains(name))
}

fn decompression(name: &str) -> Option<&'static str> {
    match name {
        "EXT_meshopt_compression" | "KHR_meshopt_compression" => {
            Some("decompress it with `gltfpack -noq -i IN -o OUT`")
        }
        "KHR_draco_mesh_compression" => Some("decompress it with `gltf-transform cp IN OUT`"),
        _ => None,
    }
}

pub(super) fn instances(node: &Value) -> [Option<usize>; 3] {
    let attributes = node.pointer("/extensions/EXT_mesh_gpu_instancing/attributes");
    let number = |accessor: &Value| accessor.as_u64().map_or(usize::MAX, |number| number as usize);
    ["TRANSLATION", "ROTATION", "SCALE"].map(|key| attributes.and_then(|all| all.get(key)).map(number))
}
