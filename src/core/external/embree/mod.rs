//! [Embree](https://github.com/RenderKit/embree) 4: the library that renderers use, loaded at run time from the path in
//! `SAHARA_EMBREE` or from the system's search path.
//!
//! Its flag ROBUST changes both the triangle test and the box test, so there are two structures: `embree` and
//! `embree-robust`. Only its own triangle test is available; brute force over it uses a scene of one triangle for each
//! tested triangle ([`alone`]). Rays and packets of eight or sixteen are converted to its format before the clock
//! starts: 48, 384 and 768 bytes, all that it reads. A query overwrites the end of the ray (`tfar`) and writes the hit
//! behind it, so each query gets a copy on the stack, followed by an empty hit. This is the cheapest way to repeat the
//! same rays, and a renderer does the same if it generates rays on demand. Builds run on the threads of the caller. The
//! shape of its tree is unknown, so the adapter reports one leaf.
//!
//! # References
//! Wald, Woop, Benthin, Johnson, Ernst: Embree: a kernel framework for efficient CPU ray tracing. SIGGRAPH 2014.

mod api;
mod device;
mod rays;

use std::borrow::Cow;
use std::ffi::c_int;
use std::marker::PhantomData;
use std::sync::Arc;

use glam::Vec3;
use serde::{Deserialize, Serialize};

use crate::accel::{Accel, BuildError, Capabilities, Footprint, Loaded, Observed, Observer, TreeShape};
use crate::external::prepared::{Prepare, PreparedBatch};
use crate::geometry::{Hit, Mesh, Ray};
use api::Arguments;
use device::Scene;
use rays::{Packet, Single};

/// A scene of Embree.
pub struct Embree<M: Mode> {
    scene: Scene,
    /// The triangle of the mesh for each triangle of the scene.
    ids: Vec<u32>,
    packet: Lanes,
    arguments: Arguments,
    mode: PhantomData<M>,
}

/// The effect of the flag ROBUST.
pub trait Mode: Send + Sync + 'static {
    /// Scene flags, as numbered in Embree's headers.
    const FLAGS: c_int;
    /// The name of its triangle test.
    const TEST: &'static str;
    /// Whether intervals include their start.
    const CLOSED_START: bool;
    /// Other deviations from the contract.
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
    const CLOSED_START: bool = false;
    const CONVENTIONS: &'static [&'static str] = &[];
}

impl Mode for Robust {
    const FLAGS: c_int = 4;
    const TEST: &'static str = "embree-plucker";
    const CLOSED_START: bool = true;
    const CONVENTIONS: &'static [&'static str] = &["counts rays that pass an edge within rounding error as hits"];
}

/// The options of Embree.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct EmbreeConfig {
    /// Its build quality.
    pub quality: Quality,
    /// Rays per query: 1, 8 or 16. Packets of the register width are the fastest: 8 with AVX2, 16 with AVX-512.
    pub packet: Lanes,
    /// Whether queries declare the rays of a packet as coherent.
    pub rays: Rays,
    /// The instructions that it may use.
    pub isa: Isa,
}

/// The build qualities of Embree for static scenes.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Quality {
    /// Binned surface area heuristic.
    Medium,
    /// With spatial splits.
    #[default]
    High,
}

/// Rays per query.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(try_from = "u32", into = "u32")]
pub enum Lanes {
    /// `rtcIntersect1`.
    #[default]
    One,
    /// `rtcIntersect8`, for consecutive rays of a batch.
    Eight,
    /// `rtcIntersect16`, for consecutive rays of a batch.
    Sixteen,
}

/// The coherence of the rays of a packet.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Rays {
    /// No coherence.
    #[default]
    Incoherent,
    /// Similar directions.
    Coherent,
}

/// The instructions that Embree may use.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Isa {
    /// All of the processor.
    #[default]
    Native,
    /// None beyond AVX2, to compare with a build for processors without AVX-512.
    Avx2,
}

impl TryFrom<u32> for Lanes {
    type Error = String;

    fn try_from(rays: u32) -> Result<Self, String> {
        match rays {
            1 => Ok(Self::One),
            8 => Ok(Self::Eight),
            16 => Ok(Self::Sixteen),
            other => Err(format!("packet must be 1, 8 or 16, not {other}")),
        }
    }
}

impl From<Lanes> for u32 {
    fn from(lanes: Lanes) -> Self {
        match lanes {
            Lanes::One => 1,
            Lanes::Eight => 8,
            Lanes::Sixteen => 16,
        }
    }
}

impl<M: Mode> Embree<M> {
    #[inline(always)]
    fn hit(&self, found: Option<(f32, u32)>) -> Option<Hit> {
        found.map(|(t, primitive)| Hit::new(t, self.ids[primitive as usize]))
    }

    #[inline]
    fn closest_of_packet<const LANES: usize>(&self, packet: &Packet<LANES>, hits: &mut [Option<Hit>]) {
        let found = packet.closest(&self.scene, &self.arguments);
        hits.iter_mut().zip(found).for_each(|(hit, found)| *hit = self.hit(found));
    }

    #[inline]
    fn any_of_packet<const LANES: usize>(&self, packet: &Packet<LANES>, hits: &mut [bool]) {
        let found = packet.any(&self.scene, &self.arguments);
        hits.iter_mut().zip(found).for_each(|(hit, found)| *hit = found);
    }

    fn closest_in_packets<const LANES: usize>(&self, rays: &[Ray], hits: &mut [Option<Hit>]) {
        let blocks = rays.chunks(LANES).zip(hits.chunks_mut(LANES));
        blocks.for_each(|(rays, hits)| self.closest_of_packet(&Packet::<LANES>::new(rays), hits));
    }

