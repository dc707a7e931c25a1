use std::sync::Arc;

use glam::Vec3;

use super::*;
use crate::accel::{Accel, DynAccel};
use crate::geometry::Mesh;
use crate::kdtree::{KdConfig, KdTree};
use crate::scene::{Camera, Light, Material, Model, Offset, meshes};
use crate::triangle::MollerTrumbore;

fn room() -> Scene {
    let square = |y: f32| [[-4.0, y, -4.0], [-4.0, y, 4.0], [4.0, y, 4.0], [4.0, y, -4.0]].map(Vec3::from_array);
    let model = Model {
        positions: [square(0.0), square(2.0)].concat(),
        triangles: vec![[0, 1, 2], [0, 2, 3], [4, 6, 5], [4, 7, 6]],
        materials: vec![Material { mirror: 0.5, ..Material::named("floor") }, Material::named("ceiling")],
        material_of: vec![0, 0, 1, 1],
        ..Model::default()
    };
    let light = |x| Light { position: Vec3::new(x, 1.0, 0.0), colour: Vec3::ONE, linear: 0.0, quadratic: 0.0 };
    Scene {
        lights: vec![light(-1.0), light(1.0)],
        camera: Camera::new(Vec3::new(0.0, 1.0, 6.0), Vec3::new(0.0, 0.9, 0.0), Vec3::Y, 60.0).unwrap(),
        shadow_terminator_fix: true,
        offset: Offset::Direction(0.01),
        size: [24, 16],
        ..Scene::framed("room", model).unwrap()
    }
}

fn tree(scene: &Scene) -> KdTree<MollerTrumbore> {
    KdTree::build(&scene.mesh, &KdConfig::SAH).unwrap()
}

fn workload(scene: &Scene, kind: WorkloadKind) -> Workload {
    Workload::new(scene, kind, &Sampling::of(scene), &tree(scene))
}

#[test]
fn every_kind_has_valid_rays_and_is_the_same_again() {
    let scene = room();
    for kind in WorkloadKind::ALL {
        let rays = workload(&scene, kind);
        assert!(!rays.rays.is_empty(), "{kind:?}");
        assert!(rays.rays.iter().all(Ray::is_valid), "{kind:?}");
        assert_eq!(rays, workload(&scene, kind), "{kind:?}");
        assert_eq!(rays.hash().len(), 16);
    }
}

#[test]
fn the_seed_changes_the_random_kinds_and_no_others() {
    let scene = room();
    let with = |kind, seed| Workload::new(&scene, kind, &Sampling { seed, ..Sampling::of(&scene) }, &tree(&scene));
    for kind in WorkloadKind::ALL {
        let random = matches!(kind, WorkloadKind::Diffuse | WorkloadKind::Ambient | WorkloadKind::Random);
        assert_eq!(with(kind, 1).hash() != with(kind, 2).hash(), random, "{kind:?}");
    }
}

#[test]
fn the_number_of_secondary_rays_follows_from_hits_and_lights() {
    let scene = room();
    let primary = workload(&scene, WorkloadKind::Primary);
    let surface_hits = bounces::surface_hits(&scene, &primary.rays, &tree(&scene));
    let (floor, hits) = (surface_hits.iter().filter(|h| h.hit.prim.index() < 2).count(), surface_hits.len());
    assert!(floor > 0 && floor < hits && hits < primary.rays.len());
    let count = |kind| workload(&scene, kind).rays.len();
    assert_eq!(primary.rays.len(), 24 * 16);
    assert_eq!(count(WorkloadKind::Shadow), 2 * hits);
    assert_eq!([WorkloadKind::Mirror, WorkloadKind::Diffuse, WorkloadKind::Ambient].map(count), [hits; 3]);
    assert_eq!(count(WorkloadKind::Axis), 6 * 8 * 8);
    // Each primary hit on the floor adds one mirror ray. Mirror rays do not hit the floor.
    assert_eq!(count(WorkloadKind::Image), 24 * 16 + floor);
}

#[test]
fn bounces_leave_on_the_side_they_came_from() {
    let scene = room();
    for kind in [WorkloadKind::Mirror, WorkloadKind::Diffuse, WorkloadKind::Ambient] {
        for ray in workload(&scene, kind).rays {
            assert!(ray.origin.y > 0.0 && ray.origin.y < 2.0, "{kind:?} {ray:?}");
        }
    }
}

#[test]
fn bounces_off_a_framed_convex_mesh_hit_nothing_at_any_size_and_place() {
    let hidden = |offset: Option<Offset>, radius: f32, centre: f32| {
        let mut model = meshes::icosphere(4);
        model.positions.iter_mut().for_each(|p| *p = *p * radius + centre);
        model.normal_indices.clear();
        let framed = Scene::framed("sphere", model).unwrap();
        let scene = Scene { size: [64, 64], offset: offset.unwrap_or(framed.offset), ..framed };
        let (rays, tree) = (workload(&scene, WorkloadKind::Diffuse).rays, tree(&scene));
        assert!(rays.len() > 1000);
        tree.any(&rays).into_iter().filter(|hidden| *hidden).count()
    };
    for (radius, centre) in [(1.0, 0.0), (1e-6, 0.0), (1e6, 0.0), (1.0, 1e3), (10.0, 1e5)] {
        assert_eq!(hidden(None, radius, centre), 0, "r = {radius} at {centre}");
    }
    // Without an offset, many rays hit the triangle that they leave.
    assert!(hidden(Some(Offset::Direction(0.0)), 10.0, 1e5) > 300);
}

#[test]
fn the_axis_lattice_contains_coordinates_of_vertices() {
    let scene = room();
    let vertices: Vec<f32> = scene.mesh.positions().iter().map(|p| p.x).collect();
    let rays = workload(&scene, WorkloadKind::Axis).rays;
    let meeting = rays.iter().filter(|r| r.direction.x == 0.0 && vertices.contains(&r.origin.x)).count();
    assert_eq!(meeting, rays.len() * 4 / 6 / 4);
}

#[test]
fn a_limit_picks_rays_at_equal_distances() {
    let scene = room();
    let all = workload(&scene, WorkloadKind::Primary);
    let sampling = Sampling { limit: 96, ..Sampling::of(&scene) };
    let some = Workload::new(&scene, WorkloadKind::Primary, &sampling, &tree(&scene));
    assert_eq!(some.rays, all.rays.iter().step_by(4).copied().collect::<Vec<_>>());
    assert_ne!(some.hash(), all.hash());
}

#[test]
fn an_empty_scene_and_one_without_lights_have_no_secondary_rays() {
    let dark = Scene { lights: vec![], ..room() };
    assert!(workload(&dark, WorkloadKind::Shadow).rays.is_empty());
    assert!(workload(&dark, WorkloadKind::ImageShadow).rays.is_empty());

    let empty = Scene { mesh: Arc::new(Mesh::new(vec![], vec![]).unwrap()), material_of: vec![], ..room() };
    for kind in WorkloadKind::ALL {
        let seen = matches!(kind, WorkloadKind::Primary | WorkloadKind::Corners | WorkloadKind::Image);
        assert_eq!(workload(&empty, kind).rays.is_empty(), !seen, "{kind:?}");
    }
}
