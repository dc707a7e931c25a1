//! One comparison, in the form of tables, JSON and the page.

use image::{DynamicImage, RgbImage};
use serde::Serialize;

use super::judgement::{Judgement, Match, Verdict};
use super::limit::{Limit, differ};
use super::measures::{FlipMap, Measures};
use super::{Difference, Layout, Mask, difference_picture};
use crate::plural::{count, plural};

/// Two pictures of one name, or one picture without a partner.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Comparison {
    pub name: String,
    pub verdict: Verdict,
    /// The findings, in sentences.
    pub said: Vec<String>,
    /// A command that investigates the difference.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub command: Option<String>,
    /// The number that decided, unless all values must be equal.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub limit: Option<Limit>,
    /// Measures of two pictures of one layout that differ.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub measures: Option<Measures>,
}

/// Maps of the difference of two pictures, which a page shows beside them.
pub struct Maps {
    pub difference: RgbImage,
    pub flip: Option<FlipMap>,
}

impl Comparison {
    /// A comparison without measures.
    pub fn said(name: impl Into<String>, verdict: Verdict, sentence: impl Into<String>) -> Self {
        Self { name: name.into(), verdict, said: vec![sentence.into()], command: None, limit: None, measures: None }
    }

    /// See [`Measures::of_names`].
    #[must_use]
    pub fn of_names(self, size: [u32; 2]) -> Self {
        let Some(measures) = self.measures.map(Measures::of_names) else { return self };
        Self { said: vec![measures.difference.sentence(size)], measures: Some(measures), ..self }
    }

    /// Whether the pictures are not accepted, or one is missing.
    pub fn fails(&self) -> bool {
        self.verdict < Verdict::Accepted
    }
}

/// Compares two pictures, except the masked pixels. Also returns maps of the difference.
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
        let sentence = format!(
            "the mask has {width} x {height} pixels, but the picture has {wanted}: use a mask of the same \
                     size"
        );
        return said(Verdict::Failed, sentence);
    }
    let masked = mask.map(|mask| mask.applied(expected, actual.clone()));
    let pictures = [expected, masked.as_ref().unwrap_or(actual)];
    let mut judged = match Judgement::new(pictures, how, mask) {
        Err(refused) => return said(Verdict::Failed, refused.to_string()),
        Ok(None) => return said(Verdict::Identical, "all values are equal".into()),
        Ok(Some(judged)) => judged,
    };
    let comparison = Comparison {
        name: name.into(),
        verdict: if judged.accepted { Verdict::Accepted } else { Verdict::Differs },
        said: judged.said(),
        command: None,
        limit: judged.limit,
        measures: Some(judged.measures()),
    };
    let flip = judged.flip().cloned();
    (comparison, Some(Maps { difference: difference_picture(pictures[0], pictures[1]), flip }))
}

impl Difference {
    /// The number of differing pixels of a picture of this size, with the largest difference and its place.
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

    fn verdict(pictures: [&DynamicImage; 2], how: Match) -> Verdict {
        compare("a", pictures, how, None).0.verdict
    }

    #[test]
    fn floats_are_accepted_by_their_own_difference_and_not_by_flip() {
        let float = |value| DynamicImage::from(Rgb32FImage::from_pixel(12, 12, Rgb([value, 0.0, 7.0])));
        let [one, other] = [float(2.0), float(2.5)];
        assert_eq!(
            [0.4, 0.5].map(|most| verdict([&one, &other], Match::within(most))),
            [Verdict::Differs, Verdict::Accepted]
        );
        let (refused, maps) = compare("a", [&one, &other], Match::flip(1.0), None);
        assert!(
            refused.verdict == Verdict::Failed && refused.said[0].contains("floats") && maps.is_none(),
            "{refused:?}"
        );
        let (found, maps) = compare("a", [&one, &float(f32::NAN)], Match::Exact, None);
        assert!(found.measures.unwrap().flip.is_none() && maps.unwrap().flip.is_none());
        let text = serde_json::to_value(&found).unwrap();
        assert!(
            text["measures"]["largest"].is_null() && text["measures"]["pixels"] == 144,
            "infinity is no JSON: {text}"
        );
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
