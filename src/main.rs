use std::process::ExitCode;

use sahara::registry::Registry;

fn main() -> ExitCode {
    sahara::cli::main(Registry::builtin())
}
