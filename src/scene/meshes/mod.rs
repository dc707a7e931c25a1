//! Meshes made by our own code.

#[cfg(test)]
mod checks;
mod clay;
mod creatures;
mod dragon;
mod lucy;
mod noise;
mod sponza;
mod stone;

pub use creatures::{elephant, fox, rabbit};
pub use dragon::dragon;
pub use lucy::lucy;
pub use sponza::sponza;
