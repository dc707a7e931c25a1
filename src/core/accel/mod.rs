//! The interface of acceleration structures, and the numbers that they report: hits, counts per ray, bytes, tree shape.

mod capabilities;
mod counts;
mod footprint;
mod loaded;
mod observer;
mod query;
mod remote;
mod shape;
mod traits;

pub use capabilities::Capabilities;
pub use counts::Counts;
pub use footprint::Footprint;
pub use loaded::Loaded;
pub use observer::{Observed, Observer};
pub use query::Query;
pub use remote::Remote;
pub use shape::{Part, TreeShape};
#[cfg(feature = "suite")]
pub(crate) use traits::RayBatch;
pub use traits::{Accel, BuildError, DynAccel};
