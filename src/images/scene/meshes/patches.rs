//! Builds architecture from surface patches. Different patches share no vertices.

use glam::Vec3;

use super::sdf::{Frame, cosine, sine};
use super::{net, normals};
use crate::scene::{Material, Model};

#[derive(Clone, Copy, PartialEq, Eq)]
pub enum Finish {
    Flat,
    Smooth,
}

#[derive(Default)]
pub struct Patches {
    pub model: Model,
    material: u32,
}

impl Patches {
    /// Sets the material of later patches. The name identifies a material.
    pub fn of(&mut self, material: &Material) {
        let known = self.model.materials.iter().position(|m| m.name == material.name);
        self.material = known.unwrap_or(self.model.materials.len()) as u32;
        if known.is_none() {
            self.model.materials.push(material.clone());
        }
    }

    /// Seen from the front, columns run to the right. Rows run upwards. `round` joins the last column to the first
    /// column.
    pub fn patch(
        &mut self,
        [columns, rows]: [usize; 2],
        round: bool,
        finish: Finish,
        at: impl Fn(usize, usize) -> Vec3,
    ) {
        let across = if round { columns } else { columns + 1 };
        let places = (0..across * (rows + 1)).map(|i| at(i % across, i / across));
        let positions: Vec<Vec3> = places.collect();
        let corner = |column: u32, row: u32| row * across as u32 + column % across as u32;
        let quad = |r: u32, c: u32| [corner(c, r), corner(c + 1, r), corner(c + 1, r + 1), corner(c, r + 1)];
        let triangles = net(rows as u32, columns as u32, quad);

        let model = &mut self.model;
        let shifted = |by: usize| triangles.iter().map(move |t| t.map(|v| v + by as u32));
        match finish {
            Finish::Flat => model.normal_indices.extend(triangles.iter().map(|_| [Model::FLAT; 3])),
            Finish::Smooth => {
                model.normal_indices.extend(shifted(model.normals.len()));
                model.normals.extend(normals::by_area(&positions, &triangles));
            }
        }
        model.triangles.extend(shifted(model.positions.len()));
        model.positions.extend(positions);
        model.material_of.resize(model.triangles.len(), self.material);
    }

    /// Seen from the front, the corners run counter-clockwise.
    pub fn quad(&mut self, [a, b, c, d]: [Vec3; 4]) {
        self.patch([1, 1], false, Finish::Flat, |column, row| [[a, b], [d, c]][row][column]);
    }

    /// The corners `low` and `high` are in the coordinates of `frame`.
    pub fn block(&mut self, frame: &Frame, low: [f32; 3], high: [f32; 3]) {
        let at = |corner: usize| {
            let [x, y, z] = std::array::from_fn(|i| if corner >> i & 1 == 1 { high[i] } else { low[i] });
            frame.at(x, y, z)
        };
        for [a, b, c, d] in [[4, 5, 7, 6], [1, 0, 2, 3], [5, 1, 3, 7], [0, 4, 6, 2], [6, 7, 3, 2], [0, 1, 5, 4]] {
            self.quad([at(a), at(b), at(c), at(d)]);
        }
    }

    /// `profile` has points (radius, height) from the bottom up.
    pub fn lathe(&mut self, foot: Vec3, profile: &[[f32; 2]], sides: usize) {
        self.patch([sides, profile.len() - 1], true, Finish::Smooth, |column, row| {
            let [radius, height] = profile[row];
            let (sine, cosine) = turn(column, sides);
            foot + Vec3::new(radius * sine, height, radius * cosine)
        });
    }

    /// `profile` has points (height, depth) from the bottom up.
    pub fn moulding(&mut self, frame: &Frame, [from, to]: [f32; 2], profile: &[[f32; 2]]) {
        for (&[y0, z0], &[y1, z1]) in profile.iter().zip(&profile[1..]) {
            self.quad([frame.at(from, y0, z0), frame.at(to, y0, z0), frame.at(to, y1, z1), frame.at(from, y1, z1)]);
        }
    }
}

/// Sine and cosine of the fraction `part / whole` of a full turn.
pub fn turn(part: usize, whole: usize) -> (f32, f32) {
    let angle = part as f32 / whole as f32 * std::f32::consts::TAU;
    (sine(angle), cosine(angle))
}
