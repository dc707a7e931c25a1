//! Does a KD-tree overtake a BVH where depth complexity is high?

use super::prediction;
use crate::report::number::figures;
use crate::report::words::interval;
use crate::study::crossover::{Member, PAIRS};
use crate::study::predictions::{Finding, Inputs, Prediction};

pub(super) fn depth(inputs: &Inputs) -> Prediction {
    let claim = "On a CPU as on GPUs a KD-tree overtakes a BVH as depth complexity grows (open in the literature): whatever the pair and the kind of \
                 rays, the BVH is the faster one at the fewest surfaces and the KD-tree at the most.";
    let mut findings = vec![];
    let mut crossings = vec![];
    let (mut overtakes, mut ahead, mut behind) = (0, 0, 0);
    for race in &inputs.crossover {
        let (Some(first), Some(last)) = (race.members.first(), race.members.last()) else { continue };
        let pair = format!("{} / {}, {} rays", short(&race.kd), short(&race.bvh), race.workload);
        let what = |member: &Member| format!("{pair}, {} surfaces: time", figures(member.complexity));
        let ends = [
            Finding::within(what(first), first.ratio, 1.0, f64::INFINITY),
            Finding::within(what(last), last.ratio, f64::NEG_INFINITY, 1.0),
        ];
        match (ends[0].holds, ends[1].holds) {
            (true, true) => overtakes += 1,
            (false, true) => ahead += 1,
            (true, false) => behind += 1,
            (false, false) => {}
        }
        findings.extend(ends);
        if let Some(crossing) = race.crossings.iter().rev().find(|c| c.kd_wins_beyond && c.found >= 0.95) {
            crossings.push(format!("{pair}, at {} surfaces", interval(crossing.complexity)));
        }
    }
    // Whether it gains at all: the sign of the trend, where that is sure.
    let trends = || inputs.crossover.iter().filter_map(|race| race.trend);
    let gains = trends().filter(|trend| trend.high < 0.0).count();
    let losses = trends().filter(|trend| trend.low > 0.0).count();
    let sure = match crossings.len() {
        0 => "No crossing is sure".into(),
        _ => format!("Surely it overtakes for {}", crossings.join("; ")),
    };
    let races = findings.len() / 2;
    let why = format!(
        "Of {races} pairs and kinds of rays the KD-tree overtakes the BVH in {overtakes}, is ahead at both ends in {ahead} and behind at both in \
         {behind}. {sure}. With growing depth complexity it surely gains in {gains} of them and surely loses in {losses}.",
    );
    let complete = PAIRS.iter().all(|[kd, bvh]| inputs.crossover.iter().any(|race| race.kd == *kd && race.bvh == *bvh));
    prediction(8, claim, findings, complete, why, "sahara study crossover")
}

/// A label without its keys.
fn short(label: &str) -> &str {
    label.split(':').next().unwrap_or(label)
}
