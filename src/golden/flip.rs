//! How different two pictures look, not how different their numbers are.
//!
//! FLIP for pictures of 8 bits a channel: "FLIP: A Difference Evaluator for Alternating Images", Pontus Andersson, Jim
//! Nilsson, Tomas Akenine-Möller, Magnus Oskarsson, Kalle Åström, Mark D. Fairchild, 2020. As there, with its default viewing
//! distance; in `f64` and with the `libm` crate, so that it is the same on every machine.

use crate::render::Picture;

/// Pixels a degree: a screen 0.7 m wide with 3840 pixels, seen from 0.7 m.
const PIXELS_A_DEGREE: f64 = 67.020_643;

type Colour = [f64; 3];

/// Rows of numbers.
struct Plane<T> {
    size: [usize; 2],
    at: Vec<T>,
}

impl<T: Copy> Plane<T> {
    /// The nearest pixel, where there is none.
    fn near(&self, x: isize, y: isize) -> T {
        let [width, height] = self.size;
        let inside = |i: isize, n: usize| i.clamp(0, n as isize - 1) as usize;
        self.at[inside(y, height) * width + inside(x, width)]
    }

    fn map<U>(&self, f: impl Fn(T) -> U) -> Plane<U> {
        Plane { size: self.size, at: self.at.iter().map(|&x| f(x)).collect() }
    }
}

/// The mean over all pixels of how different they look: 0 for the same picture, at most 1.
///
/// # Panics
/// If the pictures differ in size.
pub fn flip(expected: &Picture, actual: &Picture) -> f64 {
    assert_eq!(expected.size(), actual.size(), "pictures of one size");
    let [one, other] = [expected, actual].map(opponent);
    let colours = differences(&filtered(&one), &filtered(&other), colour_difference);
    let features = differences(&features(&one), &features(&other), feature_difference);
    let sum: f64 = colours.iter().zip(&features).map(|(&colour, &feature)| libm::pow(colour, 1.0 - feature)).sum();
    sum / colours.len() as f64
}

fn differences<T: Copy>(one: &Plane<T>, other: &Plane<T>, of: fn(T, T) -> f64) -> Vec<f64> {
    one.at.iter().zip(&other.at).map(|(&a, &b)| of(a, b)).collect()
}

/// From sRGB to XYZ, D65 (as in the paper's supplement), and back.
const TO_XYZ: [Colour; 3] = [
    [10_135_552.0 / 24_577_794.0, 8_788_810.0 / 24_577_794.0, 4_435_075.0 / 24_577_794.0],
    [2_613_072.0 / 12_288_897.0, 8_788_810.0 / 12_288_897.0, 887_015.0 / 12_288_897.0],
    [1_425_312.0 / 73_733_382.0, 8_788_810.0 / 73_733_382.0, 70_074_185.0 / 73_733_382.0],
];

/// XYZ as shares of white.
fn xyz(rgb: Colour) -> Colour {
    TO_XYZ.map(|row| {
        let white: f64 = row.iter().sum();
        (row[0] * rgb[0] + row[1] * rgb[1] + row[2] * rgb[2]) / white
    })
}

/// The linear colour with these shares of white, by Cramer's rule.
fn linear(shares: Colour) -> Colour {
    let m = TO_XYZ;
    let right: Colour = std::array::from_fn(|i| shares[i] * m[i].iter().sum::<f64>());
    let det = |m: [Colour; 3]| {
        m[0][0] * (m[1][1] * m[2][2] - m[1][2] * m[2][1]) - m[0][1] * (m[1][0] * m[2][2] - m[1][2] * m[2][0])
            + m[0][2] * (m[1][0] * m[2][1] - m[1][1] * m[2][0])
    };
    let whole = det(m);
    std::array::from_fn(|column| {
        let mut replaced = m;
        for (row, value) in replaced.iter_mut().zip(right) {
            row[column] = value;
        }
        det(replaced) / whole
    })
}

/// YCxCz: lightness, red against green, yellow against blue, all linear.
fn opponent(picture: &Picture) -> Plane<Colour> {
    let [width, height] = picture.size().map(|n| n as usize);
    let decoded = |byte: u8| {
        let s = f64::from(byte) / 255.0;
        if s <= 0.04045 { s / 12.92 } else { libm::pow((s + 0.055) / 1.055, 2.4) }
    };
    let of = |pixel: &[u8; 3]| {
        let [x, y, z] = xyz(pixel.map(decoded));
        [116.0 * y - 16.0, 500.0 * (x - y), 200.0 * (y - z)]
    };
    Plane { size: [width, height], at: picture.pixels().iter().map(of).collect() }
}

