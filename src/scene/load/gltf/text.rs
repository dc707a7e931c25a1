//! The text of a glTF document, alone or in a binary file.
//!
//! The crate `gltf` has the types of a document and checks its indices. By itself it refuses valid files for what is not
//! read here, and misreads some invalid ones. The document is therefore cut down to what is read before the crate sees
//! it.

use std::collections::{HashMap, HashSet};
use std::ops::Range;
use std::sync::LazyLock;

use gltf::json::validation::{Error, Validate as _};
use gltf::json::{Path, Root};
use serde_json::Value;

use super::extensions;
use crate::scene::load::error::{Fault, message, quoted};
use crate::scene::load::notes::Notes;
use crate::scene::load::text::plain;

/// The most objects in a small document: each takes some hundred bytes of memory, and may be as short as `{}`.
const MOST_OBJECTS: usize = 1 << 16;

/// So many bytes of the file allow for one more object.
const BYTES_AN_OBJECT: usize = 48;

/// The most entries of lists and objects, per object.
const ENTRIES_AN_OBJECT: usize = 12;

/// The keys that are read, apart from those of joints and weights.
static KEYS: LazyLock<HashSet<&str>> = LazyLock::new(|| {
    "accessors asset attributes baseColorFactor buffer bufferView bufferViews buffers byteLength byteOffset byteStride \
    children componentType count indices inverseBindMatrices joints material materials matrix mesh meshes mode name nodes \
    normalized pbrMetallicRoughness primitives rotation scale scene scenes skin skins sparse targets translation type uri \
    values version NORMAL POSITION"
        .split_whitespace()
        .collect()
});

/// The keys of objects; serde takes a list for an object as well.
const OBJECTS: [&str; 5] = ["asset", "indices", "pbrMetallicRoughness", "sparse", "values"];

/// The keys of numbers that may be 2^32 or more. Indices may not: the crate would cut them off.
const LARGE: [&str; 8] =
    ["baseColorFactor", "byteLength", "byteOffset", "count", "matrix", "rotation", "scale", "translation"];

/// By nodes, the accessors of translations, rotations and scales of the instances of their meshes.
pub(super) type Instances = HashMap<usize, [Option<usize>; 3]>;

pub(super) struct Document {
    /// All indices are in range; accessors are not checked against their buffers.
    pub root: Root,
    pub instances: Instances,
    /// Whether each material has a texture.
    pub textured: Vec<bool>,
    /// About extensions.
    pub notes: Notes,
}

/// The document in a file, and where its binary chunk lies, if there is one.
pub(super) fn parse(bytes: &[u8]) -> Result<(Document, Option<Range<usize>>), Fault> {
    let (text, chunk) = if bytes.starts_with(b"glTF") { chunks(bytes)? } else { (plain(bytes)?, None) };
    check_size(text, bytes.len())?;
    let mut value: Value = serde_json::from_slice(text).map_err(|error| no_gltf(&message(&error)))?;
    // Other versions and extensions first: they explain what is wrong with the rest.
    check_version(&value)?;
    let mut notes = Notes::default();
    extensions::check(&value, &mut notes)?;

    let list = |key: &str| value.get(key).and_then(Value::as_array).into_iter().flatten();
    let textured = list("materials").map(is_textured).collect();
    let mut instances = HashMap::new();
    for (number, node) in list("nodes").enumerate() {
        let accessors = extensions::instances(node);
        if accessors.iter().any(Option::is_some) {
            instances
                .insert(number, accessors.map(|accessor| Some(accessor?.as_u64().map_or(usize::MAX, |n| n as usize))));
        }
    }
    // The crate wants this list, which is optional.
    for scene in value.get_mut("scenes").and_then(Value::as_array_mut).into_iter().flatten() {
        if let Value::Object(scene) = scene {
            scene.entry("nodes").or_insert_with(|| Value::Array(Vec::new()));
        }
    }
    prune("", &mut value).map_err(|(place, problem)| Fault::part(place.trim_start_matches('.'), problem))?;
    let root = serde_path_to_error::deserialize(value)
        .map_err(|error| Fault::part(error.path().to_string(), message(error.inner())))?;
    validate(&root)?;
    Ok((Document { root, instances, textured, notes }, chunk))
}

