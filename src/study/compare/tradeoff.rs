//! Speed against memory and build time.

use super::Reference;
use crate::report::plot::{Chart, Tradeoff, TradeoffCase, TradeoffPoint};
use crate::report::words::{distinct, interval};
use crate::report::{Art, Cell, Figure, Table};
use crate::request::BRUTE_FORCE;
use crate::study::measurement::{Measurement, trace_noise};

/// Every scene, in this order, with every workload; `None` if no two structures have a time on the same rays. Brute
/// force, far away from all others, is left out.
pub fn figure(scenes: &[Vec<Measurement>], references: &[Reference]) -> Option<Figure> {
    let cases: Vec<TradeoffCase> = scenes.iter().flat_map(|all| cases(all, references.first())).collect();
    let first = cases.first()?;
    let best = |cost: fn(&TradeoffPoint) -> f64| {
        let least = first.points.iter().min_by(|a, b| cost(a).total_cmp(&cost(b)));
        least.map_or(String::new(), |point| point.label.clone())
    };
    let alt = format!(
        "Scatter plot of {} structures on {}, {} rays: fastest {}, smallest {}, fastest build {}.",
        first.points.len(),
        first.scene,
        first.workload,
        best(|point| point.ns_per_ray),
        best(|point| point.bytes),
        best(|point| point.build_ns)
    );
    let data = table(&cases);
    Some(Figure {
        id: "tradeoff".into(),
        caption: format!(
            "{}, {} rays: speed against memory. Higher is faster, further left is smaller; both axes are logarithmic. \
             The solid line joins the structures that no other one beats in both speed and memory. The web page has \
             this plot for every scene and workload, and also with build time instead of memory. In the plot with \
             build time, points on the dashed line need the same total time, for the build and a chosen number of \
             rays, as the structure with the least total time. Points are medians on the same rays; the tables have \
             their intervals. Brute force is left out.",
            first.scene, first.workload
        ),
        alt,
        art: Art::Chart(Chart::Tradeoff(Tradeoff { cases })),
        data,
    })
}

fn cases(all: &[Measurement], reference: Option<&Reference>) -> Vec<TradeoffCase> {
    let noise = trace_noise(all);
    let ratio = |own: &Measurement| {
        let reference = reference?;
        let ratio = Reference::ratio(&reference.pairs(all, [own]), &noise)?;
        Some(format!("speedup {} over {}", interval(ratio), reference.words()))
    };
    let case = |workload: &String| {
        let is_drawn =
            |r: &&Measurement| r.workload == *workload && r.structure != BRUTE_FORCE && r.mrays_per_s.is_some();
        let drawn = || all.iter().filter(is_drawn);
        // Compare all on the same rays: the sample of the slowest.
        let common = drawn().map(|own| own.rays).min().unwrap_or(0);
        let point = |own: &Measurement| {
            Some(TradeoffPoint {
                label: own.label.clone(),
                bytes: own.shape.bytes.max(1) as f64,
                build_ns: own.build_ns.max(1) as f64,
                ns_per_ray: own.ns_per_ray_of(common)?,
                ratio: ratio(own).unwrap_or_default(),
            })
        };
        let points = drawn().filter_map(point).collect();
        TradeoffCase { scene: all[0].scene_title(), workload: workload.clone(), points }
    };
    let workloads = distinct(all.iter().map(|r| &r.workload));
    workloads.iter().map(case).filter(|case| case.points.len() > 1).collect()
}

fn table(cases: &[TradeoffCase]) -> Table {
    let row = |case: &TradeoffCase, point: &TradeoffPoint| -> Vec<Cell> {
        let (size, build) = (Cell::bytes(point.bytes as usize), Cell::duration(point.build_ns));
        let names = [&case.scene, &case.workload, &point.label].map(Cell::from);
        names.into_iter().chain([Cell::from(1e3 / point.ns_per_ray), size, build]).collect()
    };
    let rows = cases.iter().flat_map(|case| case.points.iter().map(move |point| row(case, point)));
    Table::new("", ["scene", "rays", "structure", "Mrays/s", "memory", "build"], rows)
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
            let drawn = cases(all, None);
            assert_eq!(drawn.len(), 1, "one structure alone is no comparison");
            drawn[0].points.iter().map(|p| (p.label.clone(), p.ns_per_ray)).collect::<Vec<_>>()
        };
        assert_eq!(times(&all), [("sah-kd".into(), 500.0), ("sah-bvh".into(), 250.0)]);
        let drawn = figure(std::slice::from_ref(&all), &[]).unwrap();
        assert!(drawn.alt.contains("fastest sah-bvh") && drawn.data.rows.len() == 2, "{}", drawn.alt);
        assert!(figure(&[all[..2].to_vec()], &[]).is_none());

        // A structure that is timed on a subset of the rays, which take less time, is compared on that subset.
        all[1].parts = vec![SubsetSamples { rays: 25, ns: vec![10_000] }];
        all[2] = Measurement { rays: 25, samples_ns: vec![5_000.0], ..all[2].clone() };
        assert_eq!(times(&all), [("sah-kd".into(), 400.0), ("sah-bvh".into(), 200.0)]);
    }
}
