//! Layouts and channel values of pictures.

use std::fmt::{self, Display, Formatter};

use image::DynamicImage;

/// Only pictures with equal layouts can be compared.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Layout {
    pub size: [u32; 2],
    /// 1: grey, 2: grey with alpha, 3: RGB, 4: RGBA.
    pub channels: u8,
    /// Bits per channel: 8 or 16, or 32 for floats.
    pub bits: u8,
}

impl Layout {
    pub fn of(picture: &DynamicImage) -> Self {
        let (size, color) = ([picture.width(), picture.height()], picture.color());
        let channels = color.channel_count();
        Self { size, channels, bits: (color.bits_per_pixel() / u16::from(channels)) as u8 }
    }

    pub fn full_scale(&self) -> f64 {
        match self.bits {
            8 => u8::MAX.into(),
            16 => u16::MAX.into(),
            _ => 1.0,
        }
    }

    /// Float values may be less than 0 or more than 1.
    pub fn is_float(&self) -> bool {
        self.bits == 32
    }

    pub fn pixels(&self) -> usize {
        self.size.map(|side| side as usize).iter().product()
    }

    pub(super) fn alpha(&self) -> Option<usize> {
        self.channels.is_multiple_of(2).then(|| usize::from(self.channels) - 1)
    }

    pub(super) fn bytes_per_pixel(&self) -> usize {
        usize::from(self.channels) * usize::from(self.bits / 8)
    }

    pub(super) fn values<'a>(&self, pixel: &'a [u8]) -> impl Iterator<Item = f64> + 'a {
        pixel.chunks_exact(usize::from(self.bits / 8)).map(value)
    }
}

fn value(sample: &[u8]) -> f64 {
    match *sample {
        [byte] => byte.into(),
        [a, b] => u16::from_ne_bytes([a, b]).into(),
        [a, b, c, d] => f32::from_ne_bytes([a, b, c, d]).into(),
        _ => unreachable!("pictures have 8, 16 or 32 bits per channel"),
    }
}

impl Display for Layout {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        let [width, height] = self.size;
        let channels = ["grey", "grey and alpha", "RGB", "RGBA"][usize::from(self.channels) - 1];
        write!(f, "{width} x {height} pixels of {channels} with {} bits per channel", self.bits)
    }
}
