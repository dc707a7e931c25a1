//! Boxes of the slices of a triangle between parallel planes. The boxes are not rounded outward. Use the boxes only to
//! estimate costs.

use glam::Vec3A;

use super::extent::Extent;
use super::planes::Planes;

/// A triangle with corners in ascending order along `AXIS`.
struct Slicer<const AXIS: usize> {
    corners: [Vec3A; 3],
    inverse: [f32; 3],
}

#[inline(always)]
fn on<const AXIS: usize>(p: Vec3A) -> f32 {
    p.to_array()[AXIS]
}

impl<const AXIS: usize> Slicer<AXIS> {
    #[inline(always)]
    fn new([mut a, mut b, mut c]: [Vec3A; 3]) -> Self {
        let order = |p: &mut Vec3A, q: &mut Vec3A| {
            if on::<AXIS>(*q) < on::<AXIS>(*p) {
                std::mem::swap(p, q);
            }
        };
        order(&mut a, &mut b);
        order(&mut b, &mut c);
        order(&mut a, &mut b);
        let inverse = |p, q| {
            let length = on::<AXIS>(q) - on::<AXIS>(p);
            if length > 0.0 { 1.0 / length } else { 0.0 }
        };
        Self { corners: [a, b, c], inverse: [inverse(a, b), inverse(b, c), inverse(a, c)] }
    }

    /// `x` must lie in the range of the corners along `AXIS`.
    #[inline(always)]
    fn section(&self, x: f32) -> Extent {
        let [a, b, c] = self.corners;
        let [ab, bc, ac] = self.inverse;
        let long = a + (c - a) * ((x - on::<AXIS>(a)) * ac);
        let (from, to, inverse) = if x < on::<AXIS>(b) { (a, b, ab) } else { (b, c, bc) };
        let short = from + (to - from) * ((x - on::<AXIS>(from)) * inverse);
        Extent { min: long.min(short), max: long.max(short) }
    }
}

/// Calls `grow` for each bin, with the box of the slice in this bin. Each box is clipped to `part`.
#[inline(always)]
pub(super) fn slice<const AXIS: usize>(
    corners: [Vec3A; 3],
    part: Extent,
    planes: &Planes,
    (first, last): (usize, usize),
    mut grow: impl FnMut(usize, Extent),
) {
    let slicer = Slicer::<AXIS>::new(corners);
    let middle = slicer.corners[1];
    let mut from = on::<AXIS>(part.min);
    let mut face = slicer.section(from);
    for bin in first..=last {
        let to = if bin == last { on::<AXIS>(part.max) } else { planes.value(bin) };
        let next = slicer.section(to);
        let mut part_between = face.union(next);
        if from <= on::<AXIS>(middle) && on::<AXIS>(middle) <= to {
            part_between = part_between.with_point(middle);
        }
        grow(bin, part_between.intersection(part));
        (from, face) = (to, next);
    }
}
