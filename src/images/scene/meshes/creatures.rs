//! Generates three animal meshes with few triangles.

use glam::{Vec3, vec4};

use super::fit::fit;
use super::sdf::{Blend, Frame, Sdf, split_to};
use crate::geometry::Aabb;
use crate::scene::{Material, Model};

const EYE: usize = 96;

struct Design {
    triangles: usize,
    bounds: Aabb,
    /// The approximate edge length of the surface mesh.
    step: f32,
    fur: [f32; 3],
    /// Centre and radius of the eye at x > 0. The other eye is the mirror image.
    eye: (Vec3, f32),
}

/// A crouching rabbit that faces +z.
pub fn rabbit() -> Model {
    let v = Vec3::new;
    let mut sdf = Sdf::plain();
    sdf.group(Blend::smooth(0.0)).ellipsoid(v(0.0, 1.35, -0.8), v(1.28, 1.3, 1.5));
    sdf.group(Blend::smooth(0.4)).ellipsoid(v(0.0, 1.35, 0.5), v(0.9, 1.0, 0.85));
    sdf.group(Blend::smooth(0.3)).ellipsoid(v(0.0, 2.6, 1.1), v(0.85, 0.8, 0.85));
    sdf.group(Blend::smooth(0.25)).ellipsoid(v(0.0, 2.35, 1.8), v(0.42, 0.36, 0.42));
    sdf.group(Blend::smooth(0.25)).sphere(v(0.0, 1.25, -2.3), 0.48);
    for side in [-1.0, 1.0] {
        sdf.group(Blend::smooth(0.25)).sphere(v(side * 0.42, 2.25, 1.45), 0.4);
        let ear = [
            vec4(side * 0.32, 3.1, 0.85, 0.22),
            vec4(side * 0.42, 3.6, 0.65, 0.3),
            vec4(side * 0.56, 4.1, 0.35, 0.31),
            vec4(side * 0.66, 4.5, 0.0, 0.16),
        ];
        sdf.group(Blend::smooth(0.15)).tube(&ear, 4);
        sdf.group(Blend::smooth(0.2)).ellipsoid(v(side * 0.95, 1.0, -0.9), v(0.6, 0.85, 0.95));
        sdf.group(Blend::smooth(0.12)).cone(v(side * 1.1, 0.27, -0.9), 0.27, v(side * 1.15, 0.24, 0.4), 0.26);
        sdf.group(Blend::smooth(0.2)).cone(v(side * 0.42, 1.1, 0.85), 0.32, v(side * 0.46, 0.27, 1.35), 0.27);
    }
    let design = Design {
        triangles: 1532,
        bounds: Aabb { min: Vec3::new(-1.593, 0.0, -2.554), max: Vec3::new(1.593, 4.446, 2.349) },
        step: 0.34,
        fur: [0.70, 0.58, 0.46],
        eye: (Vec3::new(0.60, 2.78, 1.62), 0.19),
    };
    design.model(&sdf)
}

/// A sitting fox that faces +z.
pub fn fox() -> Model {
    let v = Vec3::new;
    let mut sdf = Sdf::plain();
    sdf.group(Blend::smooth(0.0)).cone(v(0.0, 1.3, -0.9), 1.25, v(0.0, 2.7, -0.15), 0.85);
    sdf.group(Blend::smooth(0.25)).ellipsoid(v(0.0, 4.0, 0.3), v(1.2, 0.95, 0.95));
    sdf.group(Blend::smooth(0.3)).cone(v(0.0, 3.78, 0.95), 0.5, v(0.0, 3.62, 1.75), 0.2);
    let tail = [
        vec4(0.2, 0.7, -1.7, 0.45),
        vec4(1.1, 0.75, -2.6, 0.62),
        vec4(1.9, 1.3, -3.0, 0.78),
        vec4(2.2, 2.3, -3.0, 0.66),
        vec4(1.9, 3.2, -2.8, 0.22),
    ];
    sdf.group(Blend::smooth(0.2)).tube(&tail, 5);
    for side in [-1.0, 1.0] {
        sdf.group(Blend::smooth(0.3)).cone(v(side * 0.75, 3.7, 0.45), 0.45, v(side * 1.5, 3.5, 0.3), 0.2);
        sdf.group(Blend::smooth(0.2)).cone(v(side * 0.72, 4.55, 0.2), 0.46, v(side * 1.05, 5.5, 0.1), 0.14);
        sdf.group(Blend::smooth(0.2)).cone(v(side * 0.5, 2.1, 0.45), 0.42, v(side * 0.52, 0.4, 0.8), 0.3);
        sdf.group(Blend::smooth(0.15)).ellipsoid(v(side * 0.52, 0.3, 1.0), v(0.34, 0.3, 0.44));
        sdf.group(Blend::smooth(0.25)).ellipsoid(v(side * 1.1, 1.0, -0.35), v(0.75, 0.98, 1.0));
        sdf.group(Blend::smooth(0.15)).cone(v(side * 1.25, 0.3, 0.1), 0.3, v(side * 1.3, 0.28, 0.8), 0.28);
    }
    let design = Design {
        triangles: 1374,
        bounds: Aabb { min: Vec3::new(-2.451, 0.0, -3.901), max: Vec3::new(2.451, 5.484, 1.881) },
        step: 0.43,
        fur: [0.86, 0.42, 0.16],
        eye: (Vec3::new(0.52, 4.18, 1.14), 0.19),
    };
    design.model(&sdf)
}

