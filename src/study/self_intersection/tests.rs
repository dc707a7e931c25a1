use super::*;
use crate::registry::Registry;

const RAYS: usize = 6000;

fn all(choices: &[Choice], rays: usize, seed: u64) -> Vec<Row> {
    Sphere::ALL.map(|sphere| trace(sphere, choices, rays, seed).unwrap()).concat()
}

/// Every triangle test that the SAH tree is offered over.
fn traced() -> Vec<Row> {
    let registry = Registry::builtin();
    let tests = registry.entries().iter().filter(|e| e.name == "sah-kd").map(|e| e.triangle_test);
    let choices: Vec<Choice> = tests.map(|test| registry.choose(&format!("sah-kd:test={test}")).unwrap()).collect();
    all(&choices, RAYS, 1)
}

#[test]
fn error_bounded_rays_alone_have_neither_acne_nor_leaks_on_any_sphere() {
    let study = traced();

    // Exactly, for whatever triangle test.
    let bounded = Offset::ErrorBounded.name();
    for row in study.iter().filter(|r| r.offset == bounded && r.point == PointFrom::Corners) {
        assert_eq!((row.acne, row.leaks), (0, 0), "{row:?}");
    }

    // As answered, too. Baldwin and Weber's planes count from zero: far from there the test has errors of its own.
    let sees = |r: &&Row| r.triangle_test != "baldwin-weber";
    let cases = |offset: Offset, sphere: usize, point: Option<PointFrom>| {
        let name = offset.name();
        let rows = study.iter().filter(move |r| r.sphere == Sphere::ALL[sphere] && r.offset == name);
        let rows: Vec<&Row> = rows.filter(move |r| point.is_none_or(|p| p == r.point)).filter(sees).collect();
        assert!(!rows.is_empty());
        assert!(rows.iter().all(|r| (r.outward, r.inward) == (RAYS, RAYS)), "every case has all of its rays");
        rows
    };
    let corners = Some(PointFrom::Corners);
    for sphere in 0..6 {
        for row in cases(Offset::ErrorBounded, sphere, corners) {
            assert_eq!((row.acne, row.acne_of_test, row.leaks, row.leaks_of_test), (0, 0, 0, 0), "{row:?}");
        }
        // Half of all rays start on the wrong side.
        for row in cases(Offset::None, sphere, None) {
            assert!(row.acne > RAYS * 2 / 5, "{row:?}");
        }
    }

    // A length is right for one scale.
    for row in cases(Offset::Normal(1e-4), 0, None) {
        assert_eq!((row.acne, row.leaks), (0, 0), "{row:?}");
    }
    for offset in [Offset::Normal(1e-4), Offset::TMin(1e-4)] {
        cases(offset, 5, None).iter().for_each(|row| assert!(row.acne > RAYS * 2 / 5, "{row:?}"));
        cases(offset, 4, None).iter().for_each(|row| assert_eq!(row.leaks, RAYS, "{row:?}"));
    }
    cases(Offset::TMin(1e-4), 3, None).iter().for_each(|row| assert!(row.leaks > RAYS / 50, "{row:?}"));
    cases(Offset::TMin(1e-4), 2, None).iter().for_each(|row| assert!(row.acne > RAYS / 20, "{row:?}"));
    cases(Offset::Normal(1e-4), 2, Some(PointFrom::Ray))
        .iter()
        .for_each(|row| assert!(row.acne > RAYS / 20, "{row:?}"));

    // Wächter and Binder's way is right at every place, until the sphere is smaller than its length.
    for sphere in [0, 1, 2, 3, 5] {
        for row in cases(Offset::WachterBinder, sphere, corners) {
            assert_eq!((row.acne, row.leaks), (0, 0), "{row:?}");
        }
    }
    cases(Offset::WachterBinder, 4, None).iter().for_each(|row| assert_eq!(row.leaks, RAYS, "{row:?}"));
}

#[test]
fn the_spheres_are_closed_and_exactly_convex() {
    for sphere in Sphere::ALL {
        let mesh = sphere.mesh();
        assert!(mesh.degenerate().is_empty(), "{sphere}");
        let coord = |v: glam::Vec3| robust::Coord3D { x: f64::from(v.x), y: f64::from(v.y), z: f64::from(v.z) };
        for id in mesh.solid() {
            let [a, b, c] = mesh.corners(id).map(coord);
            let inside = |p: glam::Vec3| robust::orient3d(a, b, c, coord(p)) >= 0.0;
            assert!(mesh.positions().iter().all(|&p| inside(p)), "{sphere}: triangle {id}");
        }
        let mut edges = std::collections::HashSet::new();
        for t in mesh.triangles() {
            for i in 0..3 {
                let (from, to) = (t[i], t[(i + 1) % 3]);
                if !edges.remove(&(to, from)) {
                    assert!(edges.insert((from, to)));
                }
            }
        }
        assert!(edges.is_empty(), "{sphere}: every edge is passed both ways");
    }
}

#[test]
fn the_same_again_and_printed_whole() {
    let registry = Registry::builtin();
    let run = || all(&[registry.choose("sah-kd").unwrap()], 50, 3);
    assert_eq!(run(), run());
    let table = table(&run());
    assert_eq!(table.rows.len(), 12);
    assert!(table.rows.iter().all(|row| row.len() == table.columns.len()));
    let last = |row: usize| table.rows[row].last().unwrap().text.clone();
    assert_eq!(last(1), "0 / 0");
}
