//! FLIP for low dynamic range. FLIP measures the visible difference when a viewer flips between two pictures.
//!
//! Unlike the paper, this module blends transparent pictures with a black and with a white background. The FLIP of a
//! pixel is the larger of the two results.
//!
//! # References
//! Andersson, Nilsson, Akenine-Möller, Oskarsson, Åström, Fairchild: FLIP: a difference evaluator for alternating
//! images, Proceedings of the ACM on Computer Graphics and Interactive Techniques 3(2), 2020.

use std::f64::consts::PI;

use glam::{DMat3, DVec3};
use image::DynamicImage;

use super::plane::{Plane, gaussian, in_bands, offsets};
use crate::golden::layout::Layout;

/// The default of the paper for pixels per degree of visual angle. The paper assumes a screen of 3840 columns, 0.7 m
/// wide and 0.7 m away.
pub const PIXELS_PER_DEGREE: f64 = 3840.0 * PI / 180.0;

/// FLIP of each pixel, from 0 (equal) to 1. The pictures must have equal layouts. Floats are not supported.
pub fn flip(one: &DynamicImage, other: &DynamicImage, pixels_per_degree: f64) -> Vec<f32> {
    let layout = Layout::of(one);
    let filters = Filters::new(pixels_per_degree);
    let over = |background: f64| {
        in_bands(layout.size, filters.reach(), |rows| {
            let [one, other] = [one, other].map(|picture| Perceived::new(picture, &layout, rows, background, &filters));
            (0..one.lab.len()).map(|i| one.differs(&other, i)).collect()
        })
    };
    let black = over(0.0);
    let Some(alpha) = layout.alpha() else { return black };
    let is_clear = |pixel| layout.values(pixel).nth(alpha) != Some(layout.full_scale());
    if ![one, other].iter().any(|picture| picture.as_bytes().chunks_exact(layout.bytes_per_pixel()).any(is_clear)) {
        return black;
    }
    black.iter().zip(over(1.0)).map(|(black, white)| black.max(white)).collect()
}

struct Filters {
    /// The filters `lightness`, `red_green` and `blue_yellow` model contrast sensitivity.
    lightness: Vec<f64>,
    red_green: Vec<f64>,
    /// Two pairs of a share and a Gaussian.
    blue_yellow: [(f64, Vec<f64>); 2],
    /// A Gaussian for feature detection.
    smooth: Vec<f64>,
    /// The first derivative of `smooth`, normalized.
    edge: Vec<f64>,
    /// The second derivative of `smooth`, normalized.
    point: Vec<f64>,
}

impl Filters {
    fn new(pixels_per_degree: f64) -> Self {
        // The term `a sqrt(π/b) exp(-π² x²/b)` of the paper, with x in degrees, is a Gaussian. `deviation` is its
        // standard deviation in pixels. All terms have the window of the widest Gaussian.
        let deviation = |b: f64| (b / (2.0 * PI * PI)).sqrt() * pixels_per_degree;
        let reach = (3.0 * deviation(0.04)).ceil() as usize;
        let term = |b| gaussian(reach, deviation(b));
        let sum = |a: f64, b: f64| {
            let weights = offsets(reach).map(|x| libm::exp(-x * x / (2.0 * deviation(b) * deviation(b))));
            let across: f64 = weights.sum();
            a * (PI / b).sqrt() * across * across
        };
        let [wide, narrow] = [sum(34.1, 0.04), sum(13.5, 0.025)];
        let share = wide / (wide + narrow);

        // Features are 0.082 degrees wide.
        let sigma = 0.5 * 0.082 * pixels_per_degree;
        let feature = (3.0 * sigma).ceil() as usize;
        let smooth = gaussian(feature, sigma);
        let derived = |of: fn(f64) -> f64| {
            balanced(smooth.iter().zip(offsets(feature)).map(|(own, x)| own * of(x / sigma)).collect())
        };
        Self {
            lightness: term(0.0047),
            red_green: term(0.0053),
            blue_yellow: [(share, term(0.04)), (1.0 - share, term(0.025))],
            edge: derived(|x| -x),
            point: derived(|x| x * x - 1.0),
            smooth,
        }
    }

    fn reach(&self) -> usize {
        self.lightness.len().max(self.smooth.len()) / 2
    }
}

fn balanced(weights: Vec<f64>) -> Vec<f64> {
    let sum = |sign: f64| weights.iter().map(|weight| (sign * weight).max(0.0)).sum::<f64>();
    let (above, below) = (sum(1.0), sum(-1.0));
    weights.iter().map(|weight| weight / if *weight > 0.0 { above } else { below }).collect()
}

struct Perceived {
    lab: Vec<DVec3>,
    edges: Vec<f64>,
    points: Vec<f64>,
}

