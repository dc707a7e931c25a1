//! The cells of the factorial design: all combinations of split plane, stop rule and traversal.

use crate::names::named_enum;
use crate::request::TWIN;

named_enum! {
    /// The factors of the design.
    #[derive(Clone, Copy, Debug, PartialEq, Eq)]
    pub enum Factor {
        Plane = "plane",
        Stop = "stop rule",
        Traversal = "traversal",
    }
}

/// The name of a factor level, and its structure options.
pub type Level = (&'static str, &'static str);

/// The first element belongs to [`Treatment::REPORT`]. The last element belongs to [`Treatment::SAH`].
const PLANES: [Level; 6] = [
    ("vertex median cyclic", "plane=vertex-median,axis=cyclic"),
    ("vertex median longest", "plane=vertex-median,axis=longest"),
    ("spatial median longest", "plane=spatial-median,axis=longest"),
    ("centroid median longest", "plane=centroid-median,axis=longest"),
    ("SAH binned", "plane=sah-binned"),
    ("SAH exact", "plane=sah-sweep"),
];

/// The first element belongs to [`Treatment::REPORT`]. The last element belongs to [`Treatment::SAH`].
const STOPS: [Level; 3] = [
    ("report", "stop=report,leaf=100,threshold=0.7,limit=below"),
    ("leaf 8", "stop=leaf,leaf=8,limit=at-most"),
    ("SAH", "stop=sah"),
];

/// The first element belongs to [`Treatment::REPORT`]. The last element belongs to [`Treatment::SAH`].
const TRAVERSALS: [Level; 2] =
    [("child boxes", "traversal=child-boxes"), ("plane intervals", "traversal=plane-intervals")];

/// All cells have these options, with the default values of `sah-kd`. The rules of [`Treatment::REPORT`] use only
/// `duplication`.
const COMMON: &str = "traversal_cost=1.0,intersection_cost=0.7,empty_bonus=0.2,duplication=8.0";

/// Trees that are built twice, for the A/A check.
pub const TWINS: [Treatment; 2] = [Treatment::REPORT, Treatment::SAH];

/// Pairs of cell and role: first all cells, then [`TWINS`].
pub fn trees() -> impl Iterator<Item = (Treatment, String)> {
    Treatment::all().map(|cell| (cell, cell.role())).chain(TWINS.map(|cell| (cell, TWIN.into())))
}

pub const CELLS: usize = PLANES.len() * STOPS.len() * TRAVERSALS.len();

/// One cell of the design: one level index per factor.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Treatment(pub [usize; 3]);

impl Treatment {
    pub const REPORT: Self = Self([0; 3]);
    pub const SAH: Self = Self([PLANES.len() - 1, STOPS.len() - 1, TRAVERSALS.len() - 1]);

    /// All cells, ordered by their [number](Self::number).
    pub fn all() -> impl Iterator<Item = Self> {
        let [stops, traversals] = [STOPS.len(), TRAVERSALS.len()];
        (0..CELLS).map(move |i| Self([i / traversals / stops, i / traversals % stops, i % traversals]))
    }

    pub fn number(self) -> usize {
        let [plane, stop, traversal] = self.0;
        (plane * STOPS.len() + stop) * TRAVERSALS.len() + traversal
    }

    /// The level of each factor, in the order of [`Factor::ALL`].
    pub fn levels(self) -> [Level; 3] {
        let [plane, stop, traversal] = self.0;
        [PLANES[plane], STOPS[stop], TRAVERSALS[traversal]]
    }

    /// For example `SAH exact / SAH / plane intervals`.
    pub fn role(self) -> String {
        self.levels().map(|(name, _)| name).join(" / ")
    }

    pub fn spec(self, test: &str) -> String {
        format!("median-kd:test={test},{},{COMMON}", self.levels().map(|(_, keys)| keys).join(","))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::kdtree::KdConfig;
    use crate::registry::Registry;

    #[test]
    fn the_corners_are_the_trees_that_they_stand_for() {
        let registry = Registry::builtin();
        // The conversion to `KdConfig` and back makes 1 and 1.0 equal.
        let config = |spec: &str| {
            let config: KdConfig = serde_json::from_value(registry.choose(spec).unwrap().config).unwrap();
            serde_json::to_value(config).unwrap()
        };
        let different = |cell: Treatment, name: &str| {
            let (ours, theirs) = (config(&cell.spec("exact")), config(name));
            let keys = ours.as_object().unwrap().keys().filter(|key| ours[*key] != theirs[*key]);
            keys.cloned().collect::<Vec<_>>()
        };
        // The rules of `REPORT` ignore `intersection_cost` and `empty_bonus`. `duplication` limits every tree.
        assert_eq!(different(Treatment::REPORT, "median-kd"), ["intersection_cost", "empty_bonus", "duplication"]);
        assert_eq!(different(Treatment::SAH, "sah-kd"), [""; 0]);
    }
}
