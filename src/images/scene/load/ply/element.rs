//! Reads the header of a PLY file and the rows of its elements.

use std::collections::HashSet;

use super::number::{ENCODINGS, Kind, word};
use crate::scene::load::error::{Fault, quoted};
use crate::scene::load::text::{lines, without_byte_order_mark};

pub(super) const STRIPS: &str = "tristrips";

/// The vertex properties that the loader reads.
pub(super) const VERTEX_PROPERTIES: [&str; 6] = ["x", "y", "z", "nx", "ny", "nz"];

/// Files use one of these names for the corners of a face or strip.
const CORNERS: [&str; 2] = ["vertex_indices", "vertex_index"];

/// The limit for the bytes of a header and for the entries of a list.
const LONGEST: usize = 1 << 20;

#[derive(Default)]
pub(super) struct Header {
    elements: Vec<Element>,
    /// Index into [`ENCODINGS`]. `None` before the line `format`.
    encoding: Option<usize>,
    /// The names of elements, and the names of properties in the form `ELEMENT PROPERTY`.
    names: HashSet<String>,
}

impl Header {
    pub fn read(bytes: &[u8]) -> Result<(Vec<Element>, &[u8]), Fault> {
        let bytes = without_byte_order_mark(bytes)?;
        if !bytes.starts_with(b"ply") {
            return Err(Fault::line(1, "a PLY file begins with the line `ply`: this is another format"));
        }
        // The first line determines the line end of the header. After a header with `\r`, binary rows may begin with
        // the byte `\n`.
        let line_end = if bytes.get(3) == Some(&b'\r') && bytes.get(4) != Some(&b'\n') { b'\r' } else { b'\n' };
        let (mut header, mut number, mut read) = (Self::default(), 1, 0);
        let text = &bytes[..bytes.len().min(LONGEST)];
        while let Some(length) = text[read..].iter().position(|&byte| byte == line_end) {
            // Comments need not be UTF-8.
            let line = String::from_utf8_lossy(text[read..read + length].trim_ascii());
            read += length + 1;
            match &*line {
                "ply" if number == 1 => {}
                "end_header" => return Ok((header.elements, &bytes[read..])),
                line => header.line(line).map_err(|problem| Fault::line(number, problem))?,
            }
            number += 1;
        }
        let problem = "the PLY header does not end with a line `end_header`: the file is truncated or not PLY";
        Err(Fault::line(number, problem))
    }

    fn line(&mut self, line: &str) -> Result<(), String> {
        let unknown = || format!("{} is not a line of a PLY header, or is misplaced", quoted(line));
        let named = |name| Kind::named(name).ok_or_else(unknown);
        let words: Vec<&str> = line.split_ascii_whitespace().collect();
        let full_name = match (&words[..], self.encoding, self.elements.last_mut()) {
            (["comment" | "obj_info", ..], ..) => return Ok(()),
            (["format", name, "1.0"], ..) => {
                self.encoding = Some(ENCODINGS.iter().position(|encoding| encoding == name).ok_or_else(unknown)?);
                return Ok(());
            }
            (&["element", name, count], Some(encoding), _) => {
                let count = count.parse().map_err(|_| unknown())?;
                self.elements.push(Element { name: name.into(), count, properties: vec![], encoding });
                name.into()
            }
            (&["property", ref types @ .., name], _, Some(element)) => {
                let (length, kind) = match *types {
                    ["list", length, entry] => (Some(named(length)?), named(entry)?),
                    [number] => (None, named(number)?),
                    _ => return Err(unknown()),
                };
                let (columns, is_right): (&[&str], _) = match element.name.as_str() {
                    "vertex" => (&VERTEX_PROPERTIES, length.is_none()),
                    "face" | STRIPS => (&CORNERS, length.is_some() && kind.is_integer),
                    _ => (&[], true),
                };
                let column = columns.iter().position(|column| *column == name);
                if column.is_some() && !is_right || length.is_some_and(|length| !length.is_integer) {
                    let types = "a coordinate is a number, corners are a list of integers, a length is an integer";
                    return Err(format!("{} has the wrong type: {types}", quoted(line)));
                }
                // In a text file, a list length may exceed the range of the declared length type.
                let length = if element.encoding == 0 && length.is_some() { Some(named("double")?) } else { length };
                element.properties.push(Property { column, length, kind });
                format!("{} {name}", element.name)
            }
            _ => return Err(unknown()),
        };
        let is_new = self.names.insert(full_name);
        if is_new { Ok(()) } else { Err(format!("{} is declared twice: give each its own name", quoted(line))) }
    }
}

pub(super) struct Element {
    pub name: String,
    pub count: usize,
    pub properties: Vec<Property>,
    /// Index into [`ENCODINGS`]. 0 is text.
    pub encoding: usize,
}

pub(super) struct Property {
    /// Index into `VERTEX_PROPERTIES` or `CORNERS`. `None` if the loader skips the property.
    pub column: Option<usize>,
    pub length: Option<Kind>,
    pub kind: Kind,
}

/// A column and a number. `None` at the end of a row.
pub(super) type Next = Option<(usize, f64)>;

impl Element {
    pub fn read(&self, rows: &mut &[u8], mut take: impl FnMut(Next) -> Result<(), String>) -> Result<(), Fault> {
        let Self { name, count, properties, encoding } = self;
        // Each number takes at least one byte. A text row without properties takes one line break. The last line may
        // lack its line break.
        if count.saturating_mul(properties.len().max(1)) > rows.len() + 1 {
            let problem = format!("the header declares {count} rows for {} bytes: the file is truncated", rows.len());
            return Err(Fault::part(format!("element {name}"), problem));
        }
        for number in 0..*count {
            let start = if *encoding == 0 { rows.trim_ascii_start() } else { *rows };
            *rows = start;
            self.row(rows, &mut take).map_err(|problem| {
                let line = lines(start).next().filter(|_| *encoding == 0);
                let line = line.map(|(_, line)| format!(": {}", quoted(line))).unwrap_or_default();
                Fault::part(format!("{name} {number}"), problem + &line)
            })?;
        }
        Ok(())
    }

    fn row(&self, rows: &mut &[u8], take: &mut impl FnMut(Next) -> Result<(), String>) -> Result<(), String> {
        // A single strip may contain the whole mesh.
        let longest = if self.name == STRIPS { rows.len() } else { LONGEST };
        for property in &self.properties {
            let length = property.length.map_or(Ok(1.0), |kind| (kind.readers[self.encoding])(rows))?;
            let count = length as usize;
            if count as f64 != length || count > longest {
                return Err(format!("a list has {length} entries: the limit is {longest}"));
            }
            let read = property.kind.readers[self.encoding];
            for _ in 0..count {
                let number = read(rows)?;
                property.column.map_or(Ok(()), |column| take(Some((column, number))))?;
            }
        }
        if self.encoding == 0 && word(rows).is_some() {
            return Err("the line has too many numbers".into());
        }
        take(None)
    }
}
