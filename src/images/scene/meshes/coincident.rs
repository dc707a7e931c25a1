//! Meshes that are difficult to trace. In most of them, a ray hits several triangles at equal or nearly equal `t`.

use glam::Vec3;

use super::plane::cube;
use super::{flat, net, noise};
use crate::scene::Model;

/// Two cities on one square, 7,426 triangles. The bottoms of all houses lie in the plane of the ground. Houses of the
/// two cities overlap.
pub fn two_cities() -> Model {
    const BLOCKS: i32 = 12;
    let city = |cells: u32, salt: u32, shift: f32| {
        let houses = (0..BLOCKS * BLOCKS).map(move |i| {
            let (x, z) = (i % BLOCKS, i / BLOCKS);
            let middle = |block: i32| (2.0 * (block as f32 + 0.5) / BLOCKS as f32 - 1.0) * 0.9 + shift;
            let height = 0.05 + 0.2 * noise::cell(x, 0, z, salt);
            let half = Vec3::new(0.04, height / 2.0, 0.04);
            boxed(Vec3::new(middle(x), half.y, middle(z)), half)
        });
        std::iter::once(ground(cells)).chain(houses)
    };
    joined(city(32, 1, 0.0).chain(city(31, 2, 0.03)))
}

/// 1000 cubes side by side, 12,000 triangles. Neighbouring cubes have coincident sides that face in opposite
/// directions.
pub fn shared_faces() -> Model {
    let cube = |i: u32| boxed(Vec3::new((i % 10) as f32, (i / 10 % 10) as f32, (i / 100) as f32), Vec3::splat(0.5));
    joined((0..1000).map(cube))
}

/// A floor of 1600 slabs, 19,202 triangles. All top sides lie in one plane. All bottom sides lie in the plane of the
/// ground.
pub fn tiled_floor() -> Model {
    const SIDE: u32 = 40;
    let (half, thick) = (1.0 / SIDE as f32, 0.01);
    let slab = |i: u32| {
        let middle = |column: u32| (2 * column + 1) as f32 * half - 1.0;
        boxed(Vec3::new(middle(i % SIDE), thick, middle(i / SIDE)), Vec3::new(half, thick, half))
    };
    joined(std::iter::once(ground(1)).chain((0..SIDE * SIDE).map(slab)))
}

/// A disc of radius 1 in the plane z = 0. All triangles have the origin as a corner.
pub fn fan(segments: u32) -> Model {
    let rim = (0..segments).map(|i| {
        let (sine, cosine) = libm::sincos(f64::from(i) * std::f64::consts::TAU / f64::from(segments));
        Vec3::new(cosine as f32, sine as f32, 0.0)
    });
    flat(
        std::iter::once(Vec3::ZERO).chain(rim).collect(),
        (0..segments).map(|i| [0, 1 + i, 1 + (i + 1) % segments]).collect(),
    )
}

/// 5,000 copies of one triangle. Each coordinate of a copy is unchanged or moved to an adjacent `f32` value.
pub fn near_duplicates() -> Model {
    const CORNERS: [Vec3; 3] = [Vec3::new(-1.1, -0.7, 0.3), Vec3::new(1.3, -0.9, -0.4), Vec3::new(0.1, 1.2, 0.2)];
    joined((0..5000).map(|copy| {
        let corner = |(i, corner): (i32, Vec3)| {
            Vec3::from_array(std::array::from_fn(|axis| match (3.0 * noise::cell(copy, i, axis as i32, 0)) as u32 {
                0 => corner[axis].next_down(),
                1 => corner[axis],
                _ => corner[axis].next_up(),
            }))
        };
        flat((0..).zip(CORNERS).map(corner).collect(), vec![[0, 1, 2]])
    }))
}

/// 283 nested cubes, 3,396 triangles. No plane separates two cubes.
pub fn growing_shells() -> Model {
    let sides = std::iter::successors(Some(1.0_f32), |side| Some(side * 1.02));
    joined(sides.take(283).map(|side| boxed(Vec3::ZERO, Vec3::splat(side))))
}

/// An upward-facing square with corners (+-1, 0, +-1) and `cells` cells per side.
fn ground(cells: u32) -> Model {
    let at = |step: u32| 2.0 * step as f32 / cells as f32 - 1.0;
    let across = cells + 1;
    let quad = |row: u32, column: u32| {
        let left = row * across + column;
        [left + across, left + across + 1, left + 1, left]
    };
    let corners = (0..across * across).map(|i| Vec3::new(at(i % across), 0.0, at(i / across)));
    flat(corners.collect(), net(cells, cells, quad))
}

fn boxed(middle: Vec3, half: Vec3) -> Model {
    let unit = cube();
    flat(unit.positions.iter().map(|&corner| middle + half * corner).collect(), unit.triangles)
}

fn joined(parts: impl Iterator<Item = Model>) -> Model {
    let (mut positions, mut triangles) = (vec![], vec![]);
    for part in parts {
        let first = positions.len() as u32;
        positions.extend(part.positions);
        triangles.extend(part.triangles.iter().map(|corners| corners.map(|corner| first + corner)));
    }
    flat(positions, triangles)
}
