//! The two queries of `BVH8_CPU`, called in the linked C++ library.
//!
//! The crate `tinybvh-rs` passes a ray of 64 bytes to functions whose ray type has 128 bytes. It does not expose
//! `IsOccluded`. Therefore this module calls both functions by their mangled C++ names (Itanium ABI). The module relies
//! on the layouts of the ray and of the crate's tree in the version that `Cargo.toml` pins.

use std::ffi::c_void;
use std::mem;

use tinybvh_rs::bvh8_cpu;

/// `tinybvh::Ray` without its last 64 bytes, the custom data. A query reads and writes no other bytes.
#[repr(C, align(64))]
#[derive(Clone, Copy)]
pub struct RayHead {
    pub origin: [f32; 3],
    pub mask: u32,
    pub direction: [f32; 3],
    pub instance: u32,
    pub inverse: [f32; 3],
    /// This field and the next four are the hit: instance, distance, barycentric coordinates, triangle.
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
    /// Frees `object` on drop; not used otherwise.
    _owner: bvh8_cpu::BVH,
    object: *const c_void,
}

// SAFETY: the tree owns its data. Both queries are `const` in C++ and write only to the ray of the caller.
unsafe impl Send for Tree {}
// SAFETY: as for `Send`.
unsafe impl Sync for Tree {}

#[cfg(target_env = "msvc")]
compile_error!("peer-tinybvh calls C++ by the names of the Itanium ABI, which Microsoft's compiler does not follow");

// SAFETY: the names encode the argument types; the result types are correct for the version in `Cargo.toml`.
unsafe extern "C" {
    #[link_name = "_ZNK7tinybvh8BVH8_CPU9IntersectERNS_3RayE"]
    fn intersect(tree: *const c_void, ray: *mut FullRay) -> i32;
    #[link_name = "_ZNK7tinybvh8BVH8_CPU10IsOccludedERKNS_3RayE"]
    fn is_occluded(tree: *const c_void, ray: *const FullRay) -> bool;
}

impl Tree {
    pub fn new(owner: bvh8_cpu::BVH) -> Self {
        const { assert!(size_of::<bvh8_cpu::BVH>() == size_of::<*const c_void>()) };
        // SAFETY: the only field of the crate's tree is a C++ `unique_ptr`, which is one pointer (size asserted above).
        let object = unsafe { mem::transmute_copy::<bvh8_cpu::BVH, *const c_void>(&owner) };
        assert!(!object.is_null(), "a converted tree has an object");
        Self { _owner: owner, object }
    }

    /// Distance and triangle of the nearest hit in (0, `ray.t`).
    #[inline]
    pub fn closest(&self, ray: &RayHead) -> Option<(f32, u32)> {
        let mut whole = FullRay { head: *ray, custom: [0; 8] };
        // SAFETY: the object is on the C++ heap and lives as long as `self`, even if `self` is moved. The ray has the
        // size and alignment of its C++ type (see `FullRay`). No other reference to the ray exists.
        unsafe { intersect(self.object, &raw mut whole) };
        (whole.head.t < ray.t).then_some((whole.head.t, whole.head.primitive))
    }

    #[inline]
    pub fn any(&self, ray: &RayHead) -> bool {
        let whole = FullRay { head: *ray, custom: [0; 8] };
        // SAFETY: the object lives as long as `self`. The ray has the layout of its C++ type, and is only read.
        unsafe { is_occluded(self.object, &raw const whole) }
    }
}
