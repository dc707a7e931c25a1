//! The groups of options in the help of commands.

pub const SCENES: &str = "Scenes";
pub const STRUCTURES: &str = "Structures";
pub const RAYS: &str = "Rays";
pub const MEASURING: &str = "Measuring";
pub const OUTPUT: &str = "Output";
