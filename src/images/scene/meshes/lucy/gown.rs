//! The gown and the legs of the statue.

use glam::{Vec3, vec4};

use crate::scene::meshes::{
    noise,
    sdf::{Blend, Sdf, rounded_intersection, sine},
};

/// Each horizontal section has a height, a half width, a half depth and a centre (x, z).
const BODY: [[f32; 5]; 12] = [
    [1.2, 2.45, 2.15, 0.0, 0.05],
    [2.0, 2.35, 2.05, 0.0, 0.05],
    [3.2, 2.05, 1.80, 0.0, 0.05],
    [5.5, 1.82, 1.55, 0.0, 0.05],
    [8.0, 1.72, 1.42, 0.0, 0.0],
    [10.0, 1.70, 1.36, -0.05, -0.05],
    [11.3, 1.45, 1.20, -0.10, -0.05],
    [12.6, 1.18, 0.98, -0.10, 0.0],
    [14.0, 1.38, 1.12, -0.03, 0.05],
    [15.2, 1.50, 1.05, 0.0, 0.0],
    [16.0, 1.42, 0.75, 0.0, -0.05],
    [16.7, 0.75, 0.50, 0.0, -0.05],
];

pub fn model(sdf: &mut Sdf) {
    let middle = Vec3::new(0.0, 9.0, 0.0);
    sdf.group(Blend::smooth(0.0)).primitive(middle, 8.6, |p| {
        let (distance, turn) = section_distance(p, 0.0);
        capped(distance - folds(p, turn), p.y, 1.2, 16.6)
    });
    legs(sdf);
    overfold(sdf);
    bodice(sdf);
    sash(sdf);
    hanging_cloth(sdf);
}

fn smoothstep(low: f32, high: f32, x: f32) -> f32 {
    let t = ((x - low) / (high - low)).clamp(0.0, 1.0);
    t * t * (3.0 - 2.0 * t)
}

/// Returns the approximate signed distance to the body and the angle of `p` around the body. `wider` is added to the
/// half width and the half depth of the body. The angle in radians is 0 at +z and grows towards +x.
fn section_distance(p: Vec3, wider: f32) -> (f32, f32) {
    let i = BODY.iter().rposition(|section| section[0] <= p.y).unwrap_or(0).min(BODY.len() - 2);
    let (low, high) = (&BODY[i], &BODY[i + 1]);
    let t = smoothstep(low[0], high[0], p.y) * 0.5 + 0.5 * ((p.y - low[0]) / (high[0] - low[0])).clamp(0.0, 1.0);
    let [_, a, b, x, z]: [f32; 5] = std::array::from_fn(|k| low[k] + (high[k] - low[k]) * t);
    let (a, b, x, z) = (a + wider, b + wider, p.x - x, p.z - z);
    let k = ((x / a) * (x / a) + (z / b) * (z / b)).sqrt();
    let slope = ((x / (a * a)) * (x / (a * a)) + (z / (b * b)) * (z / (b * b))).sqrt();
    let distance = if slope < 1e-6 { -a.min(b) } else { k * (k - 1.0) / slope };
    (0.9 * distance, libm::atan2(f64::from(x / a), f64::from(z / b)) as f32)
}

fn capped(side: f32, y: f32, low: f32, high: f32) -> f32 {
    side.max(low - y).max(y - high)
}

fn pleat(phase: f32) -> f32 {
    sine(phase).abs()
}

fn folds(p: Vec3, turn: f32) -> f32 {
    let drop = 1.0 - smoothstep(2.0, 12.0, p.y);
    let wander = noise::smooth(Vec3::new(turn * 1.3, p.y * 0.16, 0.0), 3);
    let fine_wander = noise::smooth(Vec3::new(turn * 2.6, p.y * 0.33, 5.0), 4);
    let wide = pleat(5.0 * turn + 1.5 * wander + 0.05 * p.y);
    let narrow = pleat(11.0 * turn - 2.2 * wander + 1.1 * fine_wander);
    let knee = Vec3::new((p.x - 0.95) / 0.75, (p.y - 6.6) / 2.6, (p.z - 1.5) / 1.0).length_squared();
    let tight = 1.0 - 0.75 / (1.0 + knee * knee);
    let depth = 0.07 + 0.46 * drop;
    let long = depth * tight * (0.62 * wide + 0.38 * narrow * (0.6 + 0.4 * wander) - 0.35);

    let breast = smoothstep(12.8, 13.6, p.y);
    let sag = pleat(3.4 * (p.y - 0.55 * p.x.abs() - 0.3 * p.x * p.x) + 0.8 * fine_wander);
    long * (1.0 - breast) + breast * 0.09 * sag * (1.0 - smoothstep(15.4, 16.0, p.y))
}

