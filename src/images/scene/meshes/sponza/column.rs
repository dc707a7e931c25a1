//! Columns with a plinth, a turned base, a shaft, and a capital with leaves and volutes.

use glam::Vec3;

use super::{Frame, material};
use crate::scene::meshes::patches::{Finish, Patches, turn};

pub struct Column {
    pub height: f32,
    /// Radius of the shaft at its foot.
    pub radius: f32,
    pub sides: usize,
    /// Number of leaves in each of the two rows of the capital.
    pub leaves: usize,
    pub shaft: (&'static str, [f32; 3]),
}

impl Column {
    pub fn build(&self, patches: &mut Patches, frame: &Frame) {
        let r = self.radius;
        let foot = frame.origin;
        let capital = 2.3 * r;
        let top = self.height - 0.35 * r;

        patches.of(&material("trim", [0.98, 0.93, 0.84]));
        patches.block(frame, [-1.4 * r, 0.0, -1.4 * r], [1.4 * r, 0.35 * r, 1.4 * r]);
        let base = [
            [1.36, 0.35],
            [1.41, 0.5],
            [1.32, 0.64],
            [1.16, 0.68],
            [1.13, 0.78],
            [1.24, 0.88],
            [1.16, 1.0],
            [1.02, 1.03],
        ];
        patches.lathe(foot, &base.map(|[x, y]| [x * r, y * r]), self.sides);

        let (low, high) = (1.03 * r, top - capital);
        let shaft = [[1.0, 0.0], [1.0, 0.33], [0.95, 0.7], [0.86, 1.0]];
        patches.of(&material(self.shaft.0, self.shaft.1));
        patches.lathe(foot, &shaft.map(|[x, t]| [x * r, low + (high - low) * t]), self.sides);

        patches.of(&material("ornament", [1.02, 0.97, 0.88]));
        let neck = [
            [0.86, 0.0],
            [0.97, 0.03],
            [1.0, 0.09],
            [0.97, 0.15],
            [0.86, 0.18],
            [0.84, 0.6],
            [0.88, 1.2],
            [1.0, 1.8],
            [1.22, 2.2],
            [1.26, 2.3],
        ];
        patches.lathe(foot, &neck.map(|[x, y]| [x * r, high + y * r]), self.sides);
        for (row, up) in [0.18, 0.18 + 0.65].into_iter().enumerate() {
            (0..self.leaves).for_each(|leaf| self.leaf(patches, foot + Vec3::Y * (high + up * r), 2 * leaf + row));
        }
        for corner in 0..4 {
            self.volute(patches, foot + Vec3::Y * (high + 1.25 * r), corner);
        }
        patches.of(&material("trim", [0.98, 0.93, 0.84]));
        patches.block(frame, [-1.28 * r, top, -1.28 * r], [1.28 * r, top + 0.12 * r, 1.28 * r]);
        patches.block(frame, [-1.42 * r, top + 0.12 * r, -1.42 * r], [1.42 * r, self.height, 1.42 * r]);
    }

    fn leaf(&self, patches: &mut Patches, foot: Vec3, number: usize) {
        let (sine, cosine) = turn(number, 2 * self.leaves);
        let (out, side) = (Vec3::new(sine, 0.0, cosine), Vec3::new(cosine, 0.0, -sine));
        let spread = 2.9 / self.leaves as f32;
        let profile = [
            [0.86, 0.0, 0.8],
            [0.90, 0.3, 1.0],
            [0.97, 0.6, 1.05],
            [1.10, 0.82, 0.85],
            [1.24, 0.86, 0.6],
            [1.28, 0.74, 0.25],
        ];
        let columns = if self.leaves > 6 { 4 } else { 2 };
        patches.patch([columns, profile.len() - 1], false, Finish::Smooth, |column, row| {
            let [radius, up, wide] = profile[row];
            let across = 2.0 * column as f32 / columns as f32 - 1.0;
            let lobe = if row % 2 == 1 { 1.0 } else { 0.8 };
            let bulge = 0.06 * (1.0 - across * across) - 0.03 * (column % 2) as f32;
            foot + (out * (radius + bulge) + side * (across * spread * wide * lobe) + Vec3::Y * up) * self.radius
        });
    }

    fn volute(&self, patches: &mut Patches, foot: Vec3, corner: usize) {
        let (sine, cosine) = turn(2 * corner + 1, 8);
        let (out, side) = (Vec3::new(sine, 0.0, cosine), Vec3::new(cosine, 0.0, -sine));
        let steps = self.sides;
        patches.patch([steps, 2], false, Finish::Smooth, |column, row| {
            let t = column as f32 / steps as f32;
            let (s, c) = turn(column * 3, 2 * steps);
            let size = 0.34 * (1.0 - 0.75 * t);
            let across = [-0.16, 0.0, 0.16][row];
            let groove = if row == 1 { 0.8 } else { 1.0 };
            foot + (out * (1.32 - size * s * groove) + side * across + Vec3::Y * (0.66 + size * c * groove))
                * self.radius
        });
    }
}
