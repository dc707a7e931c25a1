use std::path::Path;

use super::*;
use crate::measure::Estimate;
use crate::render::Picture;

fn figure() -> Figure {
    let point = |(x, y, label): (f64, f64, &str)| Point {
        x,
        y,
        is_bound: label == "exact",
        is_front: label != "slow",
        label: label.into(),
        group: 0,
    };
    Figure {
        panels: vec![Panel {
            title: "uniform rays".into(),
            x_title: "ns per ray".into(),
            y_title: "error".into(),
            points: [(200.0, 0.02, "fast"), (250.0, 3e-5, "exact"), (4000.0, 0.02, "slow")].map(point).into(),
        }],
        groups: vec!["tree".into()],
        notes: vec!["a note".into()],
    }
}

#[test]
fn both_forms_hold_the_picture() {
    let svg = String::from_utf8(figure().bytes(Format::Svg)).unwrap();
    for text in ["uniform rays", "ns per ray", "error", "fast", "exact", "slow", "tree", "a note", "0.001 %", "10 %"] {
        assert!(svg.contains(&format!("\n{text}\n")), "{text} is not in {svg}");
    }
    let png = figure().bytes(Format::Png);
    let picture = Picture::from_png(&png).unwrap();
    assert_eq!(picture.size()[0], 1600);
    // The colour of the only group is there, and text is not pale boxes: dark pixels are many.
    let colour = palette::colours(&["tree".to_owned()])[0];
    assert!(picture.pixels().contains(&[colour.0, colour.1, colour.2]));
    assert!(picture.pixels().iter().filter(|p| p.iter().all(|&c| c < 90)).count() > 2000);
    assert_eq!(png, figure().bytes(Format::Png));
}

#[test]
fn a_figure_without_points_says_so() {
    let mut empty = figure();
    empty.panels[0].points.clear();
    assert!(String::from_utf8(empty.bytes(Format::Svg)).unwrap().contains("nothing to show"));
}

#[test]
fn the_ending_tells_the_form() {
    assert_eq!(Format::of(Path::new("a/b.SVG")), Ok(Format::Svg));
    assert_eq!(Format::of(Path::new("b.png")), Ok(Format::Png));
    for wrong in ["b", "b.pdf", "svg", ".png"] {
        assert!(Format::of(Path::new(wrong)).unwrap_err().to_string().contains(".svg or .png"));
    }
}

#[test]
fn long_names_leave_bars_their_room() {
    let long = "sah-hybrid:test=moller-trumbore,batch=packets,quality=high".to_owned();
    // Its interval is drawn within the axis, which must have room: an axis that ends before it begins would panic.
    let value = Estimate::between(2.0, 1.8, 2.2);
    let bars = |labels: Vec<String>| {
        let bars = labels.iter().map(|_| Bar::Of(value)).collect();
        Chart::Bars(Bars {
            x_title: "times".into(),
            reference: 1.0,
            labels,
            groups: vec![BarGroup { title: "rays".into(), bars }],
        })
    };
    let stack = |label: String| {
        let rows = vec![StackRow { label, factors: vec![2.0], total: value }];
        Chart::Stack(Stack { x_title: "times".into(), parts: vec!["plane".into()], rows })
    };
    // On a narrow screen names stand above their bars, which makes the drawing higher.
    for (short, long) in
        [(bars(vec!["a".into(); 2]), bars(vec![long.clone(); 2])), (stack("a".into()), stack(long.clone()))]
    {
        let height = |chart: &Chart, width: f64| {
            let svg = chart.svg(width);
            let (_, rest) = svg.split_once("height=\"").unwrap();
            rest.split_once('"').unwrap().0.parse::<f64>().unwrap()
        };
        assert!(height(&long, 360.0) > height(&short, 360.0));
        assert_eq!(height(&long, 1600.0), height(&short, 1600.0));
        assert!(long.svg(360.0).contains("packets"));
    }
}
