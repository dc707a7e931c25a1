//! The building around the arcades: walks, walls, floors and tiled roofs.

use glam::Vec3;

use super::{BAY, COURT, EAVES, Frame, UPPER, WALK, material};
use crate::scene::meshes::patches::{Finish, Patches, turn};

const VAULT: usize = 10;

pub fn walk(patches: &mut Patches, frame: &Frame, bays: usize, bay: f32) {
    let length = bays as f32 * bay;
    for i in 0..bays {
        let u = i as f32 * bay;
        vault(patches, frame, u, bay);
        doorway(patches, frame, u + 0.5 * bay, 0.0, 1.0);
        doorway(patches, frame, u + 0.5 * bay, UPPER, 0.8);

        patches.of(&material("wood", [0.66, 0.48, 0.34]));
        for beam in 0..3 {
            let u = u + bay * (beam as f32 + 0.5) / 3.0;
            patches.block(frame, [u - 9.0, EAVES - 40.0, -WALK], [u + 9.0, EAVES - 18.0, -16.0]);
        }
        patches.of(&material("trim", [0.98, 0.93, 0.84]));
        patches.block(frame, [u - 20.0, 0.0, -WALK], [u + 20.0, 290.0, 14.0 - WALK]);
        patches.block(frame, [u - 25.0, 290.0, -WALK], [u + 25.0, 306.0, 19.0 - WALK]);
    }

    // The walks of the long sides include the corners of the building.
    let over = if bay == BAY { WALK } else { 0.0 };
    let (from, to) = (-over, length + over);
    patches.of(&material("brick", [0.93, 0.84, 0.72]));
    let at = |u: f32, y: f32, w: f32| frame.at(u, y, w);
    patches.quad([at(from, 0.0, -WALK), at(to, 0.0, -WALK), at(to, EAVES, -WALK), at(from, EAVES, -WALK)]);
    patches.of(&material("floor", [0.86, 0.80, 0.72]));
    patches.quad([at(from, UPPER, 30.0), at(to, UPPER, 30.0), at(to, UPPER, -WALK), at(from, UPPER, -WALK)]);
    patches.of(&material("ceiling", [0.95, 0.90, 0.80]));
    let top = EAVES - 18.0;
    patches.quad([at(from, top, -WALK), at(to, top, -WALK), at(to, top, 16.0), at(from, top, 16.0)]);
}

/// A groin vault: two crossing barrel vaults.
fn vault(patches: &mut Patches, frame: &Frame, from: f32, bay: f32) {
    patches.of(&material("ceiling", [0.95, 0.90, 0.80]));
    let rise = |t: f32| 100.0 * (1.0 - (2.0 * t - 1.0) * (2.0 * t - 1.0)).max(0.0).sqrt();
    patches.patch([VAULT, VAULT], false, Finish::Smooth, |column, row| {
        let (s, t) = (column as f32 / VAULT as f32, row as f32 / VAULT as f32);
        frame.at(from + bay * s, 306.0 + rise(s).max(rise(t)), -WALK + (WALK - 20.0) * t)
    });
}

fn doorway(patches: &mut Patches, frame: &Frame, middle: f32, floor: f32, size: f32) {
    let back = -WALK;
    patches.of(&material("wood", [0.66, 0.48, 0.34]));
    let (wide, high) = (42.0 * size, 190.0 * size);
    patches.block(frame, [middle - wide, floor, back], [middle + wide, floor + high, back + 4.0]);
    for column in 0..2 {
        for row in 0..3 {
            let u = middle + (column as f32 - 1.0) * wide + 6.0 * size;
            let y = floor + 10.0 + high * row as f32 / 3.2;
            patches.block(frame, [u, y, back + 4.0], [u + wide - 12.0 * size, y + high / 3.8, back + 7.0]);
        }
    }
    patches.of(&material("trim", [0.98, 0.93, 0.84]));
    for side in [-1.0, 1.0] {
        let u = middle + side * (wide + 7.0);
        patches.block(frame, [u - 8.0, floor, back], [u + 8.0, floor + high, back + 12.0]);
    }
    let (left, right, top) = (middle - wide - 20.0, middle + wide + 20.0, floor + high);
    patches.block(frame, [left, top, back], [right, top + 16.0, back + 16.0]);
}

