//! Converts the pictures of a comparison for an HTML page.

use image::DynamicImage;
use serde_json::json;

use crate::golden::Layout;
use crate::golden::numbers::{MISS, unpacked};
use crate::render::{ViewKind, depth_picture, from_pixels, identity};

#[derive(Clone, Copy)]
pub struct PicturePair<'a> {
    pub expected: Option<&'a DynamicImage>,
    pub actual: Option<&'a DynamicImage>,
    pub values: Values,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Values {
    Colours,
    /// Distances. All channels are equal.
    Depths,
    /// Primitive numbers, [packed](crate::golden::numbers::packed).
    Primitives,
}

impl From<ViewKind> for Values {
    fn from(view: ViewKind) -> Self {
        match view {
            ViewKind::Depth => Self::Depths,
            ViewKind::Primitive => Self::Primitives,
            _ => Self::Colours,
        }
    }
}

pub fn shown(picture: &DynamicImage, values: Values) -> DynamicImage {
    let layout = Layout::of(picture);
    match (values, picture) {
        (Values::Depths, DynamicImage::ImageRgb32F(own)) => {
            depth_picture(layout.size, &own.pixels().map(|pixel| pixel.0[0]).collect::<Vec<f32>>()).into()
        }
        (Values::Primitives, _) if unpacked(picture).is_some() => {
            let colour = |number: u32| if number == MISS { [0; 3] } else { identity(number) };
            from_pixels(layout.size, unpacked(picture).into_iter().flatten().map(colour).collect()).into()
        }
        _ if layout.is_float() => picture.to_rgba8().into(),
        _ => picture.clone(),
    }
}

/// Returns a script that passes the values of the pictures to the page. Browsers do not let local pages read the pixels
/// of pictures.
pub fn values(number: usize, sides: PicturePair) -> String {
    let of = |picture: Option<&DynamicImage>| picture.map(|picture| numbers(picture, sides.values));
    let data = json!({ "expected": of(sides.expected), "actual": of(sides.actual) });
    format!("saharaValues({number}, {data});\n")
}

/// The values are little-endian bytes in base 64.
fn numbers(picture: &DynamicImage, values: Values) -> serde_json::Value {
    let Layout { size, channels, bits } = Layout::of(picture);
    let of = |kind: &str, channels: u8, bytes: &[u8]| json!({ "type": kind, "channels": channels, "size": size, "base64": base64::encode(bytes) });
    let floats = || picture.as_bytes().as_chunks::<4>().0.iter().map(|bytes| f32::from_ne_bytes(*bytes).to_le_bytes());
    match (values, unpacked(picture)) {
        (Values::Primitives, Some(numbers)) => {
            of("Uint32", 1, numbers.iter().flat_map(|number| number.to_le_bytes()).collect::<Vec<u8>>().as_slice())
        }
        (Values::Depths, _) if bits == 32 => of("Float32", 1, floats().step_by(3).collect::<Vec<_>>().as_flattened()),
        _ if bits == 32 => of("Float32", channels, floats().collect::<Vec<_>>().as_flattened()),
        _ if bits == 16 => {
            let samples = picture.as_bytes().as_chunks::<2>().0.iter();
            let bytes = samples.map(|bytes| u16::from_ne_bytes(*bytes).to_le_bytes());
            of("Uint16", channels, bytes.collect::<Vec<_>>().as_flattened())
        }
        _ => of("Uint8", channels, picture.as_bytes()),
    }
}
