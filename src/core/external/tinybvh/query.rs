//! Calls `Intersect` and `IsOccluded` of `BVH8_CPU` in the linked C++ library.
//!
//! The crate `tinybvh-rs` passes a 64-byte ray to `Intersect`, but the C++ ray type has 128 bytes. The crate does not
//! expose `IsOccluded`. This module therefore calls `Intersect` and `IsOccluded` by their mangled C++ names (Itanium
//! ABI). The layouts of the ray and of the crate's tree must match the crate version in `Cargo.toml`.

use std::ffi::c_void;
use std::mem;

use tinybvh_rs::bvh8_cpu;

/// The first 64 bytes of `tinybvh::Ray`. The queries do not access the other 64 bytes, which are custom data.
#[repr(C, align(64))]
#[derive(Clone, Copy)]
pub struct RayHead {
    pub origin: [f32; 3],
    pub mask: u32,
    pub direction: [f32; 3],
    pub instance: u32,
    pub inverse: [f32; 3],
    pub hit_instance: u32,
    pub t: f32,
    pub u: f32,
    pub v: f32,
    pub primitive: u32,
}

#[repr(C, align(64))]
struct FullRay {
    head: RayHead,
    custom: [u64; 8],
}

const _: () = assert!(size_of::<RayHead>() == 64 && size_of::<FullRay>() == 128);

pub struct Tree {
    /// Frees `object` on drop.
    _owner: bvh8_cpu::BVH,
    object: *const c_void,
}

// SAFETY: the tree owns its data.
unsafe impl Send for Tree {}
// SAFETY: `Intersect` and `IsOccluded` are `const` in C++ and do not write to the tree.
unsafe impl Sync for Tree {}

#[cfg(target_env = "msvc")]
compile_error!("peer-tinybvh calls C++ by the names of the Itanium ABI, which Microsoft's compiler does not follow");

// SAFETY: the mangled names encode the argument types. The result types match the crate version in `Cargo.toml`.
unsafe extern "C" {
    #[link_name = "_ZNK7tinybvh8BVH8_CPU9IntersectERNS_3RayE"]
    fn intersect(tree: *const c_void, ray: *mut FullRay) -> i32;
    #[link_name = "_ZNK7tinybvh8BVH8_CPU10IsOccludedERKNS_3RayE"]
    fn is_occluded(tree: *const c_void, ray: *const FullRay) -> bool;
}

impl Tree {
    pub fn new(owner: bvh8_cpu::BVH) -> Self {
        const { assert!(size_of::<bvh8_cpu::BVH>() == size_of::<*const c_void>()) };
        // SAFETY: the crate's tree has one field, a C++ `unique_ptr`. A `unique_ptr` consists of one pointer.
        let object = unsafe { mem::transmute_copy::<bvh8_cpu::BVH, *const c_void>(&owner) };
        assert!(!object.is_null(), "a converted tree has an object");
        Self { _owner: owner, object }
    }

    /// Distance and triangle of the nearest hit in (0, `ray.t`).
    #[inline]
    pub fn closest(&self, ray: &RayHead) -> Option<(f32, u32)> {
        let mut whole = FullRay { head: *ray, custom: [0; 8] };
        // SAFETY: `_owner` keeps the object alive. The object is on the C++ heap and never moves. `FullRay` has the
        // size and alignment of the C++ ray type. No other reference to `whole` exists.
        unsafe { intersect(self.object, &raw mut whole) };
        (whole.head.t < ray.t).then_some((whole.head.t, whole.head.primitive))
    }

    #[inline]
    pub fn any(&self, ray: &RayHead) -> bool {
        let whole = FullRay { head: *ray, custom: [0; 8] };
        // SAFETY: `_owner` keeps the object alive. `FullRay` has the size and alignment of the C++ ray type.
        // `IsOccluded` only reads the ray.
        unsafe { is_occluded(self.object, &raw const whole) }
    }
}
