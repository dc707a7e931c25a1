//! Checks that the licences of all dependencies allow redistribution.

use std::process::Command;

use serde_json::Value;

/// Permissive licences, each read by a person.
const ALLOWED: [&str; 12] = [
    "0BSD",
    "Apache-2.0",
    "Apache-2.0 WITH LLVM-exception",
    "BSD-2-Clause",
    "BSD-3-Clause",
    "BSL-1.0",
    "CDLA-Permissive-2.0",
    "ISC",
    "MIT",
    "Unicode-3.0",
    "Unlicense",
    "Zlib",
];

/// Licences that are allowed only for packages with `font` in the name.
const ALLOWED_FONTS: [&str; 2] = ["OFL-1.1", "Ubuntu-font-1.0"];

/// Whether a licence expression is allowed. Assumes that parentheses enclose only `OR` expressions.
fn is_allowed(licence: &str, is_font: bool) -> bool {
    let is_known = |one: &str| ALLOWED.contains(&one) || is_font && ALLOWED_FONTS.contains(&one);
    let alternatives = |part: &str| part.trim_matches(['(', ')']).replace('/', " OR ");
    let conjunction: Vec<String> = licence.split(" AND ").map(alternatives).collect();
    conjunction.iter().all(|part| part.split(" OR ").any(|one| is_known(one.trim())))
}

#[test]
fn all_dependencies_may_be_passed_on() {
    let metadata = |more: &[&str]| {
        let mut cargo = Command::new(env!("CARGO"));
        cargo.args(["metadata", "--format-version", "1", "--locked", "--offline"]).args(more);
        cargo.current_dir(env!("CARGO_MANIFEST_DIR")).output().unwrap()
    };
    // If dependencies of other platforms were never downloaded, check only the dependencies of this platform.
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
        !package["license"].as_str().is_some_and(|licence| is_allowed(licence, is_font))
    });
    let refused: Vec<String> = refused.map(|package| format!("{}: {}", package["name"], package["license"])).collect();
    assert!(refused.is_empty(), "choose other dependencies, or allow their licences here: {refused:#?}");
}
