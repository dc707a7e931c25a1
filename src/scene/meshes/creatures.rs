//! Three small creatures of our own: few triangles, smooth normals, two materials.

use glam::Vec3;

use super::clay::{Ball, Clay, Joint, Round, Skin, Tube, fit, split_to};
use crate::{
    geometry::Aabb,
    scene::{Material, Model},
};

/// Triangles of one eye.
const EYE: usize = 96;

/// What tells one creature from another.
struct Design {
    triangles: usize,
    bounds: Aabb,
    /// Edge length of the net over the clay.
    step: f32,
    fur: [f32; 3],
    /// Middle of the right eye (x > 0) and its radius; the left one is its mirror image.
    eye: (Vec3, f32),
}

const RABBIT: Design = Design {
    triangles: 1532,
    bounds: Aabb { min: Vec3::new(-1.593, 0.0, -2.554), max: Vec3::new(1.593, 4.446, 2.349) },
    step: 0.34,
    fur: [0.70, 0.58, 0.46],
    eye: (Vec3::new(0.60, 2.78, 1.62), 0.19),
};

const FOX: Design = Design {
    triangles: 1374,
    bounds: Aabb { min: Vec3::new(-2.451, 0.0, -3.901), max: Vec3::new(2.451, 5.484, 1.881) },
    step: 0.43,
    fur: [0.86, 0.42, 0.16],
    eye: (Vec3::new(0.52, 4.18, 1.14), 0.19),
};

const ELEPHANT: Design = Design {
    triangles: 1572,
    bounds: Aabb { min: Vec3::new(-2.785, 0.002, -3.72), max: Vec3::new(2.785, 7.15, 4.736) },
    step: 0.58,
    fur: [0.46, 0.54, 0.66],
    eye: (Vec3::new(0.92, 5.75, 2.62), 0.24),
};

/// A crouching rabbit of 1532 triangles that looks to +z; every piece of it is closed.
pub fn rabbit() -> Model {
    let v = Vec3::new;
    let mut clay = Clay::plain();
    clay.part(Joint::smooth(0.0)).ball(Ball::upright(v(0.0, 1.35, -0.8), v(1.28, 1.3, 1.5)));
    clay.part(Joint::smooth(0.4)).ball(Ball::upright(v(0.0, 1.35, 0.5), v(0.9, 1.0, 0.85)));
    clay.part(Joint::smooth(0.3)).ball(Ball::upright(v(0.0, 2.6, 1.1), v(0.85, 0.8, 0.85)));
    clay.part(Joint::smooth(0.25)).ball(Ball::upright(v(0.0, 2.35, 1.8), v(0.42, 0.36, 0.42)));
    clay.part(Joint::smooth(0.25)).sphere(v(0.0, 1.25, -2.3), 0.48);
    for side in [-1.0, 1.0] {
        clay.part(Joint::smooth(0.25)).sphere(v(side * 0.42, 2.25, 1.45), 0.4);
        let ear = [
            Round(side * 0.32, 3.1, 0.85, 0.22),
            Round(side * 0.42, 3.6, 0.65, 0.3),
            Round(side * 0.56, 4.1, 0.35, 0.31),
            Round(side * 0.66, 4.5, 0.0, 0.16),
        ];
        clay.part(Joint::smooth(0.15)).tube(&Tube::through(&ear, 4));
        clay.part(Joint::smooth(0.2)).ball(Ball::upright(v(side * 0.95, 1.0, -0.9), v(0.6, 0.85, 0.95)));
        clay.part(Joint::smooth(0.12)).cone(v(side * 1.1, 0.27, -0.9), 0.27, v(side * 1.15, 0.24, 0.4), 0.26);
        clay.part(Joint::smooth(0.2)).cone(v(side * 0.42, 1.1, 0.85), 0.32, v(side * 0.46, 0.27, 1.35), 0.27);
    }
    RABBIT.cast(&clay)
}

/// A sitting fox of 1374 triangles that looks to +z, its tail to one side; every piece of it is closed.
pub fn fox() -> Model {
    let v = Vec3::new;
    let mut clay = Clay::plain();
    clay.part(Joint::smooth(0.0)).cone(v(0.0, 1.3, -0.9), 1.25, v(0.0, 2.7, -0.15), 0.85);
    clay.part(Joint::smooth(0.25)).ball(Ball::upright(v(0.0, 4.0, 0.3), v(1.2, 0.95, 0.95)));
    clay.part(Joint::smooth(0.3)).cone(v(0.0, 3.78, 0.95), 0.5, v(0.0, 3.62, 1.75), 0.2);
    let tail = [
        Round(0.2, 0.7, -1.7, 0.45),
        Round(1.1, 0.75, -2.6, 0.62),
        Round(1.9, 1.3, -3.0, 0.78),
        Round(2.2, 2.3, -3.0, 0.66),
        Round(1.9, 3.2, -2.8, 0.22),
    ];
    clay.part(Joint::smooth(0.2)).tube(&Tube::through(&tail, 5));
    for side in [-1.0, 1.0] {
        clay.part(Joint::smooth(0.3)).cone(v(side * 0.75, 3.7, 0.45), 0.45, v(side * 1.5, 3.5, 0.3), 0.2);
        clay.part(Joint::smooth(0.2)).cone(v(side * 0.72, 4.55, 0.2), 0.46, v(side * 1.05, 5.5, 0.1), 0.14);
        clay.part(Joint::smooth(0.2)).cone(v(side * 0.5, 2.1, 0.45), 0.42, v(side * 0.52, 0.4, 0.8), 0.3);
        clay.part(Joint::smooth(0.15)).ball(Ball::upright(v(side * 0.52, 0.3, 1.0), v(0.34, 0.3, 0.44)));
        clay.part(Joint::smooth(0.25)).ball(Ball::upright(v(side * 1.1, 1.0, -0.35), v(0.75, 0.98, 1.0)));
        clay.part(Joint::smooth(0.15)).cone(v(side * 1.25, 0.3, 0.1), 0.3, v(side * 1.3, 0.28, 0.8), 0.28);
    }
    FOX.cast(&clay)
}

