//! The difference between two pictures with equal layouts.

use image::{DynamicImage, RgbImage};
use serde::Serialize;

use super::layout::Layout;
use crate::render::from_pixels;

#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Difference {
    pub pixels: usize,
    /// Column and row of the first pixel that differs, in reading order.
    pub first: [u32; 2],
    /// Column and row of the first pixel with the largest difference.
    pub worst: [u32; 2],
    /// The largest difference over all pixels and all channels, including alpha.
    pub largest: f64,
    /// The channel value of white: 255, 65535, or 1 for floats.
    pub full_scale: f64,
}

impl Difference {
    /// `None` if all values are equal.
    ///
    /// # Panics
    /// If the layouts differ.
    pub fn between(one: &DynamicImage, other: &DynamicImage) -> Option<Self> {
        let layout = Layout::of(one);
        let mut found: Option<Self> = None;
        for (pixel, gap) in gaps(one, other).enumerate().filter(|&(_, gap)| gap > 0.0) {
            let (pixel, width) = (pixel as u32, layout.size[0]);
            let place = [pixel % width, pixel / width];
            let new = Self { pixels: 0, first: place, worst: place, largest: 0.0, full_scale: layout.full_scale() };
            let found = found.get_or_insert(new);
            found.pixels += 1;
            if gap > found.largest {
                (found.largest, found.worst) = (gap, place);
            }
        }
        found
    }
}

/// The number of pixels with a channel that differs by more than `difference`. The unit of `difference` is 1/255 of
/// full scale, or 1 for floats.
///
/// # Panics
/// If the layouts differ.
pub fn pixels_over(one: &DynamicImage, other: &DynamicImage, difference: f64) -> usize {
    let layout = Layout::of(one);
    // Both sides of the comparison are multiplied. A division could round a difference across the limit.
    let (own, limit) = if layout.is_float() { (1.0, difference) } else { (255.0, difference * layout.full_scale()) };
    gaps(one, other).filter(|gap| gap * own > limit).count()
}

/// Only equal pixels are black, because `ceil` never rounds a difference to 0.
///
/// # Panics
/// If the layouts differ.
pub fn difference_picture(one: &DynamicImage, other: &DynamicImage) -> RgbImage {
    let layout = Layout::of(one);
    let colour = |gap: f64| match (gap / layout.full_scale() * 255.0).ceil() as u8 {
        0 => [0; 3],
        step => [128 + step / 2, step, 0],
    };
    from_pixels(layout.size, gaps(one, other).map(colour).collect())
}

fn gaps<'a>(one: &'a DynamicImage, other: &'a DynamicImage) -> impl Iterator<Item = f64> + 'a {
    let layout = Layout::of(one);
    assert_eq!(layout, Layout::of(other), "pictures of one layout");
    let gap = move |(one, other): (&[u8], &[u8])| {
        if one == other {
            return 0.0;
        }
        layout.values(one).zip(layout.values(other)).map(|(one, other)| apart(one, other)).fold(0.0, f64::max)
    };
    let pixels = |picture| DynamicImage::as_bytes(picture).chunks_exact(layout.bytes_per_pixel());
    pixels(one).zip(pixels(other)).map(gap)
}

/// Returns 0 if both values are NaN. Returns infinity if only one value is NaN.
pub(super) fn apart(one: f64, other: f64) -> f64 {
    let gap = (one - other).abs();
    if one == other || one.is_nan() && other.is_nan() {
        0.0
    } else if gap.is_nan() {
        f64::INFINITY
    } else {
        gap
    }
}

#[cfg(test)]
mod tests {
    use image::{GrayAlphaImage, ImageBuffer, Luma, Rgb, Rgb32FImage, RgbaImage};

    use super::*;

    #[test]
    fn a_difference_has_its_place_and_size() {
        let grey = RgbImage::from_pixel(5, 3, Rgb([100, 100, 250]));
        let mut other = grey.clone();
        assert_eq!(Difference::between(&grey.clone().into(), &other.clone().into()), None);
        other.get_pixel_mut(2, 1).0[1] += 1;
        other.get_pixel_mut(1, 2).0[2] -= 200;
        let [grey, other] = [grey, other].map(DynamicImage::from);
        let found = Difference { pixels: 2, first: [2, 1], worst: [1, 2], largest: 200.0, full_scale: 255.0 };
        assert_eq!(Difference::between(&grey, &other), Some(found));
        assert_eq!([0.5, 1.0, 199.9, 200.0].map(|limit| pixels_over(&grey, &other, limit)), [2, 1, 1, 0]);
        let shown = difference_picture(&grey, &other);
        let shown = [(0, 0), (2, 1), (1, 2)].map(|(x, y)| shown.get_pixel(x, y).0);
        assert_eq!(shown, [[0; 3], [128, 1, 0], [228, 200, 0]]);
    }

    #[test]
    fn alpha_and_low_bits_count() {
        let alpha = |alpha| DynamicImage::from(RgbaImage::from_raw(1, 1, vec![1, 2, 3, alpha]).unwrap());
        let found = Difference::between(&alpha(255), &alpha(0)).unwrap();
        assert_eq!((found.pixels, found.largest), (1, 255.0));
        let alpha = |alpha| DynamicImage::from(GrayAlphaImage::from_raw(1, 1, vec![1, alpha]).unwrap());
        assert_eq!(Difference::between(&alpha(7), &alpha(8)).unwrap().largest, 1.0);

        let deep = |value| DynamicImage::from(ImageBuffer::<Luma<u16>, _>::from_raw(1, 1, vec![value]).unwrap());
        let found = Difference::between(&deep(0x0100), &deep(0x0101)).unwrap();
        assert_eq!((found.largest, found.full_scale), (1.0, 65535.0));
        assert_eq!(difference_picture(&deep(0x0100), &deep(0x0101)).into_raw(), [128, 1, 0]);
        assert_eq!([256, 257, 258].map(|gap| pixels_over(&deep(0), &deep(gap), 1.0)), [0, 0, 1], "257 is 1/255");
        assert_eq!(difference_picture(&deep(0), &deep(0xFFFF)).into_raw(), [255, 255, 0]);
    }

    #[test]
    fn floats_are_compared_as_numbers() {
        let float = |value| DynamicImage::from(Rgb32FImage::from_raw(1, 1, vec![value, 0.0, 0.0]).unwrap());
        let largest = |one, other| Difference::between(&float(one), &float(other)).map(|found| found.largest);
        assert_eq!(largest(0.5, 2.0), Some(1.5));
        assert_eq!(largest(f32::MAX, f32::INFINITY), Some(f64::INFINITY));
        assert_eq!(largest(f32::NAN, 1.0), Some(f64::INFINITY));
        assert_eq!([0.4, 0.6].map(|limit| pixels_over(&float(0.5), &float(1.0), limit)), [1, 0]);
        let another_nan = f32::from_bits(f32::NAN.to_bits() + 1);
        for (one, other) in [(0.0, -0.0), (f32::NAN, another_nan), (f32::INFINITY, f32::INFINITY)] {
            assert_eq!(largest(one, other), None, "{one} {other}");
        }
        assert_eq!(difference_picture(&float(0.0), &float(f32::NAN)).into_raw(), [255, 255, 0]);
    }
}
