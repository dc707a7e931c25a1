//! Eight-wide trees of tight boxes, with four partitioning strategies.

mod accel;
mod batch;
mod child_order;
mod collapse;
mod config;
mod frustum;
mod layout;
mod node;
mod packet;
mod packet_hits;
mod packet_state;
mod prepared_ray;
mod ray_packet;
mod stack;
mod stream;
#[cfg(test)]
mod tests;
mod traverse;
mod tree;

pub use config::{Batch, Bvh8Config, Partition};
pub use tree::Bvh8;
