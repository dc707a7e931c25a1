//! Scenes: meshes, materials, lights, cameras, and the rays made from them.

mod material;
pub mod meshes;
mod model;

pub use material::Material;
pub use model::Model;
