//! Runs a test in a separate process.

use std::process::Command;

const ALONE: &str = "SAHARA_TEST_ALONE";

/// Runs the test `path` (`module::function`) in a separate process. Panics if the test fails.
///
/// Returns true in the separate process, and false in the original process.
pub fn alone(path: &str) -> bool {
    if std::env::var_os(ALONE).is_some() {
        return true;
    }
    let mut again = Command::new(std::env::current_exe().unwrap());
    again.args(["--exact", path, "--include-ignored", "--nocapture"]).env(ALONE, "1");
    let output = again.output().unwrap();
    let (out, errors) = (String::from_utf8_lossy(&output.stdout), String::from_utf8_lossy(&output.stderr));
    assert!(output.status.success() && out.contains("1 passed"), "{path}: {out}{errors}");
    print!("{errors}");
    false
}
