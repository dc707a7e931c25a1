//! Compares two pictures.

use image::{DynamicImage, RgbImage};
use serde::Serialize;

use super::measures::{FlipMap, Measures};
use super::rule::{Limit, Match, NoFlip, differ};
use super::{Difference, Layout, Mask, difference_picture};
use crate::plural::{count, plural};

/// The result of a comparison. [`Comparison::fails`] requires that all failing verdicts precede `Accepted`.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Verdict {
    Differs,
    /// An error prevented the comparison, for example an unreadable picture.
    Failed,
    Missing,
    Additional,
    /// The rule accepts the difference.
    Accepted,
    Identical,
}

#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Comparison {
    pub name: String,
    pub verdict: Verdict,
    /// The findings, in sentences.
    pub said: Vec<String>,
    /// A command that investigates the difference.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub command: Option<String>,
    /// `None` if `measures` is `None` or the rule is [`Match::Exact`].
    #[serde(skip_serializing_if = "Option::is_none")]
    pub limit: Option<Limit>,
    /// `None` if the pictures are equal or cannot be compared.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub measures: Option<Measures>,
}

pub struct Maps {
    pub difference: RgbImage,
    pub flip: Option<FlipMap>,
}

impl Comparison {
    pub fn said(name: impl Into<String>, verdict: Verdict, sentence: impl Into<String>) -> Self {
        Self { name: name.into(), verdict, said: vec![sentence.into()], command: None, limit: None, measures: None }
    }

    /// Removes the sizes of the differences. The size of a difference between primitive numbers has no meaning.
    #[must_use]
    pub fn without_sizes(self, size: [u32; 2]) -> Self {
        let Some(measures) = self.measures.map(Measures::without_sizes) else { return self };
        Self { said: vec![measures.difference.sentence(size)], measures: Some(measures), ..self }
    }

    pub fn fails(&self) -> bool {
        self.verdict < Verdict::Accepted
    }
}

/// The maps are `None` if `measures` is `None`.
pub fn compare(
    name: &str,
    [expected, actual]: [&DynamicImage; 2],
    how: Match,
    mask: Option<&Mask>,
) -> (Comparison, Option<Maps>) {
    let said = |verdict, sentence: String| (Comparison::said(name, verdict, sentence), None);
    let [wanted, found] = [expected, actual].map(Layout::of);
    if wanted != found {
        let advice = if wanted.size == found.size {
            "convert one of the pictures"
        } else {
            "render the picture at the size of the golden image"
        };
        let sentence = format!("expected {wanted}, found {found}: {advice}, or replace the golden image");
        return said(Verdict::Differs, sentence);
    }
    if let Some(mask) = mask.filter(|mask| mask.size != wanted.size) {
        let [width, height] = mask.size;
        let masked = format!("the mask has {width} x {height} pixels, but the picture has {wanted}");
        return said(Verdict::Failed, format!("{masked}: use a mask of the same size"));
    }
    if matches!(how, Match::Flip { .. }) && wanted.is_float() {
        return said(Verdict::Failed, NoFlip.to_string());
    }
    let masked = mask.map(|mask| mask.applied(expected, actual.clone()));
    let pictures = [expected, masked.as_ref().unwrap_or(actual)];
    let Some(difference) = Difference::between(pictures[0], pictures[1]) else {
        return said(Verdict::Identical, "all values are equal".into());
    };
    let flip = FlipMap::new(pictures[0], pictures[1], how.pixels_per_degree());
    let limit = how.limit(pictures, flip.as_ref(), mask);
    let is_met = limit.is_some_and(|limit| limit.is_met());
    let verdict = if is_met { Verdict::Accepted } else { Verdict::Differs };
    let mut comparison = Comparison::said(name, verdict, difference.sentence(wanted.size));
    comparison.said.extend(limit.map(|limit| limit.sentence(&wanted)));
    comparison.limit = limit;
    comparison.measures = Some(Measures::new(pictures, difference, how.difference(), flip.as_ref(), mask));
    (comparison, Some(Maps { difference: difference_picture(pictures[0], pictures[1]), flip }))
}

impl Difference {
    pub fn sentence(&self, [width, height]: [u32; 2]) -> String {
        let Self { pixels, first, worst, largest, full_scale } = *self;
        let all = plural(width as usize * height as usize, "pixel");
        let most =
            if worst == first { String::new() } else { format!(", most at column {}, row {}", worst[0], worst[1]) };
        let size = match full_scale {
            _ if largest.is_nan() => String::new(),
            1.0 => format!(", by up to {largest}"),
            _ => format!(", by up to {} of {}", count(largest as u64), count(full_scale as u64)),
        };
        let [column, row] = first;
        let (number, differ) = (count(pixels as u64), differ(pixels));
        format!("{number} of {all} {differ}, first at column {column}, row {row}{size}{most}")
    }
}

#[cfg(test)]
mod tests {
    use image::{Rgb, Rgb32FImage, RgbImage};

    use super::*;
    use crate::golden::Allowed;

    #[test]
    fn floats_are_accepted_by_their_own_difference_and_not_by_flip() {
        let float = |value| DynamicImage::from(Rgb32FImage::from_pixel(12, 12, Rgb([value, 0.0, 7.0])));
        let [one, other] = [float(2.0), float(2.5)];
        let verdict = |most| compare("a", [&one, &other], Match::within(most), None).0.verdict;
        assert_eq!([0.4, 0.5].map(verdict), [Verdict::Differs, Verdict::Accepted]);
        let (refused, maps) = compare("a", [&one, &other], Match::flip(1.0), None);
        assert_eq!((refused.verdict, maps.is_none()), (Verdict::Failed, true));
        assert!(refused.said[0].contains("floats"), "{refused:?}");
        let (found, maps) = compare("a", [&one, &float(f32::NAN)], Match::Exact, None);
        assert!(found.measures.unwrap().flip.is_none() && maps.unwrap().flip.is_none());
        let measures = &serde_json::to_value(&found).unwrap()["measures"];
        assert!(measures["largest"].is_null() && measures["pixels"] == 144, "infinity is no JSON: {measures}");
    }

    #[test]
    fn pixels_are_allowed_by_number_or_by_percent_of_those_compared() {
        let right = DynamicImage::from(RgbImage::new(20, 10));
        let mut other = RgbImage::new(20, 10);
        (0..4).for_each(|x| other.put_pixel(x, 0, Rgb([0, 9, 0])));
        let other = other.into();
        let accepts = |pixels, mask: Option<&Mask>| {
            let how = Match::Tolerance { difference: 8.0, pixels };
            compare("a", [&right, &other], how, mask).0.verdict == Verdict::Accepted
        };
        assert_eq!([3, 4].map(|pixels| accepts(Allowed::Pixels(pixels), None)), [false, true]);
        assert_eq!([1.9, 2.0].map(|percent| accepts(Allowed::Percent(percent), None)), [false, true]);
        let mask = Mask::new(&RgbImage::from_fn(20, 10, |_, y| Rgb([0, 0, u8::from(y < 5)])).into());
        assert_eq!([3.9, 4.0].map(|percent| accepts(Allowed::Percent(percent), Some(&mask))), [false, true]);
    }
}
