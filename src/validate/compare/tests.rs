use super::*;
use crate::accel::{Accel, BuildError, Footprint, Observed, Observer, TreeShape};
use crate::brute_force::BruteForce;
use crate::triangle::MollerTrumbore;
use crate::validate::{Stratum, degenerate_meshes};

type Correct = BruteForce<MollerTrumbore>;

/// `damage` receives the bits of `ray.origin.x` and the correct hit.
struct Broken {
    correct: Correct,
    damage: Damage,
    any: fn(bool) -> bool,
}

impl Accel for Broken {
    type Config = ();
    const OBSERVED: Observed = Observed::NONE;

    fn build(_: &Arc<Mesh>, _: &()) -> Result<Self, BuildError> {
        unreachable!("the tests construct it from a correct structure")
    }

    fn closest_hit<O: Observer>(&self, ray: &Ray, _: &mut O) -> Option<Hit> {
        (self.damage)(ray.origin.x.to_bits(), self.correct.closest_hit(ray, &mut ()))
    }

    fn any_hit<O: Observer>(&self, ray: &Ray, observer: &mut O) -> bool {
        (self.any)(self.closest_hit(ray, observer).is_some())
    }

    fn footprint(&self) -> Footprint {
        Accel::footprint(&self.correct)
    }

    fn shape(&self) -> TreeShape {
        Accel::shape(&self.correct)
    }
}

type Damage = fn(u32, Option<Hit>) -> Option<Hit>;

/// If `share` is false, `validate` assumes that structure and reference have different triangle tests.
fn damaged(damage: Damage, any: fn(bool) -> bool, share: bool) -> Validation {
    let mesh = soup();
    let mut reference = Reference::brute_force::<MollerTrumbore>(&mesh).unwrap();
    reference.test = reference.test.filter(|_| share);
    let subject = Broken { correct: Correct::build(&mesh, &Default::default()).unwrap(), damage, any };
    validate(&subject, &reference, &mesh, &Stratum::Random.rays(&mesh, 3000, 1))
}

fn soup() -> Arc<Mesh> {
    degenerate_meshes().into_iter().find(|(name, _)| name == "soup").unwrap().1
}

#[test]
fn damage_is_found_and_told_apart_whoever_judges() {
    let rows: [(&str, Damage, Option<Kind>); 7] = [
        ("none", |_, hit| hit, None),
        ("lost", |bits, hit| hit.filter(|_| bits.wrapping_mul(0x9e37_79b9) >> 24 != 7), Some(Kind::Lost)),
        ("an ulp", |_, hit| hit.map(|h| Hit { t: h.t.next_up(), ..h }), Some(Kind::WrongT)),
        ("far", |_, hit| hit.map(|h| Hit { t: h.t * 1.5, ..h }), Some(Kind::WrongT)),
        ("invented", |_, hit| hit.or(Some(Hit::new(0.25, 3))), Some(Kind::Invented)),
        ("another", |_, hit| hit.map(|h| Hit::new(h.t, 499 - h.prim.index())), Some(Kind::WrongPrimitive)),
        ("outside", |_, hit| hit.map(|h| Hit::new(h.t, 10_000)), Some(Kind::WrongPrimitive)),
    ];
    for (name, damage, kind) in rows {
        for share in [true, false] {
            let v = damaged(damage, |any| any, share);
            // If `share` is false, rounding explains an error of one ulp.
            let kind = kind.filter(|_| share || name != "an ulp");
            let wrong = if share { v.structure_errors } else { v.answer_errors };
            assert_eq!(v.worst_error().map(|worst| worst.kind), kind, "{name}");
            assert!(wrong == v.errors() && (wrong > 0) == kind.is_some(), "{name}: {v:?}");
            assert!(v.rays == 3000 && v.hits > 1000, "{name}: {v:?}");
            assert!(!["none", "lost"].contains(&name) || (wrong, v.ties) == (v.differing, 0), "{name}: {v:?}");
            assert!(name != "lost" || v.worst[0].verdict.contains("the ray hits") && v.worst[0].found.is_none());
            for worst in &v.worst {
                let replayed: Ray = worst.to_string().split('"').nth(1).unwrap().parse().unwrap();
                assert_eq!(replayed, worst.ray, "{name}");
            }
        }
    }
}

#[test]
fn depths_are_judged_by_a_bound_of_rounding() {
    // Rounding in single precision explains a relative error of 2e-6.
    let near = |_, hit: Option<Hit>| hit.map(|h| Hit { t: h.t * (1.0 + 2e-6), ..h });
    let v = damaged(near, |any| any, false);
    assert!(v.depth_errors > 1000 && v.depth_errors + v.reference_errors == v.differing, "{v:?}");
    assert_eq!(v.errors(), 0);
    let worst = &v.worst[0];
    assert!(worst.kind == Kind::Depth && worst.verdict.contains("ulps away"), "{worst}");
    assert_eq!(v.worst_error(), None);
    // If structure and reference share the triangle test, they must return equal bits of `t`.
    let v = damaged(near, |any| any, true);
    assert_eq!((v.depth_errors, v.structure_errors), (0, v.differing));

    // Rounding in single precision rarely explains a relative error of 1e-4.
    let far = |_, hit: Option<Hit>| hit.map(|h| Hit { t: h.t * 1.0001, ..h });
    let v = damaged(far, |any| any, false);
    assert!(v.answer_errors > 1000 && v.depth_errors < 100, "{v:?}");
    assert_eq!(v.worst_error().map(|worst| worst.kind), Some(Kind::WrongT));
}

