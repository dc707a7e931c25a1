//! One ray against one triangle, in integers: a scene of `f32` numbers is a set of dyadic rationals, so what a ray meets, and in
//! which order, is decidable.

#[cfg(any(test, feature = "suite"))]
pub mod rational;
mod small;

use std::cmp::Ordering;
use std::ops::{Add, Mul, Neg, Sub};

use dashu_int::IBig;
use glam::Vec3;

use crate::geometry::Ray;
use small::Small;

/// Every finite `f32` is a multiple of 2^-149: times 2^149 it is an integer.
const SCALE: usize = 149;

/// An exact ray parameter: a fraction of integers. Those of one ray are ordered exactly.
#[derive(Clone, Debug)]
pub struct ExactT {
    numerator: IBig,
    /// Positive.
    denominator: IBig,
}

/// Where the whole line of `ray` meets the closed triangle, or nothing if it misses or lies in the plane of the triangle.
///
/// The interval of the ray is not looked at: see [`ExactT::is_within`]. Numbers that are not finite hit nothing.
/// Costs a tenth of a microsecond where 128 bits are enough, else some microseconds.
///
/// The line passes through the triangle when it passes all three edges on the same side, or meets them: three volumes
/// have no opposite signs.
///
/// # References
/// Segura, Feito: Algorithms to test ray-triangle intersection. Comparative study. WSCG 2001.
pub fn hit(ray: &Ray, corners: [Vec3; 3]) -> Option<ExactT> {
    if !ray.origin.is_finite() || !ray.direction.is_finite() || !corners.iter().all(|p| p.is_finite()) {
        return None;
    }
    if let Some(small) = Small::of(ray, corners) {
        let (numerator, denominator) = fraction(small.origin, small.direction, small.corners)?;
        let (numerator, denominator) = (IBig::from(numerator), IBig::from(denominator));
        return Some(match small.exponent {
            up @ 0.. => ExactT { numerator: numerator << up as usize, denominator },
            down => ExactT { numerator, denominator: denominator << down.unsigned_abs() as usize },
        });
    }
    let (numerator, denominator) = fraction(integers(ray.origin), integers(ray.direction), corners.map(integers))?;
    Some(ExactT { numerator, denominator })
}

/// The numerator and the positive denominator of `t`, for a line in integers that meets the closed triangle.
fn fraction<I>(origin: [I; 3], direction: [I; 3], corners: [[I; 3]; 3]) -> Option<(I, I)>
where
    I: Default + Ord + Neg<Output = I> + Add<Output = I> + Sub<Output = I>,
    for<'a> &'a I: Mul<&'a I, Output = I> + Sub<&'a I, Output = I>,
{
    let sub = |a: &[I; 3], b: &[I; 3]| -> [I; 3] { std::array::from_fn(|i| &a[i] - &b[i]) };
    let dot = |a: &[I; 3], b: &[I; 3]| &a[0] * &b[0] + &a[1] * &b[1] + &a[2] * &b[2];
    let cross = |a: &[I; 3], b: &[I; 3]| [(1, 2), (2, 0), (0, 1)].map(|(i, j)| &a[i] * &b[j] - &a[j] * &b[i]);
    let zero = I::default();

    let [a, b, c] = corners.map(|p| sub(&p, &origin));
    let sides = [(&c, &b), (&a, &c), (&b, &a)].map(|(p, q)| dot(&direction, &cross(p, q)));
    if sides.iter().any(|s| *s < zero) && sides.iter().any(|s| *s > zero) {
        return None;
    }

    let normal = cross(&sub(&b, &a), &sub(&c, &a));
    let (numerator, denominator) = (dot(&a, &normal), dot(&direction, &normal));
    match denominator.cmp(&zero) {
        Ordering::Less => Some((-numerator, -denominator)),
        Ordering::Equal => None,
        Ordering::Greater => Some((numerator, denominator)),
    }
}

impl ExactT {
    /// Whether this `t` lies in the half-open interval of `ray` and rounds to a finite number (see [`Ray::end`]).
    pub fn is_within(&self, ray: &Ray) -> bool {
        let (t_min, t_max) = ray.interval();
        let in_interval =
            self.compare(t_min).is_some_and(Ordering::is_ge) && self.compare(t_max).is_some_and(Ordering::is_lt);
        in_interval && !self.is_beyond_all()
    }

    /// Whether the nearest `f32` is positive infinity.
    fn is_beyond_all(&self) -> bool {
        // The middle of the largest number and the one that would follow, both times 2^149.
        let twice = magnitude(f32::MAX.to_bits()) + magnitude(f32::INFINITY.to_bits());
        (&self.numerator << (SCALE + 1)) >= twice * &self.denominator
    }

    /// The order of this `t` and a float, which may be infinite; nothing for NaN.
    pub fn compare(&self, t: f32) -> Option<Ordering> {
        match t {
            _ if t.is_nan() => None,
            f32::INFINITY => Some(Ordering::Less),
            f32::NEG_INFINITY => Some(Ordering::Greater),
            0.0 => Some(self.numerator.cmp(&IBig::ZERO)),
            _ => Some((&self.numerator << SCALE).cmp(&(integer(t) * &self.denominator))),
        }
    }

    /// This `t` with a relative error below 2^-50. Neither overflows nor underflows: the numerator and the denominator have
    /// fewer than 850 bits.
    pub fn approximate(&self) -> f64 {
        self.numerator.to_f64().value() / self.denominator.to_f64().value()
    }

    /// The nearest `f32`, ties to even: infinite from half an ulp beyond the largest finite number on.
    pub fn round(&self) -> f32 {
        // Look for the largest finite float whose magnitude does not exceed that of `t`; the bits of floats are ordered.
        let twice = (dashu_int::ops::Abs::abs(self.numerator.clone())) << (SCALE + 1);
        let (mut low, mut high) = (0, f32::INFINITY.to_bits());
        while high - low > 1 {
            let middle = low + (high - low) / 2;
            if magnitude(middle) * 2 * &self.denominator <= twice { low = middle } else { high = middle }
        }
        // `t` is between `low` and the float after it, which stands for 2^128 when `low` is the largest.
        let bits = match twice.cmp(&((magnitude(low) + magnitude(low + 1)) * &self.denominator)) {
            Ordering::Less => low,
            Ordering::Equal => low + low % 2,
            Ordering::Greater => low + 1,
        };
        if self.numerator < IBig::ZERO { -f32::from_bits(bits) } else { f32::from_bits(bits) }
    }
}

impl Ord for ExactT {
    fn cmp(&self, other: &Self) -> Ordering {
        (&self.numerator * &other.denominator).cmp(&(&other.numerator * &self.denominator))
    }
}

impl PartialOrd for ExactT {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

impl PartialEq for ExactT {
    fn eq(&self, other: &Self) -> bool {
        self.cmp(other).is_eq()
    }
}

impl Eq for ExactT {}

/// `x` 2^149, where `bits` are those of a float `x` that is not negative; 2^277 for those of infinity.
fn magnitude(bits: u32) -> IBig {
    let (exponent, fraction) = ((bits >> 23) as usize, bits & 0x7f_ffff);
    match exponent {
        0 => IBig::from(fraction),
        _ => IBig::from(fraction | 0x80_0000) << (exponent - 1),
    }
}

fn integer(x: f32) -> IBig {
    let magnitude = magnitude(x.abs().to_bits());
    if x < 0.0 { -magnitude } else { magnitude }
}

fn integers(p: Vec3) -> [IBig; 3] {
    p.to_array().map(integer)
}

#[cfg(test)]
mod tests;
