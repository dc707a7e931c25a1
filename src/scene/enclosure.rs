//! Whether a mesh looks like a room or a building, which is seen from within.

use std::sync::Arc;

use glam::Vec3;

use crate::brute_force::{BruteForce, BruteForceConfig};
use crate::geometry::{Hit, Mesh, Ray};
use crate::offered::Offered;
use crate::triangle::Exact;

/// What rays from the middle of a mesh's box meet first.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Enclosure {
    pub rays: usize,
    /// Rays that meet the front of a triangle. From within an object all that is met is backs.
    pub walls: usize,
}

/// Triangle tests that may be spent.
const TESTS: usize = 1 << 29;

/// Fewer rays than this tell nothing.
const LEAST: usize = 8;

/// Spread evenly over the sphere, and so are the first few of them; along no axis and no diagonal, where edges lie.
const DIRECTIONS: [[f32; 3]; 32] = [
    [0.237, 0.969, 0.073],
    [0.920, -0.031, -0.390],
    [0.882, 0.469, -0.044],
    [0.620, -0.531, -0.578],
    [-0.690, 0.719, -0.087],
    [-0.805, -0.281, 0.522],
    [-0.951, 0.219, 0.218],
    [-0.375, -0.781, 0.499],
    [-0.113, 0.844, 0.525],
    [0.463, -0.156, 0.872],
    [0.129, 0.344, 0.930],
    [0.561, -0.656, 0.505],
    [0.030, 0.594, -0.804],
    [-0.562, -0.406, -0.720],
    [-0.306, 0.094, -0.947],
    [-0.359, -0.906, -0.224],
    [-0.213, 0.906, -0.365],
    [-0.938, -0.094, -0.333],
    [-0.704, 0.406, -0.583],
    [-0.805, -0.594, 0.007],
    [0.489, 0.656, 0.575],
    [0.926, -0.344, 0.155],
    [0.859, 0.156, 0.488],
    [0.528, -0.844, -0.098],
    [0.509, 0.781, -0.361],
    [0.245, -0.219, -0.945],
    [0.545, 0.281, -0.790],
    [-0.067, -0.719, -0.692],
    [-0.595, 0.531, 0.603],
    [-0.069, -0.469, 0.881],
    [-0.416, 0.031, 0.909],
    [0.067, -0.969, 0.239],
];

impl Enclosure {
    /// That of a mesh. Nothing without triangles, or with so many that fewer than eight rays are affordable.
    pub fn of(mesh: &Arc<Mesh>) -> Option<Self> {
        let rays = (TESTS / mesh.len().max(1)).min(DIRECTIONS.len());
        if mesh.is_empty() || rays < LEAST {
            return None;
        }
        let triangles = BruteForce::<Exact>::boxed(mesh, &BruteForceConfig::default()).ok()?;
        let from_middle = |&way: &[f32; 3]| Ray::new(mesh.bounds().centre(), Vec3::from_array(way));
        let rays: Vec<Ray> = DIRECTIONS[..rays].iter().map(from_middle).collect();
        let is_wall = |(ray, hit): &(&Ray, Hit)| {
            let [a, b, c] = mesh.corners(hit.prim.index()).map(Vec3::as_dvec3);
            (b - a).cross(c - a).dot(ray.direction.as_dvec3()) < 0.0
        };
        let hits = rays.iter().zip(triangles.closest_by_chunks(&rays, 1)).filter_map(|(ray, hit)| Some((ray, hit?)));
        Some(Self { walls: hits.filter(is_wall).count(), rays: rays.len() })
    }

    /// Whether at least two thirds of the rays meet a wall: of kitchens, halls and boxes that are open at a side it is more than
    /// four fifths, of statues, rings and things on a floor at most half.
    pub fn is_room(&self) -> bool {
        3 * self.walls >= 2 * self.rays
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::Aabb;
    use crate::scene::{BUILTIN, Model, meshes};

    fn of(model: Model) -> Option<Enclosure> {
        Enclosure::of(&Arc::new(Mesh::new(model.positions, model.triangles).unwrap()))
    }

    fn reversed(model: Model) -> Model {
        let triangles = model.triangles.iter().map(|&[a, b, c]| [a, c, b]).collect();
        Model { triangles, ..model }
    }

    #[test]
    fn a_box_is_a_room_from_within_and_an_object_from_without() {
        // Fronts are outside.
        let cube = meshes::cube;
        assert_eq!(of(cube()), Some(Enclosure { rays: 32, walls: 0 }));
        let room = of(reversed(cube())).unwrap();
        assert!(room == Enclosure { rays: 32, walls: 32 } && room.is_room());
        let sphere = of(meshes::icosphere(3)).unwrap();
        assert!(sphere.walls == 0 && !sphere.is_room());
    }

    #[test]
    fn built_in_meshes_are_told_apart() {
        // The walls of Infinitycandy are a polyhedron turned inside out.
        let rooms = ["Cornellbox", "Infinitycandy", "Sponza"];
        for builtin in BUILTIN {
            let scene = builtin.scene(None).unwrap();
            let found = Enclosure::of(&scene.mesh).unwrap();
            assert_eq!(found.is_room(), rooms.contains(&builtin.name), "{}: {found:?}", builtin.name);
        }
    }

    #[test]
    fn meshes_without_a_middle_are_no_rooms() {
        assert_eq!(of(Model::default()), None);
        let point = Model { positions: vec![Vec3::ONE; 3], triangles: vec![[0, 1, 2]], ..Model::default() };
        assert_eq!(of(point), Some(Enclosure { rays: 32, walls: 0 }));
        let huge = [Vec3::splat(-f32::MAX), Vec3::splat(f32::MAX), Vec3::new(f32::MAX, 0.0, 0.0)];
        let huge = Model { positions: huge.into(), triangles: vec![[0, 1, 2]], ..Model::default() };
        assert!(!of(huge).unwrap().is_room());
    }

    #[test]
    fn directions_are_spread() {
        let sum: Vec3 = DIRECTIONS.iter().map(|&direction| Vec3::from_array(direction)).sum();
        let bounds = Aabb::of_points(DIRECTIONS.iter().map(|&direction| Vec3::from_array(direction)));
        assert!(sum.length() < 0.5 && bounds.extent().min_element() > 1.8, "{sum} {bounds:?}");
        let first: Vec3 = DIRECTIONS[..LEAST].iter().map(|&direction| Vec3::from_array(direction)).sum();
        assert!(first.length() < 2.0, "{first}");
    }
}
