//! What structures are built, checked, counted and timed with on one scene.

pub mod built;
pub mod case;
pub mod check;
pub mod counted;
pub mod failed;
pub mod guarded;
pub mod placed;
pub mod ray_cost;
pub mod room;
pub mod timing;
