//! Compares `Exact` with exact arithmetic.

use super::*;
use crate::simd::{Level, Portable};

/// `unit` is so small that products of three lengths underflow, but products of two lengths do not.
#[test]
fn hits_where_only_the_height_underflows_are_found() {
    let unit = libm::exp2f(-51.0);
    let corners = [Vec3::new(1.0, -2.0, -1.0), Vec3::new(2.0, 3.0, 0.0), Vec3::new(-3.0, 3.0, 2.0)].map(|p| p * unit);
    let ray = Ray::new(corners[2], Vec3::NEG_Z);
    assert_eq!(scalar_hit::<Exact>(&ray, corners), Some(0.0));
}

pub(super) fn windowed(rng: &mut Pcg32, ray: Ray, corners: [Vec3; 3]) -> Ray {
    let t = judge::hit(&ray, corners).map_or(1.0, |t| t.round());
    let end = |rng: &mut Pcg32| match rng.next_u32() % 4 {
        0 => t,
        1 => t.next_up(),
        _ => t.next_down(),
    };
    match rng.next_u32() % 4 {
        0 => Ray { t_min: end(rng), ..ray },
        1 => Ray { t_max: end(rng), ..ray },
        _ => ray,
    }
}

#[test]
fn the_exact_test_agrees_with_the_judges_everywhere() {
    let mut rng = Pcg32::seed_from_u64(5);
    let mut hits = 0;
    for round in 0..200_000 {
        let (ray, corners) = hard(&mut rng, round);
        let ray = windowed(&mut rng, ray, corners);
        let found = scalar_hit::<Exact>(&ray, corners);
        assert_eq!(found.map(f32::to_bits), true_t(&ray, corners).map(f32::to_bits), "{ray:?} {corners:?}");
        // `true_t` and `Exact` share code. `rational` and `Exact` share no code.
        if round % 31 == 0 && ray.is_valid() {
            let second = rational::hit_within(&ray, corners);
            assert_eq!(found.map(f32::to_bits), second.map(f32::to_bits), "{ray:?} {corners:?}");
        }
        hits += usize::from(found.is_some());
    }
    assert!(hits > 30_000, "{hits}");
}

pub(super) fn narrow(rng: &mut Pcg32) -> (Ray, [Vec3; 3]) {
    let mut corners = triangle(rng, unit);
    let width = libm::exp2f(-((rng.next_u32() % 24) as f32));
    corners[2] = corners[rng.next_u32() as usize % 2] + point(rng, unit) * width;
    let axis = (rng.next_u32() % 4) as usize;
    if axis < 3 {
        for corner in &mut corners {
            corner[axis] = 0.75;
        }
    }
    let [a, b, c] = corners;
    let weights = [0, 1].map(|_| unit(rng) * 0.5 + 0.5);
    let target = a + (b - a) * weights[0] + (c - a) * (weights[1] * (1.0 - weights[0]));
    let origin = target + point(rng, unit) * libm::exp2f(-((rng.next_u32() % 30) as f32));
    (Ray::new(origin, target - origin), corners)
}

#[test]
fn the_last_bits_of_eight_hits_are_those_of_each() {
    let mut rng = Pcg32::seed_from_u64(8);
    let (mut inputs, mut pending, mut len, mut hits, mut seen) = ([[0.0; 8]; INPUTS], vec![], 1, 0, 0);
    for round in 0..400_000 {
        let (ray, corners) = if round % 2 == 0 { narrow(&mut rng) } else { hard(&mut rng, round / 2) };
        let Some(t) = true_t(&ray, corners) else { continue };
        let (prepared, block) = (Exact::prepare(&ray), Exact::block(&[corners]));
        let (_, first) = Exact::candidates::<1, Portable<1>>(&prepared, &block, 0.0, f32::INFINITY);
        let values = Exact::values(first);
        let depth = Exact::decide_at_once(&prepared, &block, 0, &values)
            .unwrap_or_else(|| Exact::decide(&prepared, &block, 0, &values));
        let lane = (pending.len() + len) % 8;
        for (column, input) in inputs.iter_mut().zip(depth.expect("it is hit").inputs(&ray)) {
            column[lane] = input;
        }
        seen += usize::from(inputs[BETWEEN_BOUNDS][lane].is_finite());
        pending.push((lane, t.to_bits()));
        hits += 1;
        if pending.len() == len {
            let which = pending.iter().fold(0, |which, (lane, _)| which | 1 << lane);
            for level in Level::available() {
                let ts = last_bits::<<Exact as TriangleTest>::Depth<'_>>(level, &inputs, which).map(f32::to_bits);
                for &(lane, t) in &pending {
                    assert_eq!(ts[lane], t, "{level}, {lane} of {which:b}: {inputs:?}");
                }
            }
            inputs = [[[0.0, f32::NAN][len % 2]; 8]; INPUTS];
            pending.clear();
            len = 1 + rng.next_u32() as usize % 8;
        }
    }
    assert!(hits > 200_000 && seen > 50_000, "{seen} of {hits}");
}
