//! The rows of a PLY file.
//!
//! The numbers of rows and of list entries are compared with the bytes of the file before memory is allocated for them.

use super::header::{Element, Encoding, Header};
use super::value::Kind;
use crate::scene::load::error::{Fault, quoted};

const LONGEST_LIST: f64 = 1_048_576.0;

#[derive(Clone)]
pub(super) struct Body<'a> {
    rest: &'a [u8],
    encoding: Option<Encoding>,
    line_end: u8,
}

impl<'a> Body<'a> {
    /// The bytes after the header.
    pub fn new(header: &Header, rest: &'a [u8]) -> Self {
        Self { rest, encoding: header.encoding, line_end: header.line_end }
    }

    /// Reads all rows of the next element. `take` receives the number of each row and the values of the `wanted`
    /// properties: one for a number, all entries for a list, none if the element does not have the property.
    pub fn rows(
        &mut self,
        element: &Element,
        wanted: &[&str],
        mut take: impl FnMut(usize, &[Vec<f64>]) -> Result<(), Fault>,
    ) -> Result<(), Fault> {
        // The last line may lack its line break.
        if element.count.saturating_mul(self.least_row_bytes(element)) > self.rest.len() + 1 {
            let problem = format!(
                "the header declares {} rows, but the {} bytes left cannot hold them: the file is truncated or wrong",
                element.count,
                self.rest.len()
            );
            return Err(Fault::part(format!("element {}", element.name), problem));
        }
        let column = |name: &String| wanted.iter().position(|wanted| wanted == name);
        let columns: Vec<Option<usize>> = element.properties.iter().map(|p| column(&p.name)).collect();
        let mut values = vec![vec![]; wanted.len()];
        for number in 0..element.count {
            values.iter_mut().for_each(Vec::clear);
            let row = self.row(element, |property, value| {
                if let Some(column) = columns[property] {
                    values[column].push(value);
                }
            });
            row.map_err(|problem| Fault::part(format!("{} {number}", element.name), problem))?;
            take(number, &values)?;
        }
        Ok(())
    }

    /// Checks that only white space and padding follow the last row.
    pub fn end(&self) -> Result<(), Fault> {
        if self.rest.iter().all(|b| b.is_ascii_whitespace() || *b == 0) {
            return Ok(());
        }
        let problem = format!("{} bytes follow the last row: the counts in the header are too small", self.rest.len());
        Err(Fault::file(problem))
    }

    /// Passes on all values of the next row with the number of their property.
    fn row(&mut self, element: &Element, take: impl FnMut(usize, f64)) -> Result<(), String> {
        if self.encoding != Some(Encoding::Ascii) {
            return values(element, |kind| self.value(kind), take);
        }
        let line = std::str::from_utf8(self.line()?).map_err(|_| "the line is no ASCII text")?;
        let mut words = line.split_whitespace();
        let number = |kind: Kind| {
            let word = words.next().ok_or_else(|| format!("{} has too few numbers", quoted(line)))?;
            let problem = || format!("{} does not hold the numbers that the header declares", quoted(line));
            kind.parse(word).ok_or_else(problem)
        };
        values(element, number, take)?;
        words.next().map_or(Ok(()), |_| Err(format!("{} has too many numbers", quoted(line))))
    }

    fn value(&mut self, kind: Kind) -> Result<f64, String> {
        let (value, rest) =
            self.rest.split_at_checked(kind.bytes()).ok_or("the file ends within this row: it is truncated")?;
        self.rest = rest;
        let mut eight = [0; 8];
        let little = &mut eight[..value.len()];
        little.copy_from_slice(value);
        if self.encoding == Some(Encoding::Big) {
            little.reverse();
        }
        Ok(kind.decode(little))
    }

    fn least_row_bytes(&self, element: &Element) -> usize {
        let least: usize = match self.encoding {
            // A digit and a blank.
            Some(Encoding::Ascii) => 2 * element.properties.len(),
            _ => element.properties.iter().map(|p| p.length.unwrap_or(p.kind).bytes()).sum(),
        };
        least.max(1)
    }

    /// The next line that is not blank.
    fn line(&mut self) -> Result<&'a [u8], &'static str> {
        while !self.rest.is_empty() {
            let end = self.rest.iter().position(|&b| b == self.line_end).map_or(self.rest.len(), |end| end + 1);
            let (line, rest) = self.rest.split_at(end);
            self.rest = rest;
            if !line.trim_ascii().is_empty() {
                return Ok(line.trim_ascii());
            }
        }
        Err("the file ends before this row: it is truncated")
    }
}

/// Reads the values of a row from `next`, and passes each on with the number of its property.
fn values(
    element: &Element,
    mut next: impl FnMut(Kind) -> Result<f64, String>,
    mut take: impl FnMut(usize, f64),
) -> Result<(), String> {
    for (number, property) in element.properties.iter().enumerate() {
        let count = property.length.map_or(Ok(1.0), &mut next)?;
        if count < 0.0 || count.fract() != 0.0 {
            return Err(format!("{count} entries is not the length of a list"));
        }
        if count > LONGEST_LIST {
            return Err(format!("a list has {count} entries, and more than {LONGEST_LIST} are taken for a mistake"));
        }
        for _ in 0..count as usize {
            take(number, next(property.kind)?);
        }
    }
    Ok(())
}
