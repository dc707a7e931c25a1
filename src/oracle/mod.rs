//! Exact answers: a scene of `f32` numbers is a set of dyadic rationals, so what a ray meets, and in which order, is
//! decidable. Used to adjudicate, where two answers differ; never timed.

pub mod exact;

pub use exact::ExactT;
