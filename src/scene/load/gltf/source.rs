//! The document of a glTF file and its buffers, past the places where the gltf crate would panic.

use std::collections::HashMap;
use std::fs::{self, File};
use std::io::Read;
use std::path::{Path, PathBuf};
use std::rc::Rc;

use gltf::Document;
use gltf::binary::Glb;
use gltf::json::validation::{Error, Validate};
use gltf::json::{Root, mesh::Semantic, validation::Checked};

use crate::scene::load::below;
use crate::scene::load::error::{Fault, message, quoted};
use crate::scene::load::text::{number, plain};

/// The bytes of a buffer; buffers of one file share them.
pub(super) type Data = Rc<Vec<u8>>;

/// A document, its buffers, and how many bytes they and the document take.
pub(super) struct Source {
    pub document: Document,
    pub buffers: Vec<Data>,
    pub bytes: usize,
}

pub(super) fn open(bytes: Vec<u8>, folder: &Path) -> Result<Source, Fault> {
    let size = bytes.len();
    let (mut root, blob) = parse(&bytes)?;
    // A document keeps what it needs of its text.
    drop(bytes);
    validate(&root)?;

    let buffers = read_buffers(&mut root, blob, folder)?;
    let mut distinct: Vec<&Data> = buffers.iter().collect();
    distinct.sort_by_key(|data| Rc::as_ptr(data));
    distinct.dedup_by(|a, b| Rc::ptr_eq(a, b));
    let bytes = distinct.iter().map(|data| data.len()).sum::<usize>() + size;
    Ok(Source { document: Document::from_json_without_validation(root), buffers, bytes })
}

/// The document and the binary chunk, if there is one.
fn parse(bytes: &[u8]) -> Result<(Root, Option<Vec<u8>>), Fault> {
    let no_gltf = |error: String| Fault::file(format!("it is no glTF 2.0 file: {error}"));
    let (text, chunk) = if bytes.starts_with(b"glTF") {
        let glb = Glb::from_slice(check_binary(bytes)?).map_err(|error| no_gltf(message(error)))?;
        (glb.json, glb.bin)
    } else {
        (plain(bytes)?.into(), None)
    };
    check_text(&text, bytes.len())?;
    let root = Root::from_slice(&text).map_err(|error| match message(&error) {
        // Both are left out in valid files.
        missing if missing.contains("missing field `nodes`") => {
            let problem = "a scene has no `nodes`, so that it shows nothing: give it nodes, or remove it";
            Fault::line(error.line(), problem)
        }
        other => no_gltf(other),
    })?;
    Ok((root, chunk.map(|chunk| chunk.into_owned())))
}

/// A document takes some hundred bytes for each object in its text, which may be as short as `{}`.
const MOST_OBJECTS: usize = 1 << 16;

/// Bytes of the file that allow for one more object.
const BYTES_AN_OBJECT: usize = 48;

/// Entries of lists and objects that each object allows for.
const ENTRIES_AN_OBJECT: usize = 12;

/// What is followed by indices, of which the crate keeps the lower 32 bits.
const INDICES: [&[u8]; 10] = [
    b"scene",
    b"nodes",
    b"children",
    b"mesh",
    b"POSITION",
    b"NORMAL",
    b"indices",
    b"material",
    b"bufferView",
    b"buffer",
];

