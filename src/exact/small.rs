//! Numbers that are near enough in size for 128 bits.

use glam::Vec3;

use crate::geometry::Ray;

/// A ray and a triangle as integers below 2^39: times a power of two the points, times another the direction.
pub(super) struct Small {
    pub origin: [i128; 3],
    pub direction: [i128; 3],
    pub corners: [[i128; 3]; 3],
    /// The ray parameter is 2 to this times that of the integers.
    pub exponent: i32,
}

/// Bits of an integer. Differences have one more; the sums of three products of two differences and a third number, with
/// signs, stay below 2^(3 * 40 + 3).
const BITS: i32 = 39;

impl Small {
    /// Nothing if the numbers differ too much in size. They are finite.
    pub fn of(ray: &Ray, corners: [Vec3; 3]) -> Option<Self> {
        let [a, b, c] = corners;
        let points = unit([ray.origin, a, b, c].iter().flat_map(|p| p.to_array()))?;
        let lengths = unit(ray.direction.to_array().into_iter())?;
        let integers = |p: Vec3, unit: i32| p.to_array().map(|x| integer(x, unit));
        Some(Self {
            origin: integers(ray.origin, points),
            direction: integers(ray.direction, lengths),
            corners: corners.map(|p| integers(p, points)),
            exponent: points - lengths,
        })
    }
}

/// The exponent of a power of two of which all numbers are multiples, fewer than 2^39 times; 0 if all are zero.
fn unit(numbers: impl Iterator<Item = f32>) -> Option<i32> {
    let (mut lowest, mut highest) = (i32::MAX, i32::MIN);
    for x in numbers.filter(|x| *x != 0.0) {
        let (significand, exponent) = parts(x);
        lowest = lowest.min(exponent + significand.trailing_zeros() as i32);
        highest = highest.max(exponent + 32 - significand.leading_zeros() as i32);
    }
    match lowest {
        i32::MAX => Some(0),
        _ => (highest - lowest <= BITS).then_some(lowest),
    }
}

/// The significand as an integer, and the exponent of its unit.
fn parts(x: f32) -> (u32, i32) {
    let (exponent, fraction) = ((x.to_bits() >> 23 & 0xff) as i32, x.to_bits() & 0x7f_ffff);
    if exponent == 0 { (fraction, -149) } else { (fraction | 0x80_0000, exponent - 150) }
}

/// How many times 2^`unit` a number is that is a multiple of it.
fn integer(x: f32, unit: i32) -> i128 {
    let (significand, exponent) = parts(x);
    let (significand, up) = (i128::from(significand), exponent - unit);
    let magnitude = match up {
        0.. if significand != 0 => significand << up,
        0.. => 0,
        _ => significand >> -up.max(-127),
    };
    if x < 0.0 { -magnitude } else { magnitude }
}
