use std::collections::HashSet;

use super::*;
use crate::oracle;

fn pyramid() -> Mesh {
    let points = vec![Vec3::ZERO, Vec3::X, Vec3::Y, Vec3::new(0.3, 0.4, 0.9)];
    Mesh::new(points, vec![[0, 1, 2], [0, 1, 3], [1, 2, 3], [2, 0, 3]]).unwrap()
}

#[test]
fn rays_are_valid_unless_they_must_not_be() {
    let flat = Mesh::new(vec![Vec3::ONE; 3], vec![[0, 1, 2]]).unwrap();
    for mesh in [pyramid(), flat, Mesh::new(vec![], vec![]).unwrap()] {
        for stratum in Stratum::ALL {
            let rays = stratum.rays(&mesh, 500, 1);
            let valid = rays.iter().filter(|r| r.is_valid()).count();
            match stratum {
                Stratum::Invalid => assert_eq!(valid, 0),
                _ => assert!(valid >= 150, "{}: only {valid} of 500 are valid", stratum.name()),
            }
        }
    }
}

#[test]
fn the_same_seed_gives_the_same_rays_and_strata_differ() {
    let mesh = pyramid();
    let text = |s: Stratum, seed| s.rays(&mesh, 20, seed).iter().map(Ray::to_string).collect::<Vec<_>>();
    assert_eq!(Stratum::ALL.iter().map(|s| s.name()).collect::<HashSet<_>>().len(), Stratum::ALL.len());
    for stratum in Stratum::ALL {
        assert_eq!(text(stratum, 7), text(stratum, 7));
        assert_ne!(text(stratum, 7), text(stratum, 8));
    }
}

#[test]
fn strata_hold_what_they_promise() {
    let mesh = pyramid();
    let zeros = |r: &Ray| r.direction.to_array().iter().filter(|x| **x == 0.0).count();
    let axis = Stratum::AxisParallel.rays(&mesh, 200, 3);
    assert!(axis.iter().all(|r| zeros(r) == 2));
    assert!(axis.iter().any(|r| r.direction.to_array().iter().any(|x| x.to_bits() == 1 << 31)), "a -0.0 occurs");
    assert!(Stratum::FacePlanes.rays(&mesh, 200, 3).iter().all(|r| zeros(r) >= 1));
    let corners = mesh.positions();
    assert!(Stratum::FromVertices.rays(&mesh, 200, 3).iter().all(|r| corners.contains(&r.origin)));
    let far = Stratum::FarOrigins.rays(&mesh, 200, 3);
    assert!(far.iter().all(|r| r.origin.length() > 900.0));

    // `before_its_end` accepts a ray if the exact `t` of its hit rounds to `t_max`.
    let before_its_end = |ray: &&Ray| oracle::nearest(ray, &mesh).is_some_and(|truth| truth.rounded() == ray.t_max);
    let rounded = Stratum::RoundedEnds.rays(&mesh, 400, 3);
    let found: Vec<&Ray> = rounded.iter().filter(before_its_end).collect();
    let largest = found.iter().filter(|ray| ray.t_max == f32::MAX).count();
    assert!(found.len() > 30 && largest > 8, "{} and {largest}", found.len());
}
