//! [Embree](https://github.com/RenderKit/embree) 4, a library for renderers, loaded at run time. The library is at the
//! path in `SAHARA_EMBREE` or on the system's search path.
//!
//! # References
//! Wald, Woop, Benthin, Johnson, Ernst: Embree: a kernel framework for efficient CPU ray tracing. SIGGRAPH 2014.

mod api;
mod device;
mod rays;

use std::borrow::Cow;
use std::sync::Arc;

use glam::Vec3;
use serde::{Deserialize, Serialize};

use crate::accel::{Accel, BuildError, Capabilities, Footprint, Loaded, Observed, Observer, TreeShape};
use crate::geometry::{Hit, Mesh, Ray};
use api::Arguments;
use device::Scene;
use rays::Packet;

/// A scene of Embree. `ROBUST` sets `RTC_SCENE_FLAG_ROBUST`. Without `ROBUST`, the triangle test is Möller-Trumbore.
/// With `ROBUST`, the triangle test is Plücker, and Embree widens the boxes.
pub struct Embree<const ROBUST: bool> {
    scene: Scene,
    /// Triangle `i` of the scene is triangle `ids[i]` of the mesh.
    ids: Vec<u32>,
    packet: Lanes,
    arguments: Arguments,
}

/// The options of Embree.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct EmbreeConfig {
    /// Embree's build quality.
    pub quality: Quality,
    /// Rays per query: 1, 8 or 16.
    pub packet: Lanes,
    /// Whether queries declare the rays of a packet as coherent.
    pub rays: Rays,
    /// The instructions that Embree may use.
    pub isa: Isa,
}

/// The build qualities of Embree for static scenes. The values are from Embree's enumeration `RTCBuildQuality`.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Quality {
    /// Binned surface area heuristic.
    Medium = 1,
    /// Binned surface area heuristic with spatial splits.
    #[default]
    High = 2,
}

/// Rays per query.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(try_from = "u32", into = "u32")]
pub enum Lanes {
    /// One ray.
    #[default]
    One = 1,
    /// Eight consecutive rays.
    Eight = 8,
    /// Sixteen consecutive rays.
    Sixteen = 16,
}

/// The coherence of the rays of a packet. The values are query flags of Embree.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Rays {
    /// Any directions.
    #[default]
    Incoherent = 0,
    /// Similar directions.
    Coherent = 1 << 16,
}

/// The instructions that Embree may use.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Isa {
    /// All instructions of the processor.
    #[default]
    Native,
    /// Instruction sets up to AVX2.
    Avx2,
}

impl TryFrom<u32> for Lanes {
    type Error = String;

    fn try_from(rays: u32) -> Result<Self, String> {
        let all = [Self::One, Self::Eight, Self::Sixteen];
        let named = all.into_iter().find(|&lanes| lanes as u32 == rays);
        named.ok_or_else(|| format!("packet must be 1, 8 or 16, not {rays}"))
    }
}

impl From<Lanes> for u32 {
    fn from(lanes: Lanes) -> Self {
        lanes as Self
    }
}

struct Packets<'a, const LANES: usize, const ROBUST: bool> {
    structure: &'a Embree<ROBUST>,
    packets: Vec<Packet<LANES>>,
    rays: usize,
}

impl<'a, const LANES: usize, const ROBUST: bool> Packets<'a, LANES, ROBUST> {
    fn boxed(structure: &'a Embree<ROBUST>, rays: &[Ray]) -> Box<dyn Loaded + 'a> {
        let packets = rays.chunks(LANES).map(Packet::new).collect();
        Box::new(Self { structure, packets, rays: rays.len() })
    }
}

impl<const LANES: usize, const ROBUST: bool> Loaded for Packets<'_, LANES, ROBUST> {
    fn closest_hits(&self, hits: &mut [Option<Hit>]) {
        assert_eq!(self.rays, hits.len(), "one result per ray");
        let Embree { scene, ids, arguments, .. } = self.structure;
        for (packet, hits) in self.packets.iter().zip(hits.chunks_mut(LANES)) {
            for (hit, found) in hits.iter_mut().zip(packet.closest(scene, arguments)) {
                *hit = found.map(|(t, primitive)| Hit::new(t, ids[primitive as usize]));
            }
        }
    }

