//! Intersects a line and a triangle with integer arithmetic. Integer arithmetic is faster than sums of floats. Some
//! inputs need more bits than the integer types have.

use std::cmp::Ordering;

use glam::Vec3;

use super::ExactT;
use super::expansion::Expansion;
use crate::geometry::Ray;
use crate::simd::each;

/// A number of bits that suffices for the magnitude of each integer in a set.
///
/// Let the points have p places and the direction d places. Then these magnitudes are bounded:
/// - Coordinates of points are below 2^p.
/// - Differences of coordinates are below 2^(p + 1).
/// - Components of the cross product of two differences are below 2^(2 p + 3).
/// - The dot product of this cross product and the direction is below 2^(2 p + d + 5).
/// - The dot product of this cross product and a difference is below 2^(3 p + 6).
type Places = i32;

/// Whether triple products of two differences and a direction are below 2^126.
fn sides_fit(points: Places, direction: Places) -> bool {
    2 * points + direction <= 121
}

/// Whether triple products of three differences are below 2^126.
fn heights_fit(points: Places) -> bool {
    points <= 40
}

/// Like [`hit`](super::hit), for finite numbers. The outer result is `None` if the integers would need too many bits.
pub(super) fn hit(ray: &Ray, corners: [Vec3; 3]) -> Option<Option<ExactT>> {
    let [a, b, c] = corners;
    let (points, unit, places) = integers([ray.origin, a, b, c])?;
    let ([direction], direction_unit, direction_places) = integers([ray.direction])?;
    if !sides_fit(places, direction_places) || !heights_fit(places) {
        return None;
    }
    let [origin, corners @ ..] = points;
    let [a, b, c] = each(&corners, |&corner| minus(corner, origin));

    let (mut left, mut right) = (false, false);
    for (p, q) in [(c, b), (a, c), (b, a)] {
        let volume = dot(direction, cross(p, q));
        left |= volume < 0;
        right |= volume > 0;
        if left && right {
            return Some(None);
        }
    }

    let normal = cross(minus(corners[1], corners[0]), minus(corners[2], corners[0]));
    let (numerator, denominator) = (dot(a, normal), dot(direction, normal));
    if denominator == 0 {
        return Some(None);
    }
    let sign = denominator.signum();
    Some(Some(ExactT {
        numerator: Expansion::of_integer(sign * numerator, 3 * unit),
        denominator: Expansion::of_integer(sign * denominator, 2 * unit + direction_unit),
    }))
}

pub(super) fn side(ray: &Ray, [p, q]: [Vec3; 2]) -> Option<Ordering> {
    let ([origin, p, q], _, places) = integers([ray.origin, p, q])?;
    let ([direction], _, direction_places) = integers([ray.direction])?;
    sides_fit(places, direction_places).then(|| dot(direction, cross(minus(p, origin), minus(q, origin))).cmp(&0))
}

pub(super) fn height(origin: Vec3, [a, b, c]: [Vec3; 3]) -> Option<f64> {
    let ([origin, a, b, c], unit, places) = integers([origin, a, b, c])?;
    if !heights_fit(places) {
        return None;
    }
    let height = dot(minus(a, origin), cross(minus(b, a), minus(c, a)));
    Some(Expansion::of_integer(height, 3 * unit).approximate())
}

/// Expresses the vectors as integer multiples of a power of two.
///
/// Returns the multiples, the exponent of the power, and the places of the multiples. Returns `None` for more than 60
/// places.
fn integers<const N: usize>(vectors: [Vec3; N]) -> Option<([[i64; 3]; N], i32, Places)> {
    let (mut lowest, mut highest) = (i32::MAX, i32::MIN);
    for x in vectors.iter().flat_map(|vector| vector.to_array()).filter(|&x| x != 0.0) {
        let (bits, exponent) = (x.to_bits() & 0x7f_ffff, (x.to_bits() >> 23 & 0xff) as i32);
        let (bits, last) = if exponent == 0 { (bits, -149) } else { (bits | 0x80_0000, exponent - 150) };
        lowest = lowest.min(last + bits.trailing_zeros() as i32);
        highest = highest.max(last + 24);
    }
    if lowest == i32::MAX {
        return Some(([[0; 3]; N], 0, 0));
    }
    let times = f64::from_bits(((1023 - lowest) as u64) << 52);
    let places = highest - lowest;
    (places <= 60)
        .then(|| (each(&vectors, |v| each(&v.to_array(), |&x| (f64::from(x) * times) as i64)), lowest, places))
}

fn minus(p: [i64; 3], q: [i64; 3]) -> [i64; 3] {
    [p[0] - q[0], p[1] - q[1], p[2] - q[2]]
}

fn cross(p: [i64; 3], q: [i64; 3]) -> [i128; 3] {
    let times = |x: i64, y: i64| i128::from(x) * i128::from(y);
    each(&[(1, 2), (2, 0), (0, 1)], |&(i, j)| times(p[i], q[j]) - times(p[j], q[i]))
}

