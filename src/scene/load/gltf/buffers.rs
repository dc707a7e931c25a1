//! The buffers of a glTF file.

use std::collections::HashMap;
use std::fs::{self, File};
use std::io::Read;
use std::path::{Path, PathBuf};
use std::rc::Rc;

use super::document::Buffer;
use crate::scene::load::below;
use crate::scene::load::error::{Fault, message, quoted};

/// The bytes of a buffer; buffers of one file share them.
pub(super) type Bytes = Rc<Vec<u8>>;

pub(super) fn size(buffers: &[Bytes]) -> usize {
    let mut distinct: Vec<&Bytes> = buffers.iter().collect();
    distinct.sort_by_key(|data| Rc::as_ptr(data));
    distinct.dedup_by(|a, b| Rc::ptr_eq(a, b));
    distinct.iter().map(|data| data.len()).sum()
}

/// Reads the files of the buffers, each once, and takes embedded data out of the document.
pub(super) fn read(list: &mut [Buffer], mut chunk: Option<Vec<u8>>, folder: &Path) -> Result<Vec<Bytes>, Fault> {
    let fault = |number: usize| move |problem: String| Fault::part(format!("buffer {number}"), problem);
    let mut files: Vec<Option<PathBuf>> = vec![None; list.len()];
    // Read no more of a file than its longest buffer needs.
    let mut longest: HashMap<PathBuf, u64> = HashMap::new();
    for (number, buffer) in list.iter().enumerate() {
        if let Some(uri) = buffer.uri.as_deref().filter(|uri| !uri.starts_with("data:")) {
            let path = file(uri, folder).map_err(fault(number))?;
            let length = longest.entry(path.clone()).or_default();
            *length = buffer.byte_length.max(*length);
            files[number] = Some(path);
        }
    }

    let mut read: HashMap<PathBuf, Bytes> = HashMap::new();
    let mut buffers = Vec::with_capacity(files.len());
    for (number, (buffer, path)) in list.iter_mut().zip(files).enumerate() {
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
        if (data.len() as u64) < buffer.byte_length {
            let (owed, found) = (buffer.byte_length, data.len());
            return Err(fault(number)(format!("it should have {owed} bytes and has {found}: it is truncated")));
        }
        buffers.push(data);
    }
    Ok(buffers)
}

fn embedded(uri: &str) -> Result<Vec<u8>, String> {
    let (_, data) = uri.split_once(";base64,").ok_or("its data URI is not in base64")?;
    base64::decode(data).map_err(|error| format!("its data URI cannot be read: {}", message(error)))
}

fn read_start(path: &Path, length: u64) -> Result<Bytes, String> {
    let mut data = Vec::new();
    File::open(path)
        .and_then(|file| {
            data.reserve_exact(file.metadata()?.len().min(length) as usize);
            file.take(length).read_to_end(&mut data)
        })
        .map_err(|cause| format!("its file {} cannot be read ({cause})", quoted(path.to_string_lossy().as_bytes())))?;
    Ok(Rc::new(data))
}

/// The canonical path of the file that a URI names; the file must be below this one's folder.
fn file(uri: &str, folder: &Path) -> Result<PathBuf, String> {
    if uri.is_empty() {
        return Err("its URI is empty: name the file of the buffer".into());
    }
    if uri.contains(':') {
        return Err(format!("its URI {} is no relative path: put the buffer beside the file", quoted(uri)));
    }
    let name = unescape(uri).ok_or_else(|| format!("its URI {} is not in UTF-8", quoted(uri)))?;
    let outside = || format!("its file {} is not below the folder of this one: put it there", quoted(&name));
    let path = below(folder, &name).ok_or_else(outside)?;
    match fs::metadata(&path) {
        Ok(file) if file.is_file() => Ok(fs::canonicalize(&path).unwrap_or(path)),
        Ok(_) => Err(format!("its file {} is not a regular file: name the file of the buffer", quoted(&name))),
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
