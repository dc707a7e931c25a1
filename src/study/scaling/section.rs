//! Writes the sentences, charts and tables of the study `scaling`.

use super::growth::{Growth, LEVEL_8, MESHES, Point, SPHERES};
use crate::measure::Estimate;
use crate::report::number::count;
use crate::report::plot::{Chart, Curves, Line};
use crate::report::words::{listed, slug, written};
use crate::report::{Art, Block, Cell, Figure, Finding, Format, Table};
use crate::request::{REPORT_TREE, SAH_TREE};
use crate::scene::WorkloadKind;
use crate::study::measurement::{Measurement, push_columns};

struct Quantity {
    id: &'static str,
    words: &'static str,
    y_title: &'static str,
    value: fn(&Point) -> f64,
    power: fn(&Growth) -> Option<Estimate>,
}

const TIME: Quantity = Quantity {
    id: "time",
    words: "Time per ray",
    y_title: "nanoseconds per ray",
    value: |point| point.ns_per_ray,
    power: |growth| growth.time,
};

const BUILD: Quantity = Quantity {
    id: "build",
    words: "Build time",
    y_title: "build time in milliseconds",
    value: |point| point.build_ns * 1e-6,
    power: |growth| growth.build,
};

const MEMORY: Quantity = Quantity {
    id: "memory",
    words: "Memory",
    y_title: "bytes per triangle",
    value: Point::bytes_per_triangle,
    power: |growth| growth.bytes,
};

pub fn findings(growths: &[Growth]) -> Vec<Finding> {
    let of = |label: &str| {
        let primary = WorkloadKind::Primary.name();
        growths.iter().find(|g| g.family == SPHERES && g.workload == primary && g.label == label)
    };
    let both = [("growth-report", of(REPORT_TREE)), ("growth-sah", of(SAH_TREE))];
    let words = |growth: &Growth| {
        let over = ends(growth).map_or(String::new(), |ends| format!(" ({ends} triangles)"));
        let power = written(growth.time?, |x| format!("{x:.2}"));
        Some(format!("n^{power} with {}{over}", growth.label))
    };
    let powers: Vec<String> = both.iter().filter_map(|(_, growth)| words((*growth)?)).collect();
    let sentence = format!("On spheres of n triangles the time of a primary ray grows like {}.", listed(&powers));
    let first = both.iter().find_map(|(_, growth)| growth.as_ref()?.time);
    let spheres = first.map(|power| Finding::new("spheres", sentence).with_value(power));
    // The claims are about spheres up to level 8. Without a sphere of that size, the finding is left out.
    let claimed = both.iter().filter_map(|(key, growth)| {
        let growth = growth.filter(|growth| growth.points.iter().any(|point| point.triangles() >= LEVEL_8))?;
        Some(Finding::number(*key, growth.time_to_level_8?))
    });
    spheres.into_iter().chain(claimed).collect()
}

/// Formats the range of triangle counts in the fit, such as `20 to 1,280`.
fn ends(growth: &Growth) -> Option<String> {
    let fitted = || growth.points.iter().filter(|point| point.is_fitted()).map(|point| count(point.triangles() as u64));
    Some(format!("{} to {}", fitted().next()?, fitted().next_back()?))
}

pub fn blocks(growths: &[Growth]) -> Vec<Block> {
    let groups: Vec<&[Growth]> = growths.chunk_by(|a, b| a.family == b.family && a.workload == b.workload).collect();
    let Some(first) = groups.first() else { return vec![] };
    let text = "For a query in logarithmic time the fitted exponent of n, the number of triangles, is near 0; an exponent \
                of 1 means that twice the triangles take twice the time. Icospheres at successive subdivision levels, \
                seen by the same camera, differ only in n; different meshes differ in more than their size. Meshes \
                whose tree is one leaf are not fitted.";
    let mut blocks = vec![Block::Text(text.into())];
    let spheres = groups.iter().filter(|group| group[0].family == SPHERES);
    blocks.extend(spheres.clone().map(|group| Block::figure(figure(group, &TIME))));
    // Build time and memory are equal for all workloads.
    let quantities = if first[0].family == MESHES { &[][..] } else { &[BUILD, MEMORY] };
    blocks.extend(quantities.iter().map(|quantity| Block::figure(figure(first, quantity))));
    let families: Vec<&[Growth]> = growths.chunk_by(|a, b| a.family == b.family).collect();
    blocks.extend(families.iter().filter_map(|family| exponents(family)).map(Block::from));
    let points = families.iter().map(|family| points(family).into()).collect();
    blocks.push(Block::Fold("All points".into(), points));
    blocks
}

