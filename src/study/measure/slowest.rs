use std::hint::black_box;
use std::slice;

use crate::accel::DynAccel;
use crate::geometry::Ray;
use crate::measure::Clock;

/// Traces of each ray: a disturbance rarely meets the same ray every time.
const PASSES: usize = 3;

/// The longest time of any of `rays` traced on its own, ns: the maximum over the rays of the minimum over the passes.
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
