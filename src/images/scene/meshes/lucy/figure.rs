//! The head, the arms and the torch of the statue.

use glam::{Vec3, Vec4, vec4};

use crate::scene::meshes::sdf::{Blend, Frame, Sdf, cosine, sine};

pub fn model(sdf: &mut Sdf) {
    let v = Vec3::new;
    sdf.group(Blend::smooth(0.3)).cone(v(0.0, 16.1, -0.05), 0.62, v(0.0, 17.5, 0.05), 0.46);
    let head = Frame::looking(v(0.0, 18.1, 0.12), v(-0.22, -0.03, 1.0), v(-0.06, 1.0, 0.0));
    face(sdf, &head);
    hair(sdf, &head);
    raised_arm(sdf);
    lowered_arm(sdf);
    torch(sdf);
}

fn face(sdf: &mut Sdf, head: &Frame) {
    sdf.group(Blend::smooth(0.2)).ellipsoid_in(head, [0.0, 0.12, 0.0], [0.76, 0.92, 0.86]);
    sdf.group(Blend::smooth(0.3)).cone(head.at(0.0, -0.35, 0.3), 0.48, head.at(0.0, -0.72, 0.55), 0.25);
    for side in [-1.0, 1.0] {
        sdf.group(Blend::subtract(0.14)).ellipsoid_in(head, [side * 0.30, 0.04, 0.92], [0.19, 0.12, 0.16]);
        sdf.group(Blend::smooth(0.02)).ellipsoid_in(head, [side * 0.29, 0.03, 0.70], [0.17, 0.11, 0.14]);
        sdf.group(Blend::smooth(0.05));
        sdf.cone(head.at(side * 0.12, 0.22, 0.84), 0.06, head.at(side * 0.46, 0.24, 0.66), 0.06);
        sdf.group(Blend::smooth(0.2)).sphere(head.at(side * 0.36, -0.26, 0.55), 0.24);
    }
    sdf.group(Blend::smooth(0.15)).ellipsoid_in(head, [0.0, -0.45, 0.55], [0.36, 0.30, 0.29]);
    sdf.group(Blend::smooth(0.08)).cone(head.at(0.0, 0.16, 0.84), 0.07, head.at(0.0, -0.18, 0.97), 0.10);
    sdf.group(Blend::smooth(0.04));
    sdf.ellipsoid_in(head, [0.0, -0.455, 0.83], [0.25, 0.055, 0.08]);
    sdf.ellipsoid_in(head, [0.0, -0.575, 0.80], [0.20, 0.06, 0.08]);
}

fn hair(sdf: &mut Sdf, head: &Frame) {
    sdf.group(Blend::smooth(0.05)).ellipsoid_in(head, [0.0, 0.26, -0.14], [0.83, 0.86, 0.86]);
    for side in [-1.0, 1.0] {
        sdf.group(Blend::smooth(0.05));
        for i in 0..8 {
            let s = i as f32 / 7.0;
            let parting = Vec3::new(0.02 * side, 0.78 - 0.1 * s, 0.62 - 1.2 * s);
            let temple = Vec3::new(side * (1.5 - 0.6 * s), 0.8 * s - 0.35, 0.75 - 1.5 * s);
            let knot = Vec3::new(side * 0.1, -0.25 + 0.2 * s, -1.0);
            let strand: [Vec4; 9] = std::array::from_fn(|k| {
                let t = k as f32 / 8.0;
                let way = parting * (1.0 - t) * (1.0 - t) + temple * 2.0 * t * (1.0 - t) + knot * t * t;
                let p = way.normalize() * (0.87 + 0.035 * sine(11.0 * t + 4.0 * s));
                vec4(p.x, p.y + 0.26, p.z - 0.14, 0.10 + 0.02 * sine(3.0 * t))
            });
            sdf.tube_in(head, &strand, 3);
        }
        let lock = [
            vec4(side * 0.55, -0.35, -0.55, 0.17),
            vec4(side * 0.68, -0.9, -0.42, 0.19),
            vec4(side * 0.60, -1.4, -0.2, 0.18),
            vec4(side * 0.72, -1.85, 0.15, 0.17),
            vec4(side * 0.64, -2.3, 0.42, 0.15),
            vec4(side * 0.70, -2.75, 0.62, 0.09),
        ];
        sdf.tube_in(head, &lock, 5);
    }
    sdf.group(Blend::smooth(0.06)).ellipsoid_in(head, [0.0, -0.1, -1.08], [0.46, 0.42, 0.38]);
    sdf.group(Blend::smooth(0.03));
    for i in 0..6 {
        let angle = i as f32 * std::f32::consts::FRAC_PI_3;
        let (c, s) = (cosine(angle), sine(angle));
        sdf.cone(head.at(0.36 * c, -0.1 + 0.33 * s, -1.12), 0.13, head.at(0.12 * s, -0.1 + 0.1 * c, -1.42), 0.1);
    }
    // A diadem.
    sdf.group(Blend::smooth(0.03));
    let band: [Vec4; 17] = std::array::from_fn(|i| {
        let angle = (i as f32 - 8.0) * 0.17;
        vec4(0.88 * sine(angle), 0.62, 0.88 * cosine(angle) - 0.14, 0.1)
    });
    sdf.tube_in(head, &band, 2);
    for i in -3..=3 {
        let angle = i as f32 * 0.3;
        let (x, z) = (0.88 * sine(angle), 0.88 * cosine(angle) - 0.14);
        let high = 0.42 - 0.03 * (i * i) as f32;
        sdf.cone(head.at(x, 0.64, z), 0.1, head.at(x * 1.08, 0.7 + high, z * 1.04), 0.06);
    }
}

