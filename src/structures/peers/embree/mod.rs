//! [Embree](https://github.com/RenderKit/embree) 4: the library that renderers use, loaded at run time from the path in
//! `SAHARA_EMBREE` or from the system's.
//!
//! Its flag ROBUST changes the triangle test with the boxes, and so makes a structure of its own here: `embree` and
//! `embree-robust`. Its own triangle test is the only one; brute force over it is a scene of one triangle for every triangle
//! that is asked for ([`alone`]). Rays are copied into its form (96 bytes for one, 1,344 for sixteen) inside of the timed
//! region, on the stack. It builds on the threads of the caller. What its tree looks like is not known: its shape is that of one leaf.
//!
//! # References
//! Wald, Woop, Benthin, Johnson, Ernst: Embree: a kernel framework for efficient CPU ray tracing. SIGGRAPH 2014.

mod api;
mod device;
mod rays;

use std::ffi::c_int;
use std::marker::PhantomData;
use std::sync::Arc;

use glam::Vec3;
use serde::{Deserialize, Serialize};

use crate::accel::{Accel, BuildError, Footprint, Observed, Observer, TreeShape};
use crate::geometry::{Hit, Mesh, Ray};
use api::Arguments;
use device::Scene;
use rays::LANES;

/// A scene of Embree.
pub struct Embree<M: Mode> {
    scene: Scene,
    /// The triangle of the mesh for each of its own.
    ids: Vec<u32>,
    packets: bool,
    arguments: Arguments,
    mode: PhantomData<M>,
}

/// What the flag ROBUST decides.
pub trait Mode: Send + Sync + 'static {
    /// Scene flags, as Embree's headers number them.
    const FLAGS: c_int;
    /// The name of its triangle test.
    const TEST: &'static str;
    /// What it does with the ends of an interval.
    const CONVENTIONS: &'static [&'static str];
}

/// Without flags: Möller-Trumbore, boxes by fused multiply-add.
#[derive(Clone, Copy, Debug)]
pub struct Fast;

/// `RTC_SCENE_FLAG_ROBUST`: Plücker, widened boxes.
#[derive(Clone, Copy, Debug)]
pub struct Robust;

impl Mode for Fast {
    const FLAGS: c_int = 0;
    const TEST: &'static str = "embree-moller-trumbore";
    const CONVENTIONS: &'static [&'static str] = &["open at t_min: what lies at the origin is not hit"];
}

impl Mode for Robust {
    const FLAGS: c_int = 4;
    const TEST: &'static str = "embree-plucker";
    const CONVENTIONS: &'static [&'static str] = &["counts edges within rounding errors as hit"];
}

/// How Embree builds and is asked.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct EmbreeConfig {
    /// Its build quality.
    pub quality: Quality,
    /// Rays at a time: 1 or 16.
    pub packet: Packet,
    /// What it is told of the rays of a packet.
    pub rays: Rays,
}

/// The build qualities of Embree for scenes that stay.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Quality {
    /// Binned surface area heuristic.
    Medium,
    /// With spatial splits.
    #[default]
    High,
}

/// Rays at a time.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(try_from = "u32", into = "u32")]
pub enum Packet {
    /// `rtcIntersect1`.
    #[default]
    One,
    /// `rtcIntersect16`, for rays of a batch that follow each other.
    Sixteen,
}

/// What Embree may expect of the rays of a packet.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Rays {
    /// Nothing.
    #[default]
    Incoherent,
    /// That they go the same way.
    Coherent,
}

impl TryFrom<u32> for Packet {
    type Error = String;

    fn try_from(rays: u32) -> Result<Self, String> {
        match rays {
            1 => Ok(Self::One),
            16 => Ok(Self::Sixteen),
            other => Err(format!("packet must be 1 or 16, not {other}")),
        }
    }
}

impl From<Packet> for u32 {
    fn from(packet: Packet) -> Self {
        match packet {
            Packet::One => 1,
            Packet::Sixteen => LANES as u32,
        }
    }
}

impl<M: Mode> Embree<M> {
    fn hit(&self, found: Option<(f32, u32)>) -> Option<Hit> {
        found.map(|(t, primitive)| Hit::new(t, self.ids[primitive as usize]))
    }
}

