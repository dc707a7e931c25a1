//! Checks `filter_block`, the first stage of `Exact`.

use super::super::filter::{FilterBlock, FilterRay, filter_block};
use super::*;
use crate::exact::ExactT;
use crate::simd::{EightLanes, Kernel, Level, dispatch};

/// The first output is true if lane 3 is a candidate. The second output contains the bounds of `t` in lane 3. The
/// second output is `None` if the hit is uncertain.
struct Look<'a>(&'a Ray, [Vec3; 3], f32);

impl Kernel for Look<'_> {
    type Output = (bool, Option<(f32, f32)>);

    #[inline(always)]
    fn run<L: EightLanes>(self) -> Self::Output {
        let Look(ray, corners, to) = self;
        let (candidates, first) = filter_block::<8, L>(&FilterRay::new(ray), &FilterBlock::new(&[corners; 4]), to);
        assert_eq!(candidates >> 4, 0, "a lane left over is a candidate");
        let bounds = first.bounds();
        (candidates >> 3 & 1 == 1, (bounds.sure >> 3 & 1 == 1).then(|| (bounds.low[3], bounds.high[3])))
    }
}

fn near(rng: &mut Pcg32) -> (Ray, [Vec3; 3]) {
    let scale = libm::exp2f((rng.next_u32() % 80) as f32 - 50.0);
    let corners = triangle(rng, unit).map(|p| p * scale);
    let (origin, [a, b, c]) = (point(rng, unit) * scale * 4.0, corners);
    let (u, v) = (unit(rng) * 0.7 + 0.3, unit(rng) * 0.7 + 0.3);
    let direction = (a + (b - a) * u + (c - a) * v - origin) * libm::exp2f((rng.next_u32() % 60) as f32 - 30.0);
    (Ray::new(origin, direction), corners)
}

#[test]
fn the_first_stage_loses_no_hit_is_right_when_sure_and_leaves_little() {
    let mut rng = Pcg32::seed_from_u64(6);
    let (mut hits, mut sure, mut narrow, mut cut) = (0, 0, 0, 0);
    // `misses`, `kept`, `met` and `unsure` count only rays from `near` with an infinite `to`.
    let (mut misses, mut kept, mut met, mut unsure) = (0, 0, 0, 0);
    for round in 0..400_000 {
        let (ray, corners) = match round % 3 {
            0 => near(&mut rng),
            1 => super::exact::narrow(&mut rng),
            _ => hard(&mut rng, round / 3),
        };
        if !ray.is_valid() {
            continue;
        }
        let truth = judge::hit(&ray, corners);
        let within = |low: f32, high: f32, t: &ExactT| {
            t.compare(low) != Some(std::cmp::Ordering::Less) && t.compare(high) != Some(std::cmp::Ordering::Greater)
        };
        let t = truth.as_ref().map_or(1.0, ExactT::round);
        let to = [f32::INFINITY, t * 0.99, t.next_down(), t, t.next_up()][rng.next_u32() as usize % 5].max(0.0);
        for level in Level::available() {
            let (candidate, seen) = dispatch(level, Look(&ray, corners, to));
            if let Some(t) = &truth
                && within(0.0, to, t)
            {
                assert!(candidate, "{level}: lost {ray:?} {corners:?} up to {to:?}");
            }
            cut += usize::from(!candidate && truth.is_some());
            if round % 3 == 0 && to == f32::INFINITY {
                match truth {
                    None => (misses, kept) = (misses + 1, kept + usize::from(candidate)),
                    Some(_) if candidate => (met, unsure) = (met + 1, unsure + usize::from(seen.is_none())),
                    Some(_) => {}
                }
            }
            let Some((low, high)) = seen else { continue };
            let t = truth.as_ref().unwrap_or_else(|| panic!("{level}: not met by {ray:?}: {corners:?}"));
            assert!(within(low, high, t), "{level}: {t:?} is not in [{low:?}, {high:?}] {ray:?} {corners:?}");
            narrow += usize::from(high - low < 1e-3 * high);
            sure += 1;
        }
        hits += usize::from(truth.is_some_and(|t| within(0.0, f32::MAX, &t)));
    }
    let levels = Level::available().len();
    let shares = [hits, sure / levels, narrow / levels, cut / levels];
    assert!(shares[0] > 100_000 && shares[1] > 50_000 && shares[2] > 40_000 && shares[3] > 10_000, "{shares:?}");
    assert!(misses > 10_000 && kept < misses / 100, "{kept} of {misses} misses survive");
    assert!(met > 10_000 && unsure < met / 50, "{unsure} of {met} hits are not certain");
}
