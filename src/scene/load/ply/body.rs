//! The rows of a PLY file, read by ply-rs-bw one at a time.
//!
//! The library takes memory for as many rows and list entries as the file says there are. Here both numbers are first
//! held against the bytes that are there.

use ply_rs_bw::parser::Parser;
use ply_rs_bw::ply::{ElementDef, Encoding, PropertyAccess, PropertyType, ScalarType};

use crate::scene::load::error::{Fault, message, quoted};

/// Longer lists are taken for mistakes.
const LONGEST_LIST: usize = 1 << 20;

#[derive(Clone)]
pub(super) struct Body<'a> {
    rest: &'a [u8],
    encoding: Encoding,
    line_end: u8,
}

impl<'a> Body<'a> {
    /// The bytes after the header; `line_end` ends the lines of a text.
    pub fn new(rest: &'a [u8], encoding: Encoding, line_end: u8) -> Self {
        Self { rest, encoding, line_end }
    }

    /// Reads all rows of the next element and hands each with its number to `take`.
    pub fn rows<E: PropertyAccess>(
        &mut self,
        element: &ElementDef,
        mut take: impl FnMut(usize, E) -> Result<(), Fault>,
    ) -> Result<(), Fault> {
        let least = self.least_row_bytes(element);
        // The last line of a text may have no end.
        if element.count.saturating_mul(least) > self.rest.len() + 1 {
            let problem = format!(
                "the header declares {} rows, but the {} bytes left cannot hold them: the file is truncated or wrong",
                element.count,
                self.rest.len()
            );
            return Err(Fault::part(format!("element {}", element.name), problem));
        }
        let parser = Parser::<E>::new();
        for number in 0..element.count {
            let row = self.row(&parser, element);
            take(number, row.map_err(|problem| Fault::part(format!("{} {number}", element.name), problem))?)?;
        }
        Ok(())
    }

    /// After the last row there may be blanks and padding only.
    pub fn end(&self) -> Result<(), Fault> {
        if self.rest.iter().all(|b| b.is_ascii_whitespace() || *b == 0) {
            return Ok(());
        }
        let problem = format!("{} bytes follow the last row: the counts in the header are too small", self.rest.len());
        Err(Fault::file(problem))
    }

    fn row<E: PropertyAccess>(&mut self, parser: &Parser<E>, element: &ElementDef) -> Result<E, String> {
        match self.encoding {
            Encoding::Ascii => {
                let line = self.line()?;
                let line = std::str::from_utf8(line).map_err(|_| "the line is no ASCII text".to_owned())?;
                check_line(line, element)?;
                parser
                    .read_ascii_element(line, element)
                    .map_err(|_| format!("{} does not hold the numbers that the header declares", quoted(line)))
            }
            Encoding::BinaryBigEndian => {
                let length = self.row_bytes(element)?;
                let mut row = self.take(length)?;
                parser.read_big_endian_element(&mut row, element).map_err(message)
            }
            Encoding::BinaryLittleEndian => {
                let length = self.row_bytes(element)?;
                let mut row = self.take(length)?;
                parser.read_little_endian_element(&mut row, element).map_err(message)
            }
        }
    }

    fn least_row_bytes(&self, element: &ElementDef) -> usize {
        let least = |kind: &PropertyType| match kind {
            PropertyType::Scalar(kind) | PropertyType::List(kind, _) => bytes(kind),
        };
        let properties = element.properties.values();
        let least = match self.encoding {
            // A digit and a blank.
            Encoding::Ascii => 2 * properties.count(),
            _ => properties.map(|p| least(&p.data_type)).sum(),
        };
        least.max(1)
    }

    /// The next line that is not blank.
    fn line(&mut self) -> Result<&'a [u8], String> {
        loop {
            if self.rest.is_empty() {
                return Err("the file ends before this row: it is truncated".to_owned());
            }
            let end = self.rest.iter().position(|&b| b == self.line_end).map_or(self.rest.len(), |end| end + 1);
            let line = self.take(end)?;
            if !line.trim_ascii().is_empty() {
                return Ok(line.trim_ascii());
            }
        }
    }

    fn take(&mut self, length: usize) -> Result<&'a [u8], String> {
        let (row, rest) = self
            .rest
            .split_at_checked(length)
            .ok_or_else(|| "the file ends within this row: it is truncated".to_owned())?;
        self.rest = rest;
        Ok(row)
    }

    /// The length of the next row of a binary file.
    fn row_bytes(&self, element: &ElementDef) -> Result<usize, String> {
        let mut length = 0_usize;
        for property in element.properties.values() {
            length = match &property.data_type {
                PropertyType::Scalar(kind) => length + bytes(kind),
                PropertyType::List(count, entry) => {
                    let start = length;
                    length += bytes(count);
                    let count = match self.rest.get(start..length) {
                        Some(digits) => check_list(self.count(digits, count)?)?,
                        None => return Err("the file ends within this row: it is truncated".to_owned()),
                    };
                    length.saturating_add(count.saturating_mul(bytes(entry)))
                }
            };
        }
        Ok(length)
    }

    fn count(&self, digits: &[u8], kind: &ScalarType) -> Result<usize, String> {
        let mut wide = [0; 8];
        wide[..digits.len()].copy_from_slice(digits);
        if self.encoding == Encoding::BinaryBigEndian {
            wide[..digits.len()].reverse();
        }
        let unsigned = i64::from_le_bytes(wide);
        let count = match kind {
            ScalarType::Char => i64::from(unsigned as i8),
            ScalarType::Short => i64::from(unsigned as i16),
            ScalarType::Int => i64::from(unsigned as i32),
            ScalarType::UChar | ScalarType::UShort | ScalarType::UInt => unsigned,
            ScalarType::Float | ScalarType::Double => return Err("the length of a list must be an integer".to_owned()),
        };
        usize::try_from(count).map_err(|_| format!("a list cannot have {count} entries"))
    }
}

/// Whether a list of that length is read.
fn check_list(count: usize) -> Result<usize, String> {
    if count > LONGEST_LIST {
        return Err(format!("a list has {count} entries, and more than {LONGEST_LIST} are taken for a mistake"));
    }
    Ok(count)
}

/// Whether a line has as many numbers as its lists say.
fn check_line(line: &str, element: &ElementDef) -> Result<(), String> {
    let mut words = line.split_whitespace();
    let mut left = words.clone().count();
    let mut skip = |wanted: usize| {
        left = left.checked_sub(wanted).ok_or_else(|| format!("{} has too few numbers", quoted(line)))?;
        Ok::<_, String>(wanted.checked_sub(1).and_then(|last| words.nth(last)).unwrap_or_default())
    };
    for property in element.properties.values() {
        let word = skip(1)?;
        if let PropertyType::List(..) = property.data_type {
            let count = word.parse().map_err(|_| format!("{} is not the length of a list", quoted(word)))?;
            skip(check_list(count)?)?;
        }
    }
    if left > 0 {
        return Err(format!("{} has too many numbers", quoted(line)));
    }
    Ok(())
}

fn bytes(kind: &ScalarType) -> usize {
    match kind {
        ScalarType::Char | ScalarType::UChar => 1,
        ScalarType::Short | ScalarType::UShort => 2,
        ScalarType::Int | ScalarType::UInt | ScalarType::Float => 4,
        ScalarType::Double => 8,
    }
}
