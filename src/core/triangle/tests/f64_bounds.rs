//! Checks the documented error bounds of the `f64` triangle tests against rationals.

use dashu_ratio::RBig;

use super::*;

/// The size of a vector is the sum of the magnitudes of the components.
struct Sizes {
    direction: f64,
    /// The sizes of the vectors from the ray's origin to each corner.
    corners: [f64; 3],
    /// The sizes of the vectors b - a, c - b and a - c, for the corners a, b and c.
    edges: [f64; 3],
}

impl Sizes {
    fn of(ray: &Ray, corners: [Vec3; 3]) -> Self {
        let size = |v: glam::DVec3| v.abs().element_sum();
        let [a, b, c] = corners.map(Vec3::as_dvec3);
        Self {
            direction: size(ray.direction.as_dvec3()),
            corners: [a, b, c].map(|p| size(p - ray.origin.as_dvec3())),
            edges: [b - a, c - b, a - c].map(size),
        }
    }
}

/// The documented bounds of a triangle test. `check` divides `outside` and `t` by the magnitude of the determinant.
struct Bounds {
    /// The smallest magnitude of the determinant for which the test must find a hit.
    found: f64,
    /// In `check`, a barycentric of a reported hit must be at least `-outside / determinant`.
    outside: [f64; 3],
    t: f64,
}

fn of_moller_trumbore(sizes: &Sizes, t: f64) -> Bounds {
    let (d, s) = (sizes.direction, sizes.corners[0]);
    let e = sizes.edges[0] + sizes.edges[2];
    let unit = libm::exp2(-46.0) * d * e;
    Bounds { found: unit * e, outside: [unit * (s + 2.0 * e); 3], t: libm::exp2(-51.0) * e * e * (s + t.abs() * d) }
}

fn of_edges(sizes: &Sizes, t: f64) -> Bounds {
    let [a, b, c] = sizes.corners;
    let [ab, bc, ca] = sizes.edges;
    let d = sizes.direction;
    let outside = [b * bc, c * ca, a * ab].map(|area| libm::exp2(-47.0) * d * area);
    Bounds { found: libm::exp2(-48.0) * d * ab * ca, outside, t: libm::exp2(-49.0) * ab * ca * (a + t.abs() * d) }
}

fn f64_of(x: &RBig) -> f64 {
    x.to_f64().value()
}

fn ulp(t: f64) -> f64 {
    let t = t.abs() as f32;
    f64::from(t.next_up()) - f64::from(t)
}

#[derive(Debug, Default)]
struct ErrorCounts {
    hits: u32,
    lost: u32,
    invented: u32,
    /// The hits whose `t` has an error of more than an ulp.
    off: u32,
}

fn check<T: TriangleTest>(ray: &Ray, corners: [Vec3; 3], bounds: fn(&Sizes, f64) -> Bounds, counts: &mut ErrorCounts) {
    let found = scalar_hit::<T>(ray, corners);
    let Some(rational::Solution { determinant, u, v, t }) = rational::solve(ray, corners) else {
        assert_eq!(found, None, "{}: a parallel ray hits: {ray:?} {corners:?}", T::NAME);
        return;
    };
    let is_hit = rational::hit_within(ray, corners).is_some();
    let (determinant, t) = (f64_of(&determinant).abs(), f64_of(&t));
    let Bounds { found: sure, outside, t: off } = bounds(&Sizes::of(ray, corners), t);
    let off = off / determinant + 0.51 * ulp(t);
    match found {
        Some(found) => {
            let barycentrics = [RBig::ONE - &u - &v, u, v];
            for (barycentric, outside) in barycentrics.iter().zip(outside) {
                let (is, may) = (f64_of(barycentric), -outside / determinant);
                assert!(is >= may, "{}: {is:e} is below {may:e}: {ray:?} {corners:?}", T::NAME);
            }
            let error = (f64::from(found) - t).abs();
            assert!(error <= off, "{}: t = {t:e} is off by {error:e} > {off:e}: {ray:?} {corners:?}", T::NAME);
            counts.hits += 1;
            counts.invented += u32::from(!is_hit);
            counts.off += u32::from(error > ulp(t));
        }
        None if is_hit => {
            // Near an end of the interval, rounding of `t` may lose the hit.
            let at_an_end = t <= off || t + off >= f64::from(f32::MAX);
            assert!(determinant < sure || at_an_end, "{}: a sure hit is lost: {ray:?} {corners:?}", T::NAME);
            counts.lost += 1;
        }
        None => {}
    }
}

fn needle(rng: &mut Pcg32) -> (Ray, [Vec3; 3]) {
    let long = point(rng, unit) * 1e6;
    let thin = |rng: &mut Pcg32| point(rng, unit) * libm::exp2f((rng.next_u32() % 20) as f32 - 8.0);
    let corners = [long, -long + thin(rng), long * unit(rng) + thin(rng)];
    let inside = (corners[0] + corners[1] + corners[2]) / 3.0;
    let target = inside + (corners[0] - inside) * unit(rng).abs();
    let origin = inside + thin(rng) + long * (0.1 * unit(rng));
    (Ray::new(origin, (target - origin) * libm::exp2f((rng.next_u32() % 8) as f32 - 8.0)), corners)
}

fn check_bounds<T: TriangleTest>(bounds: fn(&Sizes, f64) -> Bounds) {
    let mut rng = Pcg32::seed_from_u64(14);
    let mut counts = ErrorCounts::default();
    for round in 0..12_000 {
        let (ray, corners) = if round % 2 == 0 { needle(&mut rng) } else { hard(&mut rng, round / 2) };
        if ray.is_valid() && corners.iter().all(|p| p.is_finite()) {
            check::<T>(&ray, corners, bounds, &mut counts);
        }
    }
    let ErrorCounts { hits, lost, invented, off } = counts;
    // The bounds are tested only if errors occur.
    assert!(hits > 2_000 && lost > 0 && invented > 0 && off > 20, "{}: {counts:?}", T::NAME);
}

#[test]
fn tests_in_f64_keep_their_bounds() {
    check_bounds::<MollerTrumboreF64>(of_moller_trumbore);
    check_bounds::<EdgeF64>(of_edges);
}
