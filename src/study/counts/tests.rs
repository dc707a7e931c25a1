use super::*;
use crate::registry::Registry;
use crate::scene::Builtin;

#[test]
fn a_cube_is_counted_as_one_would_by_hand() {
    let registry = Registry::builtin();
    let choose = |spec: &str| registry.choose(spec).unwrap();
    let settings = CountSettings {
        structures: ["brute-force", "median-kd", "obvhs-bvh2", "sah-bvh"].map(choose).into(),
        named: Structures::default(),
        guide: choose("sah-kd"),
        workloads: vec![WorkloadKind::Primary, WorkloadKind::Mirror],
        rays: 400,
        seed: 1,
        threads: Threads::new(1).unwrap(),
        overlap: true,
    };
    let scene = Builtin::find("cube").unwrap().scene(None).unwrap();
    let Counts { measures, refused, .. } = count_scene(&scene, &settings, &mut |_| ()).unwrap();
    assert_eq!((measures.len(), refused.len()), (4, 0));

    // Twelve triangles are fewer than the report's 100: both are one leaf.
    for one in &measures[..2] {
        assert_eq!((one.tree.inner_nodes, one.tree.leaves, one.tree.references), (0, 1, 12), "{one:?}");
        assert_eq!((one.tree.mean_leaf, one.tree.duplication, one.tree.depth), (Some(12.0), Some(1.0), 0));
        assert_eq!(one.tree.end_point_overlap, Some(0.0));
        assert_eq!(one.tree.leaf_sizes.iter().collect::<Vec<_>>(), [(12, 1)]);
        // The cube casts no mirror rays.
        assert_eq!(one.rays.len(), 1);
        let rays = &one.rays[0];
        assert_eq!(rays.leaf_steps_per_ray.map(|n| n <= 1.0), Some(true));
        let hits = rays.hit_rate * rays.rays as f64;
        assert!(
            (rays.tests_over_minimum.unwrap() * hits - rays.tests_per_ray.unwrap() * rays.rays as f64).abs() < 1e-6
        );
    }
    assert_eq!(measures[0].rays[0].tests_per_ray, Some(12.0));
    // Both triangles of a side have the same box, which holds the other one.
    assert!(measures[2].tree.end_point_overlap.unwrap() > 0.0);
    assert!(measures.iter().all(|one| one.rays[0].hits == measures[0].rays[0].hits));
    assert!(!tables(&measures, &[]).is_empty() && !histogram_tables(&measures).is_empty());
}
