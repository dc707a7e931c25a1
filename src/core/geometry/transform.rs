//! The placement of a model in a scene: scale, rotate, translate.

use glam::{DMat3, DVec3, Vec3};

/// Maps a point `p` of a model to `R * S * p + t`. `R` rotates, `S` scales and `t` translates.
///
/// `R` is `Rz * Ry * Rx`. By rows, `Rx = [1 0 0; 0 c s; 0 -s c]`, `Ry = [c 0 -s; 0 1 0; s 0 c]` and
/// `Rz = [c s 0; -s c 0; 0 0 1]`. Here `c` and `s` are the cosine and the sine of the angle. These three matrices are
/// the inverses of the usual right-handed rotations.
///
/// Points and normals are computed in `f64`, then rounded to `f32`. Every machine computes the same bits.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Transform {
    linear: DMat3,
    translation: DVec3,
}

impl Transform {
    /// The identity.
    pub const IDENTITY: Self = Self { linear: DMat3::IDENTITY, translation: DVec3::ZERO };

    /// Scales by `scale`, then rotates by `rotation`, then translates by `translation`.
    ///
    /// The angles of `rotation` are in degrees. The rotation about x comes first, then y, then z.
    pub fn new(rotation: Vec3, scale: Vec3, translation: Vec3) -> Self {
        let [x, y, z] = rotation.to_array().map(sin_cos_degrees);
        let about_x = rows([[1.0, 0.0, 0.0], [0.0, x.1, x.0], [0.0, -x.0, x.1]]);
        let about_y = rows([[y.1, 0.0, -y.0], [0.0, 1.0, 0.0], [y.0, 0.0, y.1]]);
        let about_z = rows([[z.1, z.0, 0.0], [-z.0, z.1, 0.0], [0.0, 0.0, 1.0]]);
        let linear = about_z * about_y * about_x * DMat3::from_diagonal(scale.as_dvec3());
        Self { linear, translation: translation.as_dvec3() }
    }

    /// Whether the transform reverses the orientation of triangles. If true, the caller must restore the orientation.
    pub fn is_mirror(&self) -> bool {
        self.linear.determinant() < 0.0
    }

    /// The transformed `point`.
    pub fn point(&self, point: Vec3) -> Vec3 {
        (self.linear * point.as_dvec3() + self.translation).as_vec3()
    }

    /// `R * S * normal`, normalized. If this product is zero, the result is zero.
    ///
    /// The inverse transpose of `R * S` would be correct for normals. The scenes come from a course that uses
    /// `R * S` for normals. These scenes stretch only flat squares, whose normals stay correct.
    pub fn normal(&self, normal: Vec3) -> Vec3 {
        (self.linear * normal.as_dvec3()).normalize_or_zero().as_vec3()
    }
}

fn rows(rows: [[f64; 3]; 3]) -> DMat3 {
    DMat3::from_cols_array_2d(&rows).transpose()
}

/// Sine and cosine, exact at multiples of 90 degrees. There, `libm` is inexact, because angles in radians are rounded.
/// `libm` computes the same bits on every machine.
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
