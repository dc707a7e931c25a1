//! One side of the court: arches, columns, balustrade, string course and cornice.

use super::{EAVES, Frame, UPPER, column::Column, material};
use crate::scene::meshes::{
    patches::{Finish, Patches},
    sdf::{cosine, sine},
};

const HALF_WALL: f32 = 26.0;

struct Arch {
    middle: f32,
    half_bay: f32,
    radius: f32,
    /// Height of the foot of the arch, then height of the top of the wall.
    heights: [f32; 2],
    half_wall: f32,
    pieces: usize,
}

/// `frame.ahead` points into the court. The bays extend from `frame.origin` along `frame.right`.
pub fn build(patches: &mut Patches, frame: &Frame, bays: usize, bay: f32) {
    let length = bays as f32 * bay;
    let lower = Column { height: 306.0, radius: 29.0, sides: 20, leaves: 8, shaft: ("column_a", [0.95, 0.90, 0.82]) };
    let upper = Column { height: 236.0, radius: 12.5, sides: 10, leaves: 4, shaft: ("column_b", [0.90, 0.80, 0.72]) };
    for i in 0..bays {
        let u = i as f32 * bay;
        lower.build(patches, &Frame { origin: frame.at(u, 0.0, 0.0), ..*frame });
        let (half_bay, radius) = (0.5 * bay, 0.5 * bay - 32.0);
        let (heights, half_wall) = ([306.0, UPPER - 40.0], HALF_WALL);
        Arch { middle: u + half_bay, half_bay, radius, heights, half_wall, pieces: 20 }.build(patches, frame);
        for half in 0..2 {
            let u = u + 0.5 * bay * half as f32;
            upper.build(patches, &Frame { origin: frame.at(u, UPPER + 100.0, 0.0), ..*frame });
            let (half_bay, radius) = (0.25 * bay, 0.25 * bay - 15.0);
            let (heights, half_wall) = ([UPPER + 336.0, EAVES], 0.6 * HALF_WALL);
            Arch { middle: u + half_bay, half_bay, radius, heights, half_wall, pieces: 14 }.build(patches, frame);
            balustrade(patches, frame, u, 0.5 * bay);
        }
    }
    courses(patches, frame, length);
}

impl Arch {
    fn on_circle(&self, step: usize, radius: f32) -> [f32; 2] {
        let angle = step as f32 / self.pieces as f32 * std::f32::consts::PI;
        [self.middle - radius * cosine(angle), self.heights[0] + radius * sine(angle)]
    }

    fn build(&self, patches: &mut Patches, frame: &Frame) {
        let (w, [spring, top]) = (self.half_wall, self.heights);
        let ends = [self.middle - self.half_bay, self.middle + self.half_bay];

        patches.of(&material("brick", [0.93, 0.84, 0.72]));
        for side in [1.0, -1.0] {
            let place = |u: f32, y: f32| frame.at(u, y, w * side);
            patches.patch([self.pieces, 1], false, Finish::Flat, |column, row| {
                let [u, y] = self.on_circle(if side > 0.0 { column } else { self.pieces - column }, self.radius);
                place(u, if row == 0 { y } else { top })
            });
            for [a, b] in [[ends[0], self.middle - self.radius], [self.middle + self.radius, ends[1]]] {
                let [a, b] = if side > 0.0 { [a, b] } else { [b, a] };
                patches.quad([place(a, spring), place(b, spring), place(b, top), place(a, top)]);
            }
        }

        patches.of(&material("arch", [1.0, 0.95, 0.86]));
        patches.patch([self.pieces, 1], false, Finish::Smooth, |column, row| {
            let [u, y] = self.on_circle(column, self.radius);
            frame.at(u, y, if row == 0 { -w } else { w })
        });
        // Only the court side of the wall has mouldings.
        let size = self.radius / 72.0;
        let bands =
            [[0.0, 0.0], [0.0, 5.0], [6.0, 7.0], [8.0, 4.0], [14.0, 4.0], [16.0, 8.0], [21.0, 9.0], [23.0, 0.0]];
        patches.patch([self.pieces, bands.len() - 1], false, Finish::Flat, |column, row| {
            let [out, front] = bands[row];
            let [u, y] = self.on_circle(column, self.radius + out * size);
            frame.at(u, y, w + front * size)
        });
        self.keystone(patches, frame, size);
    }

