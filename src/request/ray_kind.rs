use std::str::FromStr;

use serde::{Deserialize, Serialize};

use crate::geometry::{Mesh, Ray};
use crate::measure::spread;
use crate::names::{Unknown, find, named_enum};
use crate::scene::{Scene, View};
use crate::validate::Stratum;

named_enum! {
    /// A workload of `study accuracy`.
    #[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Serialize, Deserialize)]
    #[serde(rename_all = "kebab-case")]
    pub enum RayKind {
        Uniform = "uniform",
        Edge = "edge",
        Vertex = "vertex",
        Axis = "axis",
        Grazing = "grazing",
        Scale = "scale",
        Offset = "offset",
        Surface = "surface",
    }
}

impl RayKind {
    pub fn description(self) -> &'static str {
        self.meaning().1
    }

    fn meaning(self) -> (Stratum, &'static str) {
        match self {
            // The method `rays` adds the camera rays.
            Self::Uniform => (Stratum::Random, "camera rays and random lines, half of each"),
            Self::Edge => (Stratum::Edges, "rays through points on edges"),
            Self::Vertex => (Stratum::Vertices, "rays through vertices"),
            Self::Axis => (Stratum::AxisParallel, "axis-parallel rays through vertex coordinates"),
            Self::Grazing => (Stratum::Grazing, "rays almost in the plane of a triangle"),
            Self::Scale => (Stratum::Lengths, "rays with directions 1e-30 to 1e30 long"),
            // Far beyond 1e6 scene sizes, the spacing of `f32` values exceeds the scene size. A traversal that loses no
            // hit then visits nearly all nodes.
            Self::Offset => (Stratum::FarOrigins, "rays from 1e3 to 1e6 scene sizes away"),
            Self::Surface => (Stratum::FromSurface, "rays from points on triangles"),
        }
    }

    pub fn rays(self, scene: &Scene, count: usize, seed: u64) -> Vec<Ray> {
        if self == Self::Offset {
            return near_enough(&scene.mesh, count, seed);
        }
        let mut rays = vec![];
        if self == Self::Uniform {
            let pixels = scene.size[0] * scene.size[1];
            rays = spread(&scene.primary_rays(scene.size, View::CENTRE, 0..pixels), count / 2);
        }
        rays.extend(self.meaning().0.rays(&scene.mesh, count - rays.len(), seed));
        rays
    }
}

/// Rays of [`Stratum::FarOrigins`] whose origins are less than 2e6 mesh sizes from the centre of the mesh.
fn near_enough(mesh: &Mesh, count: usize, seed: u64) -> Vec<Ray> {
    let (centre, reach) = (mesh.bounds().centre(), mesh.bounds().extent().max_element() * 2e6);
    // About two of three rays are near enough.
    let mut tried = 2 * count + 64;
    loop {
        let mut rays = Stratum::FarOrigins.rays(mesh, tried, seed);
        rays.retain(|ray| (ray.origin - centre).abs().max_element() < reach);
        // For a mesh of size 0, no ray is near enough. Missing rays are replaced by rays from any distance.
        if rays.len() >= count || tried > 64 * count + 64 {
            rays.extend(Stratum::FarOrigins.rays(mesh, count.saturating_sub(rays.len()), seed));
            rays.truncate(count);
            return rays;
        }
        tried *= 2;
    }
}

impl FromStr for RayKind {
    type Err = Unknown;

    fn from_str(name: &str) -> Result<Self, Unknown> {
        find("workload", Self::ALL, name, Self::name)
    }
}
