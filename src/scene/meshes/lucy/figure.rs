//! Head with hair, neck, arms and hands, and the torch.

use glam::Vec3;

use crate::scene::meshes::clay::{Ball, Clay, Frame, Joint, Round, Tube, cosine, sine};

/// Adds them.
pub fn model(clay: &mut Clay) {
    let v = Vec3::new;
    clay.part(Joint::smooth(0.3)).cone(v(0.0, 16.1, -0.05), 0.62, v(0.0, 17.5, 0.05), 0.46);
    let head = Frame::looking(v(0.0, 18.1, 0.12), v(-0.22, -0.03, 1.0), v(-0.06, 1.0, 0.0));
    face(clay, &head);
    hair(clay, &head);
    raised_arm(clay);
    lowered_arm(clay);
    torch(clay);
}

fn ball(head: &Frame, at: [f32; 3], radii: [f32; 3]) -> Ball {
    Ball { frame: Frame { origin: head.at(at[0], at[1], at[2]), ..*head }, radii: radii.into() }
}

fn face(clay: &mut Clay, head: &Frame) {
    clay.part(Joint::smooth(0.2));
    clay.ball(ball(head, [0.0, 0.12, 0.0], [0.76, 0.92, 0.86]));
    clay.part(Joint::smooth(0.3)).cone(head.at(0.0, -0.35, 0.3), 0.48, head.at(0.0, -0.72, 0.55), 0.25);
    for side in [-1.0, 1.0] {
        clay.part(Joint::carve(0.14)).ball(ball(head, [side * 0.30, 0.04, 0.92], [0.19, 0.12, 0.16]));
        clay.part(Joint::smooth(0.02)).ball(ball(head, [side * 0.29, 0.03, 0.70], [0.17, 0.11, 0.14]));
        clay.part(Joint::smooth(0.05));
        clay.cone(head.at(side * 0.12, 0.22, 0.84), 0.06, head.at(side * 0.46, 0.24, 0.66), 0.06);
        clay.part(Joint::smooth(0.2)).sphere(head.at(side * 0.36, -0.26, 0.55), 0.24);
    }
    clay.part(Joint::smooth(0.15)).ball(ball(head, [0.0, -0.45, 0.55], [0.36, 0.30, 0.29]));
    clay.part(Joint::smooth(0.08));
    clay.cone(head.at(0.0, 0.16, 0.84), 0.07, head.at(0.0, -0.18, 0.97), 0.10);
    clay.part(Joint::smooth(0.04));
    clay.ball(ball(head, [0.0, -0.455, 0.83], [0.25, 0.055, 0.08]));
    clay.ball(ball(head, [0.0, -0.575, 0.80], [0.20, 0.06, 0.08]));
}

