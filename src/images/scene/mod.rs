//! Scenes: meshes, materials, lights, cameras and rays.

mod assemble;
mod camera;
mod error;
pub mod files;
pub mod format;
mod frame;
mod hash;
mod light;
pub mod load;
mod material;
pub mod meshes;
mod model;
mod normals;
pub mod offset;
mod polygon;
#[allow(clippy::module_inception)]
mod scene;
pub mod spheres;
#[cfg(test)]
pub(crate) mod tests;
mod workload;

pub use camera::{Camera, CameraError, View};
pub use error::SceneError;
pub use light::Light;
pub use load::{LoadError, load};
pub use material::Material;
pub use model::Model;
pub use normals::CornerNormals;
pub use offset::{Offset, SurfacePoint};
pub use scene::{Scene, Surface};
pub use workload::{Sampling, Workload, WorkloadKind};
