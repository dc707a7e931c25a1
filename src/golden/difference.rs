//! The difference of two pictures, in their own channels and depth.

use std::fmt::{self, Display, Formatter};

use image::{DynamicImage, RgbImage};

use crate::render::from_pixels;

/// What pictures must have in common to be compared.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Layout {
    /// Width and height.
    pub size: [u32; 2],
    /// 1 is grey, 2 is grey and alpha, 3 is RGB, 4 is RGB and alpha.
    pub channels: u8,
    /// Bits a channel: 8 or 16, or 32 for floats.
    pub bits: u8,
}

impl Layout {
    pub fn of(picture: &DynamicImage) -> Self {
        let (size, color) = ([picture.width(), picture.height()], picture.color());
        let channels = color.channel_count();
        Self { size, channels, bits: (color.bits_per_pixel() / u16::from(channels)) as u8 }
    }

    /// The largest value of a channel, which is white.
    fn full_scale(&self) -> f64 {
        match self.bits {
            8 => u8::MAX.into(),
            16 => u16::MAX.into(),
            _ => 1.0,
        }
    }

    fn bytes_per_pixel(&self) -> usize {
        usize::from(self.channels) * usize::from(self.bits / 8)
    }
}

impl Display for Layout {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        let [width, height] = self.size;
        let channels = ["grey", "grey and alpha", "RGB", "RGBA"][usize::from(self.channels) - 1];
        write!(f, "{width} x {height} pixels of {channels} with {} bits a channel", self.bits)
    }
}

/// The difference of two pictures of one layout.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Difference {
    /// How many pixels differ, at least 1.
    pub pixels: usize,
    /// Column and row, from the top left, of the first of them in reading order.
    pub first: [u32; 2],
    /// The largest difference of a channel, alpha as any other; infinite against a value that is no number.
    pub largest: f64,
    /// What `largest` is a part of: 255 or 65535; 1 for floats, which can be more.
    pub full_scale: f64,
}

impl Difference {
    /// The difference of the pictures, or none if all their values are equal.
    ///
    /// # Panics
    /// If they differ in layout.
    pub fn between(one: &DynamicImage, other: &DynamicImage) -> Option<Self> {
        let layout = Layout::of(one);
        let mut found: Option<Self> = None;
        for (pixel, gap) in gaps(one, other).enumerate().filter(|&(_, gap)| gap > 0.0) {
            let (pixel, width) = (pixel as u32, layout.size[0]);
            let first = [pixel % width, pixel / width];
            let found = found.get_or_insert(Self { pixels: 0, first, largest: 0.0, full_scale: layout.full_scale() });
            found.pixels += 1;
            found.largest = found.largest.max(gap);
        }
        found
    }
}

/// A picture of the difference: black where equal, from dark red for a step of 255 to yellow for 255. Less than a step
/// is shown as one.
///
/// # Panics
/// If the pictures differ in layout.
pub fn difference_picture(one: &DynamicImage, other: &DynamicImage) -> RgbImage {
    let layout = Layout::of(one);
    let colour = |gap: f64| match (gap / layout.full_scale() * 255.0).ceil() as u8 {
        0 => [0; 3],
        step => [128 + step / 2, step, 0],
    };
    from_pixels(layout.size, gaps(one, other).map(colour).collect())
}

/// The largest difference of a channel, for each pixel.
fn gaps<'a>(one: &'a DynamicImage, other: &'a DynamicImage) -> impl Iterator<Item = f64> + 'a {
    let layout = Layout::of(one);
    assert_eq!(layout, Layout::of(other), "pictures of one layout");
    let samples = usize::from(layout.bits / 8);
    let gap = move |(one, other): (&[u8], &[u8])| {
        if one == other {
            return 0.0;
        }
        let pairs = one.chunks_exact(samples).zip(other.chunks_exact(samples));
        pairs.map(|(one, other)| apart(value(one), value(other))).fold(0.0, f64::max)
    };
    let pixels = |picture| DynamicImage::as_bytes(picture).chunks_exact(layout.bytes_per_pixel());
    pixels(one).zip(pixels(other)).map(gap)
}

/// The value of a channel, of one of three depths.
fn value(sample: &[u8]) -> f64 {
    match *sample {
        [byte] => byte.into(),
        [a, b] => u16::from_ne_bytes([a, b]).into(),
        [a, b, c, d] => f32::from_ne_bytes([a, b, c, d]).into(),
        _ => unreachable!("pictures have 8, 16 or 32 bits a channel"),
    }
}

/// Values that are no numbers are equal to each other, and infinitely far from all others.
fn apart(one: f64, other: f64) -> f64 {
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
        let found = Difference { pixels: 2, first: [2, 1], largest: 200.0, full_scale: 255.0 };
        assert_eq!(Difference::between(&grey, &other), Some(found));
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
        assert_eq!(difference_picture(&deep(0), &deep(0xFFFF)).into_raw(), [255, 255, 0]);
    }

    #[test]
    fn floats_are_compared_as_numbers() {
        let float = |value| DynamicImage::from(Rgb32FImage::from_raw(1, 1, vec![value, 0.0, 0.0]).unwrap());
        let largest = |one, other| Difference::between(&float(one), &float(other)).map(|found| found.largest);
        assert_eq!(largest(0.5, 2.0), Some(1.5));
        assert_eq!(largest(f32::MAX, f32::INFINITY), Some(f64::INFINITY));
        assert_eq!(largest(f32::NAN, 1.0), Some(f64::INFINITY));
        let another_nan = f32::from_bits(f32::NAN.to_bits() + 1);
        for (one, other) in [(0.0, -0.0), (f32::NAN, another_nan), (f32::INFINITY, f32::INFINITY)] {
            assert_eq!(largest(one, other), None, "{one} {other}");
        }
        assert_eq!(difference_picture(&float(0.0), &float(f32::NAN)).into_raw(), [255, 255, 0]);
    }

    #[test]
    fn layouts_tell_channels_and_depth_apart() {
        let picture = DynamicImage::from(RgbImage::new(4, 2));
        let said = [picture.clone(), picture.to_rgba8().into(), picture.to_luma16().into(), picture.to_rgb32f().into()];
        assert_eq!(
            said.map(|picture| Layout::of(&picture).to_string()),
            [
                "4 x 2 pixels of RGB with 8 bits a channel",
                "4 x 2 pixels of RGBA with 8 bits a channel",
                "4 x 2 pixels of grey with 16 bits a channel",
                "4 x 2 pixels of RGB with 32 bits a channel",
            ]
        );
    }
}
