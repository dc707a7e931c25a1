//! The placement of a model in a scene: scale, rotate, translate.

use glam::{DMat3, DVec3, Vec3};

/// The transform of a model: `world = R * S * p + t`.
///
/// `R = Rz * Ry * Rx` with `Rx = [1 0 0; 0 c s; 0 -s c]`, `Ry = [c 0 -s; 0 1 0; s 0 c]` and
/// `Rz = [c s 0; -s c 0; 0 0 1]` (rows). Each matrix rotates in the opposite sense to the usual right-handed rotation.
/// Sines come from `libm`, and `f64` results are rounded to `f32` once. So every machine computes the same bits.
///
/// A transform that [mirrors](Self::is_mirror) reverses the orientation of triangles; the caller must restore it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Transform {
    linear: DMat3,
    translation: DVec3,
}

impl Transform {
    /// The identity.
    pub const IDENTITY: Self = Self { linear: DMat3::IDENTITY, translation: DVec3::ZERO };

    /// Scales by `scale`, rotates by `rotation` (degrees about x, then y, then z), then translates by `translation`.
    pub fn new(rotation: Vec3, scale: Vec3, translation: Vec3) -> Self {
        let [x, y, z] = rotation.to_array().map(sin_cos_degrees);
        let about_x = rows([[1.0, 0.0, 0.0], [0.0, x.1, x.0], [0.0, -x.0, x.1]]);
        let about_y = rows([[y.1, 0.0, -y.0], [0.0, 1.0, 0.0], [y.0, 0.0, y.1]]);
        let about_z = rows([[z.1, z.0, 0.0], [-z.0, z.1, 0.0], [0.0, 0.0, 1.0]]);
        let linear = about_z * about_y * about_x * DMat3::from_diagonal(scale.as_dvec3());
        Self { linear, translation: translation.as_dvec3() }
    }

    /// Whether the transform changes handedness: the scale is negative along one axis or along all three.
    pub fn is_mirror(&self) -> bool {
        self.linear.determinant() < 0.0
    }

    /// The transformed `point`.
    pub fn point(&self, point: Vec3) -> Vec3 {
        (self.linear * point.as_dvec3() + self.translation).as_vec3()
    }

    /// `R * S * normal` at unit length, or zero if this product is zero.
    ///
    /// The scenes come from a course that transforms normals with the matrix of the points. So normals tilt the wrong
    /// way under a non-uniform scale. The scenes of the course stretch only flat squares, whose normals stay correct.
    pub fn normal(&self, normal: Vec3) -> Vec3 {
        (self.linear * normal.as_dvec3()).normalize_or_zero().as_vec3()
    }
}

fn rows(rows: [[f64; 3]; 3]) -> DMat3 {
    DMat3::from_cols_array_2d(&rows).transpose()
}

/// Sine and cosine, exact at multiples of 90 degrees. `libm` is inexact at these angles, because angles in radians are
/// rounded.
fn sin_cos_degrees(degrees: f32) -> (f64, f64) {
    let degrees = f64::from(degrees) % 360.0;
    match degrees / 90.0 {
        0.0 => (0.0, 1.0),
        1.0 | -3.0 => (1.0, 0.0),
        2.0 | -2.0 => (0.0, -1.0),
        3.0 | -1.0 => (-1.0, 0.0),
        _ => libm::sincos(degrees.to_radians()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn turned(rotation: [f32; 3], point: Vec3) -> Vec3 {
        Transform::new(rotation.into(), Vec3::ONE, Vec3::ZERO).point(point)
    }

    #[test]
    fn quarter_turns_go_against_the_right_handed_sense_and_are_exact() {
        assert_eq!(turned([90.0, 0.0, 0.0], Vec3::Z), Vec3::Y);
        assert_eq!(turned([0.0, 90.0, 0.0], Vec3::X), Vec3::Z);
        assert_eq!(turned([0.0, 0.0, 90.0], Vec3::Y), Vec3::X);
        assert_eq!(turned([-90.0, 0.0, 0.0], Vec3::Y), Vec3::Z);
        assert_eq!(turned([0.0, 180.0, 0.0], Vec3::new(1.0, 2.0, 3.0)), Vec3::new(-1.0, 2.0, -3.0));
        assert_eq!(turned([0.0, 450.0, 0.0], Vec3::X), Vec3::Z);
        assert_eq!(turned([90.0, 90.0, 90.0], Vec3::Z), Vec3::X);
    }

    #[test]
    fn scale_comes_before_rotation_and_shift_after_it() {
        let placed = Transform::new(Vec3::new(0.0, 90.0, 0.0), Vec3::new(2.0, 3.0, 4.0), Vec3::new(10.0, 20.0, 30.0));
        assert_eq!(placed.point(Vec3::ONE), Vec3::new(6.0, 23.0, 32.0));
        assert_eq!(placed.normal(Vec3::new(0.0, 0.0, -7.0)), Vec3::X);
        assert_eq!(Transform::IDENTITY.point(Vec3::new(0.1, 0.2, 0.3)), Vec3::new(0.1, 0.2, 0.3));
        assert_eq!(Transform::new(Vec3::ZERO, Vec3::new(1.0, 0.0, 1.0), Vec3::ZERO).normal(Vec3::Y), Vec3::ZERO);
    }

    #[test]
    fn an_odd_number_of_negative_scales_is_a_mirror() {
        let mirrors = [[-1.0, 1.0, 1.0], [1.0, -2.0, 1.0], [1.0, 1.0, -1e-30], [-1.0, -1e30, -1e30]];
        let others = [[1.0, 1.0, 1.0], [-1.0, -1.0, 1.0], [0.0, -1.0, 1.0]];
        for rotation in [Vec3::ZERO, Vec3::new(10.0, 200.0, 77.0)] {
            let is_mirror = |scale: [f32; 3]| Transform::new(rotation, scale.into(), Vec3::X).is_mirror();
            assert_eq!((mirrors.map(is_mirror), others.map(is_mirror)), ([true; 4], [false; 3]), "{rotation}");
        }
    }
}
