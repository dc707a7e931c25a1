//! Surfaces of revolution: a torus, and a sphere of meridians and parallels.

use glam::DVec3;

use super::{net, smooth};
use crate::scene::Model;

const SEGMENTS: u32 = 48;
const SIDES: u32 = 24;
const TUBE: f64 = 0.37;

pub fn torus() -> Model {
    let point = |i: u32| {
        let (cosine, sine) = on_circle(i / SIDES, SEGMENTS);
        let outward = DVec3::new(cosine, 0.0, sine);
        let (across, up) = on_circle(i % SIDES, SIDES);
        outward + (outward * across + DVec3::Y * up) * TUBE
    };
    let vertex = |segment: u32, side: u32| segment % SEGMENTS * SIDES + side % SIDES;
    let quad = |s: u32, t: u32| [vertex(s, t), vertex(s, t + 1), vertex(s + 1, t + 1), vertex(s + 1, t)];
    smooth((0..SEGMENTS * SIDES).map(point).collect(), net(SEGMENTS, SIDES, quad))
}

/// Each pole consists of `segments` vertices at one point, so `2 * segments` triangles have no area. The sphere
/// in the source report has the same poles.
///
/// # Panics
/// If `segments` is below 3 or `bands` is below 2.
pub fn uv_sphere(segments: u32, bands: u32) -> Model {
    assert!(segments >= 3 && bands >= 2, "a sphere has at least 3 segments and 2 bands, not {segments} and {bands}");
    let point = |i: u32| {
        let (height, radius) = on_circle(i / segments, 2 * bands);
        let (cosine, sine) = on_circle(i % segments, segments);
        DVec3::new(radius * cosine, height, radius * sine)
    };
    let vertex = |band: u32, segment: u32| band * segments + segment % segments;
    let quad = |b: u32, s: u32| [vertex(b, s + 1), vertex(b + 1, s + 1), vertex(b + 1, s), vertex(b, s)];
    smooth((0..segments * (bands + 1)).map(point).collect(), net(bands, segments, quad))
}

/// Cosine and sine of the angle `step / steps * TAU`. The results are exact for multiples of a quarter turn.
fn on_circle(step: u32, steps: u32) -> (f64, f64) {
    if (4 * step).is_multiple_of(steps) {
        return [(1.0, 0.0), (0.0, 1.0), (-1.0, 0.0), (0.0, -1.0)][(4 * step / steps % 4) as usize];
    }
    let (sine, cosine) = libm::sincos(f64::from(step) * std::f64::consts::TAU / f64::from(steps));
    (cosine, sine)
}
