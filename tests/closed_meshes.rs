//! A million rays from inside each of three closed meshes: through no edge, no vertex and along no axis does one escape the
//! watertight test, the tests in `f64` and the exact one.

use std::sync::Arc;

use glam::Vec3;
use rayon::prelude::*;
use sahara::accel::Accel;
use sahara::geometry::{Mesh, Ray};
use sahara::kdtree::{KdConfig, KdTree};
use sahara::scene::meshes::icosphere;
use sahara::triangle::{EdgeF64, Exact, MollerTrumboreF64, TriangleTest, Watertight};
use sahara::validate::Sampler;
use sahara::validate::hard_cases;

/// How a ray leaves its origin.
#[derive(Clone, Copy, Debug)]
enum Aim {
    Anywhere,
    Edge,
    Vertex,
    Axis,
}

const AIMS: [Aim; 4] = [Aim::Anywhere, Aim::Edge, Aim::Vertex, Aim::Axis];

const RAYS: usize = 1_000_000;

/// Rays from `origins`, which are inside.
fn rays(mesh: &Mesh, aim: Aim, mut origin: impl FnMut(&mut Sampler) -> Vec3) -> Vec<Ray> {
    let mut sampler = Sampler::new(17 + aim as u64);
    let mut ray = || {
        let (mut from, corners) = (origin(&mut sampler), mesh.corners(sampler.below(mesh.len()) as u32));
        let direction = match aim {
            Aim::Anywhere => sampler.direction(),
            Aim::Edge => corners[0].lerp(corners[1], sampler.unit()) - from,
            Aim::Vertex => sampler.pick(&corners) - from,
            Aim::Axis => {
                let (axis, mut along) = (sampler.below(3), Vec3::from_array([(); 3].map(|()| sampler.zero())));
                along[axis] = sampler.sign();
                // Often exactly at a vertex: where its other coordinates are inside.
                let vertex = sampler.pick(&corners);
                let mut shifted = vertex;
                shifted[axis] = from[axis];
                if shifted.abs().max_element() <= from.abs().max_element() {
                    from = shifted;
                }
                along
            }
        };
        Ray::new(from, direction)
    };
    (0..RAYS / AIMS.len()).map(|_| ray()).collect()
}

fn escapes<T: TriangleTest>(mesh: &Arc<Mesh>, rays: &[Ray]) -> usize {
    let tree = KdTree::<T>::build(mesh, &KdConfig::SAH).expect("a valid mesh builds");
    rays.par_iter().filter(|ray| tree.closest_hit(ray, &mut ()).is_none()).count()
}

/// Where a ray starts.
type Origin = fn(&mut Sampler) -> Vec3;

/// The vertices of the cube, origins in it and so edges are on a grid of eighths: rays meet vertices, edges and planes of
/// faces exactly.
#[test]
#[ignore = "millions of rays"]
fn no_ray_escapes_from_a_sphere_a_cube_or_a_star() {
    let model = icosphere(4);
    let sphere = Arc::new(Mesh::new(model.positions, model.triangles).expect("finite"));
    let [cube, star] = ["cube_axis_aligned", "closed_random"]
        .map(|name| hard_cases::find(name).expect("a case of the catalogue").set(1).expect("the case has rays").mesh);
    let eighths = |sampler: &mut Sampler| Vec3::from_array([(); 3].map(|()| (sampler.below(15) as f32 - 7.0) / 8.0));
    let anywhere = |sampler: &mut Sampler| sampler.cube() * 0.5;
    let meshes: [(_, _, Origin); 3] = [("sphere", sphere, anywhere), ("cube", cube, eighths), ("star", star, anywhere)];
    for (name, mesh, origin) in &meshes {
        for aim in AIMS {
            let rays = rays(mesh, aim, origin);
            for (test, leaks) in [
                (Watertight::NAME, escapes::<Watertight>(mesh, &rays)),
                (MollerTrumboreF64::NAME, escapes::<MollerTrumboreF64>(mesh, &rays)),
                (EdgeF64::NAME, escapes::<EdgeF64>(mesh, &rays)),
                (Exact::NAME, escapes::<Exact>(mesh, &rays)),
            ] {
                assert_eq!(leaks, 0, "{name}, {aim:?}: rays that escape through {test}, of {}", rays.len());
            }
        }
    }
}