fn dot(p: [i64; 3], q: [i128; 3]) -> i128 {
    i128::from(p[0]) * q[0] + i128::from(p[1]) * q[1] + i128::from(p[2]) * q[2]
}

#[cfg(test)]
mod tests {
    use super::super::{difference, direction, hit_by_sums, side_by_sums, tracked};
    use super::*;

    #[test]
    fn integers_and_unrounded_floats_give_what_sums_give() {
        const ALL_SIZES: u32 = 1 << 24;
        let number = |i: u32, steps: u32, fine: f32| {
            let bits = i.wrapping_mul(2_654_435_761).rotate_left(13).wrapping_mul(0x9e37_79b1);
            let size = if steps == ALL_SIZES { 2.0_f32.powi(-((bits >> 24) as i32 % 19)) } else { 1.0 };
            ((bits % steps) as f32 - steps as f32 / 2.0) * fine * size
        };
        let (mut hits, mut misses, mut others) = (0, 0, 0);
        let (mut unrounded, mut zeros) = (0, 0);
        for i in 0..60_000 {
            let (steps, fine) = [(4, 1.0), (5, 0.1), (3000, 0.37), (ALL_SIZES, 1e-3)][i as usize % 4];
            let vector = |k: u32| Vec3::from_array([0, 1, 2].map(|axis| number(15 * i + 3 * k + axis, steps, fine)));
            let ray = Ray::new(vector(0), vector(1));
            let corners = [vector(2), vector(3), vector(4)];
            let right = hit_by_sums(&ray, corners);
            let edge = [corners[0], corners[1]];
            let sum = |ray: &Ray| {
                let [p, q] = edge.map(|corner| difference(corner, ray.origin));
                side_by_sums(&direction(ray), &p, &q)
            };
            let axes = [Vec3::X, -Vec3::Y, Vec3::Z, ray.direction, ray.direction];
            let turned = Ray { direction: axes[i as usize % 5], ..ray };
            if let Some(side) = tracked::side(&turned, edge) {
                assert_eq!(side, sum(&turned), "{turned} {edge:?}");
                unrounded += 1;
                zeros += usize::from(side.is_eq());
            }
            match hit(&ray, corners) {
                None => others += 1,
                Some(found) => {
                    assert_eq!(found, right, "{ray:?} {corners:?}");
                    assert_eq!(side(&ray, edge), Some(sum(&ray)), "{ray:?} {edge:?}");
                    if let (Some(found), Some(right)) = (found, right) {
                        assert_eq!(found.round().to_bits(), right.round().to_bits());
                        hits += 1;
                    } else {
                        misses += 1;
                    }
                }
            }
        }
        assert!(hits > 5_000 && misses > 30_000 && others > 50, "{hits} {misses} {others}");
        assert!((20_000..59_000).contains(&unrounded) && zeros > 2_000, "{unrounded} {zeros}");
    }

    #[test]
    fn what_just_fits_does_not_overflow() {
        let most = (1_i64 << 40) - (1 << 16);
        for exponent in [-149, 0, 87] {
            let number = |sign: i64| ((sign * most) as f64 * 2.0_f64.powi(exponent)) as f32;
            let unit = 2.0_f64.powi(exponent) as f32;
            for signs in 0..1_u32 << 15 {
                let x = |k: u32| number(1 - 2 * i64::from(signs >> k & 1));
                let vector = |k: u32| Vec3::new(x(3 * k), x(3 * k + 1), x(3 * k + 2));
                // With the components `unit`, the points and the direction have 40 places.
                let ray = Ray::new(Vec3 { x: unit, ..vector(0) }, Vec3 { y: unit, ..vector(1) });
                let corners = [vector(2), vector(3), vector(4)];
                let found = hit(&ray, corners).expect("it fits");
                if signs % 7 == 0 {
                    assert_eq!(found, hit_by_sums(&ray, corners), "{ray:?} {corners:?}");
                }
            }
        }
    }

    #[test]
    fn numbers_of_very_different_size_are_left_to_others() {
        let ray = |x: f32| Ray::new(Vec3::new(x, 0.0, 0.0), Vec3::Z);
        let corners = [Vec3::ZERO, Vec3::X, Vec3::Y];
        let [fits, does_not] = [-39, -40].map(|exponent| 2.0_f32.powi(exponent));
        assert!(hit(&ray(fits), corners).is_some() && hit(&ray(does_not), corners).is_none());
        let most = Vec3::splat(f32::MAX);
        assert!(hit(&Ray::new(most, -most), [Vec3::ZERO; 3]).is_some_and(|hit| hit.is_none()));
        assert_eq!(integers([Vec3::splat(1e-45)]), Some(([[1; 3]], -149, 24)));
        assert_eq!(integers([Vec3::new(-0.0, 0.0, 0.0)]), Some(([[0; 3]], 0, 0)));
    }
}
