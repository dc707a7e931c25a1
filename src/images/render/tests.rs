//! Checks the rays and pictures of the renderer.

use super::picture::primary;
use super::{RayCounts, count_rays, shade};
use crate::accel::Accel;
use crate::brute_force::BruteForce;
use crate::kdtree::{KdConfig, KdTree};
use crate::scene::tests::of_the_report;
use crate::scene::{Sampling, Scene, Workload, WorkloadKind};
use crate::triangle::{Exact, MollerTrumbore};

#[test]
fn only_needed_rays_are_traced() {
    let mut scene = of_the_report("infinitycandy");
    let all = BruteForce::<MollerTrumbore>::build(&scene.mesh, &Default::default()).unwrap();
    let mut count = |change: &dyn Fn(&mut Scene)| {
        change(&mut scene);
        count_rays(&scene, &all, &primary(&scene, [16, 16]))
    };
    let three = count(&|scene| scene.recursion_limit = 3);
    assert!(three.mirror > 2 * 256 && three.mirror <= 3 * 256, "{three:?}");
    let dark = count(&|scene| scene.lights.clear());
    assert_eq!(dark, RayCounts { shadow: 0, ..three });
    let flat = count(&|scene| scene.materials.iter_mut().for_each(|m| m.mirror = 0.0));
    assert_eq!(flat, RayCounts { primary: 256, mirror: 0, shadow: 0 });
}

#[test]
fn the_picture_does_not_depend_on_threads() {
    let scene = of_the_report("metallic");
    let tree = KdTree::<MollerTrumbore>::build(&scene.mesh, &KdConfig::SAH).unwrap();
    let with = |threads| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        let rays = primary(&scene, [90, 70]);
        pool.install(|| (shade(&scene, &tree, &rays), count_rays(&scene, &tree, &rays)))
    };
    assert_eq!(with(1), with(3));
}

#[test]
fn picture_workloads_hold_the_rays_that_the_renderer_counts() {
    let scene = of_the_report("infinitycandy");
    let size = [40, 40];
    let tree = KdTree::<MollerTrumbore>::build(&scene.mesh, &KdConfig::SAH).unwrap();
    let counts = count_rays(&scene, &tree, &primary(&scene, size));
    let sampling = Sampling { size, ..Sampling::of(&scene) };
    let count = |kind| Workload::new(&scene, kind, &sampling, &tree).rays.len() as u64;
    assert!(counts.mirror > 5 * counts.primary);
    assert_eq!(count(WorkloadKind::Image), counts.primary + counts.mirror);
    assert_eq!(count(WorkloadKind::ImageShadow), counts.shadow);
}

#[test]
fn a_mirrored_cube_looks_as_the_cube_itself() {
    let folder = tempfile::tempdir().unwrap();
    let picture = |sca: &str| {
        let path = folder.path().join("cube.toml");
        let text = format!(
            "name = \"Mirrored\"\ncamera = {{ eye = [0, 2, 5], target = [0, 0.5, 0], vertical_fov = 45 }}\n\
             lights = [{{ pos = [3, 5, 4], col = [1, 1, 1] }}]\nobjects = [{{ mesh = \"cube\", sca = {sca} }}]"
        );
        std::fs::write(&path, text).unwrap();
        let scene = Scene::read(&path, None).unwrap();
        let all = BruteForce::<Exact>::build(&scene.mesh, &Default::default()).unwrap();
        shade(&scene, &all, &primary(&scene, [48, 48]))
    };
    let plain = picture("[1, 1, 1]");
    for sca in ["[-1, 1, 1]", "[1, 1, -1]", "[-1, -1, -1]", "[-1, -1, 1]"] {
        assert!(picture(sca) == plain, "{sca}");
    }
}