/// What the eye makes out from afar, in the colours of CIELAB, less colourful where it is dark (Hunt).
fn filtered(picture: &Plane<Colour>) -> Plane<Colour> {
    const PI2: f64 = std::f64::consts::PI * std::f64::consts::PI;
    // Contrast sensitivity: weights and widths of Gaussians in the frequencies, for each channel.
    let channels = [[1.0, 0.0047, 0.0, 1e-5], [1.0, 0.0053, 0.0, 1e-5], [34.1, 0.04, 13.5, 0.025]];
    let radius = libm::ceil(3.0 * (0.04 / (2.0 * PI2)).sqrt() * PIXELS_A_DEGREE) as isize;
    let weight = |[a1, b1, a2, b2]: [f64; 4], x: isize, y: isize| {
        let z = ((x * x + y * y) as f64) / (PIXELS_A_DEGREE * PIXELS_A_DEGREE);
        let gauss = |a: f64, b: f64| a * (std::f64::consts::PI / b).sqrt() * libm::exp(-PI2 * z / b);
        gauss(a1, b1) + gauss(a2, b2)
    };
    let around = || (-radius..=radius).flat_map(|y| (-radius..=radius).map(move |x| (x, y)));
    let mut kernel: Vec<(isize, isize, Colour)> =
        around().map(|(x, y)| (x, y, channels.map(|channel| weight(channel, x, y)))).collect();
    let sums = kernel.iter().fold([0.0; 3], |sums, (.., w)| std::array::from_fn(|c| sums[c] + w[c]));
    for (.., weights) in &mut kernel {
        *weights = std::array::from_fn(|c| weights[c] / sums[c]);
    }
    let blurred = convolved(picture, &kernel, |colour, weights| std::array::from_fn(|c| colour[c] * weights[c]));
    blurred.map(|[y, cx, cz]| {
        let y = (y + 16.0) / 116.0;
        lab(linear([cx / 500.0 + y, y, y - cz / 200.0]).map(|channel| channel.clamp(0.0, 1.0)))
    })
}

fn convolved<T: Copy, W: Copy>(
    plane: &Plane<T>,
    kernel: &[(isize, isize, W)],
    times: impl Fn(T, W) -> Colour,
) -> Plane<Colour> {
    let [width, height] = plane.size;
    let at = |i: usize| {
        let (x, y) = ((i % width) as isize, (i / width) as isize);
        kernel.iter().fold([0.0; 3], |sum, &(dx, dy, weight)| {
            let part = times(plane.near(x + dx, y + dy), weight);
            std::array::from_fn(|c| sum[c] + part[c])
        })
    };
    Plane { size: plane.size, at: (0..width * height).map(at).collect() }
}

/// CIELAB with the adjustment of Hunt.
fn lab(rgb: Colour) -> Colour {
    const DELTA: f64 = 6.0 / 29.0;
    let root = |x: f64| if x > DELTA * DELTA * DELTA { libm::cbrt(x) } else { x / (3.0 * DELTA * DELTA) + 4.0 / 29.0 };
    let [x, y, z] = xyz(rgb).map(root);
    let lightness = 116.0 * y - 16.0;
    [lightness, 0.01 * lightness * 500.0 * (x - y), 0.01 * lightness * 200.0 * (y - z)]
}

/// The distance HyAB, compressed to 0 .. 1 so that large differences do not hide small ones.
fn colour_difference(one: Colour, other: Colour) -> f64 {
    let distance = |a: Colour, b: Colour| {
        let plain = (a[0] - b[0]).abs() + ((a[1] - b[1]).powi(2) + (a[2] - b[2]).powi(2)).sqrt();
        libm::pow(plain, 0.7)
    };
    let largest = distance(lab([0.0, 1.0, 0.0]), lab([0.0, 0.0, 1.0]));
    let (bend, difference) = (0.4 * largest, distance(one, other));
    let compressed = match difference {
        small if small < bend => 0.95 * small / bend,
        large => 0.95 + 0.05 * (large - bend) / (largest - bend),
    };
    compressed.clamp(0.0, 1.0)
}

