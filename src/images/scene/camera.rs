//! The pinhole camera.

use glam::{DVec2, DVec3, Vec2, Vec3};

use crate::geometry::Ray;

/// A pinhole camera with square pixels.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Camera {
    eye: Vec3,
    target: Vec3,
    up: Vec3,
    vertical_fov: f32,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
pub enum CameraError {
    #[error("the camera's eye, target and up must be finite numbers")]
    NotFinite,
    #[error("the camera's eye and target are the same point: move one of them")]
    NoDirection,
    #[error("the camera's up is parallel to its view or has no length: choose another up")]
    NoUp,
    #[error("the camera's vertical field of view must be above 0 and below 180 degrees")]
    FieldOfView,
}

impl Camera {
    /// `vertical_fov` is the full vertical field of view in degrees.
    ///
    /// # Errors
    /// A [`CameraError`] if the arguments do not define a view.
    pub fn new(eye: Vec3, target: Vec3, up: Vec3, vertical_fov: f32) -> Result<Self, CameraError> {
        if !(eye.is_finite() && target.is_finite() && up.is_finite()) {
            return Err(CameraError::NotFinite);
        }
        if !(vertical_fov > 0.0 && vertical_fov < 180.0) {
            return Err(CameraError::FieldOfView);
        }
        let forward = (target.as_dvec3() - eye.as_dvec3()).try_normalize().ok_or(CameraError::NoDirection)?;
        let up_unit = up.as_dvec3().try_normalize().ok_or(CameraError::NoUp)?;
        if forward.cross(up_unit).length() < 1e-6 {
            return Err(CameraError::NoUp);
        }
        Ok(Self { eye, target, up, vertical_fov })
    }

    pub fn eye(&self) -> Vec3 {
        self.eye
    }

    pub fn target(&self) -> Vec3 {
        self.target
    }

    pub fn up(&self) -> Vec3 {
        self.up
    }

    /// In degrees.
    pub fn vertical_fov(&self) -> f32 {
        self.vertical_fov
    }

    pub fn view(&self, size: [u32; 2]) -> View {
        let eye = self.eye.as_dvec3();
        let forward = (self.target.as_dvec3() - eye).normalize();
        let right = forward.cross(self.up.as_dvec3()).normalize();
        let up = right.cross(forward);
        let half = libm::tan(f64::from(self.vertical_fov).to_radians() * 0.5);
        let half_size = DVec2::new(size[0].into(), size[1].into()) * 0.5;
        View { eye: self.eye, forward, right, up, half_size, pixel: half / half_size.y }
    }
}

/// A camera with an image size.
///
/// Directions are computed in `f64` and rounded to `f32` once. Rays have the same bits on every machine.
#[derive(Clone, Copy, Debug)]
pub struct View {
    eye: Vec3,
    forward: DVec3,
    right: DVec3,
    up: DVec3,
    half_size: DVec2,
    /// The width of a pixel in the image plane at distance 1 from the eye.
    pixel: f64,
}

impl View {
    /// The offset from the top left corner of a pixel to the centre of the pixel.
    pub const CENTRE: Vec2 = Vec2::splat(0.5);

    /// The ray through a point of pixel (`x`, `y`). The direction of the ray has unit length.
    ///
    /// Pixel (0, 0) is at the top left of the image. `offset` is (0, 0) at the top left corner of a pixel. `offset` is
    /// (1, 1) at the bottom right corner of a pixel.
    pub fn ray(&self, x: u32, y: u32, offset: Vec2) -> Ray {
        let across = (f64::from(x) + f64::from(offset.x) - self.half_size.x) * self.pixel;
        let upward = (self.half_size.y - f64::from(y) - f64::from(offset.y)) * self.pixel;
        let direction = self.forward + self.right * across + self.up * upward;
        Ray::new(self.eye, direction.normalize().as_vec3())
    }
}
