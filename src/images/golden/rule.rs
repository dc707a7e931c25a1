//! The rules for accepting a picture that differs from a golden image.

use image::DynamicImage;
use serde::Serialize;

use super::difference::pixels_over;
use super::layout::Layout;
use super::mask::Mask;
use super::measures::{FlipMap, PIXELS_PER_DEGREE};
use crate::plural::{count, plural};

/// All rules require pictures with equal layouts.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Match {
    Exact,
    /// `pixels` limits the number of pixels with a channel that differs by more than `difference`. The unit of
    /// `difference` is 1/255 of full scale, or 1 for floats.
    Tolerance {
        difference: f64,
        pixels: Allowed,
    },
    /// The mean of FLIP is at most `mean`. FLIP does not support floats.
    Flip {
        mean: f64,
        pixels_per_degree: f64,
    },
}

/// The number of pixels that may differ by more than the tolerance.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Allowed {
    Pixels(usize),
    /// A percentage of the compared pixels.
    Percent(f64),
}

impl Match {
    pub fn within(difference: f64) -> Self {
        Self::Tolerance { difference, pixels: Allowed::Pixels(0) }
    }

    pub fn flip(mean: f64) -> Self {
        Self::Flip { mean, pixels_per_degree: PIXELS_PER_DEGREE }
    }

    /// The pictures must have the same layout. Each masked pixel must be equal in both pictures.
    pub(super) fn limit(
        self,
        [expected, actual]: [&DynamicImage; 2],
        flip: Option<&FlipMap>,
        mask: Option<&Mask>,
    ) -> Option<Limit> {
        match self {
            Self::Exact => None,
            Self::Tolerance { difference, pixels } => Some(Limit::Pixels {
                max_difference: difference,
                pixels_over: pixels_over(expected, actual, difference),
                allow_pixels: pixels.of(Layout::of(expected).pixels() - mask.map_or(0, Mask::masked_pixels)),
            }),
            Self::Flip { mean, .. } => {
                flip.map(|flip| Limit::Flip { flip_mean: flip.summary(mask).mean, max_flip: mean })
            }
        }
    }

    pub(super) fn difference(self) -> f64 {
        if let Self::Tolerance { difference, .. } = self { difference } else { 0.0 }
    }

    pub(super) fn pixels_per_degree(self) -> f64 {
        if let Self::Flip { pixels_per_degree, .. } = self { pixels_per_degree } else { PIXELS_PER_DEGREE }
    }
}

impl Allowed {
    fn of(self, compared: usize) -> usize {
        match self {
            Self::Pixels(pixels) => pixels,
            // Rounding down changes no verdict, because `pixels_over` is an integer.
            Self::Percent(percent) => (percent * compared as f64 / 100.0) as usize,
        }
    }
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[error("FLIP needs pictures of 8 or 16 bits per channel, and these are floats: use --max-difference instead")]
pub struct NoFlip;

/// The field names appear in JSON.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
#[serde(untagged)]
pub enum Limit {
    Pixels { max_difference: f64, pixels_over: usize, allow_pixels: usize },
    Flip { flip_mean: f64, max_flip: f64 },
}

impl Limit {
    pub fn is_met(&self) -> bool {
        match *self {
            Self::Pixels { pixels_over, allow_pixels, .. } => pixels_over <= allow_pixels,
            Self::Flip { flip_mean, max_flip } => flip_mean <= max_flip,
        }
    }

    pub fn sentence(&self, layout: &Layout) -> String {
        match *self {
            Self::Pixels { max_difference, pixels_over, allow_pixels } => {
                let unit = if layout.is_float() { "" } else { " of 255" };
                let more =
                    if max_difference > 0.0 { format!(" by more than {max_difference}{unit}") } else { String::new() };
                let are = if allow_pixels == 1 { "is" } else { "are" };
                let pixels = plural(pixels_over, "pixel");
                format!("{pixels} {}{more}, and {} {are} allowed", differ(pixels_over), count(allow_pixels as u64))
            }
            Self::Flip { flip_mean, max_flip } => {
                // Add decimals until rounding does not move the mean across the limit.
                let is_true = |text: &String| {
                    text.parse::<f64>().is_ok_and(|rounded| (rounded <= max_flip) == (flip_mean <= max_flip))
                };
                let rounded = (4..20).map(|decimals| format!("{flip_mean:.decimals$}")).find(is_true);
                let mean = rounded.unwrap_or_else(|| flip_mean.to_string());
                format!("the mean of FLIP is {mean}, and {max_flip} is allowed")
            }
        }
    }
}

pub(super) fn differ(pixels: usize) -> &'static str {
    if pixels == 1 { "differs" } else { "differ" }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_sentence_has_the_number_that_is_compared_with_the_limit() {
        let layout = |bits| Layout { size: [160, 120], channels: 3, bits };
        let pixels =
            |max_difference, pixels_over, allow_pixels| Limit::Pixels { max_difference, pixels_over, allow_pixels };
        for (limit, bits, text) in [
            (pixels(2.0, 2258, 1000), 8, "2,258 pixels differ by more than 2 of 255, and 1,000 are allowed"),
            (pixels(0.5, 1, 0), 32, "1 pixel differs by more than 0.5, and 0 are allowed"),
            (pixels(0.0, 1, 1), 16, "1 pixel differs, and 1 is allowed"),
        ] {
            assert_eq!((limit.sentence(&layout(bits)), limit.is_met()), (text.into(), text.contains("1 is")));
        }
        for (flip_mean, mean, is_met) in [
            (0.034_21, "0.0342", false),
            (0.010_000_04, "0.01000004", false),
            (0.01, "0.0100", true),
            (0.0, "0.0000", true),
        ] {
            let limit = Limit::Flip { flip_mean, max_flip: 0.01 };
            let text = format!("the mean of FLIP is {mean}, and 0.01 is allowed");
            assert_eq!((limit.sentence(&layout(8)), limit.is_met()), (text, is_met));
        }
    }
}
