//! Converts colours to pictures with 8 bits per channel. Encodes pictures as PNG.

use std::io::Write;

use glam::Vec3;
use image::RgbImage;
use image::codecs::png::{CompressionType, FilterType, PngEncoder};

use crate::geometry::Ray;
use crate::scene::{Scene, View};

/// Makes a picture from RGB colours. `pixels` contains the rows of the picture from top to bottom.
///
/// # Panics
/// If the number of `pixels` is not `width * height`.
pub fn from_pixels([width, height]: [u32; 2], pixels: Vec<[u8; 3]>) -> RgbImage {
    assert_eq!(pixels.len() as u64, u64::from(width) * u64::from(height), "one colour per pixel");
    RgbImage::from_raw(width, height, pixels.into_flattened()).expect("all pixels are there")
}

/// Converts linear RGB colours to a picture, without a gamma curve. NaN becomes 0.
///
/// # Panics
/// If the number of `colours` is not `size[0] * size[1]`.
pub fn of_colours(size: [u32; 2], colours: &[Vec3]) -> RgbImage {
    from_pixels(size, colours.iter().map(|colour| colour.to_array().map(quantised)).collect())
}

pub(super) fn quantised(channel: f32) -> u8 {
    (channel * 255.0 + 0.5) as u8
}

/// The encoder of all PNG files. The settings are explicit, because the defaults of `image` may change.
pub fn png_encoder<W: Write>(file: W) -> PngEncoder<W> {
    PngEncoder::new_with_quality(file, CompressionType::Fast, FilterType::Adaptive)
}

/// # Panics
/// If the picture has no pixels.
pub fn png(picture: &RgbImage) -> Vec<u8> {
    let mut bytes = vec![];
    picture.write_with_encoder(png_encoder(&mut bytes)).expect("memory takes every picture that has pixels");
    bytes
}

pub fn primary(scene: &Scene, size: [u32; 2]) -> Vec<Ray> {
    scene.primary_rays(size, View::CENTRE, 0..size[0] * size[1])
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn channels_are_rounded_and_clamped() {
        let colours = [Vec3::new(-1.0, 0.5, 2.0), Vec3::new(f32::NAN, 1.0, 0.1)];
        assert_eq!(of_colours([2, 1], &colours).into_raw(), [0, 128, 255, 0, 255, 26]);
    }

    #[test]
    fn committed_pictures_are_encoded_to_their_bytes() {
        let scenes = concat!(env!("CARGO_MANIFEST_DIR"), "/../../scenes");
        for name in ["cube", "cornellbox", "teapot"] {
            let bytes = std::fs::read(format!("{scenes}/{name}/golden.png")).unwrap();
            let picture = image::load_from_memory(&bytes).unwrap();
            assert!(png(picture.as_rgb8().unwrap()) == bytes, "{name}");
        }
    }
}
