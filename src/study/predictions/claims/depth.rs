//! Does a KD-tree overtake a BVH where depth complexity is high?

use super::prediction;
use crate::report::number::figures;
use crate::report::words::interval;
use crate::study::predictions::{Finding, Inputs, Prediction};

pub(super) fn depth(inputs: &Inputs) -> Prediction {
    let claim = "On a CPU as on GPUs a KD-tree overtakes a BVH at high depth complexity (open in the literature).";
    let mut findings = vec![];
    let mut crossings = vec![];
    for race in &inputs.crossover {
        let Some(last) = race.members.last() else { continue };
        let pair = format!("{} / {}, {} rays", short(&race.kd), short(&race.bvh), race.workload);
        let what = format!("{pair}, {} surfaces: time", figures(last.complexity));
        findings.push(Finding::within(what, last.ratio, f64::NEG_INFINITY, 1.0));
        if let Some(crossing) = race.crossings.iter().rev().find(|c| c.kd_wins_beyond && c.found >= 0.95) {
            crossings.push(format!("{pair}, at {} surfaces", interval(crossing.complexity)));
        }
    }
    // Whether it gains at all: the sign of the trend, where that is sure.
    let trends = || inputs.crossover.iter().filter_map(|race| race.trend);
    let gains = trends().filter(|trend| trend.high < 0.0).count();
    let losses = trends().filter(|trend| trend.low > 0.0).count();
    let overtakes = match crossings.len() {
        0 => "It is not seen to overtake anywhere".into(),
        _ => format!("It overtakes for {}", crossings.join("; ")),
    };
    let why = format!(
        "At the most surfaces the KD-tree is the faster one for {} of {} pairs and kinds of rays. {overtakes}. With growing depth complexity it surely \
         gains in {gains} of them and surely loses in {losses}.",
        findings.iter().filter(|finding| finding.holds).count(),
        findings.len(),
    );
    prediction(8, claim, findings, true, why, "sahara study crossover")
}

/// A label without its keys.
fn short(label: &str) -> &str {
    label.split(':').next().unwrap_or(label)
}