pub fn grounds(patches: &mut Patches) {
    let [half_length, half_width, middle] = COURT;
    let v = Vec3::new;

    patches.of(&material("floor", [0.86, 0.80, 0.72]));
    let bays = 16;
    let (from, to) = (-half_length - WALK, half_length + WALK);
    for i in 0..bays {
        let x = |i: usize| from + (to - from) * i as f32 / bays as f32;
        for (a, b) in [(-half_width - WALK, -half_width), (-half_width, half_width), (half_width, half_width + WALK)] {
            let (a, b) = (middle + a, middle + b);
            patches.quad([v(x(i), 0.0, b), v(x(i + 1), 0.0, b), v(x(i + 1), 0.0, a), v(x(i), 0.0, a)]);
        }
    }

    // Brick blocks surround the walks. The ground under the blocks is lower than the court's floor.
    patches.of(&material("brick", [0.93, 0.84, 0.72]));
    let (near, far) = (middle - half_width - WALK - 1.0, middle + half_width + WALK + 1.0);
    let (left, right) = (from - 1.0, to + 1.0);
    patches.block(&Frame::WORLD, [-1800.0, -126.0, -1100.0], [1700.0, 980.0, near]);
    patches.block(&Frame::WORLD, [-1800.0, -126.0, far], [1700.0, 980.0, 1022.0]);
    patches.block(&Frame::WORLD, [-1800.0, -126.0, near], [left, 980.0, far]);
    patches.block(&Frame::WORLD, [right, -126.0, near], [1700.0, 980.0, far]);
    patches.of(&material("floor", [0.86, 0.80, 0.72]));
    let at = |x: f32, z: f32| v(x, -126.0, z);
    patches.quad([at(-1921.0, 1105.0), at(1800.0, 1105.0), at(1800.0, -1183.0), at(-1921.0, -1183.0)]);
}

/// Both ends of a roof's eaves, and the vector from the eaves to the ridge.
type Slope = [Vec3; 3];

/// Adds tiles until the whole building has `triangles` triangles. Panics if the roofs have too few tiles.
pub fn roofs(patches: &mut Patches, triangles: usize) {
    let [half_length, half_width, middle] = COURT;
    let v = Vec3::new;
    let eaves = EAVES + 62.0;
    let (x, z) = (half_length - 60.0, half_width - 60.0);
    let rise = 1429.0 - eaves;
    let slopes = [
        [v(-x, eaves, middle - z), v(x, eaves, middle - z), v(0.0, rise, -560.0)],
        [v(x, eaves, middle + z), v(-x, eaves, middle + z), v(0.0, rise, 560.0)],
        [v(-x, eaves, middle + z), v(-x, eaves, middle - z), v(-440.0, 0.8 * rise, 0.0)],
        [v(x, eaves, middle - z), v(x, eaves, middle + z), v(440.0, 0.8 * rise, 0.0)],
    ];
    patches.of(&material("roof", [0.95, 0.60, 0.44]));
    for [from, to, up] in slopes {
        patches.quad([from, to, to + up, from + up]);
        // The underside of the roof is visible from the court.
        let down = v(0.0, -4.0, 0.0);
        patches.quad([to + down, from + down, from + up + down, to + up + down]);
        patches.quad([from + down, to + down, to, from]);
    }

    let built = patches.model.triangles.len();
    assert!(built < triangles, "the building without tiles has {built} triangles already");
    let mut left = triangles - built;
    for row in 0..ROWS {
        for slope @ [from, to, _] in &slopes {
            let columns = ((to - from).length() / TILE) as usize;
            for column in 0..columns {
                let sides = 3.min(left / 2);
                if sides == 0 {
                    return;
                }
                left -= 2 * sides;
                tile(patches, slope, [column, columns], row, sides);
            }
        }
    }
    assert!(left == 0, "{left} triangles are left when all roofs are tiled");
}

const ROWS: usize = 11;
const TILE: f32 = 44.0;

/// `lift` is larger at the lower end of a tile. The lower end overlaps the row below.
fn tile(patches: &mut Patches, [from, to, up]: &Slope, [column, columns]: [usize; 2], row: usize, sides: usize) {
    let along = (to - from) / columns as f32;
    let step = up / ROWS as f32;
    let normal = along.cross(step).normalize();
    let foot = from + along * (column as f32 + 0.5) + step * row as f32;
    patches.patch([sides, 1], false, Finish::Smooth, |side, end| {
        let (height, across) = turn(sides - side, 2 * sides);
        let lift = if end == 0 { 6.0 } else { 1.0 };
        foot + along * (0.46 * across) + normal * (0.4 * TILE * height + lift) + step * (1.08 * end as f32)
    });
}
