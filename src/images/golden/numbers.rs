//! PNG files that store one 32-bit number per pixel without loss.
//!
//! Each pixel has two channels of 16 bits. Grey stores the upper half of the number. Alpha stores the lower half.
//! Golden images of your renderer may use this format:
//!
//! ```
//! use sahara_images::golden::numbers::packed;
//! use sahara_images::golden::{Match, assert_image};
//!
//! # let folder = tempfile::tempdir().unwrap();
//! # let golden = folder.path().join("depth.png");
//! let depths = [1.5f32, f32::INFINITY, 2.25, 0.1];
//! # sahara_images::golden::write(&golden, &packed([2, 2], &depths.map(f32::to_bits))).unwrap();
//! assert_image(&golden, packed([2, 2], &depths.map(f32::to_bits)), Match::Exact);
//! ```

use image::{DynamicImage, ImageBuffer, LumaA, Rgb32FImage};

/// Represents a miss in a picture of primitive numbers.
pub const MISS: u32 = u32::MAX;

/// # Panics
/// If there are fewer numbers than pixels.
pub fn packed([width, height]: [u32; 2], numbers: &[u32]) -> DynamicImage {
    let halves = numbers.iter().flat_map(|number| [(number >> 16) as u16, *number as u16]).collect();
    let picture = ImageBuffer::<LumaA<u16>, Vec<u16>>::from_raw(width, height, halves);
    picture.expect("one number per pixel").into()
}

pub fn unpacked(picture: &DynamicImage) -> Option<Vec<u32>> {
    let halves = picture.as_luma_alpha16()?.as_raw().as_chunks::<2>().0;
    Some(halves.iter().map(|[upper, lower]| u32::from(*upper) << 16 | u32::from(*lower)).collect())
}

/// All three channels of a pixel are `f32::from_bits` of the number.
pub fn as_floats([width, height]: [u32; 2], numbers: &[u32]) -> DynamicImage {
    let values = numbers.iter().flat_map(|number| [f32::from_bits(*number); 3]).collect();
    Rgb32FImage::from_raw(width, height, values).expect("one number per pixel").into()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::golden::{Difference, read, write};

    #[test]
    fn every_bit_is_in_the_file() {
        let numbers = [0, 1, u32::MAX, 0x8000_0000, f32::INFINITY.to_bits(), 1.5f32.to_bits(), 70_000, 0x1234_5678];
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a.png");
        write(&path, &packed([4, 2], &numbers)).unwrap();
        assert_eq!(unpacked(&read(&path).unwrap()), Some(numbers.to_vec()));
        assert_eq!(unpacked(&DynamicImage::new_rgb8(4, 2)), None);

        let depths = |depths: [f32; 2]| as_floats([2, 1], &depths.map(f32::to_bits));
        let next = f32::from_bits(2.0f32.to_bits() + 1);
        let found = Difference::between(&depths([2.0, f32::INFINITY]), &depths([next, f32::INFINITY])).unwrap();
        assert_eq!((found.pixels, found.largest), (1, f64::from(next) - 2.0));
        let found = Difference::between(&depths([2.0, 1.0]), &depths([2.0, f32::INFINITY])).unwrap();
        assert_eq!((found.first, found.largest), ([1, 0], f64::INFINITY));
    }
}