impl<M: Mode> Accel for Embree<M> {
    type Config = EmbreeConfig;

    const TRIANGLE_TEST: &'static str = M::TEST;
    const OBSERVED: Observed = Observed::NONE;
    const CONVENTIONS: &'static [&'static str] = M::CONVENTIONS;

    fn build(mesh: &Arc<Mesh>, config: &EmbreeConfig) -> Result<Self, BuildError> {
        let ids: Vec<u32> = mesh.solid().collect();
        let quality = match config.quality {
            Quality::Medium => 1,
            Quality::High => 2,
        };
        let scene = Scene::new(mesh, &ids, M::FLAGS, quality, rayon::current_num_threads())?;
        let flags = match config.rays {
            Rays::Incoherent => 0,
            Rays::Coherent => 1 << 16,
        };
        let arguments = Arguments { flags, features: u32::MAX, rest: [0; 5] };
        Ok(Self { scene, ids, packets: config.packet == Packet::Sixteen, arguments, mode: PhantomData })
    }

    #[inline]
    fn closest_hit<O: Observer>(&self, ray: &Ray, _: &mut O) -> Option<Hit> {
        let mut hit = [None];
        self.closest_hits(&[*ray], &mut hit, &mut ());
        hit[0]
    }

    #[inline]
    fn any_hit<O: Observer>(&self, ray: &Ray, _: &mut O) -> bool {
        let mut hit = [false];
        self.any_hits(&[*ray], &mut hit, &mut ());
        hit[0]
    }

    fn closest_hits<O: Observer>(&self, rays: &[Ray], hits: &mut [Option<Hit>], _: &mut O) {
        assert_eq!(rays.len(), hits.len(), "one answer a ray");
        if self.packets {
            for (rays, hits) in rays.chunks(LANES).zip(hits.chunks_mut(LANES)) {
                let found = rays::closest_of_packet(&self.scene, rays, &self.arguments);
                hits.iter_mut().zip(found).for_each(|(hit, found)| *hit = self.hit(found));
            }
            return;
        }
        for (ray, hit) in rays.iter().zip(hits) {
            let found = if ray.is_valid() { rays::closest(&self.scene, ray, &self.arguments) } else { None };
            *hit = self.hit(found);
        }
    }

    fn any_hits<O: Observer>(&self, rays: &[Ray], hits: &mut [bool], _: &mut O) {
        assert_eq!(rays.len(), hits.len(), "one answer a ray");
        if self.packets {
            for (rays, hits) in rays.chunks(LANES).zip(hits.chunks_mut(LANES)) {
                let found = rays::any_of_packet(&self.scene, rays, &self.arguments);
                hits.iter_mut().zip(found).for_each(|(hit, found)| *hit = found);
            }
            return;
        }
        for (ray, hit) in rays.iter().zip(hits) {
            *hit = ray.is_valid() && rays::any(&self.scene, ray, &self.arguments);
        }
    }

    /// As Embree's own memory monitor counts, buffers of corners included; what is nodes and what triangles is not known.
    fn footprint(&self) -> Footprint {
        let references = size_of_val(&self.ids[..]);
        Footprint { references, other: self.scene.bytes(), ..Footprint::default() }
    }

    fn shape(&self) -> TreeShape {
        let references = self.ids.len();
        TreeShape {
            leaves: 1,
            empty: usize::from(references == 0),
            references,
            largest_leaf: references,
            ..TreeShape::default()
        }
    }
}

/// One triangle in a scene of its own: what Embree's triangle test says without a walk. Takes a fraction of a millisecond.
pub fn alone<M: Mode>(ray: &Ray, corners: [Vec3; 3]) -> Option<f32> {
    let mesh = Arc::new(Mesh::new(corners.into(), vec![[0, 1, 2]]).ok()?);
    let scene = Embree::<M>::build(&mesh, &EmbreeConfig { quality: Quality::Medium, ..Default::default() }).ok()?;
    scene.closest_hit(ray, &mut ()).map(|hit| hit.t)
}
