//! All integration tests in one binary: the trees are compiled and linked once.

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

/// The allocator of the command.
#[global_allocator]
static ALLOCATOR: CountingAllocator = CountingAllocator;
