//! The interface of acceleration structures, and the data that structures report.

mod capabilities;
mod footprint;
mod loaded;
mod observer;
mod query;
mod shape;
mod traits;

pub use capabilities::Capabilities;
pub use footprint::Footprint;
pub use loaded::{Loaded, Remote};
pub use observer::{Counts, Observed, Observer};
pub use query::Query;
pub use shape::{Part, TreeShape};
pub use traits::{Accel, BuildError, DynAccel};
