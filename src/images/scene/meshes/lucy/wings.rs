//! Two wings of separate, overlapping feathers.

use glam::Vec3;

use crate::scene::meshes::sdf::{Blend, Frame, RoundCone, Sdf, rounded_intersection};

pub fn model(sdf: &mut Sdf) {
    for side in [-1.0, 1.0] {
        wing(sdf, side);
    }
}

/// The arm of a wing, as points (distance from the plane x = 0, height, radius).
const ARM: [[f32; 3]; 6] = [
    [0.45, 14.2, 0.5],
    [1.5, 15.6, 0.52],
    [2.6, 17.4, 0.48],
    [3.8, 18.35, 0.42],
    [4.9, 18.2, 0.34],
    [5.75, 17.3, 0.22],
];

/// The curve of the tips of the longest feathers, as points (distance from the plane x = 0, height).
const TIPS: [[f32; 2]; 9] =
    [[0.9, 10.9], [1.6, 9.6], [2.4, 8.4], [3.2, 7.5], [4.1, 6.9], [5.0, 6.9], [5.8, 7.8], [6.4, 9.4], [6.85, 11.4]];

/// `front` moves the point towards +z.
fn place(side: f32, out: f32, up: f32, front: f32) -> Vec3 {
    let back = 1.05 + 0.62 * out - 0.028 * out * out + 0.05 * (15.0 - up).max(0.0) * 0.6;
    Vec3::new(side * out, up, front - back)
}

fn along<const N: usize>(line: &[[f32; N]], t: f32) -> [f32; N] {
    let s = t.clamp(0.0, 1.0) * (line.len() - 1) as f32;
    let i = (s as usize).min(line.len() - 2);
    std::array::from_fn(|k| line[i][k] + (line[i + 1][k] - line[i][k]) * (s - i as f32))
}

fn wing(sdf: &mut Sdf, side: f32) {
    sdf.group(Blend::smooth(0.15));
    let arm = ARM.map(|[out, up, radius]| place(side, out, up, 0.05).extend(radius));
    sdf.tube(&arm, 5);

    // `wide` is half of the width. `thick` is half of the thickness.
    for (count, length, wide, thick) in [(12, 1.0, 0.46, 0.07), (11, 0.56, 0.46, 0.19), (12, 0.31, 0.42, 0.30)] {
        sdf.group(Blend::smooth(0.03));
        for i in 0..count {
            let t = (i as f32 + 0.25) / (count as f32 - 0.5);
            let [out, up, _] = along(&ARM, 0.06 + 0.94 * t);
            let [tip_out, tip_up] = along(&TIPS, t);
            let (tip_out, tip_up) = (out + (tip_out - out) * length, up + (tip_up - up) * length);
            let (root, tip) = (place(side, out, up, 0.0), place(side, tip_out, tip_up, 0.0));
            feather(sdf, side, root, tip, wide, thick);
        }
    }
    sdf.group(Blend::smooth(0.04));
    for row in [0.0, 1.0] {
        for i in 0..15 {
            let t = (i as f32 + 0.5 + 0.5 * row) / 15.5;
            let [out, up, radius] = along(&ARM, t);
            let root = place(side, out, up + 0.2 - 0.35 * row, 0.0);
            let tip = root + Vec3::new(side * 0.12, -0.85, -0.1);
            feather(sdf, side, root, tip, 0.27, radius + 0.02 - 0.06 * row);
        }
    }
}

fn feather(sdf: &mut Sdf, side: f32, root: Vec3, tip: Vec3, wide: f32, thick: f32) {
    let frame = Frame::looking(root, tip - root, Vec3::new(0.42 * side, 0.0, 1.0));
    let length = root.distance(tip);
    let outline = RoundCone::new(Vec3::ZERO, 0.7 * wide, Vec3::new(0.0, 0.0, length - 0.8 * wide), wide);
    let radius = 0.5 * length + wide + thick;
    sdf.primitive((root + tip) * 0.5, radius, move |p| {
        let q = frame.local(p);
        let in_plane = outline.distance(Vec3::new(q.x, 0.0, q.z));
        let shaft = 0.07 * (1.0 - (q.x.abs() / 0.12)).max(0.0);
        let barb = (q.z - q.x.abs()) * 2.1;
        let barb = 0.018 * (2.0 * (barb - barb.floor()) - 1.0).abs();
        let bulge = 0.05 * (1.0 - (q.x / wide) * (q.x / wide)).max(0.0);
        let across = q.y.abs() - thick - bulge - shaft - barb;
        rounded_intersection(in_plane, across, 0.06)
    });
}
