//! Parses the JSON of a glTF document.
//!
//! The crate `gltf` rejects some valid files because of parts that the loader does not use. This module removes unused
//! parts before the crate `gltf` parses the document.

use std::borrow::Cow;
use std::collections::HashMap;
use std::ops::Range;

use gltf::json::validation::{Error, Validate as _};
use gltf::json::{Path, Root};
use serde::de::DeserializeOwned;
use serde_json::value::RawValue;
use serde_json::{Value, json};

use super::extensions;
use crate::scene::load::error::{Fault, quoted};
use crate::scene::load::notes::Notes;
use crate::scene::load::text::{is_among, without_byte_order_mark};

/// Even a small document may have this number of objects. An empty object takes hundreds of bytes of memory.
const MOST_OBJECTS: usize = 1 << 16;

/// A document may have one more object for each `BYTES_AN_OBJECT` bytes of the file.
const BYTES_AN_OBJECT: usize = 48;

/// `check_size` permits this number of list and object entries for each permitted object.
const ENTRIES_AN_OBJECT: usize = 12;

/// The keys that `prune` keeps.
const KEYS: &str = "attributes baseColorFactor buffer bufferView byteLength byteOffset byteStride children componentType \
    count indices inverseBindMatrices joints material matrix mesh mode name nodes normalized pbrMetallicRoughness \
    primitives rotation scale skin sparse targets translation type uri values NORMAL POSITION";

/// The keys of numbers that may be 2^32 or more.
const LARGE: &str = "baseColorFactor byteLength byteOffset count matrix rotation scale translation";

pub(super) struct Document {
    /// All references between objects are valid. The accessors are not checked against the buffers.
    pub root: Root,
    /// For each node, the accessors of the translations, rotations and scales of instances.
    pub instances: Vec<[Option<usize>; 3]>,
    pub textured: Vec<bool>,
    pub notes: Notes,
}

/// The range locates the binary chunk in `bytes`.
pub(super) fn parse(bytes: &[u8]) -> Result<(Document, Option<Range<usize>>), Fault> {
    let (text, chunk) =
        if bytes.starts_with(b"glTF") { chunks(bytes)? } else { (without_byte_order_mark(bytes)?, None) };
    check_size(text, bytes.len())?;
    if !text.trim_ascii_start().starts_with(b"{") {
        return Err(no_gltf("it is not a JSON object"));
    }
    let broken = |error: serde_json::Error| no_gltf(&error.to_string());
    let members: Members = serde_json::from_slice(text).map_err(broken)?;
    // Check the version first, because an unsupported version also causes later errors.
    check_version(&value(&members, "asset")?)?;
    let mut notes = Notes::default();
    let [required, used] = ["extensionsRequired", "extensionsUsed"].map(|key| value(&members, key));
    extensions::check(&required?, &used?, &mut notes)?;

    let nodes = members.get("nodes").map(|nodes| nodes.get()).filter(|nodes| *nodes != "null").unwrap_or("[]");
    let texts: Vec<&RawValue> = serde_json::from_str(nodes).map_err(broken)?;
    let (mut nodes, mut instances) = (vec![], vec![]);
    for (number, text) in texts.into_iter().enumerate() {
        let place = format!("nodes[{number}]");
        let node = serde_json::from_str(text.get()).map_err(|error| Fault::part(&place, error.to_string()))?;
        instances.push(extensions::instances(&node));
        nodes.push(typed(&place, node)?);
    }
    // The crate `gltf` requires the list of nodes of a scene.
    let mut scenes = value(&members, "scenes")?;
    for scene in scenes.as_array_mut().into_iter().flatten().filter_map(Value::as_object_mut) {
        scene.entry("nodes").or_insert_with(|| json!([]));
    }
    let materials = value(&members, "materials")?;
    let textured = materials.as_array().into_iter().flatten().map(is_textured).collect();
    let root = Root {
        scene: typed("scene", value(&members, "scene")?)?,
        scenes: typed_list("scenes", scenes)?,
        nodes,
        materials: typed_list("materials", materials)?,
        skins: typed_list("skins", value(&members, "skins")?)?,
        meshes: typed_list("meshes", value(&members, "meshes")?)?,
        accessors: typed_list("accessors", value(&members, "accessors")?)?,
        buffer_views: typed_list("bufferViews", value(&members, "bufferViews")?)?,
        buffers: typed_list("buffers", value(&members, "buffers")?)?,
        ..Root::default()
    };
    for (m, mesh) in root.meshes.iter().enumerate() {
        for (p, primitive) in mesh.primitives.iter().enumerate() {
            // `Root::validate` panics on positions whose accessor does not exist.
            if let Some(index) = primitive.attributes.values().find(|index| index.value() >= root.accessors.len()) {
                let problem = format!("index {index} is out of bounds: export the file again");
                return Err(Fault::part(format!("meshes[{m}].primitives[{p}].attributes"), problem));
            }
        }
    }
    validate(&root)?;
    Ok((Document { root, instances, textured, notes }, chunk))
}

