//! Checks that all compiled code may be distributed: the licences of all dependencies.

use std::process::Command;

use serde_json::Value;

/// The licences in manifests, in each of their spellings. A person must read a new one: all parts of an `AND`, and one
/// part of an `OR`, must be permissive.
const ALLOWED: [&str; 22] = [
    "(MIT OR Apache-2.0) AND Unicode-3.0",
    "0BSD OR MIT OR Apache-2.0",
    "Apache-2.0",
    "Apache-2.0 AND ISC",
    "Apache-2.0 OR BSL-1.0",
    "Apache-2.0 OR ISC OR MIT",
    "Apache-2.0 OR MIT",
    "Apache-2.0 WITH LLVM-exception OR Apache-2.0 OR MIT",
    "BSD-2-Clause OR Apache-2.0 OR MIT",
    "BSD-3-Clause",
    "BSD-3-Clause OR Apache-2.0",
    "CDLA-Permissive-2.0",
    "ISC",
    "MIT",
    "MIT OR Apache-2.0",
    "MIT OR Apache-2.0 OR LGPL-2.1-or-later",
    "MIT OR Zlib OR Apache-2.0",
    "MIT/Apache-2.0",
    "Unlicense OR MIT",
    "Unlicense/MIT",
    "Zlib",
    "Zlib OR Apache-2.0 OR MIT",
];

/// The licence of packages with fonts.
const ALLOWED_FONTS: &str = "(MIT OR Apache-2.0) AND OFL-1.1 AND Ubuntu-font-1.0";

#[test]
fn all_dependencies_may_be_passed_on() {
    let metadata = |more: &[&str]| {
        let mut cargo = Command::new(env!("CARGO"));
        cargo.args(["metadata", "--format-version", "1", "--locked", "--offline"]).args(more);
        cargo.current_dir(env!("CARGO_MANIFEST_DIR")).output().unwrap()
    };
    // Dependencies of other platforms may never have been downloaded.
    let mut output = metadata(&[]);
    if !output.status.success() {
        output = metadata(&["--filter-platform", env!("SAHARA_TARGET")]);
    }
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    let metadata: Value = serde_json::from_slice(&output.stdout).unwrap();
    let packages = metadata["packages"].as_array().unwrap();
    assert!(packages.len() > 100, "{}", packages.len());
    let refused = packages.iter().filter(|package| {
        let is_font = package["name"].as_str().is_some_and(|name| name.contains("font"));
        let is_allowed = |own| ALLOWED.contains(&own) || is_font && own == ALLOWED_FONTS;
        !package["license"].as_str().is_some_and(is_allowed)
    });
    let refused: Vec<String> = refused.map(|package| format!("{}: {}", package["name"], package["license"])).collect();
    assert!(refused.is_empty(), "choose other dependencies, or allow their licences here: {refused:#?}");
}
