//! The head: open jaws with teeth and tongue, brows, eyes, horns, a frill, a beard and whiskers.

use glam::Vec3;

use crate::scene::meshes::clay::{Ball, Clay, Frame, Joint, Round, Tube};

/// Adds the head at the end of the neck.
pub fn model(clay: &mut Clay, neck: Frame) {
    let origin = neck.at(0.0, 0.01, 0.12);
    let head = Frame::looking(origin, Vec3::new(0.80, 0.04, 0.60), Vec3::Y);
    skull(clay, &head);
    jaws(clay, &head);
    eyes(clay, &head);
    horns(clay, &head);
    frill(clay, &head);
    teeth(clay, &head);
    hair(clay, &head);
}

fn stretched(head: &Frame, at: [f32; 3], radii: [f32; 3]) -> Ball {
    let origin = head.at(at[0], at[1], at[2]);
    Ball { frame: Frame { origin, ..*head }, radii: radii.into() }
}

fn skull(clay: &mut Clay, head: &Frame) {
    clay.part(Joint { grain: 0.5, ..Joint::smooth(0.08) });
    clay.ball(stretched(head, [0.0, 0.03, 0.0], [0.20, 0.19, 0.25]));
    clay.part(Joint { grain: 0.4, ..Joint::smooth(0.07) });
    clay.cone(head.at(0.0, 0.02, 0.10), 0.16, head.at(0.0, 0.0, 0.50), 0.105);
    clay.part(Joint::bare(0.05));
    clay.ball(stretched(head, [0.0, 0.07, 0.53], [0.095, 0.075, 0.085]));
}

fn jaws(clay: &mut Clay, head: &Frame) {
    // The lower jaw hangs open; the palate is hollowed out above it.
    clay.part(Joint { grain: 0.4, ..Joint::smooth(0.04) });
    clay.cone(head.at(0.0, -0.10, 0.02), 0.12, head.at(0.0, -0.36, 0.36), 0.062);
    clay.part(Joint::carve(0.03));
    clay.cone(head.at(0.0, -0.12, 0.16), 0.075, head.at(0.0, -0.19, 0.58), 0.125);

    // Lips.
    clay.part(Joint::bare(0.02));
    for side in [-1.0, 1.0] {
        let lip = [
            Round(side * 0.135, -0.06, 0.12, 0.03),
            Round(side * 0.125, -0.045, 0.30, 0.028),
            Round(side * 0.085, -0.05, 0.48, 0.026),
            Round(0.0, -0.05, 0.575, 0.026),
        ];
        tube(clay, head, &lip, 4);
    }
    clay.part(Joint::bare(0.02));
    let tongue = [
        Round(0.0, -0.16, 0.12, 0.05),
        Round(0.0, -0.20, 0.30, 0.042),
        Round(0.0, -0.26, 0.44, 0.034),
        Round(0.0, -0.25, 0.54, 0.024),
        Round(0.0, -0.18, 0.60, 0.013),
    ];
    tube(clay, head, &tongue, 4);
}

fn eyes(clay: &mut Clay, head: &Frame) {
    for side in [-1.0, 1.0] {
        clay.part(Joint::bare(0.03));
        clay.cone(head.at(side * 0.10, 0.14, 0.30), 0.042, head.at(side * 0.17, 0.20, 0.02), 0.05);
        clay.part(Joint::carve(0.02)).sphere(head.at(side * 0.185, 0.095, 0.17), 0.062);
        clay.part(Joint::bare(0.006)).sphere(head.at(side * 0.152, 0.098, 0.165), 0.052);
        clay.part(Joint::bare(0.02)).sphere(head.at(side * 0.06, 0.11, 0.56), 0.042);
        clay.part(Joint::carve(0.01)).sphere(head.at(side * 0.068, 0.11, 0.61), 0.026);
    }
}