/// The members stay text, because a parsed value takes more memory.
type Members<'a> = HashMap<Cow<'a, str>, &'a RawValue>;

fn value(members: &Members, key: &str) -> Result<Value, Fault> {
    let read = |text: &&RawValue| serde_json::from_str(text.get());
    let value = members.get(key).map_or(Ok(Value::Null), read);
    value.map_err(|error| Fault::part(key, error.to_string()))
}

fn typed_list<T: DeserializeOwned>(key: &str, list: Value) -> Result<Vec<T>, Fault> {
    if list.is_null() { Ok(vec![]) } else { typed(key, list) }
}

fn typed<T: DeserializeOwned>(place: &str, mut value: Value) -> Result<T, Fault> {
    prune("", &mut value).map_err(|problem| Fault::part(place, problem))?;
    serde_path_to_error::deserialize(value).map_err(|error| {
        let place = format!("{place}.{}", error.path()).replace(".[", "[");
        Fault::part(place.trim_end_matches('.'), error.inner().to_string())
    })
}

/// Indices of 2^32 or more become `u32::MAX`, which is out of bounds. The crate `gltf` would truncate them. A
/// nested list is an error, because serde would read the inner list as an object.
fn prune(key: &str, value: &mut Value) -> Result<(), &'static str> {
    match value {
        Value::Object(members) => {
            members.retain(|key, _| is_among(KEYS, key.as_bytes()));
            return members.iter_mut().try_for_each(|(key, value)| prune(key, value));
        }
        Value::Array(list) if list.iter().any(Value::is_array) => return Err("unexpected list: export the file again"),
        Value::Array(list) => return list.iter_mut().try_for_each(|value| prune(key, value)),
        Value::Number(number) if number.as_u64() > Some(u32::MAX.into()) && !is_among(LARGE, key.as_bytes()) => {
            *value = u32::MAX.into();
        }
        _ => {}
    }
    Ok(())
}

fn validate(root: &Root) -> Result<(), Fault> {
    let mut fault = None;
    root.validate(root, Path::new, &mut |path, error| {
        // The loader needs no key that `Root::validate` reports as missing. `Accessors` checks strides.
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

fn check_version(asset: &Value) -> Result<(), Fault> {
    let version = |key: &str| asset.get(key).and_then(Value::as_str);
    let problem = match (version("minVersion"), version("version")) {
        (Some(least), _) if least != "2.0" => {
            format!("it needs glTF {}, but sahara supports 2.0: export it as 2.0", quoted(least))
        }
        (_, Some(version)) if version.split('.').next() == Some("2") => return Ok(()),
        (_, Some(version)) => format!("it is glTF {}: convert it to 2.0", quoted(version)),
        (_, None) => return Err(no_gltf("it has no `asset` with a version")),
    };
    Err(Fault::part("asset", problem))
}

fn no_gltf(problem: &str) -> Fault {
    Fault::file(format!("it is not a glTF 2.0 file: {problem}"))
}

/// The format requires readers to ignore chunks of unknown types.
fn chunks(bytes: &[u8]) -> Result<(&[u8], Option<Range<usize>>), Fault> {
    let word = |at: usize| bytes.get(at..at + 4).map(|b| u32::from_le_bytes([b[0], b[1], b[2], b[3]]) as usize);
    let length = match (word(4), word(8)) {
        (Some(2), Some(length)) if length > bytes.len() => {
            let found = bytes.len();
            let problem = format!("the header states {length} bytes, but there are {found}: the file is truncated");
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
    let text = chunk(12, b"JSON").ok_or_else(|| no_gltf("its first chunk is not a complete JSON chunk"))?;
    let binary = chunk(text.end, b"BIN\0");
    Ok((&bytes[text], binary))
}

/// Braces, brackets and commas count even within strings.
fn check_size(text: &[u8], bytes: usize) -> Result<(), Fault> {
    let count = |bytes: &[u8]| text.iter().filter(|byte| bytes.contains(byte)).count();
    let (objects, entries) = (count(b"{"), count(b",["));
    let most = MOST_OBJECTS + bytes / BYTES_AN_OBJECT;
    for (count, most, what) in [(objects, most, "objects"), (entries, ENTRIES_AN_OBJECT * most, "entries")] {
        if count > most {
            let problem = format!("its text describes {count} {what}, but the limit is {most}: split the file");
            return Err(Fault::file(problem));
        }
    }
    Ok(())
}