    fn any_in_packets<const LANES: usize>(&self, rays: &[Ray], hits: &mut [bool]) {
        let blocks = rays.chunks(LANES).zip(hits.chunks_mut(LANES));
        blocks.for_each(|(rays, hits)| self.any_of_packet(&Packet::<LANES>::new(rays), hits));
    }

    fn packets<const LANES: usize>(&self, rays: &[Ray]) -> Box<dyn Loaded + '_> {
        let packets = rays.chunks(LANES).map(Packet::<LANES>::new).collect();
        Box::new(Packets { structure: self, packets, rays: rays.len() })
    }
}

impl<M: Mode> Prepare for Embree<M> {
    type Ready = Single;

    #[inline(always)]
    fn ready(&self, ray: &Ray) -> Option<Single> {
        Single::new(ray)
    }

    #[inline(always)]
    fn closest<O: Observer>(&self, ready: &Single, _: &mut O) -> Option<Hit> {
        self.hit(ready.closest(&self.scene, &self.arguments))
    }

    #[inline(always)]
    fn any<O: Observer>(&self, ready: &Single, _: &mut O) -> bool {
        ready.any(&self.scene, &self.arguments)
    }
}

/// A batch of rays in packets; the last one has the remaining rays.
struct Packets<'a, const LANES: usize, M: Mode> {
    structure: &'a Embree<M>,
    packets: Vec<Packet<LANES>>,
    rays: usize,
}

impl<const LANES: usize, M: Mode> Loaded for Packets<'_, LANES, M> {
    fn closest_hits(&self, hits: &mut [Option<Hit>]) {
        assert_eq!(self.rays, hits.len(), "one result per ray");
        let blocks = self.packets.iter().zip(hits.chunks_mut(LANES));
        blocks.for_each(|(packet, hits)| self.structure.closest_of_packet(packet, hits));
    }

    fn any_hits(&self, hits: &mut [bool]) {
        assert_eq!(self.rays, hits.len(), "one result per ray");
        let blocks = self.packets.iter().zip(hits.chunks_mut(LANES));
        blocks.for_each(|(packet, hits)| self.structure.any_of_packet(packet, hits));
    }
}

impl<M: Mode> Accel for Embree<M> {
    type Config = EmbreeConfig;

    const TRIANGLE_TEST: &'static str = M::TEST;
    const OBSERVED: Observed = Observed::NONE;
    const CAPABILITIES: Capabilities = Capabilities { closed_start: M::CLOSED_START, ..Capabilities::ALL };
    const CONVENTIONS: &'static [&'static str] = M::CONVENTIONS;

    fn build(mesh: &Arc<Mesh>, config: &EmbreeConfig) -> Result<Self, BuildError> {
        let ids: Vec<u32> = mesh.solid().collect();
        let quality = match config.quality {
            Quality::Medium => 1,
            Quality::High => 2,
        };
        let isa = match config.isa {
            Isa::Native => "",
            Isa::Avx2 => ",isa=avx2",
        };
        let device = format!("threads={},set_affinity=0{isa}", rayon::current_num_threads());
        let scene = Scene::new(mesh, &ids, M::FLAGS, quality, &device)?;
        let flags = match config.rays {
            Rays::Incoherent => 0,
            Rays::Coherent => 1 << 16,
        };
        let arguments = Arguments { flags, features: u32::MAX, rest: [0; 5] };
        Ok(Self { scene, ids, packet: config.packet, arguments, mode: PhantomData })
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
        assert_eq!(rays.len(), hits.len(), "one result per ray");
        match self.packet {
            Lanes::One => {}
            Lanes::Eight => return self.closest_in_packets::<8>(rays, hits),
            Lanes::Sixteen => return self.closest_in_packets::<16>(rays, hits),
        }
        let answer = |ray| self.ready(ray).and_then(|ready| self.closest(&ready, &mut ()));
        rays.iter().zip(hits).for_each(|(ray, hit)| *hit = answer(ray));
    }

    fn any_hits<O: Observer>(&self, rays: &[Ray], hits: &mut [bool], _: &mut O) {
        assert_eq!(rays.len(), hits.len(), "one result per ray");
        match self.packet {
            Lanes::One => {}
            Lanes::Eight => return self.any_in_packets::<8>(rays, hits),
            Lanes::Sixteen => return self.any_in_packets::<16>(rays, hits),
        }
        let answer = |ray| self.ready(ray).is_some_and(|ready| self.any(&ready, &mut ()));
        rays.iter().zip(hits).for_each(|(ray, hit)| *hit = answer(ray));
    }

    fn load<'a>(&'a self, rays: Cow<'a, [Ray]>) -> Box<dyn Loaded + 'a> {
        match self.packet {
            Lanes::One => Box::new(PreparedBatch::new(self, &rays)),
            Lanes::Eight => self.packets::<8>(&rays),
            Lanes::Sixteen => self.packets::<16>(&rays),
        }
    }

    /// As counted by Embree's memory monitor, including buffers of corners; the shares of nodes and triangles are
    /// unknown.
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

/// The result of Embree's triangle test without a traversal: a scene of one triangle. Takes a fraction of a
/// millisecond.
pub fn alone<M: Mode>(ray: &Ray, corners: [Vec3; 3]) -> Option<f32> {
    let mesh = Arc::new(Mesh::new(corners.into(), vec![[0, 1, 2]]).ok()?);
    let scene = Embree::<M>::build(&mesh, &EmbreeConfig { quality: Quality::Medium, ..Default::default() }).ok()?;
    scene.closest_hit(ray, &mut ()).map(|hit| hit.t)
}