/// A young elephant that faces +z.
pub fn elephant() -> Model {
    let v = Vec3::new;
    let mut sdf = Sdf::plain();
    sdf.group(Blend::smooth(0.0)).ellipsoid(v(0.0, 3.6, -1.1), v(1.95, 1.95, 2.4));
    sdf.group(Blend::smooth(0.5)).ellipsoid(v(0.0, 5.4, 1.6), v(1.5, 1.6, 1.4));
    let trunk = [
        vec4(0.0, 5.0, 2.6, 0.78),
        vec4(0.0, 4.0, 3.4, 0.62),
        vec4(0.0, 3.0, 3.75, 0.52),
        vec4(0.0, 2.2, 4.1, 0.45),
        vec4(0.0, 2.05, 4.8, 0.4),
        vec4(0.0, 2.7, 5.2, 0.38),
    ];
    sdf.group(Blend::smooth(0.4)).tube(&trunk, 5);
    let tail = [vec4(0.0, 4.2, -3.2, 0.32), vec4(0.0, 3.4, -3.7, 0.28), vec4(0.0, 2.5, -3.8, 0.36)];
    sdf.group(Blend::smooth(0.2)).tube(&tail, 4);
    for side in [-1.0, 1.0] {
        for z in [0.4, -2.4] {
            sdf.group(Blend::smooth(0.4)).cone(v(side * 1.05, 2.6, z), 0.85, v(side * 1.12, 0.74, z + 0.05), 0.74);
        }
        let ear = Frame::looking(v(side * 2.2, 5.5, 1.1), v(side * 0.45, 0.0, 1.0), Vec3::Y);
        sdf.group(Blend::smooth(0.3)).ellipsoid_in(&ear, Vec3::ZERO, v(1.15, 1.4, 0.4));
    }
    let design = Design {
        triangles: 1572,
        bounds: Aabb { min: Vec3::new(-2.785, 0.002, -3.72), max: Vec3::new(2.785, 7.15, 4.736) },
        step: 0.58,
        fur: [0.46, 0.54, 0.66],
        eye: (Vec3::new(0.92, 5.75, 2.62), 0.24),
    };
    design.model(&sdf)
}

impl Design {
    fn model(&self, sdf: &Sdf) -> Model {
        let bounds = Aabb { min: Vec3::new(-3.6, -0.5, -5.0), max: Vec3::new(3.6, 8.0, 6.0) };
        let mut model = sdf.surface(bounds, self.step, 6);
        split_to(&mut model, self.triangles - 2 * EYE);
        sdf.settle(&mut model, self.step);
        let body_triangles = model.triangles.len();

        let (eye, radius) = self.eye;
        for side in [-1.0, 1.0] {
            let ball = eye_ball(eye * Vec3::new(side, 1.0, 1.0), radius);
            let offset = model.positions.len() as u32;
            model.triangles.extend(ball.triangles.iter().map(|t| t.map(|v| v + offset)));
            model.positions.extend(ball.positions);
            model.normals.extend(ball.normals);
        }
        fit(&mut model, self.bounds);

        let coat = |name| Material { ambient: Vec3::splat(0.5), shininess: 10.0, ..Material::named(name) };
        let fur = Material { diffuse: self.fur.into(), specular: Vec3::ZERO, ..coat("body") };
        let pupil = Material { diffuse: Vec3::splat(0.03), specular: Vec3::splat(0.6), shininess: 60.0, ..coat("eye") };
        model.materials = vec![fur, pupil];
        model.material_of = (0..model.triangles.len()).map(|t| u32::from(t >= body_triangles)).collect();
        model
    }
}

fn eye_ball(centre: Vec3, radius: f32) -> Model {
    let mut sdf = Sdf::plain();
    sdf.group(Blend::smooth(0.0)).sphere(centre, radius);
    let around = Aabb { min: centre - radius, max: centre + radius };
    let mut ball = sdf.surface(around, 0.62 * radius, 3);
    split_to(&mut ball, EYE);
    sdf.settle(&mut ball, radius);
    ball
}
