//! Names of commands, studies and options that went, and where their worth is now.

pub const COMMANDS: [(&str, &str); 5] = [
    ("bench", "`sahara compare --export-json A.json` and `sahara diff A.json B.json --fail-on-regression PERCENT`"),
    ("compare-runs", "`sahara diff A.json B.json`"),
    ("hard", "`sahara validate --hard CASE`"),
    ("counts", "`sahara compare --wide`"),
    ("accuracy", "`sahara study accuracy`"),
];

pub const STUDIES: [(&str, &str); 10] = [
    ("predictions", "its claims are judged by the studies that measure them: `sahara study all`, then `sahara report`"),
    ("crossover", "`sahara compare` on scenes of few and of many layers; papers/TUNING.md has what it found"),
    ("break-even", "the column \"pays off after\" of `sahara compare --wide`"),
    ("threads", "`sahara compare --threads N`; papers/TUNING.md has what it found"),
    ("binary", "`sahara compare -s sah-kd -s obvhs-bvh2`; papers/TUNING.md has what it found"),
    ("costs", "papers/TUNING.md has what a node and a triangle test cost"),
    ("parameters", "`sahara replicate` measures the report's settings"),
    ("partitions", "`sahara compare -s sah-kd-wide -s sah-kd-tight -s sah-hybrid -s sah-bvh`"),
    ("counts", "`sahara compare --wide`"),
    ("self-intersection", "papers/TUNING.md has what it found about ray offsets"),
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
    Some(format!("the {kind} {name} went: {now}"))
}
