//! SSIM, the structural similarity.
//!
//! # References
//! Wang, Bovik, Sheikh, Simoncelli: Image quality assessment: from error visibility to structural similarity, IEEE
//! Transactions on Image Processing, 2004.

use image::DynamicImage;

use super::plane::{Plane, gaussian, in_bands};
use crate::golden::layout::Layout;

/// The number of pixels on each side of the centre of the Gaussian window.
const REACH: usize = 5;
const SIGMA: f64 = 1.5;

/// `(K1 L)²` of the paper, for K1 = 0.01 and full scale L = 1.
const C1: f64 = 1e-4;
/// `(K2 L)²` of the paper, for K2 = 0.03 and full scale L = 1.
const C2: f64 = 9e-4;

/// The mean SSIM over all channels, including alpha. The mean excludes pixels for which `compared` returns false. The
/// mean also excludes pixels with a window that crosses the edge of the picture. The result is `None` if all pixels are
/// excluded or the mean is not finite.
pub fn ssim(one: &DynamicImage, other: &DynamicImage, compared: impl Fn(usize) -> bool) -> Option<f64> {
    let layout = Layout::of(one);
    let [width, height] = layout.size.map(|side| side as usize);
    let weights = gaussian(REACH, SIGMA);
    let map = in_bands(layout.size, REACH, |rows| {
        let mut sums = vec![0.0; rows.len() * width];
        for channel in 0..usize::from(layout.channels) {
            let plane = |picture| Plane::new(width, channel_of(picture, &layout, channel, rows));
            let (x, y) = (plane(one), plane(other));
            let mean = |plane: &Plane| plane.convolved(&weights, &weights).values;
            let [mx, my, xx, yy, xy] = [&x, &y, &x.times(&x), &y.times(&y), &x.times(&y)].map(mean);
            for (i, sum) in sums.iter_mut().enumerate() {
                let (product, squares) = (mx[i] * my[i], mx[i] * mx[i] + my[i] * my[i]);
                *sum += (2.0 * product + C1) * (2.0 * (xy[i] - product) + C2)
                    / ((squares + C1) * (xx[i] + yy[i] - squares + C2));
            }
        }
        sums
    });

    let is_inside = |place: usize, side: usize| place >= REACH && place + REACH < side;
    let counts = |i: usize| is_inside(i % width, width) && is_inside(i / width, height) && compared(i);
    let chosen = map.iter().enumerate().filter(|(i, _)| counts(*i));
    let (sum, count) = chosen.fold((0.0, 0), |(sum, count), (_, &own)| (sum + f64::from(own), count + 1));
    let mean = sum / f64::from(count) / f64::from(layout.channels);
    mean.is_finite().then_some(mean)
}

fn channel_of(picture: &DynamicImage, layout: &Layout, channel: usize, rows: &[usize]) -> Vec<f64> {
    let (width, bytes) = (layout.size[0] as usize, layout.bytes_per_pixel());
    let pixels =
        rows.iter().flat_map(|row| picture.as_bytes()[row * width * bytes..][..width * bytes].chunks_exact(bytes));
    let value = |pixel| layout.values(pixel).nth(channel).expect("all pixels have all channels");
    pixels.map(|pixel| value(pixel) / layout.full_scale()).collect()
}