/// Waved strands from the parting around the head to a knot at the back, and two locks on the shoulders.
fn hair(clay: &mut Clay, head: &Frame) {
    clay.part(Joint::smooth(0.05)).ball(ball(head, [0.0, 0.26, -0.14], [0.83, 0.86, 0.86]));
    for side in [-1.0, 1.0] {
        clay.part(Joint::smooth(0.05));
        for i in 0..8 {
            let s = i as f32 / 7.0;
            let parting = Vec3::new(0.02 * side, 0.78 - 0.1 * s, 0.62 - 1.2 * s);
            let temple = Vec3::new(side * (1.5 - 0.6 * s), 0.8 * s - 0.35, 0.75 - 1.5 * s);
            let knot = Vec3::new(side * 0.1, -0.25 + 0.2 * s, -1.0);
            let strand: Vec<Round> = (0..9)
                .map(|k| {
                    let t = k as f32 / 8.0;
                    let way = parting * (1.0 - t) * (1.0 - t) + temple * 2.0 * t * (1.0 - t) + knot * t * t;
                    let p = way.normalize() * (0.87 + 0.035 * sine(11.0 * t + 4.0 * s));
                    Round(p.x, p.y + 0.26, p.z - 0.14, 0.10 + 0.02 * sine(3.0 * t))
                })
                .collect();
            strands(clay, head, &strand, 3);
        }
        let lock = [
            Round(side * 0.55, -0.35, -0.55, 0.17),
            Round(side * 0.68, -0.9, -0.42, 0.19),
            Round(side * 0.60, -1.4, -0.2, 0.18),
            Round(side * 0.72, -1.85, 0.15, 0.17),
            Round(side * 0.64, -2.3, 0.42, 0.15),
            Round(side * 0.70, -2.75, 0.62, 0.09),
        ];
        strands(clay, head, &lock, 5);
    }
    clay.part(Joint::smooth(0.06)).ball(ball(head, [0.0, -0.1, -1.08], [0.46, 0.42, 0.38]));
    clay.part(Joint::smooth(0.03));
    for i in 0..6 {
        let angle = i as f32 * std::f32::consts::FRAC_PI_3;
        let (c, s) = (cosine(angle), sine(angle));
        clay.cone(head.at(0.36 * c, -0.1 + 0.33 * s, -1.12), 0.13, head.at(0.12 * s, -0.1 + 0.1 * c, -1.42), 0.1);
    }
    // A diadem.
    clay.part(Joint::smooth(0.03));
    let band: Vec<Round> = (-8..=8)
        .map(|i| {
            let angle = i as f32 * 0.17;
            Round(0.88 * sine(angle), 0.62, 0.88 * cosine(angle) - 0.14, 0.1)
        })
        .collect();
    strands(clay, head, &band, 2);
    for i in -3..=3 {
        let angle = i as f32 * 0.3;
        let (x, z) = (0.88 * sine(angle), 0.88 * cosine(angle) - 0.14);
        let high = 0.42 - 0.03 * (i * i) as f32;
        clay.cone(head.at(x, 0.64, z), 0.1, head.at(x * 1.08, 0.7 + high, z * 1.04), 0.06);
    }
}

/// A tube given in head coordinates.
fn strands(clay: &mut Clay, head: &Frame, points: &[Round], steps: usize) {
    let outside = |&Round(x, y, z, r): &Round| {
        let p = head.at(x, y, z);
        Round(p.x, p.y, p.z, r)
    };
    let points: Vec<Round> = points.iter().map(outside).collect();
    clay.tube(&Tube::through(&points, steps));
}

fn raised_arm(clay: &mut Clay) {
    let v = Vec3::new;
    let (shoulder, elbow, wrist) = (v(-1.45, 15.85, 0.0), v(-2.85, 16.95, 0.45), v(-2.95, 19.1, 0.85));
    clay.part(Joint::smooth(0.3)).cone(shoulder, 0.56, elbow, 0.42);
    clay.part(Joint::smooth(0.12)).cone(elbow, 0.42, wrist, 0.27);
    clay.part(Joint::smooth(0.1)).cone(wrist, 0.25, v(-2.93, 19.5, 0.92), 0.34);
    grip(clay, v(-2.92, 19.62, 1.06), 0.22);

    // The sleeve: rings of cloth pushed together on the upper arm, and a corner that hangs down.
    clay.part(Joint::smooth(0.07));
    for i in 0..5 {
        let t = 0.18 + 0.14 * i as f32;
        let at = shoulder.lerp(elbow, t);
        clay.cone(at, 0.60 - 0.015 * i as f32, at + v(-0.06, -0.28, 0.02), 0.5);
    }
    for i in 0..5 {
        let t = i as f32 / 4.0;
        let top = shoulder.lerp(elbow, 0.15 + 0.5 * t) + v(0.0, -0.45, 0.25 * (t - 0.5));
        clay.cone(top, 0.2, top + v(0.12, -0.9 - 0.7 * sine(2.0 * t + 0.6), -0.05), 0.15);
    }
}

