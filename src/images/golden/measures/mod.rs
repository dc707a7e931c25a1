//! Measures of the difference between two pictures: mean, PSNR, SSIM and FLIP.

mod flip;
mod plane;
mod ssim;
#[cfg(test)]
mod tests;

use image::DynamicImage;
use serde::Serialize;

use super::difference::{Difference, apart, pixels_over};
use super::layout::Layout;
use super::mask::Mask;

pub use flip::PIXELS_PER_DEGREE;

/// An undefined measure is `None` or not finite. In JSON, an undefined measure is null.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Measures {
    pub compared: usize,
    pub masked: usize,
    #[serde(flatten)]
    pub difference: Difference,
    /// The number of pixels that differ by more than the tolerance.
    pub pixels_over: usize,
    /// The mean difference, in channel values, over all channels of the compared pixels.
    pub mean: f64,
    /// The peak signal-to-noise ratio in dB.
    pub psnr: f64,
    /// The mean SSIM of the compared pixels whose SSIM window is inside the picture.
    pub ssim: Option<f64>,
    pub flip: Option<Flip>,
}

#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Flip {
    pub mean: f64,
    pub percentile_95: f64,
    pub largest: f64,
}

/// FLIP of each pixel, from 0 to 1.
#[derive(Clone, Debug, PartialEq)]
pub struct FlipMap {
    pub size: [u32; 2],
    pub values: Vec<f32>,
}

impl FlipMap {
    /// `None` for pictures of floats. The pictures must have the same layout.
    pub fn new(one: &DynamicImage, other: &DynamicImage, pixels_per_degree: f64) -> Option<Self> {
        let layout = Layout::of(one);
        (!layout.is_float()).then(|| Self { size: layout.size, values: flip::flip(one, other, pixels_per_degree) })
    }

    pub fn summary(&self, mask: Option<&Mask>) -> Flip {
        let compared = self.values.iter().enumerate().filter(|(i, _)| Mask::compares(mask, *i));
        let mut values: Vec<f32> = compared.map(|(_, value)| *value).collect();
        values.sort_unstable_by(f32::total_cmp);
        let sum: f64 = values.iter().copied().map(f64::from).sum();
        let at = |place: usize| values.get(place.saturating_sub(1)).map_or(0.0, |&value| value.into());
        Flip {
            mean: sum / values.len().max(1) as f64,
            percentile_95: at((values.len() * 95).div_ceil(100)),
            largest: at(values.len()),
        }
    }
}

impl Measures {
    /// Each masked pixel must be equal in both pictures.
    pub fn new(
        [one, other]: [&DynamicImage; 2],
        difference: Difference,
        tolerance: f64,
        flip: Option<&FlipMap>,
        mask: Option<&Mask>,
    ) -> Self {
        let layout = Layout::of(one);
        let masked = mask.map_or(0, Mask::masked_pixels);
        let compared = layout.pixels() - masked;
        let numbers = (compared * usize::from(layout.channels)) as f64;
        let values = |picture| DynamicImage::as_bytes(picture).chunks_exact(layout.bytes_per_pixel());
        let pixels = values(one).zip(values(other)).filter(|(one, other)| one != other);
        let gaps = pixels.flat_map(|(one, other)| {
            layout.values(one).zip(layout.values(other)).map(|(one, other)| apart(one, other))
        });
        let (sum, squares) = gaps.fold((0.0, 0.0), |(sum, squares), gap| (sum + gap, squares + gap * gap));
        Self {
            compared,
            masked,
            difference,
            pixels_over: pixels_over(one, other, tolerance),
            mean: sum / numbers,
            psnr: 10.0 * libm::log10(layout.full_scale() * layout.full_scale() * numbers / squares),
            ssim: ssim::ssim(one, other, |pixel| Mask::compares(mask, pixel)),
            flip: flip.map(|map| map.summary(mask)),
        }
    }

    /// Removes the sizes of the differences. The size of a difference between primitive numbers has no meaning.
    #[must_use]
    pub fn without_sizes(self) -> Self {
        let difference = Difference { worst: self.difference.first, largest: f64::NAN, ..self.difference };
        Self { difference, mean: f64::NAN, psnr: f64::NAN, ssim: None, flip: None, ..self }
    }
}
