//! How time, build and memory grow with the number of triangles.

use super::table::{exponents, groups, points};
use super::{Family, Growth, Point};
use crate::measure::Estimate;
use crate::report::document::{Art, Block, Figure};
use crate::report::number::{count, figures};
use crate::report::plot::{Chart, Curves, Line};
use crate::report::words::{listed, slug, written};
use crate::report::{Statement, Table};
use crate::study::{REPORT_TREE, SAH_TREE};

struct Quantity {
    id: &'static str,
    words: &'static str,
    y_title: &'static str,
    value: fn(&Point) -> f64,
    power: fn(&Growth) -> Option<Estimate>,
}

const TIME: Quantity = Quantity {
    id: "time",
    words: "time of a ray",
    y_title: "nanoseconds a ray",
    value: |point| point.ns_per_ray,
    power: |growth| growth.time,
};

const BUILD: Quantity = Quantity {
    id: "build",
    words: "time of the build",
    y_title: "milliseconds of the build",
    value: |point| point.build_ns * 1e-6,
    power: |growth| growth.build,
};

const MEMORY: Quantity = Quantity {
    id: "memory",
    words: "memory",
    y_title: "bytes a triangle",
    value: |point| point.bytes_per_triangle,
    power: |growth| growth.bytes,
};

/// How the time of a primary ray grows on the spheres with the report's tree and with the SAH tree.
pub fn statements(growths: &[Growth]) -> Vec<Statement> {
    let of = |name: &str| {
        let is = |g: &&Growth| g.family == Family::Spheres && g.workload == "primary" && g.structure == name;
        let growth = growths.iter().find(is)?;
        Some((growth, growth.time?))
    };
    let found: Vec<(&Growth, Estimate)> = [REPORT_TREE, SAH_TREE].into_iter().filter_map(of).collect();
    let powers = found.iter().map(|(growth, time)| {
        let fitted = || growth.points.iter().filter(|p| p.fitted).map(|p| p.triangles as u64);
        let over = fitted()
            .min()
            .zip(fitted().max())
            .map_or(String::new(), |(from, to)| format!(" from {} to {} triangles", count(from), count(to)));
        format!("n^{}{over} with {}", written(*time, |x| format!("{x:.2}")), growth.structure)
    });
    let powers: Vec<String> = powers.collect();
    let Some((_, first)) = found.first() else { return vec![] };
    let sentence = format!("On one sphere of n triangles the time of a primary ray grows like {}.", listed(&powers));
    vec![Statement::new("spheres", sentence).of(*first)]
}

pub fn blocks(growths: &[Growth], command: &str) -> Vec<Block> {
    let mut blocks = vec![Block::Text(
        "If a query were logarithmic in the number of triangles n, its power of n would be near 0; a power of 1 means that \
         twice the triangles take twice the time. One sphere, divided more and more finely and seen alike, asks this \
         without anything else that changes; different meshes differ in more than their size. What more threads give is the \
         question of `sahara study threads`."
            .into(),
    )];
    for group in growths.chunk_by(|a, b| a.family == b.family && a.workload == b.workload) {
        if group[0].family == Family::Spheres {
            blocks.push(Block::figure(figure(group, &TIME, command)));
            // Builds and memory do not know of rays.
            if group[0].workload == growths[0].workload {
                blocks.push(Block::figure(figure(group, &BUILD, command)));
                blocks.push(Block::figure(figure(group, &MEMORY, command)));
            }
        }
    }
    let groups = groups(growths);
    blocks.extend(groups.iter().map(|group| Block::table(exponents(group), command)));
    let points = groups.iter().map(|group| Block::table(points(group), command)).collect();
    blocks.push(Block::Fold("All points".into(), points));
    blocks
}

fn figure(group: &[Growth], quantity: &Quantity, command: &str) -> Figure {
    let first = &group[0];
    let line = |growth: &Growth| {
        let point = |point: &Point| (point.triangles as f64, (quantity.value)(point));
        let power = (quantity.power)(growth).map(|power| format!("n^{:.2}", power.estimate));
        let note = power.unwrap_or_default();
        Line { label: growth.structure.clone(), note, points: growth.points.iter().map(point).collect() }
    };
    let rows = group.iter().flat_map(|growth| {
        growth.points.iter().map(|p| [growth.structure.clone(), p.triangles.to_string(), figures((quantity.value)(p))])
    });
    let told = group.iter().filter_map(|growth| {
        let power = (quantity.power)(growth)?;
        Some(format!("{}: power {}", growth.structure, written(power, |x| format!("{x:.2}"))))
    });
    let told: Vec<String> = told.collect();
    let rays = if quantity.id == TIME.id { format!(" {} rays;", first.workload) } else { String::new() };
    Figure {
        id: format!("scaling-{}-{}-{}", quantity.id, slug(first.family.name()), slug(&first.workload)),
        caption: format!(
            "{}, {};{rays} both axes are logarithmic, so that a power of n is a straight line. Its exponent stands behind the name.",
            capital(quantity.words),
            first.family.name(),
        ),
        alt: format!("Line chart over the number of triangles. {}.", told.join("; ")),
        command: command.into(),
        art: Art::Chart(Chart::Curves(Curves {
            x_title: "triangles".into(),
            y_title: quantity.y_title.into(),
            lines: group.iter().map(line).collect(),
        })),
        data: Table::of_texts("", ["structure", "triangles", quantity.y_title], rows.collect()),
    }
}

fn capital(words: &str) -> String {
    let mut letters = words.chars();
    letters.next().map_or(String::new(), |first| first.to_uppercase().chain(letters).collect())
}
