//! The chart of error against time.

use super::judged::{Judged, JudgedRays};
use super::table::table;
use crate::report::number::{count, figures};
use crate::report::plot::{Chart, LABELLED, Point, Scatter};
use crate::report::words::slug;
use crate::report::{Art, Figure};

pub fn figure(number: usize, of_kind: &JudgedRays) -> Figure {
    let JudgedRays { epoch, kind, structures, .. } = of_kind;
    let front = structures.iter().filter(|own| own.dominated_by.is_none()).map(|own| {
        let (ns, error) = (figures(own.ns_per_ray), figures(100.0 * own.error_bound));
        format!("{}, {ns} ns per ray, wrong results at most {error} % (95 % confidence)", own.structure.label)
    });
    let front: Vec<String> = front.collect();
    let few = format!(" Only filled points are labelled (more than {LABELLED} points).");
    let few = if structures.len() > LABELLED { few } else { String::new() };
    Figure {
        id: format!("accuracy-{}-{}-{number}", slug(&epoch.scene), slug(kind)),
        caption: format!(
            "{}, {} {}: share of wrong results (missed, invented, or at a wrong depth) against time. Lower and further \
             left is better; both axes are logarithmic. Labels name the triangle test, colours the structure. Filled: no \
             other point is faster and less wrong. Arrow: no wrong result in n rays; the dot is the upper bound with 95 % \
             confidence, about 3/n.{few}",
            epoch.title(),
            count(of_kind.most(|own| own.errors.rays)),
            of_kind.description()
        ),
        alt: format!(
            "Scatter plot of {} structures and triangle tests on {} {kind} rays. On the front: {}.",
            structures.len(),
            count(structures.first().map_or(0, |own| own.errors.rays)),
            front.join("; ")
        ),
        art: Art::Chart(Chart::Scatter(scatter(of_kind))),
        data: table(of_kind),
    }
}

fn scatter(of_kind: &JudgedRays) -> Scatter {
    let point = |own: &Judged| Point {
        x: own.ns_per_ray,
        y: 100.0 * own.error_bound,
        is_bound: own.errors.errors() == 0,
        is_front: own.dominated_by.is_none(),
        label: own.structure.triangle_test.clone(),
        group: without_test(own),
    };
    Scatter {
        x_title: "ns per ray, one thread".into(),
        y_title: "wrong results, upper bound in % (95 % confidence)".into(),
        points: of_kind.structures.iter().map(point).collect(),
    }
}

fn without_test(own: &Judged) -> String {
    let label = &own.structure.label;
    let (name, keys) = label.split_once(':').unwrap_or((label, ""));
    let keys: Vec<&str> = keys.split(',').filter(|key| !key.starts_with("test=")).collect();
    format!("{name}:{}", keys.join(",")).trim_end_matches(':').into()
}
