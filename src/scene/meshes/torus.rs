//! The torus.

use glam::DVec3;

use super::{net, on_circle, smooth};
use crate::scene::Model;

/// A closed, smooth torus about the y axis: `segments` around the ring of radius 1, `sides` around the tube of radius
/// `tube`; `segments * sides` vertices, twice as many triangles.
///
/// # Panics
/// Below 3 segments or sides, or when `tube` does not lie between 0 and 1.
pub fn torus(segments: u32, sides: u32, tube: f64) -> Model {
    assert!(segments >= 3 && sides >= 3, "a torus has at least 3 segments and 3 sides, not {segments} and {sides}");
    assert!(tube > 0.0 && tube < 1.0, "the tube's radius lies between 0 and 1, {tube} does not");
    let mut points = Vec::new();
    for segment in 0..segments {
        let (cosine, sine) = on_circle(segment, segments);
        let outward = DVec3::new(cosine, 0.0, sine);
        for side in 0..sides {
            let (across, up) = on_circle(side, sides);
            points.push(outward + (outward * across + DVec3::Y * up) * tube);
        }
    }

    let vertex = |segment: u32, side: u32| segment % segments * sides + side % sides;
    let quad = |s: u32, t: u32| [vertex(s, t), vertex(s, t + 1), vertex(s + 1, t + 1), vertex(s + 1, t)];
    smooth(points, net(segments, sides, quad))
}