impl Perceived {
    fn new(picture: &DynamicImage, layout: &Layout, rows: &[usize], background: f64, filters: &Filters) -> Self {
        let (width, bytes) = (layout.size[0] as usize, layout.bytes_per_pixel());
        let pixels =
            rows.iter().flat_map(|row| picture.as_bytes()[row * width * bytes..][..width * bytes].chunks_exact(bytes));
        let opponent: Vec<DVec3> = pixels.map(|pixel| opponent(linear(layout, pixel, background))).collect();
        let plane = |axis: usize| Plane::new(width, opponent.iter().map(|colour| colour[axis]).collect());
        let [y, cx, cz] = [0, 1, 2].map(plane);

        let lightness = y.convolved(&filters.lightness, &filters.lightness).values;
        let red_green = cx.convolved(&filters.red_green, &filters.red_green).values;
        let [wide, narrow] = filters.blue_yellow.each_ref().map(|(_, weights)| cz.convolved(weights, weights).values);
        let [share, rest] = [filters.blue_yellow[0].0, filters.blue_yellow[1].0];
        let seen = |i| perceived(DVec3::new(lightness[i], red_green[i], share * wide[i] + rest * narrow[i]));
        let lab = (0..opponent.len()).map(seen).collect();

        let y = Plane::new(width, y.values.iter().map(|y| (y + 16.0) / 116.0).collect());
        let strength = |derived: &[f64]| -> Vec<f64> {
            let [across, down] =
                [[derived, &filters.smooth], [&filters.smooth, derived]].map(|[a, b]| y.convolved(a, b));
            across.values.iter().zip(down.values).map(|(x, y)| (x * x + y * y).sqrt()).collect()
        };
        Self { lab, edges: strength(&filters.edge), points: strength(&filters.point) }
    }

    fn differs(&self, other: &Self, i: usize) -> f64 {
        let colour = spread(libm::pow(hyab(self.lab[i], other.lab[i]), 0.7));
        let feature = (self.edges[i] - other.edges[i]).abs().max((self.points[i] - other.points[i]).abs());
        libm::pow(colour, 1.0 - libm::sqrt(feature / 2.0f64.sqrt()))
    }
}

fn linear(layout: &Layout, pixel: &[u8], background: f64) -> DVec3 {
    let mut values = [0.0; 4];
    layout.values(pixel).zip(&mut values).for_each(|(own, value)| *value = own / layout.full_scale());
    let alpha = layout.alpha().map_or(1.0, |channel| values[channel]);
    let colour = if layout.channels < 3 { DVec3::splat(values[0]) } else { DVec3::from_slice(&values) };
    let shown = colour * alpha + background * (1.0 - alpha);
    let decoded = |c: f64| if c > 0.04045 { libm::pow((c + 0.055) / 1.055, 2.4) } else { c / 12.92 };
    DVec3::from_array(shown.to_array().map(decoded))
}

/// The matrix from linear sRGB to XYZ.
const XYZ: DMat3 = DMat3::from_cols_array(&[
    10135552.0 / 24577794.0,
    2613072.0 / 12288897.0,
    1425312.0 / 73733382.0,
    8788810.0 / 24577794.0,
    8788810.0 / 12288897.0,
    8788810.0 / 73733382.0,
    4435075.0 / 24577794.0,
    887015.0 / 12288897.0,
    70074185.0 / 73733382.0,
]);

/// XYZ of a linear RGB colour, divided by XYZ of white.
fn relative_to_white(rgb: DVec3) -> DVec3 {
    XYZ * rgb / (XYZ * DVec3::ONE)
}

/// Converts linear RGB to YCxCz, a linearized CIELAB.
fn opponent(rgb: DVec3) -> DVec3 {
    let xyz = relative_to_white(rgb);
    DVec3::new(116.0 * xyz.y - 16.0, 500.0 * (xyz.x - xyz.y), 200.0 * (xyz.y - xyz.z))
}

/// Converts a filtered colour from YCxCz to CIELAB.
fn perceived(colour: DVec3) -> DVec3 {
    let y = (colour.x + 16.0) / 116.0;
    let xyz = DVec3::new(y + colour.y / 500.0, y, y - colour.z / 200.0);
    lab((XYZ.inverse() * (xyz * (XYZ * DVec3::ONE))).clamp(DVec3::ZERO, DVec3::ONE))
}

/// Converts linear RGB to CIELAB. Chroma is scaled by lightness (Hunt effect).
fn lab(rgb: DVec3) -> DVec3 {
    let delta: f64 = 6.0 / 29.0;
    let root = |t: f64| if t > delta.powi(3) { libm::cbrt(t) } else { t / (3.0 * delta * delta) + 4.0 / 29.0 };
    let [x, y, z] = relative_to_white(rgb).to_array().map(root);
    let lightness = 116.0 * y - 16.0;
    DVec3::new(lightness, 5.0 * lightness * (x - y), 2.0 * lightness * (y - z))
}

fn hyab(one: DVec3, other: DVec3) -> f64 {
    let gap = one - other;
    gap.x.abs() + (gap.y * gap.y + gap.z * gap.z).sqrt()
}

/// Maps `distance`, a HyAB distance to the power 0.7, to 0..1. The largest HyAB distance is between green and blue.
fn spread(distance: f64) -> f64 {
    let most = libm::pow(hyab(lab(DVec3::Y), lab(DVec3::Z)), 0.7);
    let bend = 0.4 * most;
    if distance < bend { 0.95 / bend * distance } else { 0.95 + (distance - bend) / (most - bend) * 0.05 }
}
