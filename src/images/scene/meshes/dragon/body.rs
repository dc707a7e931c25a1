//! The body of the dragon.

use glam::{Vec3, Vec4, vec4};

use crate::scene::meshes::sdf::{Blend, Frame, Sdf, Tube, cosine, sine};

const SPINE: [Vec4; 22] = [
    vec4(0.62, 0.62, 0.84, 0.03),
    vec4(0.78, 0.34, 0.80, 0.05),
    vec4(0.55, 0.13, 0.74, 0.07),
    vec4(0.05, 0.11, 0.70, 0.095),
    vec4(-0.55, 0.14, 0.66, 0.125),
    vec4(-1.15, 0.17, 0.58, 0.155),
    vec4(-1.62, 0.22, 0.30, 0.185),
    vec4(-1.80, 0.42, -0.06, 0.21),
    vec4(-1.66, 0.80, -0.34, 0.235),
    vec4(-1.30, 1.02, -0.48, 0.26),
    vec4(-0.90, 0.86, -0.46, 0.285),
    vec4(-0.55, 0.70, -0.34, 0.32),
    vec4(-0.15, 0.78, -0.20, 0.335),
    vec4(0.25, 0.98, -0.10, 0.325),
    vec4(0.62, 1.02, 0.00, 0.335),
    vec4(0.95, 1.06, 0.05, 0.335),
    vec4(1.22, 1.28, 0.06, 0.285),
    vec4(1.27, 1.62, 0.03, 0.235),
    vec4(1.08, 1.92, 0.00, 0.205),
    vec4(0.95, 2.18, 0.02, 0.19),
    vec4(1.05, 2.40, 0.08, 0.185),
    vec4(1.26, 2.44, 0.17, 0.18),
];

/// The number of tube pieces between successive points of [`SPINE`].
const PIECES: usize = 6;

const AROUND: f32 = 16.0;

/// Returns the frame where the neck meets the head.
pub fn model(sdf: &mut Sdf) -> Frame {
    let tube = Tube::through(&SPINE, PIECES);
    let frames = tube.frames(12 * PIECES, Vec3::Y);
    scaly_tube(sdf, &tube, &frames);
    legs(sdf);
    crest(sdf, &tube, &frames);
    tail_tuft(sdf, &tube);
    frames[frames.len() - 1]
}

fn scaly_tube(sdf: &mut Sdf, tube: &Tube, frames: &[Frame]) {
    sdf.group(Blend { displacement: 0.15, ..Blend::smooth(0.0) });
    let mut rows = 0.0;
    for i in 0..tube.pieces() {
        let piece = tube.piece(i);
        let length = piece.a.distance(piece.b);
        let radius = 0.5 * (piece.radius_a + piece.radius_b);
        let next_rows = rows + length * AROUND / (std::f32::consts::TAU * radius);
        let (start, end) = (frames[i], frames[i + 1]);
        let height = (0.16 * radius).min(0.042);
        let bounding = 0.5 * length + piece.radius_a.max(piece.radius_b) + height;
        sdf.primitive((piece.a + piece.b) * 0.5, bounding, move |p| {
            let distance = piece.distance(p);
            if distance.abs() > 3.0 * height {
                return distance;
            }
            let t = ((p - piece.a).dot(piece.b - piece.a) / (length * length)).clamp(0.0, 1.0);
            let q = start.local(p).lerp(end.local(p), t);
            distance - height * scales(rows + (next_rows - rows) * t, q.x, q.y)
        });
        rows = next_rows;
    }
}

/// Returns a height in [0, 1]. (`x`, `y`) is the direction from the axis of the tube. +y points away from the belly.
fn scales(row: f32, x: f32, y: f32) -> f32 {
    let turn = (libm::atan2(f64::from(x), f64::from(y)) / std::f64::consts::TAU) as f32;
    let belly = ((turn.abs() - 0.36) / 0.03).clamp(0.0, 1.0);

    // Broad plates on the belly.
    let part = row * 0.6 - (row * 0.6).floor();
    let plate = (1.0 - (2.0 * part - 1.0) * (2.0 * part - 1.0)).sqrt();

    // Round scales. Odd rows are shifted by half a scale.
    let mut scale = 0.0f32;
    for step in -1..=1 {
        let line = row.floor() + step as f32;
        let shift = 0.5 * (line - 2.0 * (0.5 * line).floor());
        let across = turn * AROUND + shift;
        let across = 2.0 * (across - across.floor()) - 1.0;
        let along = row - line - 0.5;
        let round = 1.0 - across * across * 0.95 - along * along * 0.8;
        if round > 0.0 {
            scale = scale.max((round * 1.6).min(1.0) * (0.62 - 0.45 * along));
        }
    }
    scale * (1.0 - belly) + plate * belly
}

