//! All integration tests form one binary to reduce the build time.

use sahara::measure::CountingAllocator;

mod alone;
mod browser;
mod cli;
mod conformance;
mod controls;
mod fetch;
mod findings;
mod golden;
mod hard_cases;
mod hostile_files;
mod layers;
mod levels;
mod licences;
mod oracle;
mod peers;
mod properties;
mod real_meshes;
mod third_party;

/// Some tests measure memory with this allocator.
#[global_allocator]
static ALLOCATOR: CountingAllocator = CountingAllocator;