fn raised_arm(sdf: &mut Sdf) {
    let v = Vec3::new;
    let (shoulder, elbow, wrist) = (v(-1.45, 15.85, 0.0), v(-2.85, 16.95, 0.45), v(-2.95, 19.1, 0.85));
    sdf.group(Blend::smooth(0.3)).cone(shoulder, 0.56, elbow, 0.42);
    sdf.group(Blend::smooth(0.12)).cone(elbow, 0.42, wrist, 0.27);
    sdf.group(Blend::smooth(0.1)).cone(wrist, 0.25, v(-2.93, 19.5, 0.92), 0.34);
    grip(sdf, v(-2.92, 19.62, 1.06), 0.22);

    // The sleeve.
    sdf.group(Blend::smooth(0.07));
    for i in 0..5 {
        let t = 0.18 + 0.14 * i as f32;
        let at = shoulder.lerp(elbow, t);
        sdf.cone(at, 0.60 - 0.015 * i as f32, at + v(-0.06, -0.28, 0.02), 0.5);
    }
    for i in 0..5 {
        let t = i as f32 / 4.0;
        let top = shoulder.lerp(elbow, 0.15 + 0.5 * t) + v(0.0, -0.45, 0.25 * (t - 0.5));
        sdf.cone(top, 0.2, top + v(0.12, -0.9 - 0.7 * sine(2.0 * t + 0.6), -0.05), 0.15);
    }
}

fn lowered_arm(sdf: &mut Sdf) {
    let v = Vec3::new;
    let (shoulder, elbow, wrist) = (v(1.45, 15.75, 0.0), v(2.25, 13.35, -0.1), v(2.05, 12.85, 1.75));
    sdf.group(Blend::smooth(0.3)).cone(shoulder, 0.56, elbow, 0.42);
    sdf.group(Blend::smooth(0.1)).cone(elbow, 0.42, wrist, 0.26);
    sdf.group(Blend::smooth(0.1)).cone(wrist, 0.24, v(1.95, 12.9, 2.2), 0.29);
    sdf.group(Blend::smooth(0.03));
    for i in 0..4 {
        let s = i as f32;
        let knuckle = v(1.78 + 0.15 * s, 13.02 - 0.05 * s, 2.36);
        let bend = knuckle + v(-0.02, -0.08, 0.34);
        sdf.cone(knuckle, 0.115, bend, 0.105);
        sdf.cone(bend, 0.105, bend + v(-0.03, -0.3, 0.06), 0.08);
    }
    sdf.cone(v(1.72, 12.92, 2.15), 0.12, v(1.62, 12.75, 2.5), 0.1);
    sdf.group(Blend::smooth(0.07));
    for i in 0..5 {
        let at = shoulder.lerp(elbow, 0.18 + 0.14 * i as f32);
        sdf.cone(at, 0.60 - 0.012 * i as f32, at + v(0.12, -0.16, 0.05), 0.54);
    }
}

fn grip(sdf: &mut Sdf, at: Vec3, handle: f32) {
    sdf.group(Blend::smooth(0.03));
    for i in 0..4 {
        let up = 0.2 * (i as f32 - 1.5);
        let ring: [Vec4; 6] = std::array::from_fn(|k| {
            let (angle, r) = (0.6 + k as f32 * 0.62, handle + 0.12);
            vec4(at.x + r * cosine(angle), at.y + up, at.z + r * sine(angle) - 0.05, 0.12)
        });
        sdf.tube(&ring, 3);
    }
    sdf.cone(at + Vec3::new(0.28, 0.1, -0.1), 0.14, at + Vec3::new(0.12, 0.48, 0.22), 0.11);
}

fn torch(sdf: &mut Sdf) {
    let (x, z) = (-2.92, 1.06);
    let v = |y: f32| Vec3::new(x, y, z);
    sdf.group(Blend::smooth(0.06));
    sdf.cone(v(18.3), 0.15, v(20.9), 0.23);
    sdf.sphere(v(18.25), 0.24);
    sdf.group(Blend::smooth(0.05));
    for (y, r) in [(18.7, 0.2), (20.35, 0.28), (20.75, 0.33), (21.0, 0.3)] {
        sdf.ellipsoid(v(y), Vec3::new(r, 0.1, r));
    }
    sdf.group(Blend::smooth(0.05)).cone(v(20.95), 0.26, v(21.45), 0.52);
    sdf.ellipsoid(v(21.62), Vec3::new(0.72, 0.13, 0.72));
    sdf.group(Blend::smooth(0.12));
    for (i, height) in [(0, 1.0), (1, 0.8), (2, 1.15), (3, 0.72), (4, 0.9)] {
        let angle = 1.256_637 * i as f32;
        let (c, s) = (cosine(angle), sine(angle));
        let curl = |y: f32, r: f32, thick: f32| vec4(x + r * c - 0.1 * y * s, 21.6 + y, z + r * s + 0.1 * y * c, thick);
        let tongue = [
            curl(0.0, 0.38, 0.24),
            curl(0.4 * height, 0.44, 0.25),
            curl(0.8 * height, 0.26, 0.2),
            curl(1.15 * height, 0.22, 0.13),
            curl(1.45 * height, 0.06, 0.06),
        ];
        sdf.tube(&tongue, 4);
    }
    sdf.cone(v(21.6), 0.4, v(22.5), 0.22);
}