/// A young elephant of 1572 triangles that looks to +z; every piece of it is closed.
pub fn elephant() -> Model {
    let v = Vec3::new;
    let mut clay = Clay::plain();
    clay.part(Joint::smooth(0.0)).ball(Ball::upright(v(0.0, 3.6, -1.1), v(1.95, 1.95, 2.4)));
    clay.part(Joint::smooth(0.5)).ball(Ball::upright(v(0.0, 5.4, 1.6), v(1.5, 1.6, 1.4)));
    let trunk = [
        Round(0.0, 5.0, 2.6, 0.78),
        Round(0.0, 4.0, 3.4, 0.62),
        Round(0.0, 3.0, 3.75, 0.52),
        Round(0.0, 2.2, 4.1, 0.45),
        Round(0.0, 2.05, 4.8, 0.4),
        Round(0.0, 2.7, 5.2, 0.38),
    ];
    clay.part(Joint::smooth(0.4)).tube(&Tube::through(&trunk, 5));
    let tail = [Round(0.0, 4.2, -3.2, 0.32), Round(0.0, 3.4, -3.7, 0.28), Round(0.0, 2.5, -3.8, 0.36)];
    clay.part(Joint::smooth(0.2)).tube(&Tube::through(&tail, 4));
    for side in [-1.0, 1.0] {
        for z in [0.4, -2.4] {
            clay.part(Joint::smooth(0.4)).cone(v(side * 1.05, 2.6, z), 0.85, v(side * 1.12, 0.74, z + 0.05), 0.74);
        }
        let ear = super::clay::Frame::looking(v(side * 2.2, 5.5, 1.1), v(side * 0.45, 0.0, 1.0), Vec3::Y);
        clay.part(Joint::smooth(0.3)).ball(Ball { frame: ear, radii: v(1.15, 1.4, 0.4) });
    }
    ELEPHANT.cast(&clay)
}

impl Design {
    /// The skin of `clay` with two eyes, of exactly the designed number of triangles, filling exactly the box.
    fn cast(&self, clay: &Clay) -> Model {
        let bounds = Aabb { min: Vec3::new(-3.6, -0.5, -5.0), max: Vec3::new(3.6, 8.0, 6.0) };
        let mut body = Skin::of(clay, bounds, self.step, 6);
        split_to(&mut body, self.triangles - 2 * EYE);
        let mut model = body.settled(clay, self.step).into_bare_model();
        let body_triangles = model.triangles.len();

        let (eye, radius) = self.eye;
        for side in [-1.0, 1.0] {
            let ball = eye_ball(eye * Vec3::new(side, 1.0, 1.0), radius);
            let offset = model.positions.len() as u32;
            model.triangles.extend(ball.triangles.iter().map(|t| t.map(|v| v + offset)));
            model.positions.extend(ball.positions);
            model.normals.extend(ball.normals);
        }
        model.normal_indices = model.triangles.clone();
        fit(&mut model.positions, &mut model.normals, self.bounds);

        let fur = Material { diffuse: self.fur.into(), ..coat("body") };
        let pupil = Material { diffuse: Vec3::splat(0.03), specular: Vec3::splat(0.6), shininess: 60.0, ..coat("eye") };
        model.materials = vec![fur, pupil];
        model.material_of = (0..model.triangles.len()).map(|t| u32::from(t >= body_triangles)).collect();
        model
    }
}

/// The reflection that the scene gives to all creatures, but for the colour.
fn coat(name: &str) -> Material {
    Material { ambient: Vec3::splat(0.5), specular: Vec3::ZERO, shininess: 10.0, ..Material::named(name) }
}

fn eye_ball(centre: Vec3, radius: f32) -> Skin {
    let mut clay = Clay::plain();
    clay.part(Joint::smooth(0.0)).sphere(centre, radius);
    let around = Aabb { min: centre - radius, max: centre + radius };
    let mut ball = Skin::of(&clay, around, 0.62 * radius, 3);
    split_to(&mut ball, EYE);
    ball.settled(&clay, radius)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::meshes::checks;

    #[test]
    fn creatures_are_closed_and_fill_their_boxes_exactly() {
        let creatures = [(rabbit(), RABBIT), (fox(), FOX), (elephant(), ELEPHANT)];
        for (model, design) in &creatures {
            let mesh = checks::sound(model, design.triangles);
            assert_eq!(mesh.bounds(), design.bounds);
            assert_eq!(checks::closed_pieces(model), 3, "a body and two eyes");
            let names: Vec<_> = model.materials.iter().map(|m| &m.name[..]).collect();
            assert_eq!(names, ["body", "eye"]);
            assert_eq!(model.material_of.iter().filter(|&&m| m == 1).count(), 2 * EYE);
        }
        assert_eq!(
            creatures.map(|(model, _)| checks::fingerprint(&model)),
            ["931b060059f36c68", "7971a6993d7fbde9", "4e8ec9f72bb0c3b9"]
        );
    }
}
