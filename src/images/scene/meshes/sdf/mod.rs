//! Solids as signed distance functions, built from primitives.
//!
//! Distances must be the same on every machine. Use only `f32` arithmetic, square roots and functions of `libm`.
//!
//! # References
//! Quilez: Distance functions; Smooth minimum. iquilezles.org, 2008 to 2024.

mod grid;
mod primitives;
mod split;
mod surface_nets;

use glam::Vec3;

pub use primitives::{Frame, RoundCone, Tube, cosine, rounded_intersection, sine};
pub use split::split_to;
#[cfg(test)]
pub use surface_nets::pieces;

type Field = Box<dyn Fn(Vec3) -> f32 + Send + Sync>;

const FAR: f32 = 1e9;

struct Primitive {
    centre: Vec3,
    radius: f32,
    /// Signed distance to the surface, negative inside. The magnitude may be below the true distance. The length of the
    /// gradient must not exceed about 1.
    distance: Field,
}

#[derive(Clone, Copy, Debug)]
pub struct Blend {
    /// Width of the smooth minimum. A width of 0 gives a sharp crease.
    pub smoothing: f32,
    pub subtract: bool,
    /// Factor of the displacement on the group's surface, from 0 to 1.
    pub displacement: f32,
}

impl Blend {
    pub fn smooth(smoothing: f32) -> Self {
        Self { smoothing, subtract: false, displacement: 1.0 }
    }

    pub fn undisplaced(smoothing: f32) -> Self {
        Self { displacement: 0.0, ..Self::smooth(smoothing) }
    }

    pub fn subtract(smoothing: f32) -> Self {
        Self { subtract: true, ..Self::smooth(smoothing) }
    }
}

struct Group {
    blend: Blend,
    primitives: Vec<Primitive>,
}

/// A solid. Every group is joined to, or subtracted from, the earlier groups. The primitives of one group form a union
/// without smoothing.
pub struct Sdf {
    groups: Vec<Group>,
    displacement: Field,
    highest: f32,
}

/// Indices (group, primitive) of all primitives that can affect a region. The pairs are in ascending order.
type Active = Vec<(u16, u16)>;

impl Sdf {
    /// The values of `displacement` must be between `-highest` and `highest`.
    pub fn new(highest: f32, displacement: impl Fn(Vec3) -> f32 + Send + Sync + 'static) -> Self {
        Self { groups: Vec::new(), displacement: Box::new(displacement), highest }
    }

    pub fn plain() -> Self {
        Self::new(0.0, |_| 0.0)
    }

    pub fn group(&mut self, blend: Blend) -> &mut Self {
        self.groups.push(Group { blend, primitives: Vec::new() });
        self
    }

    /// The primitive must lie in the sphere of `radius` around `centre`.
    pub fn primitive(
        &mut self,
        centre: Vec3,
        radius: f32,
        distance: impl Fn(Vec3) -> f32 + Send + Sync + 'static,
    ) -> &mut Self {
        let group = self.groups.last_mut().expect("a primitive needs a group: call Sdf::group first");
        group.primitives.push(Primitive { centre, radius, distance: Box::new(distance) });
        self
    }

    fn near(&self, centre: Vec3, radius: f32) -> Active {
        let mut active = Active::new();
        for (i, group) in (0..).zip(&self.groups) {
            let reach = radius + group.blend.smoothing + self.highest;
            let is_near = |own: &Primitive| own.centre.distance(centre) < own.radius + reach;
            active.extend((0..).zip(&group.primitives).filter(|(_, own)| is_near(own)).map(|(j, _)| (i, j)));
        }
        active
    }

    fn undisplaced_distance(&self, active: &Active, p: Vec3) -> (f32, f32) {
        let (mut distance, mut displaced) = (FAR, 1.0);
        for members in active.chunk_by(|a, b| a.0 == b.0) {
            let group = &self.groups[members[0].0 as usize];
            let Blend { smoothing, subtract, displacement } = group.blend;
            let sign = if subtract { -1.0 } else { 1.0 };

            // Primitives farther from `p` than `bound` do not change the distance.
            let mut near = FAR;
            let mut bound = sign * distance + smoothing;
            for &(_, j) in members {
                let primitive = &group.primitives[j as usize];
                let reach = primitive.radius + bound;
                if reach > 0.0 && primitive.centre.distance_squared(p) < reach * reach {
                    near = near.min((primitive.distance)(p));
                    bound = bound.min(near);
                }
            }
            let (joined, share) = smooth_minimum(sign * distance, near, smoothing);
            distance = sign * joined;
            displaced += (displacement - displaced) * share;
        }
        (distance, displaced)
    }

    fn distance(&self, active: &Active, p: Vec3) -> f32 {
        let (distance, displaced) = self.undisplaced_distance(active, p);
        if self.highest > 0.0 && displaced > 0.0 && distance.abs() < 3.0 * self.highest {
            distance - displaced * (self.displacement)(p)
        } else {
            distance
        }
    }

    fn normal(&self, active: &Active, p: Vec3, step: f32) -> Vec3 {
        let along = |axis: Vec3| self.distance(active, p + axis * step) - self.distance(active, p - axis * step);
        Vec3::new(along(Vec3::X), along(Vec3::Y), along(Vec3::Z)).normalize_or(Vec3::Y)
    }
}

/// Returns (smooth minimum of `a` and `b`, weight of `b` in [0, 1]). The width of the smooth minimum is `k`.
fn smooth_minimum(a: f32, b: f32, k: f32) -> (f32, f32) {
    if k <= 0.0 || (a - b).abs() >= k {
        return if b < a { (b, 1.0) } else { (a, 0.0) };
    }
    let h = (k - (a - b).abs()) / k;
    let share = 0.5 * h * h;
    (a.min(b) - 0.25 * k * h * h, if b < a { 1.0 - share } else { share })
}
