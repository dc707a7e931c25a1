use glam::Vec3;
use rand_core::SeedableRng;
use rand_pcg::Pcg32;

use super::*;
use crate::build::check::{straddling_soup, unit};
use crate::triangle::Exact;

fn soup(triangles: usize) -> Arc<Mesh> {
    Arc::new(straddling_soup(triangles, 3))
}

fn rays(count: usize) -> Vec<Ray> {
    let mut random = Pcg32::seed_from_u64(4);
    let mut ray = |i: usize| {
        let whole = Ray::new(unit(&mut random) * 6.0, unit(&mut random));
        match i % 5 {
            0 => Ray { direction: Vec3::AXES[i % 3] * if i.is_multiple_of(2) { -1.0 } else { 1.0 }, ..whole },
            1 => Ray { t_min: 2.0, ..whole },
            2 => Ray { t_max: 3.0, ..whole },
            _ => whole,
        }
    };
    (0..count).map(&mut ray).collect()
}

/// `own` traces a ray with the traversals of the crate `obvhs`.
fn same_answers<B: Tree>(own: impl Fn(&Obvhs<B, Native>, &Ray) -> (Option<Hit>, bool)) {
    for triangles in [1, 2, 3, 3000] {
        let mesh = soup(triangles);
        for preset in [Preset::Fastest, Preset::VerySlow] {
            let built = Obvhs::<B, Native>::build(&mesh, &ObvhsConfig { preset }).unwrap();
            let mut hits = 0;
            for ray in rays(5000) {
                let answers = (built.closest_hit(&ray, &mut ()), built.any_hit(&ray, &mut ()));
                assert_eq!(answers, own(&built, &ray), "{triangles} triangles, {preset:?}, ray \"{ray}\"");
                hits += u32::from(answers.1);
            }
            assert!(triangles < 3000 || (1000..4900).contains(&hits), "{hits} hits");
        }
    }
}

/// `own_walk` is a macro, because the traversals of `obvhs` have no common trait.
macro_rules! own_walk {
    () => {
        |built, ray| {
            let Some((ray, ())) = built.leaves.start(ray) else { return (None, false) };
            let test = |ray: &PreparedRay, index: usize| built.leaves.triangles[index].intersect(ray);
            let mut hit = RayHit::none();
            let found = built.tree.ray_traverse(ray, &mut hit, test).then(|| built.leaves.hit(hit));
            (found, !built.tree.ray_traverse_miss(ray, test))
        }
    };
}

#[test]
fn the_walk_of_each_tree_gives_the_hits_of_its_own() {
    same_answers::<Bvh2>(own_walk!());
    same_answers::<CwBvh>(own_walk!());
}

/// The exact `t` is 1/3, which rounds up to `third`.
#[test]
fn a_hit_that_is_rounded_to_the_end_is_found() {
    fn found<B: Tree>(t_max: f32) -> (Option<Hit>, bool) {
        let mesh = Arc::new(Mesh::new(vec![Vec3::X, Vec3::Y, Vec3::Z], vec![[0, 1, 2]]).unwrap());
        let built = Obvhs::<B, Over<Exact>>::build(&mesh, &ObvhsConfig::default()).unwrap();
        let ray = Ray::new(Vec3::ZERO, Vec3::ONE).until(t_max);
        (built.closest_hit(&ray, &mut ()), built.any_hit(&ray, &mut ()))
    }
    let third: f32 = 1.0 / 3.0;
    for found in [found::<Bvh2>, found::<CwBvh>] {
        assert_eq!(found(third), (Some(Hit::new(third, 0)), true));
        assert_eq!(found(third.next_down()), (None, false));
    }
}

#[test]
fn it_lives_in_the_pages_of_our_own_trees_and_a_link_to_nowhere_is_noticed() {
    let mesh = soup(20_000);
    let mut binary = ObvhsBvh2::<Native>::build(&mesh, &ObvhsConfig::default()).unwrap();
    let count = binary.leaves.len();
    assert!(binary.tree.leads_inside(count) && !binary.tree.leads_inside(count - 1));
    let nodes = binary.tree.nodes.len() as u32;
    binary.tree.nodes.iter_mut().find(|node| !node.is_leaf()).unwrap().first_index = nodes - 1;
    assert!(!binary.tree.leads_inside(count));

    let mut wide = ObvhsCwBvh::<Native>::build(&mesh, &ObvhsConfig::default()).unwrap();
    let count = wide.leaves.len();
    assert!(wide.tree.leads_inside(count) && !wide.tree.leads_inside(count - 1));
    wide.tree.nodes[0].child_base_idx = wide.tree.nodes.len() as u32;
    assert!(!wide.tree.leads_inside(count));

    pages::assert_large(&binary.tree.nodes);
    pages::assert_large(&wide.tree.nodes);
    for leaves in [binary.leaves, wide.leaves] {
        pages::assert_large(&leaves.triangles);
        pages::assert_large(&leaves.ids);
    }
}
