use std::hint::black_box;
use std::slice;

use crate::accel::DynAccel;
use crate::geometry::Ray;
use crate::measure::Clock;

/// How often each ray is asked: what else the machine does meets no ray every time.
const PASSES: usize = 3;

/// The longest that any of `rays` takes when it is asked alone, nanoseconds: of each ray the least of its times, of these the most.
pub fn slowest(accel: &dyn DynAccel, rays: &[Ray], clock: &dyn Clock) -> u64 {
    let mut least = vec![u64::MAX; rays.len()];
    for _ in 0..PASSES {
        for (ray, least) in rays.iter().zip(&mut least) {
            let start = clock.now_ns();
            black_box(accel.closest(slice::from_ref(ray)));
            *least = (*least).min(clock.now_ns() - start);
        }
    }
    least.into_iter().max().unwrap_or(0)
}
