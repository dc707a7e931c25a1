//! Scenes: meshes, materials, lights, cameras, and the rays made from them.

mod camera;
mod light;
pub mod load;
mod material;
pub mod meshes;
mod model;
mod normals;
#[allow(clippy::module_inception)]
mod scene;

pub use camera::{Camera, CameraError, View};
pub use light::Light;
pub use load::{LoadError, load};
pub use material::Material;
pub use model::Model;
pub use normals::CornerNormals;
pub use scene::{Scene, Surface};
