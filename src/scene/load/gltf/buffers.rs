//! The buffers of a glTF file.

use std::collections::HashMap;
use std::collections::hash_map::Entry;
use std::fs::{self, File};
use std::io::Read;
use std::path::{Path, PathBuf};
use std::rc::Rc;

use gltf::json::Buffer;
use percent_encoding::percent_decode_str;

use crate::scene::load::below;
use crate::scene::load::error::{Fault, message, quoted};

/// The bytes of a buffer; buffers of one file share them.
pub(super) type Bytes = Rc<Vec<u8>>;

pub(super) fn size(buffers: &[Bytes]) -> usize {
    let distinct: HashMap<_, _> = buffers.iter().map(|data| (Rc::as_ptr(data), data.len())).collect();
    distinct.values().sum()
}

/// Reads the files of the buffers, each once, and takes embedded data out of the document.
pub(super) fn read(list: &mut [Buffer], mut chunk: Option<Vec<u8>>, folder: &Path) -> Result<Vec<Bytes>, Fault> {
    // No more is read of any file.
    let longest = list.iter().map(|buffer| buffer.byte_length.0).max().unwrap_or(0);
    let mut files: HashMap<PathBuf, Bytes> = HashMap::new();
    let mut read = |number: usize, uri: Option<String>| {
        Ok(match uri {
            Some(uri) if uri.starts_with("data:") => Rc::new(embedded(&uri)?),
            Some(uri) => match files.entry(file(&uri, folder)?) {
                Entry::Occupied(file) => Rc::clone(file.get()),
                Entry::Vacant(file) => {
                    let data = read_start(file.key(), longest)?;
                    Rc::clone(file.insert(Rc::new(data)))
                }
            },
            None if number > 0 => return Err("it has no URI, and only buffer 0 may lie in a binary chunk".to_owned()),
            None => {
                let none = "it has no URI and the file has no binary chunk for it: export the file again";
                Rc::new(chunk.take().ok_or(none)?)
            }
        })
    };
    let mut buffers = Vec::new();
    for (number, buffer) in list.iter_mut().enumerate() {
        let fault = |problem: String| Fault::part(format!("buffer {number}"), problem);
        let data = read(number, buffer.uri.take()).map_err(fault)?;
        let (owed, found) = (buffer.byte_length.0, data.len());
        if (found as u64) < owed {
            return Err(fault(format!("it should have {owed} bytes and has {found}: it is truncated")));
        }
        buffers.push(data);
    }
    Ok(buffers)
}

fn embedded(uri: &str) -> Result<Vec<u8>, String> {
    let (_, data) = uri.split_once(";base64,").ok_or("its data URI is not in base64")?;
    base64::decode(data).map_err(|error| format!("its data URI cannot be read: {}", message(error)))
}

fn read_start(path: &Path, length: u64) -> Result<Vec<u8>, String> {
    let mut data = Vec::new();
    File::open(path)
        .and_then(|file| {
            data.reserve_exact(file.metadata()?.len().min(length) as usize);
            file.take(length).read_to_end(&mut data)
        })
        .map_err(|cause| format!("its file {} cannot be read ({cause})", quoted(path.to_string_lossy().as_bytes())))?;
    Ok(data)
}

/// The canonical path of the file that a URI names; the file must be below this one's folder.
fn file(uri: &str, folder: &Path) -> Result<PathBuf, String> {
    if uri.is_empty() {
        return Err("its URI is empty: name the file of the buffer".into());
    }
    if uri.contains(':') {
        return Err(format!("its URI {} is no relative path: put the buffer beside the file", quoted(uri)));
    }
    let not_text = |_| format!("its URI {} is not in UTF-8", quoted(uri));
    let name = percent_decode_str(uri).decode_utf8().map_err(not_text)?;
    let shown = quoted(name.as_bytes());
    let outside = || format!("its file {shown} is not below the folder of this one: put it there");
    let path = below(folder, &*name).ok_or_else(outside)?;
    match fs::metadata(&path) {
        Ok(file) if file.is_file() => Ok(fs::canonicalize(&path).unwrap_or(path)),
        Ok(_) => Err(format!("its file {shown} is not a regular file: name the file of the buffer")),
        Err(cause) => Err(format!("its file {shown} cannot be read ({cause}): put it beside this one")),
    }
}
