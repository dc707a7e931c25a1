//! What `--wide` prints beside times, and the table for programs.

use crate::report::{Cell, Format, Table};
use crate::request::BRUTE_FORCE;
use crate::study::measurement::Measurement;

/// Adds the columns of builds, memory, the shape of the trees, counts and checks to a table whose rows begin with the
/// label of a structure.
pub fn details(all: &[Measurement], workloads: &[String], columns: &mut Vec<String>, rows: &mut [Vec<Cell>]) {
    type Column = (&'static str, fn(&Measurement) -> Cell);
    let own: [Column; 13] = [
        // A program that times itself may say nothing of its build.
        ("build", |r| if r.build_ns > 0 { Cell::duration(r.build_ns as f64) } else { Cell::empty() }),
        ("peak", |r| r.build_peak_bytes.map(Cell::bytes).unwrap_or_default()),
        // A program that does not know its memory says 0.
        ("memory", |r| if r.shape.bytes > 0 { Cell::bytes(r.shape.bytes) } else { Cell::empty() }),
        ("nodes", |r| known(r.shape.inner_nodes)),
        ("leaves", |r| known(r.shape.leaves)),
        ("refs a triangle", |r| {
            let per_triangle = r.shape.references as f64 / r.triangles.max(1) as f64;
            if r.shape.references > 0 { per_triangle.into() } else { Cell::empty() }
        }),
        ("depth", |r| known(r.shape.depth)),
        ("SAH cost", |r| r.shape.sah_cost.into()),
        ("tests", |r| r.tests_per_ray.into()),
        ("steps", |r| r.steps_per_ray.into()),
        ("instructions", |r| r.instructions_per_ray.into()),
        ("checked", |r| r.checked_rays.into()),
        ("sampled", |r| Cell::number(r.rays as f64 / r.workload_rays.max(1) as f64, Format::Percent)),
    ];
    columns.extend(own.iter().map(|(name, _)| (*name).to_owned()));
    columns.extend(workloads.iter().map(|workload| format!("pays off: {workload}")));
    for row in rows {
        let label = row[0].text();
        let first = all.iter().find(|r| r.label == label);
        row.extend(own.iter().map(|(_, cell)| first.map_or(Cell::empty(), cell)));
        let pays = |workload: &String| {
            let measured = all.iter().find(|r| r.label == label && r.workload == *workload);
            measured.and_then(|own| pays_off_after(all, own)).into()
        };
        row.extend(workloads.iter().map(pays));
    }
}

fn known(n: usize) -> Cell {
    if n > 0 { n.into() } else { Cell::empty() }
}

/// After how many rays of its workload a structure has made up for the time that its build takes longer than that of the
/// structure which is built the fastest: build and rays together take as long then. Nothing where it never has, where one
/// of the times is unknown, and for that structure itself.
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

/// What the columns mean.
pub fn legend(first: &str) -> Vec<String> {
    vec![
        format!(
            "build: seen from outside, median over epochs; peak: most memory held during a build. refs a triangle: references in \
             leaves for each triangle; SAH cost: expected triangle tests of a random line. tests, steps: triangle tests and \
             nodes entered for each {first} ray."
        ),
        "checked: rays held against brute force with the same triangle test; sampled: share of the rays that was timed. Both are of \
         the first workload. pays off: rays after which a slower build is made up for, against the structure that is built the \
         fastest. Empty: unknown, or never."
            .into(),
    ]
}

/// One row for each structure and workload of a scene.
pub fn data(all: &[Measurement]) -> Table {
    Table::of(
        "",
        all,
        &[
            ("scene", &|r| (&r.scene).into()),
            ("scene_hash", &|r| (&r.scene_hash).into()),
            ("stand_in", &|r| r.stand_in.into()),
            ("triangles", &|r| r.triangles.into()),
            ("structure", &|r| (&r.structure).into()),
            ("label", &|r| (&r.label).into()),
            ("triangle_test", &|r| (&r.triangle_test).into()),
            ("config", &|r| r.config.to_string().into()),
            ("workload", &|r| (&r.workload).into()),
            ("query", &|r| r.query.name().into()),
            ("workload_hash", &|r| (&r.workload_hash).into()),
            ("workload_rays", &|r| r.workload_rays.into()),
            ("rays", &|r| r.rays.into()),
            ("epochs", &|r| r.epochs.into()),
            ("runs", &|r| r.samples_ns.len().into()),
            ("build_ns", &|r| r.build_ns.into()),
            ("build_peak_bytes", &|r| r.build_peak_bytes.into()),
            ("trace_ns", &|r| r.trace_ns.into()),
            ("mrays_per_s", &|r| r.mrays_per_s.into()),
            ("tests_per_ray", &|r| r.tests_per_ray.into()),
            ("steps_per_ray", &|r| r.steps_per_ray.into()),
            ("leaf_steps_per_ray", &|r| r.leaf_steps_per_ray.into()),
            ("empty_leaf_steps_per_ray", &|r| r.empty_leaf_steps_per_ray.into()),
            ("tests_over_minimum", &|r| r.tests_over_minimum.into()),
            ("instructions_per_ray", &|r| r.instructions_per_ray.into()),
            ("branch_misses_per_ray", &|r| r.branch_misses_per_ray.into()),
            ("bytes", &|r| r.shape.bytes.into()),
            ("inner_nodes", &|r| r.shape.inner_nodes.into()),
            ("leaves", &|r| r.shape.leaves.into()),
            ("references", &|r| r.shape.references.into()),
            ("depth", &|r| r.shape.depth.into()),
            ("sah_cost", &|r| r.shape.sah_cost.into()),
            ("pays_off_after_rays", &|r| pays_off_after(all, r).into()),
            ("hits", &|r| r.hits.into()),
            ("counted_rays", &|r| r.counted_rays.into()),
            ("declined", &|r| r.declined.as_ref().into()),
            ("checked_rays", &|r| r.checked_rays.into()),
            ("structure_errors", &|r| r.structure_errors.into()),
        ],
    )
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::study::measurement::tests::example;

    #[test]
    fn a_dearer_build_pays_off_where_its_rays_are_cheaper() {
        let of = |label: &str, build_ns: u64, ns: f64| Measurement { build_ns, ..example(label, "primary", &[ns], 1) };
        let all = [of("a", 1000, 5000.0), of("b", 2000, 4500.0), of("c", 9000, 6000.0), of("brute-force", 1, 9e9)];
        // A nanosecond a ray is saved.
        let found: Vec<Option<f64>> = all.iter().map(|own| pays_off_after(&all, own)).collect();
        assert_eq!(found, [None, Some(1000.0), None, None]);
        let unknown = [of("a", 1000, 5000.0), of("runner", 0, 10.0)];
        assert_eq!(pays_off_after(&unknown, &unknown[1]), None, "its build is unknown");
    }
}
