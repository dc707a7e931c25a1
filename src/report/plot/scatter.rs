//! Speed against what it costs: memory or time of the build. A page shows any case, other forms the first one.

use super::curves::{CurvePoint, Curves, Line, Mark};

/// Several scenes and kinds of rays.
#[derive(Clone, Debug, PartialEq)]
pub struct Scatter {
    pub cases: Vec<ScatterCase>,
}

/// The structures with a time on one kind of rays of one scene.
#[derive(Clone, Debug, PartialEq)]
pub struct ScatterCase {
    pub scene: String,
    /// The kind of rays.
    pub rays: String,
    pub points: Vec<ScatterPoint>,
}

/// A structure. All numbers are positive.
#[derive(Clone, Debug, PartialEq)]
pub struct ScatterPoint {
    /// Structures have their colours.
    pub label: String,
    pub bytes: f64,
    pub build_ns: f64,
    pub ns_per_ray: f64,
    /// How its speed is to that of another one, in words.
    pub ratio: String,
}

impl Scatter {
    /// The first case over memory.
    pub(super) fn curves(&self) -> Curves {
        let dot = |point: &ScatterPoint| {
            let dot = CurvePoint::exact(point.bytes / f64::from(1 << 20), 1e3 / point.ns_per_ray);
            Line::new(&point.label, Mark::Dots, [dot])
        };
        let points = self.cases.first().map_or(&[][..], |case| &case.points);
        Curves::logarithmic("memory, MiB", "million rays a second", points.iter().map(dot).collect())
    }
}