fn crest(sdf: &mut Sdf, tube: &Tube, frames: &[Frame]) {
    sdf.group(Blend::undisplaced(0.035));
    let mut since = 0.0;
    for (i, frame) in frames.iter().enumerate().take(tube.pieces() - 3).skip(4) {
        since += tube.centre(i).distance(tube.centre(i - 1));
        let radius = tube.0[i].w;
        if since < 0.06 + 0.28 * radius {
            continue;
        }
        since = 0.0;
        let height = 0.05 + 0.52 * radius;
        let foot = frame.at(0.0, radius * 0.92, 0.03);
        let tip = frame.at(0.0, radius + height, -0.75 * height);
        let ahead = frame.at(0.0, radius * 0.95, 0.03 + 0.3 * height);
        sdf.cone(foot, 0.032 + 0.05 * radius, tip, 0.013);
        sdf.cone(ahead, 0.025 + 0.03 * radius, (foot + tip) * 0.5, 0.02);
    }
}

fn tail_tuft(sdf: &mut Sdf, tube: &Tube) {
    sdf.group(Blend::undisplaced(0.03));
    let frame = Frame::looking(tube.centre(0), -tube.tangent(0), Vec3::X);
    for (side, length) in [(-0.85, 0.2), (-0.42, 0.3), (0.0, 0.38), (0.42, 0.3), (0.85, 0.2)] {
        let bend = frame.at(side * 0.12, 0.0, 0.5 * length - 0.06);
        sdf.cone(frame.at(0.0, 0.0, -0.04), 0.035, bend, 0.04);
        sdf.cone(bend, 0.04, frame.at(side * 0.2, 0.03 * side, length), 0.012);
    }
}

fn legs(sdf: &mut Sdf) {
    let v = Vec3::new;
    let legs = [
        ([v(0.98, 0.98, 0.24), v(0.86, 0.55, 0.56), v(1.12, 0.17, 0.60)], 0.2, v(0.9, 0.0, 0.35)),
        ([v(0.98, 0.98, -0.20), v(0.92, 0.55, -0.48), v(1.30, 0.17, -0.48)], 0.2, v(1.0, 0.0, -0.2)),
        ([v(-0.52, 0.68, -0.12), v(-0.12, 0.52, 0.28), v(-0.38, 0.16, 0.34)], 0.24, v(0.95, 0.0, 0.2)),
        ([v(-0.52, 0.68, -0.5), v(-0.2, 0.5, -0.72), v(-0.42, 0.16, -0.7)], 0.24, v(1.0, 0.0, -0.1)),
    ];
    for ([hip, knee, ankle], thick, ahead) in legs {
        sdf.group(Blend::smooth(0.12)).cone(hip, thick, knee, 0.58 * thick);
        sdf.group(Blend::smooth(0.05)).cone(knee, 0.56 * thick, ankle, 0.42 * thick);
        let frame = Frame::looking(ankle, ahead, Vec3::Y);
        sdf.group(Blend::smooth(0.06)).cone(frame.at(0.0, -0.07, 0.0), 0.085, frame.at(0.0, -0.09, 0.14), 0.07);
        foot(sdf, &frame);
        elbow_tufts(sdf, knee, knee - ankle, frame.ahead);
    }
}

fn foot(sdf: &mut Sdf, frame: &Frame) {
    let toes = [(-0.5, 1.0), (0.0, 1.1), (0.5, 1.0), (2.7, 0.7)];
    let toe = |turn: f32, long: f32, y: f32| frame.at(long * sine(turn), y, 0.04 + long * cosine(turn));
    sdf.group(Blend::smooth(0.04));
    for (turn, size) in toes {
        sdf.cone(toe(turn, 0.08, -0.09), 0.05, toe(turn, 0.24 * size, -0.105), 0.048);
    }
    sdf.group(Blend::undisplaced(0.012));
    for (turn, size) in toes {
        let knuckle = toe(turn, 0.255 * size, -0.09);
        let bend = toe(turn, 0.32 * size, -0.09);
        sdf.cone(knuckle, 0.038, bend, 0.026);
        sdf.cone(bend, 0.026, toe(turn, 0.38 * size, -0.145), 0.012);
    }
}

fn elbow_tufts(sdf: &mut Sdf, knee: Vec3, up: Vec3, ahead: Vec3) {
    sdf.group(Blend::undisplaced(0.04));
    let back = -ahead.normalize();
    for (rise, length) in [(-0.25, 0.2), (0.2, 0.27), (0.7, 0.2)] {
        let way = (back + up.normalize() * rise).normalize();
        sdf.cone(knee + way * 0.05, 0.05, knee + way * (0.08 + length), 0.012);
    }
}