/// Strengths of edges and of points, from derivatives of a Gaussian as wide as the features that the eye notices.
fn features(picture: &Plane<Colour>) -> Plane<[f64; 2]> {
    let deviation = 0.5 * 0.082 * PIXELS_A_DEGREE;
    let radius = libm::ceil(3.0 * deviation) as isize;
    let derivatives = |x: isize, y: isize| {
        let (x, y) = (x as f64 / deviation, y as f64 / deviation);
        let gauss = libm::exp(-(x * x + y * y) / 2.0);
        [-x * gauss, (x * x - 1.0) * gauss]
    };
    let around = || (-radius..=radius).flat_map(|y| (-radius..=radius).map(move |x| (x, y)));
    // What is positive sums to 1, what is negative to -1.
    let sum =
        |which: usize, sign: f64| -> f64 { around().map(|(x, y)| (sign * derivatives(x, y)[which]).max(0.0)).sum() };
    let sums = [0, 1].map(|which| [sum(which, 1.0), sum(which, -1.0)]);
    let scaled = |which: usize, value: f64| value / if value > 0.0 { sums[which][0] } else { sums[which][1] };
    let weights = |x, y| {
        let [edge, point] = derivatives(x, y);
        [scaled(0, edge), scaled(1, point)]
    };
    let light = picture.map(|[y, ..]| (y + 16.0) / 116.0);
    let along = |turned: bool| {
        let kernel: Vec<(isize, isize, [f64; 2])> =
            around().map(|(x, y)| (x, y, if turned { weights(y, x) } else { weights(x, y) })).collect();
        convolved(&light, &kernel, |light, [edge, point]| [light * edge, light * point, 0.0])
    };
    let (across, down) = (along(false), along(true));
    let strength = |(a, b): (&Colour, &Colour)| [0, 1].map(|c| (a[c] * a[c] + b[c] * b[c]).sqrt());
    Plane { size: picture.size, at: across.at.iter().zip(&down.at).map(strength).collect() }
}

fn feature_difference(one: [f64; 2], other: [f64; 2]) -> f64 {
    let larger = (one[0] - other[0]).abs().max((one[1] - other[1]).abs());
    (larger / std::f64::consts::SQRT_2).sqrt().clamp(0.0, 1.0)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn flat(colour: [u8; 3]) -> Picture {
        Picture::new([24, 20], vec![colour; 480])
    }

    #[test]
    fn the_same_picture_differs_by_nothing_and_black_from_white_by_what_the_formulas_give() {
        assert_eq!(flip(&flat([70, 30, 200]), &flat([70, 30, 200])), 0.0);
        // HyAB of black and white is 100, of green and blue 203.305 after Hunt; there is no feature in either.
        let (white, largest) = (libm::pow(100.0, 0.7), libm::pow(203.305, 0.7));
        let expected = 0.95 + 0.05 * (white - 0.4 * largest) / (0.6 * largest);
        let found = flip(&flat([0; 3]), &flat([255; 3]));
        assert!((found - expected).abs() < 1e-6, "{found} {expected}");
        assert!((flip(&flat([255; 3]), &flat([0; 3])) - found).abs() < 1e-12, "it does not matter which is expected");
    }

    #[test]
    fn what_hardly_shows_differs_hardly() {
        let whole = flip(&flat([100; 3]), &flat([200; 3]));
        let step = flip(&flat([100; 3]), &flat([101; 3]));
        assert!(step > 0.0 && step < 0.1 && whole > 5.0 * step, "{step} {whole}");
        let mut dot = vec![[100; 3]; 480];
        dot[250] = [200; 3];
        let dot = flip(&flat([100; 3]), &Picture::new([24, 20], dot));
        assert!(dot > 0.0 && dot < whole / 2.0, "{dot}");
    }

    #[test]
    fn colours_survive_the_way_there_and_back() {
        for rgb in [[0.0, 0.0, 0.0], [1.0, 1.0, 1.0], [0.2, 0.7, 0.4]] {
            let back = linear(xyz(rgb));
            assert!(rgb.iter().zip(back).all(|(a, b)| (a - b).abs() < 1e-12), "{rgb:?} {back:?}");
        }
    }
}
