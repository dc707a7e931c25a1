use crate::measure::Estimate;
use crate::report::plot::*;

fn scatter() -> Scatter {
    let point = |(x, y, label): (f64, f64, &str)| Point {
        x,
        y,
        is_bound: label == "exact",
        is_front: label != "slow",
        label: label.into(),
        group: "tree".into(),
    };
    Scatter {
        x_title: "ns per ray".into(),
        y_title: "error".into(),
        points: [(200.0, 0.02, "fast"), (250.0, 3e-5, "exact"), (4000.0, 0.02, "slow")].map(point).into(),
    }
}

#[test]
fn the_drawing_holds_its_texts_and_the_colours_of_its_groups() {
    let svg = Chart::Scatter(scatter()).svg(900.0);
    for text in ["ns per ray", "error", "fast", "exact", "slow", "tree", "0.001", "1,000"] {
        assert!(svg.contains(&format!("\n{text}\n")), "{text} is not in {svg}");
    }
    // If the labels equal the groups, there is no legend.
    let mut named = scatter();
    named.points.iter_mut().for_each(|point| point.group.clone_from(&point.label));
    assert_eq!(Chart::Scatter(named).svg(900.0).matches("\nslow\n").count(), 1);
    assert!(svg.contains(&palette::hex(palette::colours(&["tree".to_owned()])[0])), "{svg}");
}

#[test]
fn charts_without_anything_to_show_have_their_axes() {
    let curves = Curves { x_title: "n".into(), y_title: "error".into(), lines: vec![] };
    let bars = Bars { x_title: "error".into(), labels: vec![], parts: vec![], groups: vec![] };
    let scatter = Scatter { points: vec![], ..scatter() };
    for chart in [Chart::Scatter(scatter), Chart::Curves(curves), Chart::Bars(bars)] {
        assert!([360.0, 900.0].iter().all(|width| chart.svg(*width).contains("\nerror\n")), "{chart:?}");
    }
}

#[test]
fn there_is_room_for_the_name_of_each_line() {
    let line = |i: usize| Line { label: format!("tree {i}"), note: "n^1".into(), points: vec![(1.0, (i + 1) as f64)] };
    let of = |lines: usize| {
        Chart::Curves(Curves { x_title: "x".into(), y_title: "y".into(), lines: (0..lines).map(line).collect() })
    };
    assert!(of(30).size(900.0).1 > of(1).size(900.0).1 + 29 * 32);
}

#[test]
fn long_names_leave_bars_their_room() {
    let value = Estimate::between(2.0, 1.8, 2.2);
    for (bar, parts) in [(Bar::Of(value), vec![]), (Bar::Product(vec![2.0], value), vec!["plane".to_owned()])] {
        let of =
            |label: &str| Chart::Bars(Bars::of_products("times", parts.clone(), [(label.to_owned(), bar.clone())]));
        let (short, long) = (of("a"), of("sah-hybrid:test=moller-trumbore,batch=packets,quality=high"));
        // In a narrow drawing, a long name needs a separate line above the bar.
        assert!(long.size(360.0).1 > short.size(360.0).1);
        assert_eq!(long.size(1600.0), short.size(1600.0));
        assert!(long.svg(360.0).contains("packets"));
    }
}
