//! Memory: large arrays on large pages, and lines fetched ahead.

/// Memory for `len` values that are read at random places, for which the system is asked for huge pages: a walk through a few
/// megabytes in pages of four kilobytes misses the cache of addresses at nearly every node.
///
/// Only Linux is asked, and it may decline; the values are the same.
pub(super) fn with_capacity<T>(len: usize) -> Vec<T> {
    let values = Vec::with_capacity(len);
    advise(values.as_ptr(), len * size_of::<T>());
    values
}

/// Asks for the line of the cache at an address, which may be any.
#[inline(always)]
pub(super) fn fetch(at: *const u8) {
    #[cfg(target_arch = "x86_64")]
    // SAFETY: nothing is read, and there is no fault, whatever the address.
    unsafe {
        use std::arch::x86_64::{_MM_HINT_T0, _mm_prefetch};
        _mm_prefetch::<_MM_HINT_T0>(at.cast());
    }
    #[cfg(not(target_arch = "x86_64"))]
    let _ = at;
}

#[cfg(target_os = "linux")]
fn advise<T>(start: *const T, bytes: usize) {
    const PAGE: usize = 4096;
    // SAFETY: the advice changes no values; it is given for whole pages that lie in one allocation.
    unsafe {
        let first = start.addr().next_multiple_of(PAGE);
        let end = (start.addr() + bytes) / PAGE * PAGE;
        if first < end {
            libc::madvise(start.with_addr(first).cast_mut().cast(), end - first, libc::MADV_HUGEPAGE);
        }
    }
}

#[cfg(not(target_os = "linux"))]
fn advise<T>(_: *const T, _: usize) {}
