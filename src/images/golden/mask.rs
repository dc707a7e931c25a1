//! Pixels that are excluded from a comparison.

use image::{DynamicImage, ImageBuffer, Pixel};

use super::layout::Layout;

#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Mask {
    pub size: [u32; 2],
    compared: Vec<bool>,
}

impl Mask {
    /// Excludes the black pixels of `picture`. Alpha is ignored.
    pub fn new(picture: &DynamicImage) -> Self {
        let layout = Layout::of(picture);
        let colours = usize::from(layout.channels) - usize::from(layout.alpha().is_some());
        let is_light = |pixel| layout.values(pixel).take(colours).any(|value| value != 0.0);
        let compared = picture.as_bytes().chunks_exact(layout.bytes_per_pixel()).map(is_light).collect();
        Self { size: layout.size, compared }
    }

    /// `pixel` is an index in reading order.
    pub fn compares(mask: Option<&Self>, pixel: usize) -> bool {
        mask.is_none_or(|mask| mask.compared[pixel])
    }

    /// The number of excluded pixels.
    pub fn masked_pixels(&self) -> usize {
        self.compared.iter().filter(|compared| !**compared).count()
    }

    /// Copies the excluded pixels of `expected` to `actual`. The measures then find no difference in excluded
    /// pixels. The pictures must have the same layout. The pictures and the mask must have the same size.
    pub(super) fn applied(&self, expected: &DynamicImage, mut actual: DynamicImage) -> DynamicImage {
        macro_rules! of_one_kind {
            ($($kind:ident)*) => {
                match (&mut actual, expected) {
                    $((DynamicImage::$kind(own), DynamicImage::$kind(other)) => self.replace(own, other),)*
                    _ => unreachable!("pictures of one layout"),
                }
            };
        }
        of_one_kind!(ImageLuma8 ImageLumaA8 ImageRgb8 ImageRgba8 ImageLuma16 ImageLumaA16 ImageRgb16 ImageRgba16
            ImageRgb32F ImageRgba32F);
        actual
    }

    fn replace<P: Pixel>(&self, own: &mut Buffer<P>, other: &Buffer<P>) {
        let pixels = own.pixels_mut().zip(other.pixels()).zip(&self.compared);
        pixels.filter(|(_, compared)| !**compared).for_each(|((own, other), _)| *own = *other);
    }
}

type Buffer<P> = ImageBuffer<P, Vec<<P as Pixel>::Subpixel>>;
