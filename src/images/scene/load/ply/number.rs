//! Reads numbers of all types of PLY, in text and in binary.

pub(super) const ENCODINGS: [&str; 3] = ["ascii", "binary_little_endian", "binary_big_endian"];

type Readers = [fn(&mut &[u8]) -> Result<f64, &'static str>; ENCODINGS.len()];

/// A number type. `f64` represents every value exactly.
#[derive(Clone, Copy)]
pub(super) struct Kind {
    pub is_integer: bool,
    /// For each encoding, a function that takes a number from the front of the rows.
    pub readers: Readers,
}

macro_rules! kind {
    ($type:ty, is_integer: $is_integer:literal) => {
        Kind {
            is_integer: $is_integer,
            readers: [
                parse::<$type>,
                |rows| chunk(rows).map(|bytes| <$type>::from_le_bytes(bytes).into()),
                |rows| chunk(rows).map(|bytes| <$type>::from_be_bytes(bytes).into()),
            ],
        }
    };
}

impl Kind {
    pub fn named(name: &str) -> Option<Self> {
        Some(match name {
            "char" | "int8" => kind!(i8, is_integer: true),
            "uchar" | "uint8" => kind!(u8, is_integer: true),
            "short" | "int16" => kind!(i16, is_integer: true),
            "ushort" | "uint16" => kind!(u16, is_integer: true),
            "int" | "int32" => kind!(i32, is_integer: true),
            "uint" | "uint32" => kind!(u32, is_integer: true),
            "float" | "float32" => kind!(f32, is_integer: false),
            "double" | "float64" => kind!(f64, is_integer: false),
            _ => return None,
        })
    }
}

fn chunk<const BYTES: usize>(rows: &mut &[u8]) -> Result<[u8; BYTES], &'static str> {
    let bytes = rows.split_off(..BYTES).and_then(|bytes| bytes.try_into().ok());
    bytes.ok_or("the file ends within this row: it is truncated")
}

fn parse<N: std::str::FromStr + Into<f64>>(rows: &mut &[u8]) -> Result<f64, &'static str> {
    let word = word(rows).ok_or("the line has too few numbers, or the file is truncated")?;
    let word = std::str::from_utf8(word).map_err(|_| "the line is not ASCII text")?;
    word.parse().map(N::into).map_err(|_| "the line does not hold the numbers that the header declares")
}

/// Returns `None` at the end of the line.
pub(super) fn word<'a>(rows: &mut &'a [u8]) -> Option<&'a [u8]> {
    let start = rows.iter().position(|byte| matches!(byte, b'\n' | b'\r') || !byte.is_ascii_whitespace())?;
    *rows = &rows[start..];
    let end = rows.iter().position(u8::is_ascii_whitespace).unwrap_or(rows.len());
    rows.split_off(..end).filter(|word| !word.is_empty())
}
