//! The document of a glTF file and its buffers, past the places where the gltf crate would panic.

use std::fs;
use std::path::Path;

use gltf::buffer::{Data, Source};
use gltf::json::validation::{Error, Validate};
use gltf::json::{Root, mesh::Semantic, validation::Checked};
use gltf::{Buffer, Document, Gltf};

use crate::scene::load::error::{Fault, quoted};

pub(super) fn open(bytes: &[u8], folder: &Path) -> Result<(Document, Vec<Data>), Fault> {
    let bytes = if bytes.starts_with(b"glTF") { check_binary(bytes)? } else { bytes };
    let gltf = Gltf::from_slice_without_validation(bytes)
        .map_err(|error| Fault::file(format!("it is no glTF 2.0 file: {}", quoted(&error.to_string()))))?;
    validate(gltf.document.as_json())?;

    let mut blob = gltf.blob;
    let buffers = gltf.document.buffers().map(|buffer| {
        let number = buffer.index();
        read_buffer(&buffer, folder, &mut blob).map_err(|problem| Fault::part(format!("buffer {number}"), problem))
    });
    let buffers = buffers.collect::<Result<_, _>>()?;
    Ok((gltf.document, buffers))
}

/// The part of a binary file that its header speaks of. The crate subtracts from the length there unseen.
fn check_binary(bytes: &[u8]) -> Result<&[u8], Fault> {
    let word = |at: usize| bytes.get(at..at + 4).map(|b| u32::from_le_bytes([b[0], b[1], b[2], b[3]]) as usize);
    match (word(4), word(8)) {
        (Some(2), Some(length)) if length >= 12 => bytes.get(..length).ok_or_else(|| {
            let problem =
                format!("the header tells of {length} bytes, there are {}: the file is truncated", bytes.len());
            Fault::file(problem)
        }),
        (Some(2), Some(length)) => Err(Fault::file(format!("the header tells of a length of {length} bytes"))),
        (Some(version), Some(_)) => Err(Fault::file(format!("it is binary glTF {version}: convert it to 2"))),
        _ => Err(Fault::file("it ends within its header: the file is truncated")),
    }
}

fn validate(root: &Root) -> Result<(), Fault> {
    if !root.extensions_required.is_empty() {
        let names: Vec<_> = root.extensions_required.iter().map(|name| quoted(name)).collect();
        let problem = format!("it requires {}, not supported here: export it without", names.join(", "));
        return Err(Fault::file(problem));
    }
    // The crate's own check of a primitive takes this index on trust.
    for (mesh, primitive) in
        root.meshes.iter().enumerate().flat_map(|(m, mesh)| mesh.primitives.iter().map(move |p| (m, p)))
    {
        let positions = primitive.attributes.get(&Checked::Valid(Semantic::Positions));
        if let Some(index) = positions.filter(|index| index.value() >= root.accessors.len()) {
            let problem = format!("its POSITION is accessor {}, but there are {}", index.value(), root.accessors.len());
            return Err(Fault::part(format!("mesh {mesh}"), problem));
        }
    }

    let mut first = None;
    root.validate(root, Default::default, &mut |path, error| {
        let path = path();
        if first.is_none() && !harmless(path.as_str(), &error) {
            first = Some((path.0, error));
        }
    });
    match first {
        None => Ok(()),
        Some((path, error)) => {
            Err(Fault::part(path, format!("{}: export the file again", error.to_string().to_lowercase())))
        }
    }
}

/// Attributes of an application's own, and the bounds of positions, which nobody here reads.
fn harmless(path: &str, error: &Error) -> bool {
    let bounds = path.ends_with("[\"POSITION\"].min") || path.ends_with("[\"POSITION\"].max");
    path.ends_with("<invalid semantic name>\"]") && *error == Error::Invalid || bounds
}

fn read_buffer(buffer: &Buffer, folder: &Path, blob: &mut Option<Vec<u8>>) -> Result<Data, String> {
    if let Source::Uri(uri) = buffer.source() {
        check_uri(uri, folder)?;
    } else if blob.is_none() {
        return Err("it has no URI and the file has no binary chunk for it: export the file again".to_owned());
    }
    let data = Data::from_source_and_blob(buffer.source(), Some(folder), blob)
        .map_err(|error| format!("it cannot be read: {}", quoted(&error.to_string())))?;
    if data.len() < buffer.length() {
        return Err(format!("it should have {} bytes and has {}: it is truncated", buffer.length(), data.len()));
    }
    Ok(data)
}

/// Admits base64 and files below or beside this one. The crate panics on escapes that are no UTF-8.
fn check_uri(uri: &str, folder: &Path) -> Result<(), String> {
    if let Some(data) = uri.strip_prefix("data:") {
        return if data.contains(";base64,") { Ok(()) } else { Err("its data URI is not in base64".to_owned()) };
    }
    if uri.contains(':') {
        return Err(format!("its URI {} is no relative path: put the buffer beside the file", quoted(uri)));
    }
    let name = unescape(uri).ok_or_else(|| format!("its URI {} is not in UTF-8", quoted(uri)))?;
    match fs::metadata(folder.join(&name)) {
        Ok(file) if file.is_file() => Ok(()),
        Ok(_) => Err(format!("{} is not a regular file", quoted(&name))),
        Err(cause) => Err(format!("its file {} cannot be read ({cause}): put it beside this one", quoted(&name))),
    }
}

/// The text with `%xx` replaced by the byte of that number.
fn unescape(uri: &str) -> Option<String> {
    let mut bytes = Vec::with_capacity(uri.len());
    let mut rest = uri.as_bytes();
    while let Some((&first, after)) = rest.split_first() {
        let hex = |b: &u8| char::from(*b).to_digit(16);
        let escaped = match (first, after) {
            (b'%', [high, low, ..]) => hex(high).zip(hex(low)).map(|(high, low)| (high * 16 + low) as u8),
            _ => None,
        };
        bytes.push(escaped.unwrap_or(first));
        rest = if escaped.is_some() { &after[2..] } else { after };
    }
    String::from_utf8(bytes).ok()
}
