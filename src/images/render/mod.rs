//! Renders pictures: shaded scenes, depths, normals, primitives, costs and errors.

mod colour_map;
mod error_map;
mod integrator;
mod picture;
mod view;
mod work;

#[cfg(test)]
mod report_ray_counts;
#[cfg(test)]
mod tests;

pub use colour_map::{heat as heat_colour, ramp as ramp_colour, with_bar as with_heat_bar};
pub use error_map::{ErrorMap, ExactPicture, error_name};
pub use integrator::{RayCounts, count_rays, shade};
pub use picture::{from_pixels, of_colours, png, png_encoder};
pub use view::{
    ViewError, ViewKind, coarse_size, costs, depth_picture, draw, hottest, identity, normal_colour, size_of,
};
pub use work::Work;
