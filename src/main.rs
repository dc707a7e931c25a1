use std::process::ExitCode;

use sahara::measure::CountingAllocator;
use sahara::registry::Registry;

/// Measures the peak memory while a structure is built.
#[global_allocator]
static ALLOCATOR: CountingAllocator = CountingAllocator;

fn main() -> ExitCode {
    sahara::cli::main(Registry::builtin())
}