fn legs(sdf: &mut Sdf) {
    let v = Vec3::new;
    let leg = [
        vec4(0.70, 10.2, 0.20, 0.95),
        vec4(0.85, 8.4, 0.62, 0.86),
        vec4(0.93, 6.7, 0.90, 0.74),
        vec4(0.95, 4.8, 0.86, 0.58),
        vec4(0.95, 2.6, 0.60, 0.42),
    ];
    sdf.group(Blend::smooth(0.55)).tube(&leg, 8);
    sdf.group(Blend::smooth(0.06));
    for (x, turn) in [(0.95, 0.12), (-0.85, -0.18)] {
        sdf.cone(v(x, 1.98, 1.5), 0.34, v(x + turn, 1.92, 2.35), 0.22);
        for i in 0..4 {
            let across = x + turn + 0.15 * (i as f32 - 1.5);
            let long = 2.55 - 0.04 * (i as f32 - 1.5) * (i as f32 - 1.5);
            sdf.cone(v(across, 1.9, 2.3), 0.13, v(across + 0.2 * turn, 1.87, long), 0.11);
        }
    }
}

/// Adds the overfold and the belt.
fn overfold(sdf: &mut Sdf) {
    sdf.group(Blend::smooth(0.05)).primitive(Vec3::new(0.0, 11.0, 0.0), 3.2, |p| {
        let flare = 0.10 + 0.09 * (12.6 - p.y).max(0.0);
        let (distance, turn) = section_distance(p, flare);
        let wander = noise::smooth(Vec3::new(turn * 1.5, p.y * 0.3, 9.0), 5);
        let ridges = pleat(8.0 * turn + 1.2 * wander + 0.5);
        let depth = 0.03 + 0.08 * (12.8 - p.y).max(0.0);
        let hem = 9.55 + 0.75 * sine(2.0 * turn + 0.6) + 0.4 * ridges + 0.2 * wander;
        capped(distance - depth * (ridges - 0.4), p.y, hem, 12.9).max(-distance - flare - 0.3)
    });
    sdf.group(Blend::smooth(0.03)).primitive(Vec3::new(-0.1, 12.75, 0.0), 1.8, |p| {
        let (distance, turn) = section_distance(p, 0.13);
        let cord = 0.04 * pleat(14.0 * turn + 9.0 * p.y);
        let across = (p.y - 12.75).abs() - 0.13;
        rounded_intersection(distance.abs() - 0.1, across, 0.08) - cord
    });
}

fn bodice(sdf: &mut Sdf) {
    let v = Vec3::new;
    sdf.group(Blend::smooth(0.25)).sphere(v(0.56, 14.6, 0.80), 0.58).sphere(v(-0.56, 14.6, 0.80), 0.58);
    sdf.group(Blend::smooth(0.4)).cone(v(-1.35, 15.85, -0.05), 0.52, v(1.35, 15.8, -0.05), 0.52);
    sdf.group(Blend::smooth(0.12));
    let neckline = [
        vec4(-1.0, 16.3, 0.25, 0.11),
        vec4(-0.62, 15.75, 0.78, 0.11),
        vec4(0.0, 15.3, 1.08, 0.11),
        vec4(0.62, 15.75, 0.78, 0.11),
        vec4(1.0, 16.3, 0.25, 0.11),
    ];
    sdf.tube(&neckline, 5);
}

fn sash(sdf: &mut Sdf) {
    sdf.group(Blend::smooth(0.06));
    for i in 0..4 {
        let down = 0.24 * i as f32;
        let strand = [
            vec4(0.75, 15.9 - down, -1.15, 0.17),
            vec4(1.15 - 0.2 * down, 16.45 - 0.5 * down, -0.2, 0.18),
            vec4(0.98 - 0.5 * down, 15.75 - 0.6 * down, 0.85, 0.17),
            vec4(0.35 - 0.4 * down, 14.75 - down, 1.32, 0.17),
            vec4(-0.45 - 0.1 * down, 13.7 - down, 1.25, 0.17),
            vec4(-1.15, 12.85 - down, 0.85, 0.18),
            vec4(-1.52, 12.2 - down, 0.0, 0.19),
            vec4(-1.1, 12.3 - down, -0.95, 0.18),
            vec4(0.0, 13.4 - down, -1.3, 0.17),
            vec4(0.75, 15.9 - down, -1.15, 0.17),
        ];
        sdf.tube(&strand, 6);
    }
}

fn hanging_cloth(sdf: &mut Sdf) {
    sdf.group(Blend::smooth(0.14));
    for i in 0..7 {
        let s = i as f32;
        let (x, z) = (2.55 - 0.13 * s, 0.25 + 0.24 * s);
        let sway = 0.05 * sine(2.1 * s);
        let foot = 4.7 + 0.42 * s + 0.15 * sine(2.6 * s);
        let pleat = [
            vec4(x, 12.75 + 0.03 * s, z, 0.22),
            vec4(x + 0.12, 11.6, z + 0.02, 0.20),
            vec4(x + 0.06 + sway, 9.6, z - 0.05, 0.19),
            vec4(x + 0.02 - sway, 7.8, z + 0.05, 0.22),
            vec4(x + 0.1 + sway, foot, z, 0.20),
        ];
        sdf.tube(&pleat, 5);
    }
}
