//! Sixteen rays, prepared for box tests.

use super::node::{Node, WIDTH};
use super::packet_hits::{HALVES, RAYS};
use super::prepared_ray::{ENLARGED, PreparedRay};
use crate::geometry::{Aabb, Ray};
use crate::simd::{EightLanes, LaneVec3, each};
use crate::traversal::line::{after, lanes_after};
use crate::triangle::{DIRECTION, EightRays, INPUTS, ORIGIN};

type Row = [[f32; WIDTH]; HALVES];

pub(super) struct RayPacket<L> {
    pub origin: [[L; HALVES]; 3],
    direction: [[L; HALVES]; 3],
    pub inverse: [[L; HALVES]; 3],
    pub enlarged: [[L; HALVES]; 3],
    pub t_min: [L; HALVES],
    t_max: [L; HALVES],
    /// The largest magnitude of a direction component.
    longest: f32,
    /// The largest magnitude of an origin component.
    farthest: f32,
    ends: Row,
    pub octant: usize,
}

/// Transposes eight rays. Row `i` of the result contains float `i` of each ray.
#[inline(always)]
fn numbers<L: EightLanes>(rays: &[Ray]) -> [L; 8] {
    let mut rows = [L::zero(); WIDTH];
    for (row, ray) in rows.iter_mut().zip(rays) {
        let Ray { origin: o, t_min, direction: d, t_max } = *ray;
        *row = L::load(&[o.x, o.y, o.z, t_min, d.x, d.y, d.z, t_max]);
    }
    L::transpose(rows)
}

#[inline(always)]
fn greatest<L: EightLanes>(lanes: L) -> f32 {
    let lanes = lanes.store();
    lanes[1..].iter().fold(lanes[0], |most, &lane| if lane > most { lane } else { most })
}

impl<L: EightLanes> RayPacket<L> {
    /// Returns `None` in these cases:
    /// - A ray is invalid.
    /// - The octants of two rays differ.
    /// - An inverse is not a normal float.
    /// - An enlarged inverse is not finite.
    /// - The difference of an origin and a plane in `bounds` may overflow.
    ///
    /// The caller must set the ends of the rays.
    #[inline(always)]
    pub fn new(rays: &[Ray; RAYS], bounds: &Aabb) -> Option<Self> {
        let (low, high) = rays.split_at(WIDTH);
        let rows = [numbers::<L>(low), numbers::<L>(high)];
        let row = |i: usize| each(&rows, |half| half[i]);
        let (origin, direction) = ([row(0), row(1), row(2)], [row(4), row(5), row(6)]);
        let mut octant = 0;
        for (axis, [low, high]) in direction.iter().enumerate() {
            // The loop below rejects zeros of either sign, because the inverse of a zero is infinite.
            match low.lt(L::zero()) | high.lt(L::zero()) << WIDTH {
                0 => {}
                0xffff => octant |= 1 << axis,
                _ => return None,
            }
        }
        let one = L::splat(1.0);
        let inverse = each(&direction, |halves| each(halves, |d| one.div(*d)));
        let enlarged = each(&inverse, |halves| each(halves, |i| i.mul(L::splat(ENLARGED))));
        let (t_min, t_max) = (each(&row(3), |t| t.max(L::zero())), row(7));

        // The conditions below must imply `Ray::is_valid` and finite results of `traversal::line::inverses`.
        let abs = |x: L| x.flip_sign(x);
        let mut good = u32::MAX;
        for half in 0..HALVES {
            for axis in 0..3 {
                let reach = abs(origin[axis][half]).add(L::splat(bounds.min[axis].abs().max(bounds.max[axis].abs())));
                let (inverse, enlarged) = (abs(inverse[axis][half]), abs(enlarged[axis][half]));
                good &= reach.le(L::splat(f32::MAX));
                good &= L::splat(f32::MIN_POSITIVE).le(inverse) & enlarged.le(L::splat(f32::MAX));
            }
            good &= row(3)[half].le(L::splat(f32::INFINITY)) & t_min[half].lt(t_max[half]);
        }
        if good & 0xff != 0xff {
            return None;
        }
        let largest = |[x, y, z]: &[[L; HALVES]; 3]| {
            let of = |[low, high]: &[L; HALVES]| abs(*low).max(abs(*high));
            greatest(of(x).max(of(y)).max(of(z)))
        };
        let (longest, farthest) = (largest(&direction), largest(&origin));
        let ends = [[0.0; WIDTH]; HALVES];
        Some(Self { origin, direction, inverse, enlarged, t_min, t_max, longest, farthest, ends, octant })
    }

    #[inline(always)]
    pub fn meet(&self, node: &Node, lane: usize) -> u16 {
        let mut met = 0;
        for half in 0..HALVES {
            let (mut enter, mut leave) = (self.t_min[half], L::load(&self.ends[half]));
            for axis in 0..3 {
                let backward = self.octant >> axis & 1;
                let near = L::splat(node.planes[axis][backward][lane % WIDTH]);
                let far = L::splat(node.planes[axis][1 - backward][lane % WIDTH]);
                enter = near.sub(self.origin[axis][half]).mul(self.inverse[axis][half]).max(enter);
                leave = far.sub(self.origin[axis][half]).mul(self.enlarged[axis][half]).min(leave);
            }
            met |= enter.le(leave) << (half * WIDTH);
        }
        met as u16
    }

    #[inline(always)]
    pub fn single(&self, i: usize) -> PreparedRay {
        let pick = |row: &[L; HALVES]| row[i / WIDTH].store()[i % WIDTH];
        PreparedRay::of(each(&self.origin, pick), each(&self.inverse, pick), pick(&self.t_min), self.octant)
    }

    #[inline(always)]
    pub fn t_min(&self) -> [f32; RAYS] {
        let mut row = [0.0; RAYS];
        for (half, lanes) in row.chunks_exact_mut(WIDTH).zip(&self.t_min) {
            half.copy_from_slice(&lanes.store());
        }
        row
    }

    #[inline(always)]
    pub fn end(&mut self, i: usize, t: f32) {
        self.ends[i / WIDTH][i % WIDTH] = after(t);
    }

    #[inline(always)]
    pub fn end_all(&mut self, t: [L; HALVES]) {
        self.ends = each(&t, |t| lanes_after(*t).store());
    }

    /// Only the columns of origins and directions are filled.
    #[inline(always)]
    pub fn inputs(&self, half: usize) -> [[f32; WIDTH]; INPUTS] {
        let mut inputs = [[0.0; WIDTH]; INPUTS];
        for axis in 0..3 {
            inputs[ORIGIN + axis] = self.origin[axis][half].store();
            inputs[DIRECTION + axis] = self.direction[axis][half].store();
        }
        inputs
    }

    #[inline(always)]
    pub fn half(&self, half: usize) -> EightRays<L> {
        let row = |[x, y, z]: &[[L; HALVES]; 3]| LaneVec3::new(x[half], y[half], z[half]);
        EightRays {
            origin: row(&self.origin),
            direction: row(&self.direction),
            t_min: self.t_min[half],
            t_max: self.t_max[half],
            longest: self.longest,
            farthest: self.farthest,
        }
    }
}
