//! Removed commands, studies and options, and their replacements.

pub const COMMANDS: [(&str, &str); 5] = [
    ("bench", "`sahara compare --export-json A.json` and `sahara diff A.json B.json --fail-on-regression PERCENT`"),
    ("compare-runs", "`sahara diff A.json B.json`"),
    ("hard", "`sahara validate --hard CASE`"),
    ("counts", "`sahara compare --wide`"),
    ("accuracy", "`sahara study accuracy`"),
];

pub const STUDIES: [(&str, &str); 10] = [
    ("predictions", "the studies that measure its claims judge them: `sahara study all`, then `sahara report`"),
    ("crossover", "`sahara compare` on scenes with few and many layers; results: papers/TUNING.md"),
    ("break-even", "the column \"pays off after\" of `sahara compare --wide`"),
    ("threads", "`sahara compare --threads N`; results: papers/TUNING.md"),
    ("binary", "`sahara compare -s sah-kd -s obvhs-bvh2`; results: papers/TUNING.md"),
    ("costs", "papers/TUNING.md lists the cost of a node and of a triangle test"),
    ("parameters", "`sahara replicate` measures the report's settings"),
    ("partitions", "`sahara compare -s sah-kd-wide -s sah-kd-tight -s sah-hybrid -s sah-bvh`"),
    ("counts", "`sahara compare --wide`"),
    ("self-intersection", "its results on ray offsets are in papers/TUNING.md"),
];

pub const OPTIONS: [(&str, &str); 2] = [
    (
        "--save-baseline",
        "`sahara compare --export-json A.json` keeps a run, and `sahara diff A.json B.json` compares two",
    ),
    ("--baseline", "`sahara diff A.json B.json --fail-on-regression PERCENT` is the gate"),
];

pub fn said(kind: &str, names: &[(&str, &str)], name: &str) -> Option<String> {
    let (name, now) = names.iter().find(|(old, _)| *old == name)?;
    Some(format!("the {kind} {name} was removed: {now}"))
}
