use std::sync::Arc;

use glam::Vec3;

use super::*;
use crate::accel::Counts;
use crate::structures::binary_check::{mesh, soup};
use crate::structures::split::Quality;
use crate::triangle::MollerTrumbore;

type Tree = WideTree<MollerTrumbore>;

const ALL: [Partition; 4] = [Partition::Cells, Partition::Tight, Partition::Hybrid, Partition::Objects];

#[test]
fn lanes_left_over_are_not_counted_as_triangles() {
    let ray = Ray::new(Vec3::ZERO, Vec3::ONE);
    for n in [1, 8, 9] {
        let mesh = Arc::new(mesh(n, |_| [Vec3::X, Vec3::Y, Vec3::Z]));
        let mut counts = Counts::default();
        Tree::build(&mesh, &WideConfig::default()).unwrap().closest_hit(&ray, &mut counts);
        assert_eq!(counts.tests, n as u64);
    }
}

#[test]
fn the_unit_of_length_does_not_matter() {
    let metres = soup(2000, 31);
    let build = |unit: f32, config: &WideConfig| {
        let positions = metres.positions().iter().map(|&p| p * unit).collect();
        let mesh = Arc::new(Mesh::new(positions, metres.triangles().to_vec()).unwrap());
        Tree::build(&mesh, config).unwrap().shape()
    };
    for partition in ALL {
        for quality in [Quality::Fast, Quality::Balanced] {
            let config = WideConfig { quality, ..WideConfig::new(partition) };
            let shape = build(1.0, &config);
            for exponent in [-90, -60, 60, 100] {
                assert_eq!(build(libm::exp2(f64::from(exponent)) as f32, &config), shape, "{config:?}, 2^{exponent}");
            }
        }
    }
}

/// A direction may be so short on an axis that its inverse is finite and the enlarged inverse is not. This one passes the first
/// triangle by less than the test can see.
#[test]
fn packets_leave_alone_what_their_common_bounds_cannot_tell() {
    let mesh = mesh(200, |i| {
        let z = 1.0 + i as f32;
        [Vec3::new(0.0, 0.01 * z, z), Vec3::new(1.0, -1000.0, z), Vec3::new(1.0, 1000.0, z)]
    });
    let mesh = Arc::new(mesh);
    let along = |x: f32| Ray::new(Vec3::ZERO, Vec3::new(x, 0.01, 1.0));
    let mut rays = [along(-1e-3); 16];
    rays[5] = along(-2.938737e-39);
    for partition in ALL {
        let tree = Tree::build(&mesh, &WideConfig { packets: true, ..WideConfig::new(partition) }).unwrap();
        let mut hits = [None; 16];
        tree.closest_hits(&rays, &mut hits, &mut ());
        assert_eq!(hits, rays.map(|ray| tree.closest_hit(&ray, &mut ())));
        assert!(hits[5].is_some(), "nothing is proven by a ray that hits nothing");
    }
}

/// Two triangles of opposite determinants, hit at -0.0 and at 0.0: both as near, so that the lower number wins, with its own zero.
#[test]
fn packets_find_the_zero_of_the_lower_number() {
    let (x, y) = ([Vec3::ZERO, Vec3::X, Vec3::Y], [Vec3::ZERO, Vec3::Y, Vec3::X]);
    let rays = [Ray::new(Vec3::ZERO, Vec3::new(0.1, 0.1, 1.0)); 16];
    for corners in [[x, y], [y, x]] {
        let mesh = Arc::new(mesh(2, |i| corners[i]));
        let tree = Tree::build(&mesh, &WideConfig { packets: true, ..WideConfig::default() }).unwrap();
        let alone = tree.closest_hit(&rays[0], &mut ()).unwrap();
        let mut hits = [None; 16];
        tree.closest_hits(&rays, &mut hits, &mut ());
        for hit in hits.map(Option::unwrap) {
            assert_eq!((hit.prim.index(), hit.t.to_bits()), (0, alone.t.to_bits()));
        }
    }
}
