//! Solids modelled like clay: smoothly joined lumps given by their distance functions, with a fine relief on top.
//!
//! Everything is plain `f32` arithmetic and square roots, so the same clay is the same on every machine.

mod exact;
mod fit;
mod grid;
mod shapes;
mod skin;

use glam::Vec3;

pub use exact::split_to;
pub use fit::fit;
pub use shapes::{Ball, Cone, Frame, Round, Tube, cosine, sine};
pub use skin::Skin;

/// Signed distance to a surface, negative inside; it may be too small but never grow faster than about 1 per unit.
type Distance = Box<dyn Fn(Vec3) -> f32 + Send + Sync>;

/// Height added to the surface at a point near it, times the grain of the part there.
type Relief = Box<dyn Fn(Vec3) -> f32 + Send + Sync>;

/// Farther than anything is from anything.
const FAR: f32 = 1e9;

/// One solid with a ball around it.
struct Lump {
    centre: Vec3,
    radius: f32,
    distance: Distance,
}

/// How lumps are joined to the clay that is there already.
#[derive(Clone, Copy, Debug)]
pub struct Joint {
    /// Width of the fillet between old and new clay; 0 gives a sharp crease.
    pub fillet: f32,
    /// Takes clay away instead of adding it.
    pub carve: bool,
    /// Share of the relief that shows on these lumps.
    pub grain: f32,
}

impl Joint {
    pub fn smooth(fillet: f32) -> Self {
        Self { fillet, carve: false, grain: 1.0 }
    }

    /// Joined without a fillet and without relief: eyes, teeth, claws.
    pub fn bare(fillet: f32) -> Self {
        Self { fillet, carve: false, grain: 0.0 }
    }

    pub fn carve(fillet: f32) -> Self {
        Self { fillet, carve: true, grain: 1.0 }
    }
}

struct Part {
    joint: Joint,
    lumps: Vec<Lump>,
}

/// A solid: parts joined in their order, the lumps of one part by plain union.
pub struct Clay {
    parts: Vec<Part>,
    relief: Relief,
    /// Largest height of the relief.
    reach: f32,
}

/// The lumps that matter near some place, as (part, lump), ascending.
pub(crate) type Active = Vec<(u16, u16)>;

impl Clay {
    /// Nothing yet. `relief` must stay within plus or minus `reach`.
    pub fn new(reach: f32, relief: impl Fn(Vec3) -> f32 + Send + Sync + 'static) -> Self {
        Self { parts: Vec::new(), relief: Box::new(relief), reach }
    }

    /// Nothing yet, and smooth.
    pub fn plain() -> Self {
        Self::new(0.0, |_| 0.0)
    }

    /// Starts a part: the lumps added next are joined to the clay so far by `joint`.
    pub fn part(&mut self, joint: Joint) -> &mut Self {
        self.parts.push(Part { joint, lumps: Vec::new() });
        self
    }

    /// Adds a lump that lies in the ball of `radius` around `centre`.
    ///
    /// # Panics
    /// When no part was started.
    pub fn lump(
        &mut self,
        centre: Vec3,
        radius: f32,
        distance: impl Fn(Vec3) -> f32 + Send + Sync + 'static,
    ) -> &mut Self {
        let part = self.parts.last_mut().expect("a lump needs a part: call Clay::part first");
        part.lumps.push(Lump { centre, radius, distance: Box::new(distance) });
        self
    }

    /// The lumps that can change the surface within `radius` of `centre`.
    pub(crate) fn near(&self, centre: Vec3, radius: f32) -> Active {
        let mut active = Active::new();
        for (i, part) in self.parts.iter().enumerate() {
            let reach = radius + part.joint.fillet + self.reach;
            for (j, lump) in part.lumps.iter().enumerate() {
                if lump.centre.distance(centre) < lump.radius + reach {
                    active.push((i as u16, j as u16));
                }
            }
        }
        active
    }

    /// Signed distance without relief, and the grain there.
    fn bare_distance(&self, active: &Active, p: Vec3) -> (f32, f32) {
        let (mut distance, mut grain) = (FAR, 1.0);
        let mut rest = &active[..];
        while let Some(&(i, _)) = rest.first() {
            let part = &self.parts[i as usize];
            let count = rest.iter().take_while(|&&(other, _)| other == i).count();
            let (these, others) = rest.split_at(count);
            let sign = if part.joint.carve { -1.0 } else { 1.0 };

            // What is farther than this changes nothing.
            let mut near = FAR;
            let mut bound = sign * distance + part.joint.fillet;
            for &(_, j) in these {
                let lump = &part.lumps[j as usize];
                let reach = lump.radius + bound;
                if reach > 0.0 && lump.centre.distance_squared(p) < reach * reach {
                    near = near.min((lump.distance)(p));
                    bound = bound.min(near);
                }
            }
            let (joined, share) = join(sign * distance, near, part.joint.fillet);
            let joined = sign * joined;
            distance = joined;
            grain += (part.joint.grain - grain) * share;
            rest = others;
        }
        (distance, grain)
    }

    /// Signed distance to the surface.
    pub(crate) fn distance(&self, active: &Active, p: Vec3) -> f32 {
        let (distance, grain) = self.bare_distance(active, p);
        if self.reach > 0.0 && grain > 0.0 && distance.abs() < 3.0 * self.reach {
            distance - grain * (self.relief)(p)
        } else {
            distance
        }
    }

    /// Direction in which the distance grows, of unit length, by central differences over `step`.
    pub(crate) fn normal(&self, active: &Active, p: Vec3, step: f32) -> Vec3 {
        let along = |axis: Vec3| self.distance(active, p + axis * step) - self.distance(active, p - axis * step);
        Vec3::new(along(Vec3::X), along(Vec3::Y), along(Vec3::Z)).normalize_or(Vec3::Y)
    }
}

/// Union of two distances with a fillet of width `k`, and the share of the second in it (Quilez, "smooth minimum").
fn join(a: f32, b: f32, k: f32) -> (f32, f32) {
    if k <= 0.0 || (a - b).abs() >= k {
        return if b < a { (b, 1.0) } else { (a, 0.0) };
    }
    let h = (k - (a - b).abs()) / k;
    let share = 0.5 * h * h;
    (a.min(b) - 0.25 * k * h * h, if b < a { 1.0 - share } else { share })
}
