//! The header of a PLY file: its elements and their properties.

use std::collections::HashSet;

use super::value::Kind;
use crate::scene::load::error::{Fault, quoted};
use crate::scene::load::text::plain;

/// The two names in use for the corners of a face.
pub(super) const CORNERS: [&str; 2] = ["vertex_indices", "vertex_index"];

/// Counts with more digits are rejected.
const LONGEST_NUMBER: usize = 15;

const LONGEST_HEADER: usize = 1 << 20;

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Encoding {
    Ascii,
    Little,
    Big,
}

pub(super) struct Property {
    pub name: String,
    /// The type of the length, if it is a list.
    pub length: Option<Kind>,
    /// The type of the number, or of the entries of the list.
    pub kind: Kind,
}

pub(super) struct Element {
    pub name: String,
    pub count: usize,
    pub properties: Vec<Property>,
}

impl Element {
    pub fn property(&self, name: &str) -> Option<&Property> {
        self.properties.iter().find(|property| property.name == name)
    }
}

pub(super) struct Header {
    /// None until its line has been read.
    pub encoding: Option<Encoding>,
    /// The byte that ends a line.
    pub line_end: u8,
    pub elements: Vec<Element>,
    /// The names of elements, and of properties after that of their element.
    seen: HashSet<String>,
}

impl Header {
    /// Reads the header and checks that it declares a mesh. Also returns the bytes that follow.
    pub fn read(bytes: &[u8]) -> Result<(Self, &[u8]), Fault> {
        let bytes = plain(bytes)?;
        let line_end = match bytes {
            [b'p', b'l', b'y', b'\r', next, ..] if *next != b'\n' => b'\r',
            _ => b'\n',
        };
        let is_end = |byte: &u8| *byte == line_end;
        if bytes.split(is_end).next().is_none_or(|first| first.trim_ascii_end() != b"ply") {
            return Err(Fault::line(1, "a PLY file begins with the line `ply`: this is another format"));
        }
        let mut header = Self { encoding: None, line_end, elements: vec![], seen: HashSet::new() };
        let (mut lines, mut read) = (0, 0);
        let text = &bytes[..bytes.len().min(LONGEST_HEADER)];
        for line in text.split_inclusive(is_end).take_while(|line| line.last().is_some_and(is_end)) {
            (lines, read) = (lines + 1, read + line.len());
            // Comments may be in any encoding.
            let line = String::from_utf8_lossy(line.trim_ascii());
            if line == "end_header" {
                header.check()?;
                return Ok((header, &bytes[read..]));
            }
            if lines > 1 {
                header.line(&line).map_err(|problem| Fault::line(lines, problem))?;
            }
        }
        let problem = "the PLY header does not end with a line `end_header`: the file is truncated or no PLY file";
        Err(Fault::line(lines.max(1), problem))
    }

    /// The element that [`Header::check`] has found.
    pub fn element(&self, name: &str) -> Option<&Element> {
        self.elements.iter().find(|element| element.name == name)
    }

    fn line(&mut self, line: &str) -> Result<(), String> {
        let unknown = || format!("{} is no line of a PLY header", quoted(line));
        let kind = |name| Kind::named(name).ok_or_else(unknown);
        let words: Vec<&str> = line.split_ascii_whitespace().collect();
        let digits = words.last().map_or(0, |word| word.bytes().filter(u8::is_ascii_digit).count());
        match words[..] {
            ["format" | "element", ..] if digits > LONGEST_NUMBER => {
                return Err(format!("the number in {} is too large to be true", quoted(line)));
            }
            ["comment" | "obj_info", ..] => {}
            ["format", "ascii", "1.0"] => self.encoding = Some(Encoding::Ascii),
            ["format", "binary_little_endian", "1.0"] => self.encoding = Some(Encoding::Little),
            ["format", "binary_big_endian", "1.0"] => self.encoding = Some(Encoding::Big),
            ["element", name, count] => {
                let count = count.parse().map_err(|_| unknown())?;
                if !self.seen.insert(name.into()) {
                    return Err(format!("the element {} is declared twice: give each its own name", quoted(name)));
                }
                self.elements.push(Element { name: name.into(), count, properties: vec![] });
            }
            ["property", "list", length, entry, name] => self.property(name, Some(kind(length)?), kind(entry)?)?,
            ["property", number, name] => self.property(name, None, kind(number)?)?,
            _ => return Err(unknown()),
        }
        Ok(())
    }

    fn property(&mut self, name: &str, length: Option<Kind>, kind: Kind) -> Result<(), String> {
        if length.is_some_and(|length| !length.is_integer()) {
            return Err("the length of a list must be an integer".into());
        }
        // In text a length may exceed the width of its type.
        let length = length.map(|length| if self.encoding == Some(Encoding::Ascii) { Kind::F64 } else { length });
        let element = self.elements.last_mut().ok_or("it precedes all elements of the PLY header")?;
        if !self.seen.insert(format!("{} {name}", element.name)) {
            return Err(format!("the property {} is declared twice: give each its own name", quoted(name)));
        }
        element.properties.push(Property { name: name.into(), length, kind });
        Ok(())
    }

    /// Checks that the header declares a mesh: vertices with positions and faces with corners.
    fn check(&self) -> Result<(), Fault> {
        if self.encoding.is_none() {
            return Err(Fault::file("the PLY header has no line `format`: the file is damaged"));
        }
        let Some(vertex) = self.element("vertex") else {
            return Err(Fault::file("the PLY header declares no element `vertex`: there is no mesh in this file"));
        };
        for name in ["x", "y", "z", "nx", "ny", "nz"] {
            let problem = match vertex.property(name) {
                Some(Property { length: Some(_), .. }) => "must be a number, not a list",
                None if !name.starts_with('n') => "is missing",
                _ => continue,
            };
            return Err(Fault::part("element vertex", format!("the property `{name}` {problem}")));
        }
        let Some(face) = self.element("face") else {
            return Err(Fault::file(
                "the PLY header declares no element `face`: point clouds and strips are no meshes",
            ));
        };
        let mut corners = CORNERS.iter().filter_map(|name| face.property(name));
        let problem = match (corners.next(), corners.next()) {
            (None, _) => "the list property `vertex_indices` is missing",
            (Some(list), _) if list.length.is_none() || !list.kind.is_integer() => {
                "the corners must be a list of integers"
            }
            (_, Some(_)) => "there are two lists of corners: keep `vertex_indices`",
            _ => return Ok(()),
        };
        Err(Fault::part("element face", problem))
    }
}
