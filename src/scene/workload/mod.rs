//! Workloads: rays of one kind for a scene.

mod bounce;
mod lines;
mod picture;
mod sampler;
#[cfg(test)]
mod tests;
mod tiles;

use std::fmt::Write;
use std::str::FromStr;

use glam::Vec2;
use sha2::{Digest, Sha256};

use super::{Scene, View};
use crate::accel::{DynAccel, Query};
use crate::geometry::Ray;
use crate::nearest::{named, suggestion};
use tiles::in_tiles;

/// Where the rays of a workload come from and go to.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum WorkloadKind {
    /// From the eye through the middle of each pixel, in tiles of four by four pixels, those in blocks of 32 by
    /// 32; so are all that follow from these.
    Primary,
    /// From the eye through the top left corner of each pixel: on the tidy meshes of tests these meet edges and vertices.
    Corners,
    /// From each primary hit to each light, one light after the other, any hit.
    Shadow,
    /// From each primary hit, mirrored about the shading normal, whatever the material.
    Mirror,
    /// From each primary hit in a random direction, cosine-distributed about the shading normal.
    Diffuse,
    /// As [`WorkloadKind::Diffuse`], any hit, ending at a tenth of the box's diagonal: ambient occlusion.
    Ambient,
    /// Lines through two random points of the sphere around the scene's box.
    Random,
    /// Rays along the axes, both ways, on a lattice; every fourth line of it has the coordinate of a vertex.
    Axis,
    /// The closest-hit rays of the whole picture: each pixel's primary ray and then its mirror rays.
    Image,
    /// The any-hit rays of the whole picture, in the order of the hits that cast them.
    ImageShadow,
}

impl WorkloadKind {
    pub const ALL: [Self; 10] = [
        Self::Primary,
        Self::Corners,
        Self::Shadow,
        Self::Mirror,
        Self::Diffuse,
        Self::Ambient,
        Self::Random,
        Self::Axis,
        Self::Image,
        Self::ImageShadow,
    ];

    /// As written on the command line and in records.
    pub fn name(self) -> &'static str {
        match self {
            Self::Primary => "primary",
            Self::Corners => "corners",
            Self::Shadow => "shadow",
            Self::Mirror => "mirror",
            Self::Diffuse => "diffuse",
            Self::Ambient => "ambient",
            Self::Random => "random",
            Self::Axis => "axis",
            Self::Image => "image",
            Self::ImageShadow => "image-shadow",
        }
    }

    /// The question that these rays ask.
    pub fn query(self) -> Query {
        match self {
            Self::Shadow | Self::Ambient | Self::ImageShadow => Query::Any,
            _ => Query::Closest,
        }
    }
}

/// A name that is no workload.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error(
    "there is no workload {0:?}{meant}; there are: {known}",
    meant = suggestion(.0, WorkloadKind::ALL.map(WorkloadKind::name)),
    known = WorkloadKind::ALL.map(WorkloadKind::name).join(", ")
)]
pub struct UnknownWorkload(pub String);

impl FromStr for WorkloadKind {
    type Err = UnknownWorkload;

    fn from_str(name: &str) -> Result<Self, UnknownWorkload> {
        named(Self::ALL, name, |kind| kind.name()).ok_or_else(|| UnknownWorkload(name.into()))
    }
}

/// How many rays a workload gets, and its random numbers.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Sampling {
    /// Width and height of the picture whose hits secondary rays start from; random and lattice rays are as many as it
    /// has pixels.
    pub size: [u32; 2],
    /// No more rays than this, spread evenly over the workload.
    pub limit: usize,
    pub seed: u64,
}

impl Sampling {
    /// All rays of the picture that the scene asks for.
    pub fn of(scene: &Scene) -> Self {
        Self { size: scene.size, limit: usize::MAX, seed: 0 }
    }

    /// At most `limit` of them, picked at equal distances: to check answers, not to take times.
    pub fn some(scene: &Scene, limit: usize, seed: u64) -> Self {
        Self { limit, seed, ..Self::of(scene) }
    }

    fn pixels(&self) -> u32 {
        self.size[0] * self.size[1]
    }
}

/// Rays of one kind for a scene: the same bits on every machine and with every structure of the same triangle test.
#[derive(Clone, Debug, PartialEq)]
pub struct Workload {
    /// [`WorkloadKind::name`], or what a file calls its rays.
    pub name: String,
    /// What is asked.
    pub query: Query,
    pub rays: Vec<Ray>,
}

impl Workload {
    /// Makes the rays. `accel`, built over the scene's mesh, finds the hits that secondary rays start from.
    ///
    /// A workload is empty where the scene has no such rays: no shadow rays without lights, none from hits when nothing is
    /// seen, none at all about an empty mesh.
    pub fn new(scene: &Scene, kind: WorkloadKind, sampling: &Sampling, accel: &dyn DynAccel) -> Self {
        let pixels = |offset| scene.primary_rays(sampling.size, offset, 0..sampling.pixels());
        let primary = || in_tiles(&pixels(View::CENTRE), sampling.size);
        let rays = match kind {
            WorkloadKind::Primary => primary(),
            WorkloadKind::Corners => in_tiles(&pixels(Vec2::ZERO), sampling.size),
            WorkloadKind::Shadow => bounce::shadow(scene, &primary(), accel),
            WorkloadKind::Mirror => bounce::mirror(scene, &primary(), accel),
            WorkloadKind::Diffuse => bounce::diffuse(scene, &primary(), accel, sampling.seed),
            WorkloadKind::Ambient => bounce::ambient(scene, &primary(), accel, sampling.seed),
            WorkloadKind::Random => lines::random(scene, sampling.pixels(), sampling.seed),
            WorkloadKind::Axis => lines::axis(scene, sampling.pixels()),
            WorkloadKind::Image => picture::closest(scene, &pixels(View::CENTRE), accel),
            WorkloadKind::ImageShadow => picture::shadow(scene, &pixels(View::CENTRE), accel),
        };
        Self { name: kind.name().into(), query: kind.query(), rays: spread(rays, sampling.limit) }
    }

    /// All ray bits, little-endian: origin, `t_min`, direction, `t_max`.
    pub fn bytes(&self) -> Vec<u8> {
        let numbers = |ray: &Ray| {
            let [o, d] = [ray.origin, ray.direction];
            [o.x, o.y, o.z, ray.t_min, d.x, d.y, d.z, ray.t_max]
        };
        self.rays.iter().flat_map(numbers).flat_map(|value| value.to_bits().to_le_bytes()).collect()
    }

    /// The first 16 hexadecimal digits of the SHA-256 of [`bytes`](Self::bytes): names the workload in
    /// records.
    pub fn hash(&self) -> String {
        Sha256::digest(self.bytes())[..8].iter().fold(String::new(), |mut text, byte| {
            write!(text, "{byte:02x}").expect("a string takes every write");
            text
        })
    }
}

/// At most `limit` of `rays`, at equal distances.
fn spread(rays: Vec<Ray>, limit: usize) -> Vec<Ray> {
    if rays.len() <= limit {
        return rays;
    }
    (0..limit).map(|i| rays[(i as u128 * rays.len() as u128 / limit as u128) as usize]).collect()
}