/// Whether a document of this text in a file of so many bytes can be read: before memory is taken for it.
fn check_text(text: &[u8], bytes: usize) -> Result<(), Fault> {
    let (mut objects, mut entries) = (0_usize, 0_usize);
    let (mut at, mut last_string) = (0, &text[..0]);
    while let Some(&byte) = text.get(at) {
        let start = at;
        at += 1;
        match byte {
            b'{' => objects += 1,
            b',' => entries += 1,
            b'"' => {
                // What is escaped does not end it.
                while text.get(at).is_some_and(|&b| b != b'"') {
                    at += if text[at] == b'\\' { 2 } else { 1 };
                }
                last_string = text.get(start + 1..at).unwrap_or_default();
                at += 1;
            }
            b'0'..=b'9' => {
                at += text[at..].iter().take_while(|b| b.is_ascii_digit()).count();
                let digits = &text[start..at];
                if digits.len() > 9 && number::<u32>(digits).is_none() && INDICES.contains(&last_string) {
                    let problem =
                        format!("it names {} as {}, more than there can be", quoted(digits), quoted(last_string));
                    return Err(Fault::file(problem));
                }
            }
            _ => {}
        }
    }
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
        let names: Vec<_> = root.extensions_required.iter().map(quoted).collect();
        let problem = format!("it requires {}, not supported here: export it without", names.join(", "));
        return Err(Fault::file(problem));
    }
    let scenes = root.scenes.len();
    if let Some(scene) = root.scene.filter(|scene| scene.value() >= scenes) {
        return Err(Fault::part("scene", format!("it names scene {scene}, but the file has {scenes} scenes")));
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

/// Reads what the buffers name, each file once. What is embedded is taken out of the document.
fn read_buffers(root: &mut Root, mut chunk: Option<Vec<u8>>, folder: &Path) -> Result<Vec<Data>, Fault> {
    let fault = |number: usize| move |problem: String| Fault::part(format!("buffer {number}"), problem);
    let mut files: Vec<Option<PathBuf>> = vec![None; root.buffers.len()];
    // Of a file, no more is read than the longest buffer in it.
    let mut longest: HashMap<PathBuf, u64> = HashMap::new();
    for (number, buffer) in root.buffers.iter().enumerate() {
        if let Some(uri) = buffer.uri.as_deref().filter(|uri| !uri.starts_with("data:")) {
            let path = file(uri, folder).map_err(fault(number))?;
            let length = longest.entry(path.clone()).or_default();
            *length = buffer.byte_length.0.max(*length);
            files[number] = Some(path);
        }
    }

    let mut read: HashMap<PathBuf, Data> = HashMap::new();
    let mut buffers = Vec::with_capacity(files.len());
    for (number, (buffer, path)) in root.buffers.iter_mut().zip(files).enumerate() {
        let data = match (buffer.uri.take(), path) {
            (_, Some(path)) => match read.get(&path) {
                Some(data) => Rc::clone(data),
                None => {
                    let data = read_start(&path, longest[&path]).map_err(fault(number))?;
                    read.insert(path, Rc::clone(&data));
                    data
                }
            },
            (Some(uri), None) => Rc::new(embedded(&uri).map_err(fault(number))?),
            (None, None) if number > 0 => {
                return Err(fault(number)("it has no URI, and only buffer 0 may lie in a binary chunk".to_owned()));
            }
            (None, None) => {
                let none = "it has no URI and the file has no binary chunk for it: export the file again";
                Rc::new(chunk.take().ok_or_else(|| fault(number)(none.to_owned()))?)
            }
        };
        if (data.len() as u64) < buffer.byte_length.0 {
            let (owed, found) = (buffer.byte_length.0, data.len());
            return Err(fault(number)(format!("it should have {owed} bytes and has {found}: it is truncated")));
        }
        buffers.push(data);
    }
    Ok(buffers)
}

/// The bytes of a data URI.
fn embedded(uri: &str) -> Result<Vec<u8>, String> {
    let (_, data) = uri.split_once(";base64,").ok_or("its data URI is not in base64")?;
    base64::decode(data).map_err(|error| format!("its data URI cannot be read: {}", message(error)))
}

fn read_start(path: &Path, length: u64) -> Result<Data, String> {
    let mut data = Vec::new();
    File::open(path)
        .and_then(|file| {
            data.reserve_exact(file.metadata()?.len().min(length) as usize);
            file.take(length).read_to_end(&mut data)
        })
        .map_err(|cause| format!("its file {} cannot be read ({cause})", quoted(path.to_string_lossy().as_bytes())))?;
    Ok(Rc::new(data))
}

/// The file that a URI names, which is below this one's folder, by the one path that all its names lead to.
fn file(uri: &str, folder: &Path) -> Result<PathBuf, String> {
    if uri.contains(':') {
        return Err(format!("its URI {} is no relative path: put the buffer beside the file", quoted(uri)));
    }
    let name = unescape(uri).ok_or_else(|| format!("its URI {} is not in UTF-8", quoted(uri)))?;
    let outside = || format!("its file {} is not below the folder of this one: put it there", quoted(&name));
    let path = below(folder, &name).ok_or_else(outside)?;
    match fs::metadata(&path) {
        Ok(file) if file.is_file() => Ok(fs::canonicalize(&path).unwrap_or(path)),
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
