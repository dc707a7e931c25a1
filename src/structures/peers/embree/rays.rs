//! Rays as Embree takes them, one or sixteen.

use std::ffi::{c_int, c_void};

use super::api::{Arguments, Handle};
use super::device::Scene;
use crate::geometry::Ray;

/// Stands for no geometry and no primitive.
const NONE: u32 = u32::MAX;

/// `RTCRayHit`, with room for what later versions of Embree 4 add to its hit.
#[repr(C, align(16))]
#[derive(Clone, Copy)]
struct Single {
    origin: [f32; 3],
    t_near: f32,
    direction: [f32; 3],
    time: f32,
    t_far: f32,
    mask: u32,
    id: u32,
    flags: u32,
    normal: [f32; 3],
    barycentrics: [f32; 2],
    primitive: u32,
    geometry: u32,
    instances: [u32; 2],
    reserve: [u32; 3],
}

const _: () = assert!(size_of::<Single>() == 96);

/// `RTCRayHit16`, with the same room.
#[repr(C, align(64))]
struct Packet {
    origin: [[f32; LANES]; 3],
    t_near: [f32; LANES],
    direction: [[f32; LANES]; 3],
    time: [f32; LANES],
    t_far: [f32; LANES],
    mask: [u32; LANES],
    id: [u32; LANES],
    flags: [u32; LANES],
    normal: [[f32; LANES]; 3],
    barycentrics: [[f32; LANES]; 2],
    primitive: [u32; LANES],
    geometry: [u32; LANES],
    instances: [[u32; LANES]; 2],
}

/// Rays of a packet.
pub const LANES: usize = 16;

/// Which lanes of a packet are asked: -1 for those.
#[repr(C, align(64))]
struct Valid([c_int; LANES]);

/// The last `t` that a ray which ends before `t_max` may have: Embree's end is closed.
#[inline(always)]
fn last(t_max: f32) -> f32 {
    if t_max == f32::INFINITY { t_max } else { t_max.next_down() }
}

#[inline(always)]
fn single(ray: &Ray) -> Single {
    let (t_min, t_max) = ray.interval();
    Single {
        origin: ray.origin.to_array(),
        t_near: t_min,
        direction: ray.direction.to_array(),
        time: 0.0,
        t_far: last(t_max),
        mask: u32::MAX,
        id: 0,
        flags: 0,
        normal: [0.0; 3],
        barycentrics: [0.0; 2],
        primitive: NONE,
        geometry: NONE,
        instances: [NONE; 2],
        reserve: [0; 3],
    }
}

/// `t` and the number of the triangle that a valid ray hits first.
#[inline]
pub fn closest(scene: &Scene, ray: &Ray, arguments: &Arguments) -> Option<(f32, u32)> {
    let mut single = single(ray);
    // SAFETY: the scene is committed; the ray is aligned and as large as any Embree 4 writes.
    unsafe { (scene.api().intersect1)(scene.handle(), (&raw mut single).cast(), arguments) };
    (single.geometry != NONE).then_some((single.t_far, single.primitive))
}

/// Whether a valid ray hits anything.
#[inline]
pub fn any(scene: &Scene, ray: &Ray, arguments: &Arguments) -> bool {
    let mut single = single(ray);
    // SAFETY: as above; the query reads and writes the part before the hit.
    unsafe { (scene.api().occluded1)(scene.handle(), (&raw mut single).cast(), arguments) };
    single.t_far == f32::NEG_INFINITY
}

/// Asks at most [`LANES`] rays at once; those that are not valid are left out.
fn ask(
    scene: &Scene,
    rays: &[Ray],
    arguments: &Arguments,
    query: unsafe extern "C" fn(*const c_int, Handle, *mut c_void, *const Arguments),
) -> Packet {
    let mut valid = Valid([0; LANES]);
    let mut packet = Packet {
        origin: [[0.0; LANES]; 3],
        t_near: [0.0; LANES],
        direction: [[0.0; LANES]; 3],
        time: [0.0; LANES],
        t_far: [0.0; LANES],
        mask: [u32::MAX; LANES],
        id: [0; LANES],
        flags: [0; LANES],
        normal: [[0.0; LANES]; 3],
        barycentrics: [[0.0; LANES]; 2],
        primitive: [NONE; LANES],
        geometry: [NONE; LANES],
        instances: [[NONE; LANES]; 2],
    };
    for (lane, ray) in rays.iter().enumerate().filter(|(_, ray)| ray.is_valid()) {
        let (t_min, t_max) = ray.interval();
        for axis in 0..3 {
            packet.origin[axis][lane] = ray.origin[axis];
            packet.direction[axis][lane] = ray.direction[axis];
        }
        packet.t_near[lane] = t_min;
        packet.t_far[lane] = last(t_max);
        valid.0[lane] = -1;
    }
    // SAFETY: the scene is committed; mask and packet are aligned and as large as any Embree 4 reads and writes.
    unsafe { query(valid.0.as_ptr(), scene.handle(), (&raw mut packet).cast(), arguments) };
    packet
}

/// As [`closest`], for at most [`LANES`] rays.
pub fn closest_of_packet(
    scene: &Scene,
    rays: &[Ray],
    arguments: &Arguments,
) -> impl Iterator<Item = Option<(f32, u32)>> + use<> {
    let packet = ask(scene, rays, arguments, scene.api().intersect16);
    let lanes = 0..rays.len();
    lanes.map(move |lane| (packet.geometry[lane] != NONE).then_some((packet.t_far[lane], packet.primitive[lane])))
}

/// As [`any`], for at most [`LANES`] rays.
pub fn any_of_packet(scene: &Scene, rays: &[Ray], arguments: &Arguments) -> impl Iterator<Item = bool> + use<> {
    let packet = ask(scene, rays, arguments, scene.api().occluded16);
    (0..rays.len()).map(move |lane| packet.t_far[lane] == f32::NEG_INFINITY)
}
