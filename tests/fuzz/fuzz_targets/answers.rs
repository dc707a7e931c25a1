//! This libFuzzer target runs with `cargo +nightly fuzz run --fuzz-dir tests/fuzz answers`.

#![no_main]

#[path = "../target.rs"]
mod target;

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| {
    if let Err(report) = target::Case::read(bytes).check() {
        panic!("{report}");
    }
});
