//! The buffers of a glTF file.

use std::collections::HashMap;
use std::path::{Path, PathBuf};
use std::rc::Rc;

use gltf::json::Buffer;
use percent_encoding::percent_decode_str;

use crate::scene::load::error::{Fault, quoted};
use crate::scene::load::files::{named_below, read_start};

/// The bytes of a buffer. Buffers with the same path share one `Rc`.
pub(super) type Bytes = Rc<Vec<u8>>;

pub(super) fn size(buffers: &[Bytes]) -> usize {
    let distinct: HashMap<_, _> = buffers.iter().map(|data| (Rc::as_ptr(data), data.len())).collect();
    distinct.values().sum()
}

pub(super) fn read(list: &mut [Buffer], mut chunk: Option<Vec<u8>>, folder: &Path) -> Result<Vec<Bytes>, Fault> {
    let longest = list.iter().map(|buffer| buffer.byte_length.0).max().unwrap_or(0);
    let mut files: HashMap<PathBuf, Bytes> = HashMap::new();
    let mut read = |number: usize, uri: Option<String>| {
        let Some(uri) = uri else {
            let none =
                "it has no URI, which only buffer 0 of a file with a binary chunk may lack: export the file again";
            return chunk.take_if(|_| number == 0).map(Rc::new).ok_or_else(|| none.to_owned());
        };
        if uri.starts_with("data:") {
            return embedded(&uri).map(Rc::new);
        }
        if uri.contains(':') {
            return Err(format!("its URI {} is not a relative path: put the buffer next to the file", quoted(uri)));
        }
        let name: Vec<u8> = percent_decode_str(&uri).collect();
        let outside = || format!("its file {} is outside the folder of this file: move it there", quoted(&name));
        let path = named_below(folder, &name).ok_or_else(outside)?;
        if !files.contains_key(&path) {
            let unread =
                |cause| format!("its file {} cannot be read ({cause}): put it next to this file", quoted(&name));
            files.insert(path.clone(), Rc::new(read_start(&path, longest).map_err(unread)?));
        }
        Ok(Rc::clone(&files[&path]))
    };
    let mut buffers = Vec::new();
    for (number, buffer) in list.iter_mut().enumerate() {
        let fault = |problem: String| Fault::part(format!("buffer {number}"), problem);
        let data = read(number, buffer.uri.take()).map_err(fault)?;
        let (declared, found) = (buffer.byte_length.0, data.len());
        if (found as u64) < declared {
            return Err(fault(format!("it should have {declared} bytes but has {found}: it is truncated")));
        }
        buffers.push(data);
    }
    Ok(buffers)
}

fn embedded(uri: &str) -> Result<Vec<u8>, String> {
    let (_, data) = uri.split_once(";base64,").ok_or("its data URI is not base64")?;
    base64::decode(data).map_err(|error| format!("its data URI cannot be read: {}", error))
}
