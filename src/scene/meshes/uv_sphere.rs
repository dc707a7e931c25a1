//! The sphere of meridians and parallels.

use glam::DVec3;

use super::{net, on_circle, smooth};
use crate::scene::Model;

/// A smooth sphere of radius 1 with poles on the y axis: `segments * (bands + 1)` vertices, `2 * segments * bands`
/// triangles, including `2 * segments` without area.
///
/// Each pole is `segments` vertices in one point, and the outermost bands are quadrilaterals like all others: half of
/// each is degenerate, as in the course's sphere.
///
/// # Panics
/// Below 3 segments or 2 bands.
pub fn uv_sphere(segments: u32, bands: u32) -> Model {
    assert!(segments >= 3 && bands >= 2, "a sphere has at least 3 segments and 2 bands, not {segments} and {bands}");
    let mut points = Vec::new();
    for band in 0..=bands {
        let (height, radius) = on_circle(band, 2 * bands);
        for segment in 0..segments {
            let (cosine, sine) = on_circle(segment, segments);
            points.push(DVec3::new(radius * cosine, height, radius * sine));
        }
    }

    let vertex = |band: u32, segment: u32| band * segments + segment % segments;
    let quad = |b: u32, s: u32| [vertex(b, s + 1), vertex(b + 1, s + 1), vertex(b + 1, s), vertex(b, s)];
    smooth(points, net(bands, segments, quad))
}
