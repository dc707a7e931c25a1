//! Everything that is compiled in may be passed on: the licences of all dependencies.

use std::iter::Peekable;
use std::process::Command;
use std::str::SplitWhitespace;

use serde_json::Value;

const ALLOWED: [&str; 11] = [
    "0BSD",
    "Apache-2.0",
    "Apache-2.0 WITH LLVM-exception",
    "BSD-2-Clause",
    "BSD-3-Clause",
    "CC0-1.0",
    "CDLA-Permissive-2.0",
    "ISC",
    "MIT",
    "Unicode-3.0",
    "Zlib",
];

/// Of packages with fonts.
const ALLOWED_FONTS: [&str; 2] = ["OFL-1.1", "Ubuntu-font-1.0"];

/// Whether an SPDX expression can be met with allowed licences; nothing if it is malformed. `/` is the OR of old manifests.
fn judge(expression: &str, allowed: &[&str]) -> Option<bool> {
    let spaced = expression.replace('(', " ( ").replace(')', " ) ").replace('/', " OR ");
    let mut words = spaced.split_whitespace().peekable();
    let is_met = any(&mut words, allowed)?;
    words.next().is_none().then_some(is_met)
}

type Words<'a> = Peekable<SplitWhitespace<'a>>;

fn any(words: &mut Words, allowed: &[&str]) -> Option<bool> {
    let mut is_met = all(words, allowed)?;
    while words.next_if_eq(&"OR").is_some() {
        is_met |= all(words, allowed)?;
    }
    Some(is_met)
}

/// AND binds more tightly than OR.
fn all(words: &mut Words, allowed: &[&str]) -> Option<bool> {
    let mut is_met = one(words, allowed)?;
    while words.next_if_eq(&"AND").is_some() {
        is_met &= one(words, allowed)?;
    }
    Some(is_met)
}

fn one(words: &mut Words, allowed: &[&str]) -> Option<bool> {
    let mut name = match words.next()? {
        "(" => {
            let is_met = any(words, allowed)?;
            return words.next_if_eq(&")").map(|_| is_met);
        }
        ")" | "AND" | "OR" | "WITH" => return None,
        name => name.to_owned(),
    };
    if words.next_if_eq(&"WITH").is_some() {
        name = format!("{name} WITH {}", words.next()?);
    }
    Some(allowed.contains(&&*name))
}

#[test]
fn expressions_are_judged() {
    let judged = |expression| judge(expression, &ALLOWED);
    for met in [
        "MIT",
        "GPL-3.0-only OR MIT",
        "Unlicense/MIT",
        "MIT OR Apache-2.0 AND GPL-2.0",
        "(MIT OR GPL-2.0) AND (ISC OR Apache-2.0)",
        "Apache-2.0 WITH LLVM-exception AND Zlib",
    ] {
        assert_eq!(judged(met), Some(true), "{met}");
    }
    for missed in [
        "GPL-3.0-only",
        "MIT AND GPL-3.0-only",
        "(MIT OR Apache-2.0) AND AGPL-3.0",
        "GPL-2.0 WITH Classpath-exception-2.0",
        "MIT WITH LLVM-exception",
        "OFL-1.1",
        "mit",
    ] {
        assert_eq!(judged(missed), Some(false), "{missed}");
    }
    for malformed in ["", "MIT OR", "AND MIT", "(MIT", "MIT)", "MIT Apache-2.0", "Apache-2.0 WITH", "MIT//ISC"] {
        assert_eq!(judged(malformed), None, "{malformed}");
    }
}

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
    let with_fonts = [&ALLOWED[..], &ALLOWED_FONTS].concat();
    let refused = packages.iter().filter(|package| {
        let is_font = package["name"].as_str().is_some_and(|name| name.contains("font"));
        let allowed = if is_font { &with_fonts[..] } else { &ALLOWED };
        package["license"].as_str().and_then(|licence| judge(licence, allowed)) != Some(true)
    });
    let refused: Vec<String> = refused.map(|package| format!("{}: {}", package["name"], package["license"])).collect();
    assert!(refused.is_empty(), "choose other dependencies, or allow their licences here: {refused:#?}");
}