#[test]
fn contradictory_and_unrepeatable_hits_are_found() {
    let v = damaged(|_, hit| hit, |_| true, true);
    assert!(v.any_hit_errors == v.rays - v.hits && v.structure_errors == 0);
    assert_eq!(v.worst_error().unwrap().kind, Kind::AnyHitDisagrees);

    use std::sync::atomic::{AtomicU32, Ordering};
    static CALLS: AtomicU32 = AtomicU32::new(0);
    let moody = |_, hit: Option<Hit>| hit.filter(|_| !CALLS.fetch_add(1, Ordering::Relaxed).is_multiple_of(3));
    assert!(damaged(moody, |any| any, true).unrepeatable > 0);
}

#[test]
fn a_farther_hit_is_a_lost_nearer_one() {
    let mesh = soup();
    // Triangles 0 to 249 become points. All triangles keep their numbers.
    let keep = mesh.triangles().iter().enumerate().map(|(i, t)| if i < 250 { [t[0]; 3] } else { *t });
    let kept = Mesh::new(mesh.positions().to_vec(), keep.collect()).unwrap();
    let half = Correct::build(&Arc::new(kept), &Default::default()).unwrap();
    let reference = Reference::brute_force::<MollerTrumbore>(&mesh).unwrap();
    let rays = Stratum::Random.rays(&mesh, 3000, 2);
    let v = validate(&half, &reference, &mesh, &rays);
    assert!(v.structure_errors > 500 && v.any_hit_errors == 0);
    let answers = validate(&half, &Reference::structure(reference.accel, "own"), &mesh, &rays);
    assert!(answers.answer_errors > 500 && answers.structure_errors == 0);
    let kinds = |v: &Validation| v.worst.iter().all(|w| w.kind == Kind::Lost);
    assert!(kinds(&v) && kinds(&answers), "misses rank before farther hits");
    // `both` has the rays that hit `half`. Every error on these rays is a lost nearer hit.
    let only = |v: &Validation| v.structure_errors + v.answer_errors;
    let both: Vec<Ray> = rays.into_iter().filter(|ray| half.closest_hit(ray, &mut ()).is_some()).collect();
    let reference = Reference::brute_force::<MollerTrumbore>(&mesh).unwrap();
    let v = validate(&half, &reference, &mesh, &both);
    assert!(only(&v) > 100 && v.worst.iter().all(|w| w.kind == Kind::NearerLost), "{v:?}");
}

#[test]
fn the_number_of_threads_changes_nothing() {
    let run = |threads| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        pool.install(|| damaged(|bits, hit| hit.filter(|_| bits % 5 != 0), |any| any, true))
    };
    assert_eq!(run(1), run(3));
}

#[test]
fn any_hit_that_rounding_may_excuse_is_wrong_if_the_closest_hit_contradicts_it() -> Result<(), BuildError> {
    use glam::Vec3;
    let corners = vec![Vec3::new(1.0, 1.0, 1.0), Vec3::new(2.0, 1.0, 1.25), Vec3::new(1.0, 2.0, 1.5)];
    let mesh = Arc::new(Mesh::new(corners, vec![[0, 1, 2]]).unwrap());
    // The ray starts just above the triangle and points away. Rounding may give a hit at `t` = 0.
    let ray = Ray::new(Vec3::new(1.25, 1.25, 1.187_500_1), Vec3::new(0.1, 0.1, 1.0));
    let reference = Reference::of_test("own", &mesh)?;
    let hits = &reference.closest_hits(&[ray]);
    assert_eq!(hits[..], [None]);
    let expected = ExpectedHits { reference: &reference, mesh: &mesh, rays: &[ray], hits };
    let subject: Box<dyn DynAccel> = Box::new(BruteForce::<MollerTrumbore>::build(&mesh, &Default::default())?);
    let judged = |subject| validate_any_hits(&expected, &[true], subject);
    let alone = judged(None);
    assert_eq!((alone.errors(), alone.test_errors), (0, 1), "{alone:?}");
    let beside = judged(Some(subject.as_ref()));
    assert_eq!((beside.errors(), beside.test_errors, beside.any_hit_errors), (1, 0, 1), "{beside:?}");
    assert_eq!(beside.worst[0].kind, Kind::AnyHitDisagrees);
    Ok(())
}
