//! Huge pages for large arrays, and prefetching.

/// Requests huge pages from Linux. With pages of 4 KiB, random reads of a few megabytes often miss the TLB.
pub(crate) fn with_capacity<T>(len: usize) -> Vec<T> {
    let values = Vec::with_capacity(len);
    advise(values.as_ptr(), len * size_of::<T>());
    values
}

pub(crate) fn moved<T: Copy>(values: Vec<T>) -> Vec<T> {
    let mut moved = with_capacity(values.len());
    moved.extend_from_slice(&values);
    moved
}

/// Prefetches a cache line. The address `at` may be invalid.
#[inline(always)]
pub(crate) fn fetch(at: *const u8) {
    #[cfg(target_arch = "x86_64")]
    // SAFETY: a prefetch never faults and changes no value. Every x86-64 processor has SSE.
    unsafe {
        use std::arch::x86_64::{_MM_HINT_T0, _mm_prefetch};
        _mm_prefetch::<_MM_HINT_T0>(at.cast());
    }
    #[cfg(not(target_arch = "x86_64"))]
    let _ = at;
}

#[cfg(target_os = "linux")]
fn advise<T>(start: *const T, bytes: usize) {
    use std::ffi::{c_int, c_void};
    // SAFETY: the declaration agrees with `madvise` in the C library of Linux.
    unsafe extern "C" {
        fn madvise(start: *mut c_void, bytes: usize, advice: c_int) -> c_int;
    }
    const MADV_HUGEPAGE: c_int = 14;
    const PAGE: usize = 4096;
    // SAFETY: the advice changes no values. The range from `first` to `end` lies in the memory that `with_capacity` has
    // allocated.
    unsafe {
        let first = start.addr().next_multiple_of(PAGE);
        let end = (start.addr() + bytes) / PAGE * PAGE;
        if first < end {
            madvise(start.with_addr(first).cast_mut().cast(), end - first, MADV_HUGEPAGE);
        }
    }
}

#[cfg(not(target_os = "linux"))]
fn advise<T>(_: *const T, _: usize) {}

#[cfg(test)]
fn are_large<T>(values: &[T]) -> bool {
    let at = values.as_ptr().addr() + size_of_val(values) / 2;
    let maps = std::fs::read_to_string("/proc/self/smaps").unwrap_or_default();
    let holds = |line: &str| {
        let bound = |text: &str| usize::from_str_radix(text, 16).ok();
        let (start, end) = line.split(' ').next()?.split_once('-')?;
        Some((bound(start)?..bound(end)?).contains(&at))
    };
    let mut flags =
        maps.lines().skip_while(|line| holds(line) != Some(true)).filter(|line| line.starts_with("VmFlags:"));
    flags.next().is_some_and(|line| line.split_whitespace().any(|flag| flag == "hg"))
}

#[cfg(test)]
pub(crate) fn assert_large<T>(values: &[T]) {
    let mut probe = with_capacity::<u64>(1 << 20);
    probe.resize(1 << 20, 0);
    assert!(are_large(values) || !are_large(&probe));
}
