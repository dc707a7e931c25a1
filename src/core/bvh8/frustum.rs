//! Common bounds of the rays of a packet.

use super::node::{Node, WIDTH};
use super::prepared_ray::rows;
use super::ray_packet::RayPacket;
use crate::simd::{Lanes, each};

/// Bounds of the parameters at which the rays of a packet cross the planes of boxes.
///
/// **A box is rejected only if every ray misses the box.** A ray has origin o and inverse direction i. The crossing of
/// a near plane p is computed as fl(fl(p - o) * i), where fl rounds to `f32`. Rounding is monotonic, so the crossing is
/// monotonic in o and in i. Extremes of o and i therefore give a lower bound of all near crossings. Extremes
/// of o and of the enlarged i give an upper bound of all far crossings. If the lower bound exceeds the upper bound,
/// every ray misses the box.
pub(super) struct Frustum<L> {
    near_origin: [L; 3],
    far_origin: [L; 3],
    /// For each axis, the least and the greatest inverse direction.
    inverse: [[L; 2]; 3],
    enlarged: [[L; 2]; 3],
    t_min: L,
    near: [usize; 3],
    far: [usize; 3],
}

#[inline(always)]
fn range<L: Lanes<WIDTH>>(row: &[L; 2]) -> [L; 2] {
    let (low, high) = (row[0].min(row[1]).store(), row[0].max(row[1]).store());
    let (mut least, mut greatest) = (low[0], high[0]);
    for i in 1..WIDTH {
        least = if low[i] < least { low[i] } else { least };
        greatest = if high[i] > greatest { high[i] } else { greatest };
    }
    [L::splat(least), L::splat(greatest)]
}

impl<L: Lanes<WIDTH>> Frustum<L> {
    #[inline(always)]
    pub fn new(packet: &RayPacket<L>) -> Self {
        let origin = each(&packet.origin, range);
        let backward = |axis: usize| packet.octant >> axis & 1;
        let (near, far) = rows(packet.octant);
        Self {
            near_origin: each(&[0, 1, 2], |&axis| origin[axis][1 - backward(axis)]),
            far_origin: each(&[0, 1, 2], |&axis| origin[axis][backward(axis)]),
            inverse: each(&packet.inverse, range),
            enlarged: each(&packet.enlarged, range),
            t_min: range(&packet.t_min)[0],
            near,
            far,
        }
    }

    #[inline(always)]
    pub fn meet(&self, node: &Node) -> u32 {
        let planes = node.planes.as_flattened();
        let (mut enter, mut leave) = (self.t_min, L::splat(f32::INFINITY));
        for axis in 0..3 {
            let near = L::load(&planes[self.near[axis]]).sub(self.near_origin[axis]);
            let far = L::load(&planes[self.far[axis]]).sub(self.far_origin[axis]);
            enter = near.mul(self.inverse[axis][0]).min(near.mul(self.inverse[axis][1])).max(enter);
            leave = far.mul(self.enlarged[axis][0]).max(far.mul(self.enlarged[axis][1])).min(leave);
        }
        enter.le(leave)
    }
}
