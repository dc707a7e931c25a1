//! The question that the source report leaves open, and what the runs say.

use crate::measure::Interval;
use crate::publish::document::{Answer, Headline};
use crate::publish::runs::Runs;
use crate::publish::words::{ends, listed, scene_name};
use crate::report::Record;
use crate::report::number::figures;
use crate::study::compare::{speed, twins};
use crate::study::{REPORT_TREE, SAH_TREE};

/// The question in the words of the source report.
pub const QUESTION: &str = "Would a SAH tree have been much faster on the hard scenes?";

/// A scene, and how many times faster the SAH tree is there.
struct Hard {
    scene: String,
    stand_in: bool,
    ratio: Interval,
}

/// What is known of the hard scenes: from `replicate`, or else from the primary rays of `compare`.
fn hard(runs: &Runs) -> (Vec<Hard>, Option<Interval>) {
    if let Some(replication) = &runs.replication {
        let hard = replication.hard.iter().map(|hard| Hard {
            scene: hard.scene.clone(),
            stand_in: hard.stand_in,
            ratio: hard.sah_over_median,
        });
        return (hard.collect(), replication.conclusion.sah_over_median);
    }
    let floor = twins(&runs.records).log().unwrap_or(0.0);
    let (mut hard, mut pairs) = (vec![], vec![]);
    for name in ["Dragon", "Lucy", "Sponza"] {
        let of = |label: &str| {
            let is = |r: &&Record| r.scene == name && r.label == label && r.workload == "primary";
            runs.records.iter().find(is).filter(|r| r.trace_ns.is_some())
        };
        let (Some(tree), Some(sah)) = (of(REPORT_TREE), of(SAH_TREE)) else { continue };
        if let Some(ratio) = speed([(sah, tree)], floor) {
            pairs.push((sah, tree));
            hard.push(Hard { scene: name.into(), stand_in: tree.stand_in, ratio });
        }
    }
    (hard, speed(pairs, floor))
}

/// From this on a tree is called much faster: half of the time.
const MUCH: f64 = 2.0;

/// The answer, or that there is none yet.
pub fn answer(runs: &Runs) -> Answer {
    let (hard, mean) = hard(runs);
    let Some(mean) = mean else {
        return Answer {
            verdict: "Not measured".into(),
            sentences: vec![format!(
                "These runs hold no times of {REPORT_TREE} and {SAH_TREE} on Dragon, Lucy or Sponza: `sahara replicate \
                 --export-json runs/replicate.json` measures them."
            )],
            numbers: vec![],
        };
    };
    let least = hard.iter().map(|hard| hard.ratio.low).fold(f64::INFINITY, f64::min);
    let most = hard.iter().map(|hard| hard.ratio.high).fold(0.0, f64::max);
    let verdict = match () {
        () if least >= MUCH => "Yes",
        () if mean.low >= MUCH => "Yes, on average",
        () if mean.low > 1.0 => "Faster, but not much",
        () if mean.high < 1.0 => "No",
        () => "Not decided",
    };
    let names: Vec<&str> = hard.iter().map(|hard| hard.scene.as_str()).collect();
    let stand_ins = match hard.iter().filter(|hard| hard.stand_in).count() {
        0 => "",
        n if n == hard.len() => ", stand-ins of our own with as many triangles as the report's meshes,",
        _ => ", in part stand-ins of our own,",
    };
    let mut sentences = vec![format!(
        "On {}{stand_ins} the SAH tree answers the same primary rays {} times as fast as the report's tree (geometric mean, 95 % \
         interval {}; the scenes' intervals reach from {} to {}). Construction is left out, as in the report.",
        listed(&names),
        figures(mean.estimate),
        ends(&mean),
        figures(least),
        figures(most),
    )];
    sentences.extend(super::attribution::sentences(runs));
    sentences.extend(super::predictions::sentence(runs));
    let numbers = hard.iter().map(|hard| Headline {
        number: format!("{} ×", figures(hard.ratio.estimate)),
        interval: ends(&hard.ratio),
        label: scene_name(&hard.scene, hard.stand_in),
    });
    let mean = Headline {
        number: format!("{} ×", figures(mean.estimate)),
        interval: ends(&mean),
        label: "geometric mean".into(),
    };
    let numbers = if hard.len() > 1 { numbers.chain([mean]).collect() } else { numbers.collect() };
    Answer { verdict: verdict.into(), sentences, numbers }
}
