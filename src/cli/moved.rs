//! Removed commands, studies and options, and their replacements.

pub const COMMANDS: [(&str, &str); 5] = [
    ("bench", "use `sahara compare --export-json A.json` and `sahara diff A.json B.json --fail-on-regression PERCENT`"),
    ("compare-runs", "use `sahara diff A.json B.json`"),
    ("hard", "use `sahara validate --hard CASE`"),
    ("counts", "use `sahara compare --wide`"),
    ("accuracy", "use `sahara study accuracy`"),
];

pub const STUDIES: [(&str, &str); 10] = [
    ("predictions", "the report has the verdicts on its claims: run `sahara study all`, then `sahara report`"),
    ("crossover", "use `sahara compare` on scenes with few and many layers (results: papers/TUNING.md)"),
    ("break-even", "see the columns \"pays off: WORKLOAD\" of `sahara compare --wide`"),
    ("threads", "use `sahara compare --threads N` (results: papers/TUNING.md)"),
    ("binary", "use `sahara compare -s sah-kd -s obvhs-bvh2` (results: papers/TUNING.md)"),
    ("costs", "see papers/TUNING.md for the cost of a node and of a triangle test"),
    ("parameters", "use `sahara replicate`, which measures the report's settings"),
    ("partitions", "use `sahara compare -s sah-kd-wide -s sah-kd-tight -s sah-hybrid -s sah-bvh`"),
    ("counts", "use `sahara compare --wide`"),
    ("self-intersection", "see papers/TUNING.md for its results on ray offsets"),
];

pub const OPTIONS: [(&str, &str); 2] = [
    (
        "--save-baseline",
        "keep a run with `sahara compare --export-json A.json`, and compare two runs with `sahara diff A.json B.json`",
    ),
    ("--baseline", "use `sahara diff A.json B.json --fail-on-regression PERCENT`"),
];

pub fn check(kind: &str, names: &[(&str, &str)], name: &str) -> anyhow::Result<()> {
    match names.iter().find(|(old, _)| *old == name) {
        Some((name, now)) => anyhow::bail!("the {kind} `{name}` was removed; {now}"),
        None => Ok(()),
    }
}
