//! Speed against memory or build time. A page shows any case, other formats the first one.

use super::scatter::{Point, Scatter};

#[derive(Clone, Debug, PartialEq)]
pub struct Tradeoff {
    pub cases: Vec<TradeoffCase>,
}

/// The structures with a time on one workload of one scene.
#[derive(Clone, Debug, PartialEq)]
pub struct TradeoffCase {
    pub scene: String,
    pub workload: String,
    pub points: Vec<TradeoffPoint>,
}

/// A structure. All numbers are positive.
#[derive(Clone, Debug, PartialEq)]
pub struct TradeoffPoint {
    /// Structures have fixed colours.
    pub label: String,
    pub bytes: f64,
    pub build_ns: f64,
    pub ns_per_ray: f64,
    /// Its speed relative to another structure, in words.
    pub ratio: String,
}

impl Tradeoff {
    /// The first case against memory.
    pub fn scatter(&self) -> Scatter {
        let of_case = self.cases.first().map_or(&[][..], |case| &case.points);
        let is_better = |a: &TradeoffPoint, b: &TradeoffPoint| {
            let [a, b] = [a, b].map(|point| [point.bytes, point.ns_per_ray]);
            a != b && a[0] <= b[0] && a[1] <= b[1]
        };
        let point = |point: &TradeoffPoint| Point {
            x: point.bytes / f64::from(1 << 20),
            y: 1e3 / point.ns_per_ray,
            is_bound: false,
            is_front: !of_case.iter().any(|other| is_better(other, point)),
            label: point.label.clone(),
            group: point.label.clone(),
        };
        Scatter {
            x_title: "memory, MiB".into(),
            y_title: "million rays per second".into(),
            points: of_case.iter().map(point).collect(),
        }
    }
}
