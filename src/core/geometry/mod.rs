//! Rays, boxes and meshes.

mod aabb;
mod mesh;
mod ray;
mod ray_text;
mod round;
#[cfg(feature = "suite")]
mod transform;

pub use aabb::Aabb;
pub(crate) use aabb::half_area;
pub use mesh::{Mesh, MeshError};
pub use ray::{Hit, PrimId, Ray};
pub use ray_text::{RayTextError, numbers};
pub use round::{round_down, round_up};
#[cfg(feature = "suite")]
pub use transform::Transform;
