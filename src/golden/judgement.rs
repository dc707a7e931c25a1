//! Whether a picture is accepted as a replacement of another one.

use image::DynamicImage;
use serde::Serialize;

use super::difference::{Difference, pixels_over};
use super::layout::Layout;
use super::limit::Limit;
use super::mask::Mask;
use super::measures::{FlipMap, Measures, PIXELS_PER_DEGREE};

/// The condition for accepting a picture. Size, channels and bits per channel must always be equal.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Match {
    /// All values are equal, as with a deterministic renderer.
    Exact,
    /// Few pixels have a channel that differs by more than `difference`: in 1/255 of full scale at any depth, for
    /// floats in their own unit. Noise passes, a lost triangle does not.
    Tolerance { difference: f64, pixels: Allowed },
    /// The mean of FLIP is at most `mean`: the visible difference for a person who flips between the pictures. Not for
    /// floats.
    Flip { mean: f64, pixels_per_degree: f64 },
}

/// The number of pixels that may differ by more than the tolerance.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Allowed {
    Pixels(usize),
    /// A percentage of the compared pixels.
    Percent(f64),
}

impl Match {
    /// No channel of any pixel differs by more than this.
    pub fn within(difference: f64) -> Self {
        Self::Tolerance { difference, pixels: Allowed::Pixels(0) }
    }

    /// FLIP on the screen that its authors assume.
    pub fn flip(mean: f64) -> Self {
        Self::Flip { mean, pixels_per_degree: PIXELS_PER_DEGREE }
    }

    fn difference(self) -> f64 {
        if let Self::Tolerance { difference, .. } = self { difference } else { 0.0 }
    }

    fn pixels_per_degree(self) -> f64 {
        if let Self::Flip { pixels_per_degree, .. } = self { pixels_per_degree } else { PIXELS_PER_DEGREE }
    }
}

impl Allowed {
    fn of(self, compared: usize) -> usize {
        match self {
            Self::Pixels(pixels) => pixels,
            // Only whole pixels differ: the fraction has no effect.
            Self::Percent(percent) => (percent * compared as f64 / 100.0) as usize,
        }
    }
}

/// The result of comparing two pictures.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Verdict {
    Differs,
    /// It could not be read, or this measure does not support the pictures.
    Failed,
    Missing,
    Additional,
    /// It differs, but within the tolerance.
    Accepted,
    Identical,
}

/// Two pictures of one layout that differ.
pub struct Judgement<'a> {
    pub accepted: bool,
    pub difference: Difference,
    /// The number that decided; `None` for [`Match::Exact`].
    pub limit: Option<Limit>,
    how: Match,
    flip: Option<FlipMap>,
    expected: &'a DynamicImage,
    actual: &'a DynamicImage,
    mask: Option<&'a Mask>,
}

/// FLIP does not support floats.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[error("FLIP needs pictures of 8 or 16 bits per channel, and these are floats: use --max-difference instead")]
pub struct NoFlip;

impl<'a> Judgement<'a> {
    /// Judges a picture; `None` if all compared values are equal. Computes only the measures that decide. Masked pixels
    /// must already be equal: [`Mask::applied`].
    ///
    /// # Errors
    /// If FLIP is requested for floats.
    pub fn new(
        [expected, actual]: [&'a DynamicImage; 2],
        how: Match,
        mask: Option<&'a Mask>,
    ) -> Result<Option<Self>, NoFlip> {
        let layout = Layout::of(expected);
        if matches!(how, Match::Flip { .. }) && layout.is_float() {
            return Err(NoFlip);
        }
        let Some(difference) = Difference::between(expected, actual) else { return Ok(None) };
        let compared = layout.pixels() - mask.map_or(0, Mask::masked);
        let mut judged = Self { accepted: false, difference, limit: None, how, flip: None, expected, actual, mask };
        judged.limit = match how {
            Match::Exact => None,
            Match::Tolerance { difference, pixels } => Some(Limit::Pixels {
                max_difference: difference,
                pixels_over: pixels_over(expected, actual, difference),
                allow_pixels: pixels.of(compared),
            }),
            Match::Flip { mean, .. } => {
                judged.flip().map(|flip| Limit::Flip { flip_mean: flip.summary(mask).mean, max_flip: mean })
            }
        };
        judged.accepted = judged.limit.is_some_and(|limit| limit.is_met());
        Ok(Some(judged))
    }

    /// The difference, and the number that decided with its limit.
    pub fn said(&self) -> Vec<String> {
        let layout = Layout::of(self.expected);
        let limit = self.limit.map(|limit| limit.sentence(&layout));
        [self.difference.sentence(layout.size)].into_iter().chain(limit).collect()
    }

    /// FLIP of all pixels; `None` for floats.
    pub fn flip(&mut self) -> Option<&FlipMap> {
        if self.flip.is_none() {
            self.flip = FlipMap::new(self.expected, self.actual, self.how.pixels_per_degree());
        }
        self.flip.as_ref()
    }

    /// All measures.
    pub fn measures(&mut self) -> Measures {
        self.flip();
        let pictures = [self.expected, self.actual];
        Measures::new(pictures, self.difference, self.how.difference(), self.flip.as_ref(), self.mask)
    }
}
