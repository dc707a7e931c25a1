use glam::Vec3;

use super::{CellConfig, build};
use crate::build::sah_cost::CostModel;
use crate::build::{Quality, check};
use crate::geometry::Mesh;

fn cells() -> Vec<CellConfig> {
    let costs = CostModel::new(1.0, 0.7, 0.2);
    let all = CellConfig { costs, exact: CellConfig::ALL_PLANES, candidates: 32, sample: 16384 };
    let few = CellConfig { costs, exact: 100, candidates: 3, sample: 50 };
    let sah = [Quality::Fast, Quality::Balanced, Quality::High].map(CellConfig::new);
    [&sah[..], &[all, few]].concat()
}

#[test]
fn cells_as_tight_boxes_partition_space_and_lose_nothing() {
    for (mesh, seed) in [(check::soup(1500, 12), 13), (check::room(8), 14)] {
        for config in cells() {
            let tree = build(&mesh, &config, 4.0);
            check::disjoint(&check::leaves(&tree, 64));
            check::covers(&tree, &mesh, seed);
        }
    }
}

#[test]
fn full_cells_without_a_cut_become_several_leaves() {
    let coincident = check::mesh(1000, |_| [Vec3::X, Vec3::Y, Vec3::Z]);
    for config in cells() {
        let tree = build(&coincident, &config, 4.0);
        assert_eq!(tree.references.len(), 1000, "{config:?}");
        assert!(check::leaves(&tree, 64).len() >= 16);
        check::covers(&tree, &coincident, 16);

        let nothing = Mesh::new(vec![Vec3::ZERO, Vec3::X, Vec3::X * 2.0], vec![[0, 1, 2]]).unwrap();
        assert!(build(&nothing, &config, 4.0).nodes.is_empty(), "degenerate triangles are in no leaf");
    }
}