fn horns(clay: &mut Clay, head: &Frame) {
    for side in [-1.0, 1.0] {
        clay.part(Joint::bare(0.03));
        let horn = [
            Round(side * 0.10, 0.17, 0.00, 0.062),
            Round(side * 0.15, 0.34, -0.10, 0.052),
            Round(side * 0.20, 0.46, -0.28, 0.040),
            Round(side * 0.23, 0.50, -0.48, 0.027),
            Round(side * 0.22, 0.60, -0.64, 0.013),
        ];
        tube(clay, head, &horn, 5);
        clay.part(Joint::bare(0.02));
        let prong = [
            Round(side * 0.16, 0.38, -0.14, 0.034),
            Round(side * 0.21, 0.50, -0.14, 0.026),
            Round(side * 0.24, 0.60, -0.20, 0.013),
        ];
        tube(clay, head, &prong, 4);
        clay.part(Joint::smooth(0.03));
        let ear = [
            Round(side * 0.19, 0.08, -0.08, 0.045),
            Round(side * 0.31, 0.12, -0.18, 0.05),
            Round(side * 0.42, 0.17, -0.30, 0.013),
        ];
        tube(clay, head, &ear, 4);
    }
}

/// Blades that spread backwards from the cheeks.
fn frill(clay: &mut Clay, head: &Frame) {
    for side in [-1.0, 1.0] {
        clay.part(Joint::bare(0.03));
        for (rise, out, length) in [(-0.42, 0.10, 0.30), (-0.24, 0.2, 0.36), (-0.05, 0.26, 0.34), (0.12, 0.22, 0.3)] {
            let foot = [side * 0.15, rise * 0.35, -0.04];
            let blade = [
                Round(foot[0], foot[1], foot[2], 0.045),
                Round(side * (0.15 + out * 0.7), rise * 0.7, -0.06 - length * 0.5, 0.042),
                Round(side * (0.15 + out), rise + 0.04, -0.08 - length, 0.013),
            ];
            tube(clay, head, &blade, 4);
        }
    }
    // A mane on top of the head, towards the crest of the neck.
    clay.part(Joint::bare(0.03));
    for (back, rise) in [(0.02, 0.14), (-0.1, 0.17), (-0.2, 0.16)] {
        clay.cone(head.at(0.0, 0.16, back), 0.05, head.at(0.0, 0.2 + rise, back - 0.2), 0.013);
    }
}

fn teeth(clay: &mut Clay, head: &Frame) {
    clay.part(Joint::bare(0.006));
    for side in [-1.0, 1.0] {
        for (z, x, long) in
            [(0.54, 0.045, 0.11), (0.46, 0.085, 0.07), (0.38, 0.105, 0.06), (0.30, 0.12, 0.06), (0.22, 0.13, 0.05)]
        {
            let root = head.at(side * x, -0.05, z);
            clay.cone(root, 0.022, head.at(side * x * 0.95, -0.06 - long, z + 0.01), 0.011);
        }
        for (z, x, y, long) in [(0.38, 0.035, -0.32, 0.11), (0.31, 0.06, -0.265, 0.07), (0.24, 0.075, -0.215, 0.06)] {
            clay.cone(head.at(side * x, y, z), 0.02, head.at(side * x, y + long, z + 0.02), 0.011);
        }
    }
}

fn hair(clay: &mut Clay, head: &Frame) {
    clay.part(Joint::bare(0.025));
    for (z, y, long) in [(0.34, -0.39, 0.16), (0.24, -0.34, 0.22), (0.14, -0.28, 0.24), (0.03, -0.22, 0.2)] {
        clay.cone(head.at(0.0, y, z), 0.04, head.at(0.0, y - 0.6 * long, z - 0.35 * long), 0.03);
        clay.cone(head.at(0.0, y - 0.6 * long, z - 0.35 * long), 0.03, head.at(0.0, y - long, z - long), 0.011);
    }
    for side in [-1.0, 1.0] {
        let whisker = [
            Round(side * 0.08, 0.04, 0.54, 0.026),
            Round(side * 0.20, 0.06, 0.60, 0.023),
            Round(side * 0.32, -0.04, 0.56, 0.020),
            Round(side * 0.40, -0.16, 0.42, 0.018),
            Round(side * 0.46, -0.20, 0.24, 0.015),
            Round(side * 0.54, -0.14, 0.10, 0.012),
        ];
        tube(clay, head, &whisker, 5);
    }
}

/// A tube given in head coordinates.
fn tube(clay: &mut Clay, head: &Frame, points: &[Round], steps: usize) {
    let outside = |&Round(x, y, z, r): &Round| {
        let p = head.at(x, y, z);
        Round(p.x, p.y, p.z, r)
    };
    let points: Vec<Round> = points.iter().map(outside).collect();
    clay.tube(&Tube::through(&points, steps));
}
