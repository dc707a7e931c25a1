//! Measures the peak memory of a function call.

use std::alloc::{GlobalAlloc, Layout, System};
use std::sync::atomic::{AtomicBool, AtomicIsize, Ordering};
use std::sync::{Mutex, PoisonError};

/// Counts allocated bytes during [`peak_bytes`]. Allocations of C and C++ code are not counted.
pub struct CountingAllocator;

static COUNTS: AtomicBool = AtomicBool::new(false);
static LIVE: AtomicIsize = AtomicIsize::new(0);
static PEAK: AtomicIsize = AtomicIsize::new(0);

impl CountingAllocator {
    #[inline]
    fn add(bytes: isize) {
        if COUNTS.load(Ordering::Relaxed) {
            let live = LIVE.fetch_add(bytes, Ordering::Relaxed) + bytes;
            PEAK.fetch_max(live, Ordering::Relaxed);
        }
    }
}

// SAFETY: every method passes its arguments unchanged to `System`. `System` fulfils the contract of `GlobalAlloc`.
// Counting neither allocates nor panics.
unsafe impl GlobalAlloc for CountingAllocator {
    unsafe fn alloc(&self, layout: Layout) -> *mut u8 {
        Self::add(layout.size() as isize);
        // SAFETY: the caller fulfils the contract of `GlobalAlloc::alloc`. `System.alloc` has the same contract.
        unsafe { System.alloc(layout) }
    }

    unsafe fn dealloc(&self, pointer: *mut u8, layout: Layout) {
        Self::add(-(layout.size() as isize));
        // SAFETY: as in `alloc`. All methods of this type allocate with `System`, so `pointer` comes from `System`.
        unsafe { System.dealloc(pointer, layout) }
    }

    unsafe fn alloc_zeroed(&self, layout: Layout) -> *mut u8 {
        Self::add(layout.size() as isize);
        // SAFETY: as in `alloc`.
        unsafe { System.alloc_zeroed(layout) }
    }

    unsafe fn realloc(&self, pointer: *mut u8, layout: Layout, size: usize) -> *mut u8 {
        Self::add(size as isize - layout.size() as isize);
        // SAFETY: as in `dealloc`.
        unsafe { System.realloc(pointer, layout, size) }
    }
}

/// Returns the result of `work` and the peak increase of allocated bytes. The peak includes allocations of all threads.
/// Without an installed [`CountingAllocator`], the peak is `None`. Only one call runs at a time, so `work` must not
/// call `peak_bytes`.
pub fn peak_bytes<R>(work: impl FnOnce() -> R) -> (R, Option<usize>) {
    static ONE: Mutex<()> = Mutex::new(());
    /// Stops the counter on drop, also after a panic.
    struct Counting;
    impl Drop for Counting {
        fn drop(&mut self) {
            COUNTS.store(false, Ordering::Relaxed);
        }
    }

    let _one = ONE.lock().unwrap_or_else(PoisonError::into_inner);
    LIVE.store(0, Ordering::Relaxed);
    PEAK.store(0, Ordering::Relaxed);
    COUNTS.store(true, Ordering::Relaxed);
    let counting = Counting;
    // Only an installed `CountingAllocator` counts this allocation.
    drop(std::hint::black_box(Box::new(0_u64)));
    let installed = PEAK.load(Ordering::Relaxed) > 0;
    let result = work();
    drop(counting);
    let peak = usize::try_from(PEAK.load(Ordering::Relaxed)).expect("a peak is at least 0");
    (result, installed.then_some(peak))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_peak_is_the_most_at_once() {
        let of = |bytes| Layout::from_size_align(bytes, 8).unwrap();
        let (counted, peak) = peak_bytes(|| {
            // SAFETY: no layout has size 0. No pointer is dereferenced. Every block is freed with its current layout.
            unsafe {
                let (a, b) = (CountingAllocator.alloc(of(1000)), CountingAllocator.alloc_zeroed(of(500)));
                CountingAllocator.dealloc(a, of(1000));
                let b = CountingAllocator.realloc(b, of(500), 800);
                CountingAllocator.dealloc(b, of(800));
            }
            (PEAK.load(Ordering::Relaxed), LIVE.load(Ordering::Relaxed))
        });
        assert_eq!(peak, None, "the allocator is not installed in the test program");
        assert_eq!(counted, (1500, 0));
    }
}
