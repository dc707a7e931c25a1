use std::process::ExitCode;

use sahara::measure::CountingAllocator;
use sahara::registry::Registry;

/// Counts the peak memory of builds.
#[global_allocator]
static ALLOCATOR: CountingAllocator = CountingAllocator;

fn main() -> ExitCode {
    sahara::cli::main(Registry::builtin())
}
