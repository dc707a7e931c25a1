//! A cube of a grid whose lines lie at multiples of an eighth: rays along its axes, diagonals and faces.

use glam::Vec3;

use super::case::cases;
use super::set::{Set, cube};
use crate::geometry::Ray;
use crate::validate::Sampler;

cases! {
    Moderate 4 "cube_random", Hit => |n| in_cube(n, Sampler::direction),
        "Random rays inside a cube: faces in the planes of the root box.",
        "survey";
    Moderate 5 "cube_axis_aligned", Hit => |n| in_cube(n, |sampler| axis_direction(sampler, 0.0)),
        "Two direction components of +0.0: their inverse is infinite, and 0 times it is NaN.",
        "madmann91/bvh issue 9";
    Moderate 6 "cube_axis_negzero", SameAs("cube_axis_aligned") => |n| in_cube(n, |sampler| axis_direction(sampler, -0.0)),
        "The same rays with components of -0.0: an octant from d < 0 contradicts the sign of 1 / d.",
        "tinybvh pull request 282; madmann91/bvh issue 20; obvhs, CwBvh";
    Moderate 7 "cube_faceplane_grid", Hit => face_planes,
        "Rays in box faces and split planes, through vertices and along edges of the silhouette: 0 times infinity.",
        "Embree pull request 589; svenstaro/bvh pull request 149; Hapala, Havran 2011";
    Moderate 8 "cube_diagonal_111", Hit => |n| diagonals(n, false),
        "Space diagonals through grid points meet three planes, and diagonals of cells, at once.",
        "Hapala, Havran 2011";
    Moderate 9 "cube_diag_110", Hit => |n| diagonals(n, true),
        "A diagonal with one zero component, often in the plane of a face.",
        "Embree pull request 589; Ize 2013";
}

/// Squares along an edge of the cube [-1, 1]^3: corners at multiples of an eighth.
const SQUARES: usize = 16;

/// From a random point well inside.
fn in_cube(count: usize, direction: impl Fn(&mut Sampler) -> Vec3) -> Set {
    Set::new(cube(SQUARES), count, 3, |sampler| {
        let origin = sampler.cube() * 0.99;
        Ray::new(origin, direction(sampler))
    })
}

/// Along an axis, the other two components `zero`.
fn axis_direction(sampler: &mut Sampler, zero: f32) -> Vec3 {
    let mut direction = Vec3::splat(zero);
    direction[sampler.below(3)] = sampler.sign();
    direction
}

/// A multiple of an eighth from -1 to 1, both ends included.
fn on_grid(sampler: &mut Sampler) -> f32 {
    sampler.below(SQUARES + 1) as f32 / 8.0 - 1.0
}

/// From outside along an axis, at t = 2 through the face. A negative direction has zeros of the other sign, as `-axis` gives.
fn face_planes(count: usize) -> Set {
    Set::new(cube(SQUARES), count, 4, |sampler| {
        let (axis, sign) = (sampler.below(3), sampler.sign());
        let origin = Vec3::new(on_grid(sampler), on_grid(sampler), -3.0 * sign);
        Ray::new(z_to(axis, origin), Vec3::AXES[axis] * sign)
    })
}

/// The coordinates turned, so that what was z becomes `axis`.
fn z_to(axis: usize, p: Vec3) -> Vec3 {
    let mut turned = p.to_array();
    turned.rotate_left(2 - axis);
    Vec3::from_array(turned)
}

/// Through a grid point of the cube from four steps away; without a component when `flat`.
fn diagonals(count: usize, flat: bool) -> Set {
    Set::new(cube(SQUARES), count, 5, |sampler| {
        let through = Vec3::new(on_grid(sampler), on_grid(sampler), on_grid(sampler));
        let mut direction = Vec3::new(sampler.sign(), sampler.sign(), sampler.sign());
        if flat {
            direction[sampler.below(3)] = 0.0;
        }
        Ray::new(through - direction * 4.0, direction)
    })
}
