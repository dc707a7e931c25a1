//! Scenes: meshes, materials, lights, cameras, and the rays made from them.

pub mod load;
mod material;
pub mod meshes;
mod model;

pub use load::{LoadError, load};
pub use material::Material;
pub use model::Model;
