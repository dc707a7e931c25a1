//! Rays in Embree's format: one, eight or sixteen.
//!
//! A query reads the ray, overwrites the end of its interval (`tfar`) and writes the hit, so each query gets a copy.

use std::ffi::c_int;

use super::api::Arguments;
use super::device::Scene;
use crate::geometry::Ray;

const NONE: u32 = u32::MAX;

/// `RTCRay`.
#[repr(C, align(16))]
#[derive(Clone, Copy)]
pub struct Single {
    origin: [f32; 3],
    t_near: f32,
    direction: [f32; 3],
    time: f32,
    t_far: f32,
    mask: u32,
    id: u32,
    flags: u32,
}

/// `RTCRayHit`, with space for the additions of later versions of Embree 4.
#[repr(C, align(16))]
struct SingleQuery {
    ray: Single,
    normal: [f32; 3],
    barycentrics: [f32; 2],
    primitive: u32,
    geometry: u32,
    instances: [u32; 2],
    reserve: [u32; 3],
}

const _: () = assert!(size_of::<Single>() == 48 && size_of::<SingleQuery>() == 96);

/// `RTCRay8` or `RTCRay16`.
#[repr(C, align(64))]
#[derive(Clone, Copy)]
struct RayLanes<const LANES: usize> {
    origin: [[f32; LANES]; 3],
    t_near: [f32; LANES],
    direction: [[f32; LANES]; 3],
    time: [f32; LANES],
    t_far: [f32; LANES],
    mask: [u32; LANES],
    id: [u32; LANES],
    flags: [u32; LANES],
}

/// `RTCRayHit8` or `RTCRayHit16`, with the same space.
#[repr(C, align(64))]
struct PacketQuery<const LANES: usize> {
    rays: RayLanes<LANES>,
    normal: [[f32; LANES]; 3],
    barycentrics: [[f32; LANES]; 2],
    primitive: [u32; LANES],
    geometry: [u32; LANES],
    instances: [[u32; LANES]; 2],
}

const _: () = assert!(size_of::<RayLanes<16>>() == 768 && size_of::<PacketQuery<16>>() == 1344);
const _: () = assert!(size_of::<RayLanes<8>>() == 384 && size_of::<PacketQuery<8>>() >= 672);

/// At most `LANES` rays, 8 or 16; rays that are not valid are left out of the query.
#[repr(C, align(64))]
pub struct Packet<const LANES: usize> {
    /// -1 for the used lanes.
    valid: [c_int; LANES],
    rays: RayLanes<LANES>,
}

/// The last `t` that a ray that ends before `t_max` may have: Embree's end is closed.
#[inline(always)]
fn last(t_max: f32) -> f32 {
    if t_max == f32::INFINITY { t_max } else { t_max.next_down() }
}

impl Single {
    /// `None` if the ray is not valid.
    #[inline(always)]
    pub fn new(ray: &Ray) -> Option<Self> {
        let (t_min, t_max) = ray.interval();
        ray.is_valid().then(|| Self {
            origin: ray.origin.to_array(),
            t_near: t_min,
            direction: ray.direction.to_array(),
            time: 0.0,
            t_far: last(t_max),
            mask: u32::MAX,
            id: 0,
            flags: 0,
        })
    }

    /// `t` and the number of the triangle that the ray hits first.
    #[inline(always)]
    pub fn closest(&self, scene: &Scene, arguments: &Arguments) -> Option<(f32, u32)> {
        let mut query = SingleQuery {
            ray: *self,
            normal: [0.0; 3],
            barycentrics: [0.0; 2],
            primitive: NONE,
            geometry: NONE,
            instances: [NONE; 2],
            reserve: [0; 3],
        };
        // SAFETY: `Scene::new` has committed the scene; the ray has the alignment that Embree requires, and is as large
        // as any that Embree 4 writes (asserted at its type).
        unsafe { (scene.api().intersect1)(scene.handle(), (&raw mut query).cast(), arguments) };
        (query.geometry != NONE).then_some((query.ray.t_far, query.primitive))
    }

    /// Whether the ray hits anything.
    #[inline(always)]
    pub fn any(&self, scene: &Scene, arguments: &Arguments) -> bool {
        let mut ray = *self;
        // SAFETY: as in `closest`; this query writes no hit.
        unsafe { (scene.api().occluded1)(scene.handle(), (&raw mut ray).cast(), arguments) };
        ray.t_far == f32::NEG_INFINITY
    }
}

impl<const LANES: usize> Packet<LANES> {
    /// # Panics
    /// If there are more than `LANES` rays.
    pub fn new(rays: &[Ray]) -> Self {
        const { assert!(LANES == 8 || LANES == 16, "there are queries for packets of 8 and of 16") };
        assert!(rays.len() <= LANES, "a packet has {LANES} lanes");
        let mut valid = [0; LANES];
        let mut packet = RayLanes {
            origin: [[0.0; LANES]; 3],
            t_near: [0.0; LANES],
            direction: [[0.0; LANES]; 3],
            time: [0.0; LANES],
            t_far: [0.0; LANES],
            mask: [u32::MAX; LANES],
            id: [0; LANES],
            flags: [0; LANES],
        };
        for (lane, ray) in rays.iter().enumerate().filter(|(_, ray)| ray.is_valid()) {
            let (t_min, t_max) = ray.interval();
            for axis in 0..3 {
                packet.origin[axis][lane] = ray.origin[axis];
                packet.direction[axis][lane] = ray.direction[axis];
            }
            packet.t_near[lane] = t_min;
            packet.t_far[lane] = last(t_max);
            valid[lane] = -1;
        }
        Self { valid, rays: packet }
    }

    /// Like [`Single::closest`], lane by lane.
    #[inline]
    pub fn closest(
        &self,
        scene: &Scene,
        arguments: &Arguments,
    ) -> impl Iterator<Item = Option<(f32, u32)>> + use<LANES> {
        let mut query = PacketQuery {
            rays: self.rays,
            normal: [[0.0; LANES]; 3],
            barycentrics: [[0.0; LANES]; 2],
            primitive: [NONE; LANES],
            geometry: [NONE; LANES],
            instances: [[NONE; LANES]; 2],
        };
        let intersect = if const { LANES == 8 } { scene.api().intersect8 } else { scene.api().intersect16 };
        // SAFETY: `Scene::new` has committed the scene; mask and packet have the alignment that Embree requires, and
        // are as large as any that Embree 4 reads and writes (asserted at their types).
        unsafe { intersect(self.valid.as_ptr(), scene.handle(), (&raw mut query).cast(), arguments) };
        let (geometry, t, primitive) = (query.geometry, query.rays.t_far, query.primitive);
        (0..LANES).map(move |lane| (geometry[lane] != NONE).then_some((t[lane], primitive[lane])))
    }

    /// Like [`Single::any`], lane by lane.
    #[inline]
    pub fn any(&self, scene: &Scene, arguments: &Arguments) -> impl Iterator<Item = bool> + use<LANES> {
        let mut rays = self.rays;
        let occluded = if const { LANES == 8 } { scene.api().occluded8 } else { scene.api().occluded16 };
        // SAFETY: as in `closest`; this query writes no hit.
        unsafe { occluded(self.valid.as_ptr(), scene.handle(), (&raw mut rays).cast(), arguments) };
        rays.t_far.into_iter().map(|t| t == f32::NEG_INFINITY)
    }
}
