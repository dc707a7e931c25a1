use std::fmt::{Display, Formatter};
use std::sync::Arc;

use glam::{DVec3, Vec3};
use serde::{Deserialize, Serialize};

use crate::geometry::{Mesh, Ray};
use crate::scene::meshes::icosphere;
use crate::validate::Sampler;

/// A sphere of 1280 triangles, closed and convex even after its corners are rounded.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Sphere {
    pub radius: f64,
    /// All three coordinates of the centre.
    pub centre: f64,
}

impl Sphere {
    /// Of ordinary size, far from zero, large, small, tiny, very far from zero.
    pub const ALL: [Self; 6] = [
        Self { radius: 1.0, centre: 0.0 },
        Self { radius: 1.0, centre: 1e3 },
        Self { radius: 1e3, centre: 0.0 },
        Self { radius: 1e-3, centre: 0.0 },
        Self { radius: 1e-6, centre: 0.0 },
        Self { radius: 10.0, centre: 1e5 },
    ];

    fn place(&self, point: Vec3) -> Vec3 {
        (point.as_dvec3() * self.radius + DVec3::splat(self.centre)).as_vec3()
    }

    /// The triangles, the corners of each counter-clockwise seen from outside.
    pub fn mesh(&self) -> Arc<Mesh> {
        let unit = icosphere(3);
        let positions = unit.positions.iter().map(|&p| self.place(p)).collect();
        Arc::new(Mesh::new(positions, unit.triangles).expect("a sphere of finite size and place"))
    }

    /// A ray from three radii away towards a random point within.
    pub fn view(&self, sampler: &mut Sampler) -> Ray {
        let (eye, target) = (self.place(sampler.direction() * 3.0), self.place(sampler.cube() * 0.5));
        Ray::new(eye, (target.as_dvec3() - eye.as_dvec3()).normalize().as_vec3())
    }
}

impl Display for Sphere {
    fn fmt(&self, f: &mut Formatter<'_>) -> std::fmt::Result {
        let short = |x: f64| if (1e-2..1e2).contains(&x) || x == 0.0 { format!("{x}") } else { format!("{x:e}") };
        write!(f, "r={} @{}", short(self.radius), short(self.centre))
    }
}
