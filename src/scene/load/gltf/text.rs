//! The text of a glTF document, alone or in a binary file.

use serde::Deserialize;

use super::document::Document;
use crate::scene::load::error::{Fault, message, quoted};
use crate::scene::load::text::plain;

/// The most objects in a small document: each takes some hundred bytes of memory, and may be as short as `{}`.
const MOST_OBJECTS: usize = 1 << 16;

/// So many bytes of the file allow for one more object.
const BYTES_AN_OBJECT: usize = 48;

/// The most entries of lists and objects, per object.
const ENTRIES_AN_OBJECT: usize = 12;

/// The document in a file, and the binary chunk, if there is one.
pub(super) fn parse(bytes: &[u8]) -> Result<(Document, Option<&[u8]>), Fault> {
    let (text, chunk) = if bytes.starts_with(b"glTF") { chunks(bytes)? } else { (plain(bytes)?, None) };
    check_text(text, bytes.len())?;
    check_version(text)?;
    let document: Document = serde_json::from_slice(text).map_err(|error| no_gltf(&message(&error)))?;
    document.check()?;
    Ok((document, chunk))
}

/// The part of a document that all versions share.
#[derive(Deserialize)]
struct Versioned {
    asset: Asset,
}

#[derive(Deserialize)]
#[serde(rename_all = "camelCase")]
struct Asset {
    version: Option<String>,
    min_version: Option<String>,
}

/// Checks the version first: other versions have objects instead of lists, and the parser's error would mislead.
fn check_version(text: &[u8]) -> Result<(), Fault> {
    let Ok(Versioned { asset }) = serde_json::from_slice(text) else { return Ok(()) };
    let is_read = |version: &str| version.split('.').next() == Some("2");
    match asset {
        Asset { min_version: Some(least), .. } if least != "2.0" => Err(Fault::part(
            "asset",
            format!("it needs glTF {}, and 2.0 is read here: export it as that", quoted(least)),
        )),
        Asset { version: Some(version), .. } if !is_read(&version) => {
            Err(Fault::part("asset", format!("it is glTF {}: convert it to 2.0", quoted(version))))
        }
        _ => Ok(()),
    }
}

fn no_gltf(problem: &str) -> Fault {
    Fault::file(format!("it is no glTF 2.0 file: {problem}"))
}

fn chunks(bytes: &[u8]) -> Result<(&[u8], Option<&[u8]>), Fault> {
    let word = |at: usize| bytes.get(at..at + 4).map(|b| u32::from_le_bytes([b[0], b[1], b[2], b[3]]) as usize);
    let end = match (word(4), word(8)) {
        (Some(2), Some(length)) if length > bytes.len() => {
            let problem =
                format!("the header tells of {length} bytes, there are {}: the file is truncated", bytes.len());
            return Err(Fault::file(problem));
        }
        (Some(2), Some(length)) if length >= 12 => length,
        (Some(2), Some(length)) => return Err(Fault::file(format!("the header tells of a length of {length} bytes"))),
        (Some(version), Some(_)) => {
            return Err(Fault::file(format!("it is binary glTF {version}: convert it to 2")));
        }
        _ => return Err(Fault::file("it ends within its header: the file is truncated")),
    };
    let mut rest = &bytes[12..end];
    let text = chunk(&mut rest, b"JSON").ok_or_else(|| no_gltf("its first chunk is no whole JSON chunk"))?;
    Ok((text, chunk(&mut rest, b"BIN\0")))
}

/// Takes the next chunk off `rest`, if it is complete and of this kind.
fn chunk<'a>(rest: &mut &'a [u8], kind: &[u8; 4]) -> Option<&'a [u8]> {
    let length = u32::from_le_bytes(rest.get(..4)?.try_into().ok()?) as usize;
    let (data, after) = rest.get(8..)?.split_at_checked(length).filter(|_| rest[4..8] == *kind)?;
    *rest = after;
    Some(data)
}

/// Checks the number of objects in a document against the size of its file.
fn check_text(text: &[u8], bytes: usize) -> Result<(), Fault> {
    let (mut objects, mut entries, mut in_string, mut is_escaped) = (0_usize, 0_usize, false, false);
    for &byte in text {
        match byte {
            _ if is_escaped => is_escaped = false,
            b'\\' => is_escaped = in_string,
            b'"' => in_string = !in_string,
            b'{' if !in_string => objects += 1,
            b',' if !in_string => entries += 1,
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
