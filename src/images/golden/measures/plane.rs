//! Separable convolution for FLIP and SSIM.

use std::ops::Range;

use rayon::prelude::*;

/// One number per pixel, for some rows of a picture.
pub struct Plane {
    width: usize,
    pub values: Vec<f64>,
}

/// Rows per band. The temporary memory of a thread is proportional to this number.
const BAND: usize = 64;

/// Computes one number per pixel. Bands of rows are computed in parallel. `of` receives the row indices of a band,
/// extended by `reach` rows above and below. An index outside the picture is replaced by the index of the nearest row.
/// `of` must return one number per pixel of the received rows. `reach` must be at least the reach of each convolution.
/// Otherwise, the numbers depend on the bands.
pub fn in_bands(size: [u32; 2], reach: usize, of: impl Fn(&[usize]) -> Vec<f64> + Sync) -> Vec<f32> {
    let [width, height] = size.map(|side| side as usize);
    let bands: Vec<Range<usize>> = (0..height).step_by(BAND).map(|top| top..height.min(top + BAND)).collect();
    let band = |rows: Range<usize>| {
        let inside = reach * width..(reach + rows.len()) * width;
        let padded = rows.start..rows.end + 2 * reach;
        let padded: Vec<usize> = padded.map(|row| row.saturating_sub(reach).min(height - 1)).collect();
        of(&padded)[inside].iter().map(|&number| number as f32).collect::<Vec<f32>>()
    };
    bands.into_par_iter().flat_map_iter(band).collect()
}

impl Plane {
    pub fn new(width: usize, values: Vec<f64>) -> Self {
        Self { width, values }
    }

    pub fn times(&self, other: &Self) -> Self {
        Self::new(self.width, self.values.iter().zip(&other.values).map(|(one, other)| one * other).collect())
    }

    pub fn convolved(&self, across: &[f64], down: &[f64]) -> Self {
        let (width, reach) = (self.width, across.len() / 2);
        let mut rows = vec![0.0; self.values.len()];
        let mut padded = vec![0.0; width + 2 * reach];
        for (row, out) in self.values.chunks_exact(width).zip(rows.chunks_exact_mut(width)) {
            padded[..reach].fill(row[0]);
            padded[reach..reach + width].copy_from_slice(row);
            padded[reach + width..].fill(row[width - 1]);
            across.iter().enumerate().for_each(|(i, weight)| add(out, *weight, &padded[i..]));
        }

        let (height, reach) = (rows.len() / width, down.len() / 2);
        let mut values = vec![0.0; rows.len()];
        for (y, out) in values.chunks_exact_mut(width).enumerate() {
            for (i, weight) in down.iter().enumerate() {
                let row = (y + i).saturating_sub(reach).min(height - 1);
                add(out, *weight, &rows[row * width..][..width]);
            }
        }
        Self::new(width, values)
    }
}

fn add(sums: &mut [f64], weight: f64, row: &[f64]) {
    sums.iter_mut().zip(row).for_each(|(sum, value)| *sum += weight * value);
}

pub fn gaussian(reach: usize, sigma: f64) -> Vec<f64> {
    let weights: Vec<f64> = offsets(reach).map(|x| libm::exp(-x * x / (2.0 * sigma * sigma))).collect();
    let sum: f64 = weights.iter().sum();
    weights.iter().map(|weight| weight / sum).collect()
}

pub fn offsets(reach: usize) -> impl Iterator<Item = f64> {
    (0..=2 * reach).map(move |i| i as f64 - reach as f64)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn values(width: usize, height: usize) -> Vec<f64> {
        (0..width * height).map(|i| libm::sin(i as f64 * 1.7) + 0.01 * i as f64).collect()
    }

    #[test]
    fn a_convolution_is_the_sum_over_the_window_with_edges_repeated() {
        let (width, height) = (7, 5);
        let values = values(width, height);
        let (across, down) = ([0.1, -0.4, 0.7, 0.2, 0.5], [0.3, 0.6, -0.2]);
        let found = Plane::new(width, values.clone()).convolved(&across, &down).values;
        for (pixel, found) in found.into_iter().enumerate() {
            let [x, y] = [pixel % width, pixel / width].map(|place| place as i64);
            let mut sum = 0.0;
            for (j, b) in (-1..=1).zip(down) {
                for (i, a) in (-2..=2).zip(across) {
                    let [x, y] = [(x + i).clamp(0, 6), (y + j).clamp(0, 4)].map(|place| place as usize);
                    sum += a * b * values[y * width + x];
                }
            }
            assert!((found - sum).abs() < 1e-12, "{x}, {y}: {found}, {sum}");
        }
    }

    #[test]
    fn bands_give_what_the_whole_gives() {
        let (width, height) = (9, 3 * BAND + 5);
        let values = values(width, height);
        let weights = gaussian(5, 1.5);
        let whole = Plane::new(width, values.clone()).convolved(&weights, &weights).values;
        let of = |rows: &[usize]| {
            let own = rows.iter().flat_map(|row| &values[row * width..][..width]).copied().collect();
            Plane::new(width, own).convolved(&weights, &weights).values
        };
        let banded = in_bands([width as u32, height as u32], 5, of);
        assert_eq!(banded, whole.iter().map(|&value| value as f32).collect::<Vec<f32>>());
    }
}
