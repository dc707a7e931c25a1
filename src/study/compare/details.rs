//! The additional columns of `--wide`, and the CSV table.

use crate::report::words::distinct;
use crate::report::{Cell, Format, Table};
use crate::request::BRUTE_FORCE;
use crate::study::measurement::{COLUMNS, Measurement, MeasurementColumn, push_columns};

/// `table` has one row per structure in `structures`.
pub fn add_columns(table: &mut Table, all: &[Measurement], structures: &[String]) {
    let own: [MeasurementColumn; 12] = [
        // A value of 0 means unknown.
        ("build", |r| known(r.build_ns as usize).map(|ns| Cell::duration(ns as f64)).into()),
        ("peak", |r| r.build_peak_bytes.map(Cell::bytes).into()),
        ("memory", |r| known(r.shape.bytes).map(Cell::bytes).into()),
        ("nodes", |r| known(r.shape.inner_nodes).into()),
        ("leaves", |r| known(r.shape.leaves).into()),
        ("refs/triangle", |r| known(r.shape.references).map(|_| r.references_per_triangle()).into()),
        ("depth", |r| known(r.shape.depth).into()),
        ("SAH cost", |r| r.shape.sah_cost.into()),
        ("tests", |r| r.counts.tests_per_ray().into()),
        ("steps", |r| r.counts.steps_per_ray().into()),
        ("checked", |r| r.checked_rays.into()),
        ("sampled", |r| Cell::number(r.rays as f64 / r.workload_rays.max(1) as f64, Format::Percent)),
    ];
    let find = |label: &String, is: &dyn Fn(&Measurement) -> bool| all.iter().find(|r| r.label == *label && is(r));
    for (name, cell) in own {
        table.push_column(name, structures.iter().map(|label| find(label, &|_| true).map(cell).into()));
    }
    for workload in distinct(all.iter().map(|r| &r.workload)) {
        let pays = |label| find(label, &|r| r.workload == workload).and_then(|own| pays_off_after(all, own)).into();
        table.push_column(format!("pays off: {workload}"), structures.iter().map(pays));
    }
}

fn known(n: usize) -> Option<usize> {
    Some(n).filter(|&n| n > 0)
}

/// The number of rays after which a slower build breaks even with the fastest build.
pub fn pays_off_after(all: &[Measurement], own: &Measurement) -> Option<f64> {
    let is_rival = |r: &&Measurement| {
        let same = r.scene == own.scene && r.workload == own.workload;
        same && r.structure != BRUTE_FORCE && r.build_ns > 0 && r.trace_ns.is_some()
    };
    let fastest = all.iter().filter(is_rival).min_by_key(|r| r.build_ns)?;
    let rays = own.rays.min(fastest.rays);
    let saved = fastest.ns_per_ray_of(rays)? - own.ns_per_ray_of(rays)?;
    let dearer = own.build_ns as f64 - fastest.build_ns as f64;
    (own.build_ns > 0 && dearer > 0.0 && saved > 0.0).then(|| dearer / saved)
}

pub fn legend(first: &str) -> Vec<String> {
    vec![
        format!(
            "build: wall time, median over epochs. peak: largest memory use during a build. refs/triangle: leaf \
             references per triangle. SAH cost: expected triangle tests of a random line. tests, steps: triangle \
             tests and entered nodes per {first} ray."
        ),
        "checked: checked rays; sampled: share of timed rays; both for the first workload. pays off: rays after which \
         a slower build breaks even with the fastest build. Empty: unknown or never."
            .into(),
    ]
}

/// One row per scene, structure and workload.
pub fn data(all: &[Measurement]) -> Table {
    let mut table = Table::new("", [""; 0], all.iter().map(|_| vec![]));
    push_columns(&mut table, &COLUMNS.map(|(name, _)| name), &all.iter().collect::<Vec<_>>());
    table.push_column("pays_off_after_rays", all.iter().map(|own| pays_off_after(all, own).into()));
    table
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::study::measurement::tests::example;

    #[test]
    fn a_dearer_build_pays_off_where_its_rays_are_cheaper() {
        let of = |label: &str, build_ns: u64, ns: f64| Measurement { build_ns, ..example(label, "primary", &[ns], 1) };
        let all = [of("a", 1000, 5000.0), of("b", 2000, 4500.0), of("c", 9000, 6000.0), of("brute-force", 1, 9e9)];
        // Compared with structure a, structure b saves 1 ns per ray.
        let found: Vec<Option<f64>> = all.iter().map(|own| pays_off_after(&all, own)).collect();
        assert_eq!(found, [None, Some(1000.0), None, None]);
        let unknown = [of("a", 1000, 5000.0), of("runner", 0, 10.0)];
        assert_eq!(pays_off_after(&unknown, &unknown[1]), None, "its build is unknown");
    }
}
