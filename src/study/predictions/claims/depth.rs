//! Does a KD-tree overtake a BVH where depth complexity is high?

use super::Figure;
use crate::report::number::figures;
use crate::report::words::{bare, interval};
use crate::study::crossover::Member;
use crate::study::predictions::{Inputs, Prediction};

/// It was called open before anything was measured: it has figures and no verdict.
pub(super) fn depth(inputs: &Inputs) -> Prediction {
    let words = "KD-tree against BVH: for GPUs the literature says BVH on simple and moderate scenes, KD-tree at high depth complexity. Open on a \
                 CPU.";
    let (mut found, mut crossings) = (vec![], vec![]);
    let (mut overtakes, mut ahead, mut behind, mut open) = (0, 0, 0, 0);
    for race in &inputs.crossover {
        let (Some(first), Some(last)) = (race.members.first(), race.members.last()) else { continue };
        let pair = format!("{} / {}, {} rays", bare(&race.kd), bare(&race.bvh), race.workload);
        let figure = |member: &Member| Figure {
            what: format!("{pair}, {} surfaces: time", figures(member.complexity)),
            value: member.ratio,
        };
        found.extend([figure(first), figure(last)]);
        let sure = |member: &Member| (member.ratio.is_below(1.0), member.ratio.is_above(1.0));
        match (sure(first), sure(last)) {
            ((_, true), (true, _)) => overtakes += 1,
            ((true, _), (true, _)) => ahead += 1,
            ((_, true), (_, true)) => behind += 1,
            _ => open += 1,
        }
        if let Some(crossing) = race.crossings.iter().rev().find(|c| c.kd_wins_beyond && c.is_sure()) {
            crossings.push(format!("{pair}, at {} surfaces", interval(crossing.complexity)));
        }
    }
    // Whether it gains at all: the sign of the trend, where that is sure.
    let trends = || inputs.crossover.iter().filter_map(|race| race.trend);
    let gains = trends().filter(|trend| trend.is_below(0.0)).count();
    let losses = trends().filter(|trend| trend.is_above(0.0)).count();
    let sure = match crossings.len() {
        0 => "No crossing is sure".into(),
        _ => format!("Surely it overtakes for {}", crossings.join("; ")),
    };
    let races = found.len() / 2;
    let why = format!(
        "Of {races} pairs and kinds of rays, each looked at alone, the KD-tree surely overtakes the BVH from the fewest surfaces to the most in \
         {overtakes}, is ahead at both ends in {ahead} and behind at both in {behind}; {open} are none of these. {sure}. With growing depth \
         complexity it surely gains in {gains} of them and surely loses in {losses}.",
    );
    let why = if found.is_empty() { String::new() } else { why };
    Prediction { number: 8, words, claims: vec![], figures: found, why, command: "sahara study crossover" }
}
