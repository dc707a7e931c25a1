//! Runs tests in a separate process: their measurements or settings concern the whole process.

use std::process::Command;

/// Set in the process of such a test.
const ALONE: &str = "SAHARA_TEST_ALONE";

/// Runs the test with this path (`module::function`) again in a separate process, and fails if it fails there. Returns
/// whether this is that process: only then the test continues.
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
