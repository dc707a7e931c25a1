//! The header of a PLY file, read by ply-rs-bw after what it does not survive has been sorted out.

use ply_rs_bw::parser::Parser;
use ply_rs_bw::ply::{Header, PropertyType, ScalarType};

use super::row::Skipped;
use crate::scene::load::error::{Fault, message, quoted};
use crate::scene::load::text::plain;

/// Both names are in use for the corners of a face.
pub(super) const CORNERS: [&str; 2] = ["vertex_indices", "vertex_index"];

/// Counts of more digits are lies, and those of more than 19 make ply-rs-bw panic.
const LONGEST_NUMBER: usize = 15;

/// Longer headers are none.
const LONGEST_HEADER: usize = 1 << 20;

/// The header, the bytes after it, and the byte that ends a line.
pub(super) fn split(bytes: &[u8]) -> Result<(Header, &[u8], u8), Fault> {
    let bytes = plain(bytes)?;
    let mut rest = bytes;
    let mut text = String::new();
    let mut declared = [0; 2];
    let line_end = match bytes {
        [b'p', b'l', b'y', b'\r', next, ..] if *next != b'\n' => b'\r',
        _ => b'\n',
    };
    for number in 1.. {
        let header_left = &rest[..rest.len().min((LONGEST_HEADER + rest.len()).saturating_sub(bytes.len()))];
        let end = header_left.iter().position(|&b| b == line_end);
        if number == 1 && rest[..end.unwrap_or(rest.len().min(60))].trim_ascii_end() != b"ply" {
            return Err(Fault::line(1, "a PLY file begins with the line `ply`: this is another format"));
        }
        let Some(end) = end else {
            let problem = "the PLY header does not end with a line `end_header`: the file is truncated or no PLY file";
            return Err(Fault::line(number, problem));
        };
        let (line, after) = rest.split_at(end + 1);
        rest = after;
        // Comments may be in any encoding.
        let line = String::from_utf8_lossy(line.trim_ascii_end()) + "\n";
        check_line(&line).map_err(|problem| Fault::line(number, problem))?;
        declared[0] += usize::from(line.starts_with("element"));
        declared[1] += usize::from(line.starts_with("property"));
        text.push_str(&line);
        if line.trim_end() == "end_header" {
            break;
        }
    }

    let header = Parser::<Skipped>::new()
        .read_header(&mut text.as_bytes())
        .map_err(|error| Fault::file(format!("the PLY header is malformed: {}", message(error))))?;
    // ply-rs-bw keeps the last of several with one name, but the body has rows for all of them.
    let kept = [header.elements.len(), header.elements.values().map(|e| e.properties.len()).sum()];
    if kept != declared {
        return Err(Fault::file("the PLY header declares an element or a property twice: give each its own name"));
    }
    Ok((header, rest, line_end))
}

fn check_line(line: &str) -> Result<(), String> {
    let numbers = line.split(|c: char| !c.is_ascii_digit());
    let counts = line.starts_with("element") || line.starts_with("format");
    if counts && numbers.map(str::len).max().is_some_and(|digits| digits > LONGEST_NUMBER) {
        return Err(format!("the number in {} is too large to be true", quoted(line)));
    }
    if Parser::<Skipped>::new().read_header_line(line).is_err() {
        return Err(format!("{} is no line of a PLY header", quoted(line)));
    }
    Ok(())
}

/// Whether the header declares a mesh: vertices with positions and faces with corners.
pub(super) fn check(header: &Header) -> Result<(), Fault> {
    let Some(vertex) = header.elements.get("vertex") else {
        return Err(Fault::file("the PLY header declares no element `vertex`: there is no mesh in this file"));
    };
    for name in ["x", "y", "z", "nx", "ny", "nz"] {
        match vertex.properties.get(name).map(|p| &p.data_type) {
            Some(PropertyType::Scalar(_)) => {}
            None if name.starts_with('n') => {}
            None => return Err(Fault::part("element vertex", format!("the property `{name}` is missing"))),
            Some(PropertyType::List(..)) => {
                return Err(Fault::part(
                    "element vertex",
                    format!("the property `{name}` must be a number, not a list"),
                ));
            }
        }
    }
    let Some(face) = header.elements.get("face") else {
        return Err(Fault::file("the PLY header declares no element `face`: point clouds and strips are no meshes"));
    };
    let mut corners = CORNERS.iter().filter_map(|name| face.properties.get(*name));
    match (corners.next().map(|p| &p.data_type), corners.next()) {
        (Some(PropertyType::List(_, ScalarType::Float | ScalarType::Double) | PropertyType::Scalar(_)), _) => {
            Err(Fault::part("element face", "the corners must be a list of integers"))
        }
        (Some(PropertyType::List(..)), None) => Ok(()),
        (None, _) => Err(Fault::part("element face", "the list property `vertex_indices` is missing")),
        (_, Some(_)) => Err(Fault::part("element face", "there are two lists of corners: keep `vertex_indices`")),
    }
}
