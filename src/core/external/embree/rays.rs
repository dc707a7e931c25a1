//! Rays in Embree's format, in packets of one, eight or sixteen.
//!
//! A query overwrites `t_far`, so each query gets a copy of the rays.

use std::ffi::c_int;
use std::mem::offset_of;

use super::api::Arguments;
use super::device::Scene;
use crate::geometry::Ray;

const NONE: u32 = u32::MAX;

/// `RTCRay`, `RTCRay8` or `RTCRay16`.
#[repr(C)]
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

/// `RTCRayHit`, `RTCRayHit8` or `RTCRayHit16`. Early versions of Embree 4 use only the first row of `instances`.
#[repr(C, align(64))]
struct Query<const LANES: usize> {
    rays: RayLanes<LANES>,
    normal: [[f32; LANES]; 3],
    barycentrics: [[f32; LANES]; 2],
    primitive: [u32; LANES],
    geometry: [u32; LANES],
    instances: [[u32; LANES]; 2],
}

const _: () = assert!(offset_of!(Query<1>, normal) == 48 && size_of::<Query<1>>() >= 96);
const _: () = assert!(offset_of!(Query<8>, normal) == 384 && size_of::<Query<8>>() >= 672);
const _: () = assert!(offset_of!(Query<16>, normal) == 768 && size_of::<Query<16>>() == 1344);

/// At most `LANES` rays. `LANES` is 1, 8 or 16. Queries skip invalid rays.
#[repr(C, align(64))]
pub struct Packet<const LANES: usize> {
    /// -1 in lanes with a valid ray, otherwise 0.
    valid: [c_int; LANES],
    rays: RayLanes<LANES>,
}

impl<const LANES: usize> Packet<LANES> {
    pub fn new(rays: &[Ray]) -> Self {
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
            // Embree accepts hits at exactly `t_far`. The end `t_max` is exclusive.
            packet.t_far[lane] = if t_max == f32::INFINITY { t_max } else { t_max.next_down() };
            valid[lane] = -1;
        }
        Self { valid, rays: packet }
    }

    /// The `t` and the primitive number of the closest hit in each lane.
    #[inline]
    pub fn closest(
        &self,
        scene: &Scene,
        arguments: &Arguments,
    ) -> impl Iterator<Item = Option<(f32, u32)>> + use<LANES> {
        let mut query = Query {
            rays: self.rays,
            normal: [[0.0; LANES]; 3],
            barycentrics: [[0.0; LANES]; 2],
            primitive: [NONE; LANES],
            geometry: [NONE; LANES],
            instances: [[NONE; LANES]; 2],
        };
        let (api, valid, rays) = (scene.api, self.valid.as_ptr(), (&raw mut query).cast());
        // SAFETY: `Scene::new` has committed the scene. `valid` and `query` have the alignment that Embree requires.
        // `valid` has one item per lane. `query` is at least as large as Embree's type (see the assertions at `Query`).
        unsafe {
            match LANES {
                1 if self.valid[0] == 0 => {}
                1 => (api.intersect1)(scene.handle, rays, arguments),
                8 => (api.intersect8)(valid, scene.handle, rays, arguments),
                16 => (api.intersect16)(valid, scene.handle, rays, arguments),
                _ => unreachable!("there are queries for 1, 8 and 16 rays"),
            }
        }
        let (geometry, t, primitive) = (query.geometry, query.rays.t_far, query.primitive);
        (0..LANES).map(move |lane| (geometry[lane] != NONE).then_some((t[lane], primitive[lane])))
    }

    #[inline]
    pub fn any(&self, scene: &Scene, arguments: &Arguments) -> impl Iterator<Item = bool> + use<LANES> {
        #[repr(align(64))]
        struct Aligned<R>(R);
        let mut query = Aligned(self.rays);
        let (api, valid, rays) = (scene.api, self.valid.as_ptr(), (&raw mut query).cast());
        // SAFETY: as in `closest`. The `occluded` functions access only rays.
        unsafe {
            match LANES {
                1 if self.valid[0] == 0 => {}
                1 => (api.occluded1)(scene.handle, rays, arguments),
                8 => (api.occluded8)(valid, scene.handle, rays, arguments),
                16 => (api.occluded16)(valid, scene.handle, rays, arguments),
                _ => unreachable!("there are queries for 1, 8 and 16 rays"),
            }
        }
        query.0.t_far.into_iter().map(|t| t == f32::NEG_INFINITY)
    }
}