/// Cuts out what is not read. An error is the place in the value, and the problem there.
fn prune(key: &str, value: &mut Value) -> Result<(), (String, String)> {
    let problem = match value {
        Value::Object(members) => {
            let is_skin = |key: &str| key.starts_with("JOINTS_") || key.starts_with("WEIGHTS_");
            members.retain(|key, _| KEYS.contains(&key.as_str()) || is_skin(key));
            return members.iter_mut().try_for_each(|(key, value)| {
                prune(key, value).map_err(|(below, problem)| (format!(".{key}{below}"), problem))
            });
        }
        Value::Array(list) if OBJECTS.contains(&key) || list.iter().any(Value::is_array) => {
            "a list stands where glTF has none".to_owned()
        }
        Value::Array(list) => {
            return list.iter_mut().enumerate().try_for_each(|(i, value)| {
                prune(key, value).map_err(|(below, problem)| (format!("[{i}]{below}"), problem))
            });
        }
        Value::Number(index) if index.as_u64() > Some(u32::MAX.into()) && !LARGE.contains(&key) => {
            format!("index {index} is out of bounds")
        }
        _ => return Ok(()),
    };
    Err((String::new(), problem + ": export the file again"))
}

/// Checks the indices, types and modes of a document.
fn validate(root: &Root) -> Result<(), Fault> {
    // The crate panics at an accessor of positions that is out of bounds.
    for (m, mesh) in root.meshes.iter().enumerate() {
        for (p, primitive) in mesh.primitives.iter().enumerate() {
            if let Some(index) = primitive.attributes.values().find(|accessor| root.get(**accessor).is_none()) {
                let problem = format!("index {index} is out of bounds: export the file again");
                return Err(Fault::part(format!("meshes[{m}].primitives[{p}].attributes"), problem));
            }
        }
    }
    let mut fault = None;
    root.validate(root, Path::new, &mut |path, error| {
        // What is missing is optional, or not read. Strides are checked with the accessors.
        if fault.is_none() && error != Error::Missing && !path().as_str().ends_with("byteStride") {
            let problem = format!("{}: export the file again", error.to_string().to_lowercase());
            fault = Some(Fault::part(path().0, problem));
        }
    });
    fault.map_or(Ok(()), Err)
}

fn is_textured(material: &Value) -> bool {
    let parts = [Some(material), material.get("pbrMetallicRoughness")];
    let mut members = parts.into_iter().flatten().filter_map(Value::as_object).flatten();
    members.any(|(key, value)| key.ends_with("Texture") && !value.is_null())
}

fn check_version(document: &Value) -> Result<(), Fault> {
    let asset = document.get("asset").ok_or_else(|| no_gltf("it has no `asset`"))?;
    let version = |key: &str| asset.get(key).and_then(Value::as_str);
    match (version("minVersion"), version("version")) {
        (Some(least), _) if least != "2.0" => Err(Fault::part(
            "asset",
            format!("it needs glTF {}, and 2.0 is read here: export it as that", quoted(least)),
        )),
        (_, Some(version)) if version.split('.').next() != Some("2") => {
            Err(Fault::part("asset", format!("it is glTF {}: convert it to 2.0", quoted(version))))
        }
        _ => Ok(()),
    }
}

fn no_gltf(problem: &str) -> Fault {
    Fault::file(format!("it is no glTF 2.0 file: {problem}"))
}

/// The text of a binary file, and where its binary chunk lies. Further chunks are ignored, as the format has it.
fn chunks(bytes: &[u8]) -> Result<(&[u8], Option<Range<usize>>), Fault> {
    let word = |at: usize| bytes.get(at..at + 4).map(|b| u32::from_le_bytes([b[0], b[1], b[2], b[3]]) as usize);
    let length = match (word(4), word(8)) {
        (Some(2), Some(length)) if length > bytes.len() => {
            let found = bytes.len();
            let problem = format!("the header tells of {length} bytes, there are {found}: the file is truncated");
            return Err(Fault::file(problem));
        }
        (Some(2), Some(length)) => length,
        (Some(version), _) => return Err(Fault::file(format!("it is binary glTF {version}: convert it to 2"))),
        _ => return Err(Fault::file("it ends within its header: the file is truncated")),
    };
    let chunk = |start: usize, kind: &[u8; 4]| {
        let data = start + 8..(start + 8).checked_add(word(start)?)?;
        (bytes.get(start + 4..start + 8)? == kind && data.end <= length).then_some(data)
    };
    let text = chunk(12, b"JSON").ok_or_else(|| no_gltf("its first chunk is no whole JSON chunk"))?;
    let binary = chunk(text.end, b"BIN\0");
    Ok((&bytes[text], binary))
}

/// Checks the number of objects in a document against the size of its file; those in strings count as well.
fn check_size(text: &[u8], bytes: usize) -> Result<(), Fault> {
    let count = |bytes: &[u8]| text.iter().filter(|byte| bytes.contains(byte)).count();
    let (objects, entries) = (count(b"{"), count(b",["));
    let most = MOST_OBJECTS + bytes / BYTES_AN_OBJECT;
    for (count, most, what) in [(objects, most, "objects"), (entries, ENTRIES_AN_OBJECT * most, "entries")] {
        if count > most {
            let problem =
                format!("its text describes {count} {what}, and more than {most} are not read: split the file");
            return Err(Fault::file(problem));
        }
    }
    Ok(())
}
