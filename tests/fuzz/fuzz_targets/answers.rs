//! `cargo +nightly fuzz run answers`, in this folder's parent.

#![no_main]

#[path = "../target.rs"]
mod target;

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| {
    if let Err(report) = target::Case::read(bytes).check() {
        panic!("{report}");
    }
});