    fn keystone(&self, patches: &mut Patches, frame: &Frame, size: f32) {
        let crown = self.heights[0] + self.radius;
        patches.of(&material("ornament", [1.02, 0.97, 0.88]));
        let profile = [
            [-3.0, 2.0],
            [-2.0, 14.0],
            [6.0, 17.0],
            [12.0, 13.0],
            [18.0, 16.0],
            [26.0, 20.0],
            [30.0, 12.0],
            [31.0, 0.0],
        ];
        patches.patch([6, profile.len() - 1], false, Finish::Smooth, |column, row| {
            let [up, front] = profile[row];
            let across = (column as f32 - 3.0) / 3.0;
            let wide = 8.0 + 0.16 * (up + 3.0);
            let round = if column % 6 == 0 { 0.0 } else { 1.0 };
            frame.at(self.middle + across * wide * size, crown + up * size, self.half_wall + front * size * round)
        });
    }
}

fn balustrade(patches: &mut Patches, frame: &Frame, from: f32, length: f32) {
    patches.of(&material("trim", [0.98, 0.93, 0.84]));
    let to = from + length;
    patches.block(frame, [from, UPPER, -9.0], [to, UPPER + 12.0, 9.0]);
    patches.block(frame, [from, UPPER + 82.0, -10.0], [to, UPPER + 92.0, 10.0]);
    patches.block(frame, [from - 13.0, UPPER, -14.0], [from + 13.0, UPPER + 100.0, 14.0]);
    patches.of(&material("ornament", [1.02, 0.97, 0.88]));
    let profile =
        [[4.5, 0.0], [4.5, 6.0], [2.6, 10.0], [5.8, 26.0], [5.0, 37.0], [2.5, 53.0], [4.4, 60.0], [4.4, 70.0]];
    for i in 0..4 {
        let u = from + 13.0 + (length - 26.0) * (i as f32 + 0.5) / 4.0;
        patches.lathe(frame.at(u, UPPER + 12.0, 0.0), &profile, 6);
    }
}

fn courses(patches: &mut Patches, frame: &Frame, length: f32) {
    patches.of(&material("trim", [0.98, 0.93, 0.84]));
    let low = UPPER - 40.0;
    let string = [
        [0.0, 26.0],
        [2.0, 31.0],
        [10.0, 31.0],
        [13.0, 27.0],
        [22.0, 27.0],
        [26.0, 33.0],
        [32.0, 36.0],
        [40.0, 36.0],
        [40.0, -36.0],
        [0.0, -26.0],
    ];
    patches.moulding(frame, [0.0, length], &string.map(|[y, z]| [low + y, z]));
    let cornice = [
        [0.0, 15.0],
        [4.0, 20.0],
        [12.0, 20.0],
        [16.0, 17.0],
        [40.0, 17.0],
        [44.0, 24.0],
        [50.0, 40.0],
        [60.0, 46.0],
        [60.0, -20.0],
        [0.0, -15.0],
    ];
    patches.moulding(frame, [0.0, length], &cornice.map(|[y, z]| [EAVES + y, z]));

    let dentils = (length / 13.0) as usize;
    for i in 0..dentils {
        let u = length * (i as f32 + 0.25) / dentils as f32;
        patches.block(frame, [u, EAVES + 22.0, 16.0], [u + 6.5, EAVES + 40.0, 27.0]);
    }
    let consoles = (length / 26.0) as usize;
    for i in 0..consoles {
        let u = length * (i as f32 + 0.3) / consoles as f32;
        patches.block(frame, [u, low + 13.0, 26.0], [u + 10.0, low + 24.0, 33.0]);
    }
}
