//! Build script that records the commit, the compiler and the build settings.

use std::env;
use std::path::{Path, PathBuf};
use std::process::Command;

fn main() {
    let root = PathBuf::from(env::var_os("CARGO_MANIFEST_DIR").expect("cargo sets CARGO_MANIFEST_DIR"));
    let rustc = env::var("RUSTC").unwrap_or_else(|_| "rustc".into());
    let set = |name: &str, value: Option<String>| {
        println!("cargo::rustc-env={name}={}", value.as_deref().unwrap_or("unknown"))
    };

    set("SAHARA_COMMIT", commit(&root));
    set("SAHARA_RUSTC", output(&root, &rustc, &["--version"]));
    set("SAHARA_TARGET", env::var("TARGET").ok());
    set("SAHARA_TARGET_FEATURES", env::var("CARGO_CFG_TARGET_FEATURE").ok());
    set("SAHARA_PROFILE", env::var("PROFILE").ok());
    set("SAHARA_OBVHS", locked(&root, "obvhs"));

    // A change of these files can change a recorded value.
    for path in ["src", "Cargo.toml", "Cargo.lock", ".cargo/config.toml"] {
        rerun_if_changed(&root.join(path));
    }
}

fn commit(root: &Path) -> Option<String> {
    let git = |args: &[&str]| output(root, "git", args);
    let top = PathBuf::from(git(&["rev-parse", "--show-toplevel"])?);
    if top.canonicalize().ok()? != root.canonicalize().ok()? {
        return None;
    }
    for file in ["HEAD", "logs/HEAD", "index"] {
        rerun_if_changed(&root.join(git(&["rev-parse", "--git-path", file])?));
    }
    let commit = git(&["rev-parse", "--short=12", "HEAD"])?;
    // With `--no-optional-locks`, git does not write the index. A change of the index would rerun this script.
    let sources = [
        "--no-optional-locks",
        "status",
        "--porcelain",
        "--untracked-files=no",
        "--",
        "src",
        "Cargo.toml",
        "Cargo.lock",
    ];
    let changes = git(&sources).is_some_and(|text| !text.is_empty());
    Some(if changes { commit + "+changes" } else { commit })
}

fn locked(root: &Path, package: &str) -> Option<String> {
    let lock = std::fs::read_to_string(root.join("Cargo.lock")).ok()?;
    let (_, entry) = lock.split_once(&format!("name = \"{package}\"\nversion = \""))?;
    Some(entry.split('"').next()?.to_owned())
}

/// Skips a missing path. For a missing path, cargo would rerun this script on every build.
fn rerun_if_changed(path: &Path) {
    if path.exists() {
        println!("cargo::rerun-if-changed={}", path.display());
    }
}

fn output(directory: &Path, program: &str, args: &[&str]) -> Option<String> {
    let output = Command::new(program).args(args).current_dir(directory).output().ok()?;
    output.status.success().then(|| String::from_utf8_lossy(&output.stdout).trim().to_owned())
}
