//! The figure of speed against memory.

use crate::report::plot::{Chart, Point, Scatter};
use crate::report::words::distinct;
use crate::report::{Art, Cell, Figure, Table};
use crate::request::BRUTE_FORCE;
use crate::study::measurement::Measurement;

/// The structures on one workload of one scene, with nanoseconds per ray.
type Case<'a> = Vec<(&'a Measurement, f64)>;

/// Brute force is left out, because its point is far from all other points.
pub fn figure(scenes: &[Vec<Measurement>]) -> Option<Figure> {
    let cases: Vec<Case> = scenes.iter().flat_map(|all| cases(all)).collect();
    let first = cases.first()?;
    let (scene, workload) = (first[0].0.scene_title(), &first[0].0.workload);
    let best = |cost: fn(&(&Measurement, f64)) -> f64| {
        let least = first.iter().min_by(|a, b| cost(a).total_cmp(&cost(b)));
        least.map_or("", |(own, _)| own.label.as_str())
    };
    let alt = format!(
        "Scatter plot of {} structures on {scene}, {workload} rays: fastest {}, smallest {}, fastest build {}.",
        first.len(),
        best(|(_, ns_per_ray)| *ns_per_ray),
        best(|(own, _)| own.shape.bytes as f64),
        best(|(own, _)| own.build_ns as f64)
    );
    Some(Figure {
        id: "tradeoff".into(),
        caption: format!(
            "{scene}, {workload} rays: speed against memory. Higher is faster, further left is smaller; both axes are \
             logarithmic. The solid line joins the structures that no other one beats in both speed and memory. The \
             numbers behind the figure include build times, and every scene and workload. Points are medians on the \
             same rays; the tables have their intervals. Brute force is left out."
        ),
        alt,
        art: Art::Chart(Chart::Scatter(scatter(first))),
        data: table(&cases),
    })
}

fn cases(all: &[Measurement]) -> Vec<Case<'_>> {
    let case = |workload: &String| {
        let is_drawn =
            |r: &&Measurement| r.workload == *workload && r.structure != BRUTE_FORCE && r.mrays_per_s.is_some();
        let drawn = || all.iter().filter(is_drawn);
        // A structure may be timed on a subset of the rays. All structures are compared on the smallest subset.
        let common = drawn().map(|own| own.rays).min().unwrap_or(0);
        drawn().filter_map(|own| Some((own, own.ns_per_ray_of(common)?))).collect()
    };
    let workloads = distinct(all.iter().map(|r| &r.workload));
    workloads.iter().map(case).filter(|case: &Case| case.len() > 1).collect()
}

fn scatter(case: &Case) -> Scatter {
    let is_better = |(a, a_ns): &(&Measurement, f64), (b, b_ns): &(&Measurement, f64)| {
        let [a, b] = [(a.shape.bytes, *a_ns), (b.shape.bytes, *b_ns)];
        a != b && a.0 <= b.0 && a.1 <= b.1
    };
    let point = |drawn: &(&Measurement, f64)| Point {
        x: drawn.0.shape.bytes.max(1) as f64 / f64::from(1 << 20),
        y: 1e3 / drawn.1,
        is_bound: false,
        is_front: !case.iter().any(|other| is_better(other, drawn)),
        label: drawn.0.label.clone(),
        group: drawn.0.label.clone(),
    };
    Scatter {
        x_title: "memory, MiB".into(),
        y_title: "million rays per second".into(),
        points: case.iter().map(point).collect(),
    }
}

fn table(cases: &[Case]) -> Table {
    Table::of(
        "",
        cases.iter().flatten(),
        &[
            ("scene", &|(own, _)| own.scene_title().into()),
            ("rays", &|(own, _)| own.workload.as_str().into()),
            ("structure", &|(own, _)| own.label.as_str().into()),
            ("Mrays/s", &|(_, ns_per_ray)| (1e3 / ns_per_ray).into()),
            ("memory", &|(own, _)| Cell::bytes(own.shape.bytes)),
            ("build", &|(own, _)| Cell::duration(own.build_ns as f64)),
        ],
    )
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::measure::SubsetSamples;
    use crate::study::measurement::tests::example;

    #[test]
    fn what_has_no_time_or_no_company_is_not_drawn() {
        let record = |label: &str, workload: &str, speed: Option<f64>| Measurement {
            rays: 125,
            mrays_per_s: speed,
            samples_ns: speed.map(|speed| 125.0 * 1e3 / speed).into_iter().collect(),
            ..example(label, workload, &[], 1)
        };
        let mut all = vec![
            record("brute-force", "primary", Some(0.01)),
            record("sah-kd", "primary", Some(2.0)),
            record("sah-bvh", "primary", Some(4.0)),
            record("wrong", "primary", None),
            record("sah-kd", "shadow", Some(2.0)),
        ];
        let times = |all: &[Measurement]| {
            let drawn = cases(all);
            assert_eq!(drawn.len(), 1, "one structure alone is no comparison");
            drawn[0].iter().map(|(own, ns_per_ray)| (own.label.clone(), *ns_per_ray)).collect::<Vec<_>>()
        };
        assert_eq!(times(&all), [("sah-kd".into(), 500.0), ("sah-bvh".into(), 250.0)]);
        let drawn = figure(std::slice::from_ref(&all)).unwrap();
        assert!(drawn.alt.contains("fastest sah-bvh") && drawn.data.rows.len() == 2, "{}", drawn.alt);
        assert!(figure(&[all[..2].to_vec()]).is_none());

        all[1].parts = vec![SubsetSamples { rays: 25, ns: vec![10_000] }];
        all[2] = Measurement { rays: 25, samples_ns: vec![5_000.0], ..all[2].clone() };
        assert_eq!(times(&all), [("sah-kd".into(), 400.0), ("sah-bvh".into(), 200.0)]);
    }

    #[test]
    fn the_front_is_what_nothing_beats_in_both() {
        let of = |(label, bytes): (&str, usize)| {
            let mut own = example(label, "primary", &[], 1);
            own.shape.bytes = bytes;
            own
        };
        let [small, fast, neither] = [("small", 1 << 20), ("fast", 2 << 20), ("neither", 3 << 20)].map(of);
        let scatter = scatter(&vec![(&small, 500.0), (&fast, 100.0), (&neither, 200.0)]);
        assert_eq!(scatter.points.iter().map(|point| point.is_front).collect::<Vec<_>>(), [true, true, false]);
        assert_eq!((scatter.points[0].x, scatter.points[0].y), (1.0, 2.0));
    }
}
