//! All integration tests form one binary, which compiles and links the trees only once.

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

/// Tests measure memory with this allocator.
#[global_allocator]
static ALLOCATOR: CountingAllocator = CountingAllocator;
