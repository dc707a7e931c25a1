//! An example of a user crate with structures, a scene generator and a study.

pub mod broken;
pub mod faulty;
pub mod grid;
pub mod question;

use sahara::registry::Registry;
use sahara::triangle::Exact;

use broken::{Broken, BrokenConfig, Modest};
use faulty::{Faulty, FaultyConfig};
use grid::{Grid, GridConfig};
use question::staircase;

/// The structures and scenes of sahara and of this crate.
pub fn registry() -> Registry {
    Registry::builtin()
        .with::<Grid<Exact>>("grid", GridConfig::default())
        .with::<Broken>("broken", BrokenConfig::default())
        .with::<Modest>("modest", GridConfig::default())
        .with::<Faulty>("mybvh", FaultyConfig::default())
        .with_generator("staircase", staircase)
}