    fn any_hits(&self, hits: &mut [bool]) {
        assert_eq!(self.rays, hits.len(), "one result per ray");
        let Embree { scene, arguments, .. } = self.structure;
        for (packet, hits) in self.packets.iter().zip(hits.chunks_mut(LANES)) {
            hits.iter_mut().zip(packet.any(scene, arguments)).for_each(|(hit, found)| *hit = found);
        }
    }
}

impl<const ROBUST: bool> Accel for Embree<ROBUST> {
    type Config = EmbreeConfig;

    const TRIANGLE_TEST: &'static str = if ROBUST { "embree-plucker" } else { "embree-moller-trumbore" };
    const OBSERVED: Observed = Observed::NONE;
    const CAPABILITIES: Capabilities = Capabilities { closed_start: ROBUST, ..Capabilities::ALL };
    const CONVENTIONS: &'static [&'static str] =
        if ROBUST { &["counts rays that pass an edge within rounding error as hits"] } else { &[] };

    fn build(mesh: &Arc<Mesh>, config: &EmbreeConfig) -> Result<Self, BuildError> {
        let ids: Vec<u32> = mesh.solid().collect();
        let isa = if config.isa == Isa::Avx2 { ",isa=avx2" } else { "" };
        let device = format!("threads={},set_affinity=0{isa}", rayon::current_num_threads());
        let flags = if ROBUST { api::ROBUST } else { 0 };
        let scene = Scene::new(mesh, &ids, flags, config.quality as _, &device)?;
        let arguments = Arguments { flags: config.rays as _, features: u32::MAX, rest: [0; 5] };
        Ok(Self { scene, ids, packet: config.packet, arguments })
    }

    fn closest_hit<O: Observer>(&self, ray: &Ray, observer: &mut O) -> Option<Hit> {
        let mut hit = [None];
        self.closest_hits(&[*ray], &mut hit, observer);
        hit[0]
    }

    fn any_hit<O: Observer>(&self, ray: &Ray, observer: &mut O) -> bool {
        let mut hit = [false];
        self.any_hits(&[*ray], &mut hit, observer);
        hit[0]
    }

    fn closest_hits<O: Observer>(&self, rays: &[Ray], hits: &mut [Option<Hit>], _: &mut O) {
        Accel::load(self, Cow::Borrowed(rays)).closest_hits(hits);
    }

    fn any_hits<O: Observer>(&self, rays: &[Ray], hits: &mut [bool], _: &mut O) {
        Accel::load(self, Cow::Borrowed(rays)).any_hits(hits);
    }

    fn load<'a>(&'a self, rays: Cow<'a, [Ray]>) -> Box<dyn Loaded + 'a> {
        match self.packet {
            Lanes::One => Packets::<1, ROBUST>::boxed(self, &rays),
            Lanes::Eight => Packets::<8, ROBUST>::boxed(self, &rays),
            Lanes::Sixteen => Packets::<16, ROBUST>::boxed(self, &rays),
        }
    }

    /// Embree's memory monitor counts the bytes of `other`.
    fn footprint(&self) -> Footprint {
        let references = size_of_val(&self.ids[..]);
        Footprint { references, other: self.scene.bytes(), ..Footprint::default() }
    }

    /// The adapter cannot read Embree's tree.
    fn shape(&self) -> TreeShape {
        TreeShape::one_leaf(self.ids.len())
    }
}

/// The `t` of the closest hit in a scene that contains only the triangle `corners`.
pub fn alone<const ROBUST: bool>(ray: &Ray, corners: [Vec3; 3]) -> Option<f32> {
    let mesh = Arc::new(Mesh::new(corners.into(), vec![[0, 1, 2]]).ok()?);
    let config = EmbreeConfig { quality: Quality::Medium, ..Default::default() };
    Embree::<ROBUST>::build(&mesh, &config).ok()?.closest_hit(ray, &mut ()).map(|hit| hit.t)
}
