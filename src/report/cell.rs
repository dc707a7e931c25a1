//! The cells of tables.

use super::number::{bytes, count, duration, figures};
use super::words::written;
use crate::measure::Estimate;

/// An unknown value is [`Value::Empty`], never 0.
#[derive(Clone, Debug, Default, PartialEq)]
pub enum Value {
    #[default]
    Empty,
    Text(String),
    Count(u64),
    Difference(i64),
    Number(f64, Format),
    Estimate(Estimate, Format),
    /// `wrong` is the number of rays with a wrong hit. `of` is the number of checked rays.
    Errors {
        wrong: u64,
        of: u64,
    },
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Format {
    /// The format of [`figures`].
    Figures,
    Decimals(u8),
    /// A fraction, written in percent: `50.0 %`.
    Percent,
    /// A relative change, written in percent: `+1.5%`.
    Change,
    /// A duration in nanoseconds, written in `ns`, `us`, `ms` or `s`.
    Duration,
    Bytes,
}

/// The emphasis of a cell.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Tone {
    #[default]
    Plain,
    Best,
    Wrong,
}

#[derive(Clone, Debug, Default, PartialEq)]
pub struct Cell {
    pub value: Value,
    pub tone: Tone,
    /// Whether the value was measured on a subset of the rays.
    pub sampled: bool,
    /// Whether the value is not distinguishable from 1.
    pub equal: bool,
    pub note: String,
}

impl Format {
    fn write(self, x: f64) -> String {
        match self {
            Self::Figures => figures(x),
            Self::Decimals(n) => format!("{x:.*}", usize::from(n)),
            Self::Percent if x == 0.0 => "0".into(),
            Self::Percent => format!("{} %", figures(x * 100.0)),
            Self::Change => format!("{:+.1}%", x * 100.0),
            Self::Duration => duration(x),
            Self::Bytes => bytes(x as usize),
        }
    }
}

impl From<Value> for Cell {
    fn from(value: Value) -> Self {
        Self { value, ..Self::default() }
    }
}

macro_rules! cell_from {
    ($($value:ident: $type:ty => $of:expr;)*) => {
        $(impl From<$type> for Cell {
            fn from($value: $type) -> Self {
                $of.into()
            }
        })*
    };
}

cell_from! {
    text: String => if text.is_empty() { Value::Empty } else { Value::Text(text) };
    text: &str => text.to_owned();
    text: &String => text.clone();
    x: f64 => Value::Number(x, Format::Figures);
    x: Estimate => Value::Estimate(x, Format::Figures);
    n: u64 => Value::Count(n);
    n: usize => Value::Count(n as u64);
    yes: bool => if yes { "true" } else { "false" };
}

impl<T: Into<Cell>> From<Option<T>> for Cell {
    fn from(value: Option<T>) -> Self {
        value.map_or(Self::default(), Into::into)
    }
}

impl Cell {
    pub fn empty() -> Self {
        Self::default()
    }

    pub fn number(x: f64, format: Format) -> Self {
        Value::Number(x, format).into()
    }

    pub fn estimate(x: Estimate, format: Format) -> Self {
        Value::Estimate(x, format).into()
    }

    pub fn duration(ns: f64) -> Self {
        Self::number(ns, Format::Duration)
    }

    pub fn bytes(bytes: usize) -> Self {
        Self::number(bytes as f64, Format::Bytes)
    }

    /// A ratio of speeds. An exact 1 is not marked as `equal`.
    pub fn ratio(x: Estimate) -> Self {
        Self { equal: x != Estimate::exact(1.0) && x.holds(1.0), ..x.into() }
    }

    pub fn with(self, tone: Tone) -> Self {
        Self { tone, ..self }
    }

    pub fn sampled(self, sampled: bool) -> Self {
        Self { sampled, ..self }
    }

    pub fn noted(self, note: impl Into<String>) -> Self {
        Self { note: note.into(), ..self }
    }

    pub fn is_empty(&self) -> bool {
        self.value == Value::Empty
    }

    pub fn is_text(&self) -> bool {
        matches!(self.value, Value::Text(_))
    }

    pub fn text(&self) -> String {
        let value = match &self.value {
            Value::Empty => return String::new(),
            Value::Text(text) => text.clone(),
            Value::Count(n) => count(*n),
            Value::Difference(0) => "0".into(),
            Value::Difference(n) => format!("{n:+}"),
            Value::Number(x, format) => format.write(*x),
            Value::Estimate(x, format) => written(*x, |x| format.write(x)),
            Value::Errors { wrong, of } => format!("{wrong}/{of} wrong"),
        };
        let (before, equal) = (if self.sampled { "~" } else { "" }, if self.equal { " =" } else { "" });
        let note = if self.note.is_empty() { String::new() } else { format!(" ({})", self.note) };
        format!("{before}{value}{equal}{note}")
    }

    pub fn sort_key(&self) -> Option<f64> {
        match self.value {
            Value::Empty | Value::Text(_) => None,
            Value::Count(n) => Some(n as f64),
            Value::Difference(n) => Some(n as f64),
            Value::Number(x, _) => Some(x),
            Value::Estimate(x, _) => Some(x.estimate),
            Value::Errors { wrong, of } => Some(wrong as f64 / of.max(1) as f64),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn cells_read_as_people_write_numbers() {
        let between = Estimate::between(2.0, 0.5, 2.5);
        for (cell, text) in [
            (Cell::empty(), ""),
            (Cell::from(130_858_u64), "130,858"),
            (Value::Difference(2).into(), "+2"),
            (Value::Difference(0).into(), "0"),
            (Cell::from(1.2345).sampled(true), "~1.23"),
            (Cell::number(0.5, Format::Percent), "50.0 %"),
            (Cell::duration(2.5e6), "2.50 ms"),
            (Cell::bytes(1536), "1.50 KiB"),
            (Cell::ratio(between).noted("2 of 3"), "2.00 [0.500, 2.50] = (2 of 3)"),
            (Cell::ratio(Estimate::exact(1.0)), "1.00"),
            (Cell::estimate(Estimate::exact(1.0), Format::Decimals(2)), "1.00"),
            (Value::Errors { wrong: 3, of: 9 }.into(), "3/9 wrong"),
        ] {
            assert_eq!(cell.text(), text);
        }
        assert_eq!((Cell::from("a").sort_key(), Cell::ratio(between).sort_key()), (None, Some(2.0)));
    }
}