fn lowered_arm(clay: &mut Clay) {
    let v = Vec3::new;
    let (shoulder, elbow, wrist) = (v(1.45, 15.75, 0.0), v(2.25, 13.35, -0.1), v(2.05, 12.85, 1.75));
    clay.part(Joint::smooth(0.3)).cone(shoulder, 0.56, elbow, 0.42);
    clay.part(Joint::smooth(0.1)).cone(elbow, 0.42, wrist, 0.26);
    clay.part(Joint::smooth(0.1)).cone(wrist, 0.24, v(1.95, 12.9, 2.2), 0.29);
    clay.part(Joint::smooth(0.03));
    for i in 0..4 {
        let s = i as f32;
        let knuckle = v(1.78 + 0.15 * s, 13.02 - 0.05 * s, 2.36);
        let bend = knuckle + v(-0.02, -0.08, 0.34);
        clay.cone(knuckle, 0.115, bend, 0.105);
        clay.cone(bend, 0.105, bend + v(-0.03, -0.3, 0.06), 0.08);
    }
    clay.cone(v(1.72, 12.92, 2.15), 0.12, v(1.62, 12.75, 2.5), 0.1);
    clay.part(Joint::smooth(0.07));
    for i in 0..5 {
        let at = shoulder.lerp(elbow, 0.18 + 0.14 * i as f32);
        clay.cone(at, 0.60 - 0.012 * i as f32, at + v(0.12, -0.16, 0.05), 0.54);
    }
}

/// Four fingers and a thumb around the handle at `at`.
fn grip(clay: &mut Clay, at: Vec3, handle: f32) {
    clay.part(Joint::smooth(0.03));
    for i in 0..4 {
        let up = 0.2 * (i as f32 - 1.5);
        let ring: Vec<Round> = (0..6)
            .map(|k| {
                let angle = 0.6 + k as f32 * 0.62;
                let r = handle + 0.12;
                Round(at.x + r * cosine(angle), at.y + up, at.z + r * sine(angle) - 0.05, 0.12)
            })
            .collect();
        clay.tube(&Tube::through(&ring, 3));
    }
    clay.cone(at + Vec3::new(0.28, 0.1, -0.1), 0.14, at + Vec3::new(0.12, 0.48, 0.22), 0.11);
}

/// Handle with rings, a cup, and a flame of five tongues.
fn torch(clay: &mut Clay) {
    let (x, z) = (-2.92, 1.06);
    let v = |y: f32| Vec3::new(x, y, z);
    clay.part(Joint::smooth(0.06));
    clay.cone(v(18.3), 0.15, v(20.9), 0.23);
    clay.sphere(v(18.25), 0.24);
    clay.part(Joint::smooth(0.05));
    for (y, r) in [(18.7, 0.2), (20.35, 0.28), (20.75, 0.33), (21.0, 0.3)] {
        clay.ball(Ball::upright(v(y), Vec3::new(r, 0.1, r)));
    }
    clay.part(Joint::smooth(0.05)).cone(v(20.95), 0.26, v(21.45), 0.52);
    clay.ball(Ball::upright(v(21.62), Vec3::new(0.72, 0.13, 0.72)));
    clay.part(Joint::smooth(0.12));
    for (i, height) in [(0, 1.0), (1, 0.8), (2, 1.15), (3, 0.72), (4, 0.9)] {
        let angle = 1.256_637 * i as f32;
        let (c, s) = (cosine(angle), sine(angle));
        let curl =
            |y: f32, r: f32, thick: f32| Round(x + r * c - 0.1 * y * s, 21.6 + y, z + r * s + 0.1 * y * c, thick);
        let tongue = [
            curl(0.0, 0.38, 0.24),
            curl(0.4 * height, 0.44, 0.25),
            curl(0.8 * height, 0.26, 0.2),
            curl(1.15 * height, 0.22, 0.13),
            curl(1.45 * height, 0.06, 0.06),
        ];
        clay.tube(&Tube::through(&tongue, 4));
    }
    clay.cone(v(21.6), 0.4, v(22.5), 0.22);
}