fn figure(group: &[Growth], quantity: &Quantity) -> Figure {
    let first = &group[0];
    let line = |growth: &Growth| {
        let point = |point: &Point| (point.triangles() as f64, (quantity.value)(point));
        let power = (quantity.power)(growth).map(|power| format!("n^{:.2}", power.estimate));
        let note = power.unwrap_or_default();
        Line { label: growth.label.clone(), note, points: growth.points.iter().map(point).collect() }
    };
    let phrase = |growth: &Growth| {
        let power = (quantity.power)(growth)?;
        Some(format!("{}: exponent {}", growth.label, written(power, |x| format!("{x:.2}"))))
    };
    let phrases: Vec<String> = group.iter().filter_map(phrase).collect();
    let rays = if quantity.id == TIME.id { format!(" {} rays;", first.workload) } else { String::new() };
    let lines = group.iter().map(line).collect();
    Figure {
        id: format!("scaling-{}-{}-{}", quantity.id, slug(first.family), slug(&first.workload)),
        caption: format!(
            "{}, {};{rays} both axes are logarithmic, so a power of n is a straight line. The label gives its \
             exponent.",
            quantity.words, first.family,
        ),
        alt: format!("Line chart over the number of triangles. {}.", phrases.join("; ")),
        art: Art::Chart(Chart::Curves(Curves { x_title: "triangles".into(), y_title: quantity.y_title.into(), lines })),
        data: Table::of(
            "",
            all_points(group),
            &[
                ("structure", &|(growth, _)| growth.label.as_str().into()),
                ("triangles", &|(_, point)| point.triangles().into()),
                (quantity.y_title, &|(_, point)| (quantity.value)(point).into()),
            ],
        ),
    }
}

fn all_points(growths: &[Growth]) -> impl Iterator<Item = (&Growth, &Point)> {
    growths.iter().flat_map(|growth| growth.points.iter().map(move |point| (growth, point)))
}

fn exponents(family: &[Growth]) -> Option<Table> {
    let power = |x: Option<Estimate>| Cell::from(x.map(|x| Cell::estimate(x, Format::Decimals(2))));
    let over = |growth: &Growth| {
        let fitted = growth.points.iter().filter(|point| point.is_fitted()).count();
        format!("{fitted}{}", ends(growth).map_or(String::new(), |ends| format!(": {ends}")))
    };
    let table = Table::of(
        format!("Exponents of the number of triangles, {}", family[0].family),
        family,
        &[
            ("structure", &|growth| growth.label.as_str().into()),
            ("rays", &|growth| growth.workload.as_str().into()),
            ("time per ray", &|growth| power(growth.time)),
            ("build", &|growth| power(growth.build)),
            ("memory", &|growth| power(growth.bytes)),
            ("tests", &|growth| power(growth.tests)),
            ("steps", &|growth| power(growth.steps)),
            ("meshes: triangles", &|growth| over(growth).into()),
        ],
    );
    let note = "Least squares on logarithms over the meshes on which the structure has more than one leaf, with 95 % \
                intervals for a rerun on these meshes; counts and memory do not vary.";
    family.iter().any(|growth| growth.time.is_some()).then(|| table.noted([note]).with_interval_note())
}

fn points(family: &[Growth]) -> Table {
    let name = |growth: &Growth, point: &Point| {
        let cell = Cell::from(&growth.label);
        if point.is_fitted() { cell } else { cell.noted("one leaf") }
    };
    Table::of(
        format!("{}: measurements", family[0].family),
        all_points(family),
        &[
            ("structure", &|(growth, point)| name(growth, point)),
            ("rays", &|(growth, _)| growth.workload.as_str().into()),
            ("mesh", &|(_, point)| point.measurement.scene_title().into()),
            ("triangles", &|(_, point)| point.triangles().into()),
            ("time per ray", &|(_, point)| Cell::duration(point.ns_per_ray)),
            ("tests", &|(_, point)| point.measurement.counts.tests_per_ray().into()),
            ("steps", &|(_, point)| point.measurement.counts.steps_per_ray().into()),
            ("build", &|(_, point)| Cell::duration(point.build_ns)),
            ("memory per triangle", &|(_, point)| Cell::bytes(point.bytes_per_triangle() as usize)),
        ],
    )
}

pub fn data(growths: &[Growth]) -> Table {
    let mut table = Table::of(
        "",
        all_points(growths),
        &[
            ("family", &|(growth, _)| growth.family.into()),
            ("fitted", &|(_, point)| point.is_fitted().into()),
            ("mrays_per_s", &|(_, point)| (1e3 / point.ns_per_ray).into()),
            ("ns_per_ray", &|(_, point)| point.ns_per_ray.into()),
            ("build_ns", &|(_, point)| point.build_ns.into()),
        ],
    );
    let names = ["scene", "triangles", "stand_in", "structure", "label", "workload"];
    let counts = ["tests_per_ray", "steps_per_ray", "bytes", "leaves"];
    let measured: Vec<&Measurement> = all_points(growths).map(|(_, point)| &point.measurement).collect();
    push_columns(&mut table, &[&names[..], &counts].concat(), &measured);
    table
}
