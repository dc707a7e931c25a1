//! The question that the source report leaves open, and what the runs say.

use crate::measure::Estimate;
use crate::page::runs::Runs;
use crate::report::Record;
use crate::report::document::{Answer, Headline};
use crate::report::number::{figures, plural};
use crate::report::plot::{Bar, Bars, Chart};
use crate::report::words::{distinct, ends, listed, scene_name};
use crate::study::attribution::{self, AttributionStudy};
use crate::study::compare::{Winner, speed, twins, winner};
use crate::study::predictions::{self, PredictionsStudy};
use crate::study::replicate::ReplicateStudy;
use crate::study::{REPORT_TREE, SAH_TREE};

/// The question in the words of the source report.
const QUESTION: &str = "Would a SAH tree have been much faster on the hard scenes?";

/// A scene, and how many times faster the SAH tree is there.
struct Hard {
    scene: String,
    stand_in: bool,
    ratio: Estimate,
}

/// What is known of the hard scenes: from `replicate`, or else from the corners of `attribution`, which tell no mean, or else
/// from the primary rays of `compare`.
fn hard(runs: &Runs) -> (Vec<Hard>, Option<Estimate>) {
    let replication = runs.answers.of::<ReplicateStudy>().filter(|replication| !replication.hard.is_empty());
    if let Some(replication) = replication {
        let hard = replication.hard.iter().map(|hard| Hard {
            scene: hard.scene.clone(),
            stand_in: hard.stand_in,
            ratio: hard.sah_over_median,
        });
        return (hard.collect(), replication.conclusion.sah_over_median);
    }
    let corners = attribution::hard(runs.answers.of::<AttributionStudy>().map_or(&[], Vec::as_slice));
    if !corners.is_empty() {
        let hard = corners.into_iter().map(|(scene, r)| Hard {
            scene: scene.into(),
            stand_in: r.stand_in,
            ratio: r.time.whole,
        });
        return (hard.collect(), None);
    }
    let noise = twins(runs.records());
    let (mut hard, mut pairs) = (vec![], vec![]);
    for name in ["Dragon", "Lucy", "Sponza"] {
        let of = |label: &str| {
            let is = |r: &&Record| r.scene == name && r.label == label && r.workload == "primary";
            runs.records().iter().find(is).filter(|r| r.trace_ns.is_some())
        };
        let (Some(tree), Some(sah)) = (of(REPORT_TREE), of(SAH_TREE)) else { continue };
        if let Some(ratio) = speed([(sah, tree)], &noise) {
            pairs.push((sah, tree));
            hard.push(Hard { scene: name.into(), stand_in: tree.stand_in, ratio });
        }
    }
    (hard, speed(pairs, &noise))
}

/// The hard scenes.
const SCENES: usize = 3;

/// From this on a tree is called much faster: half of the time.
const MUCH: f64 = 2.0;

/// That the runs were made for trying out, where one of them was.
fn banner(runs: &Runs) -> String {
    let quick = |command: &str| command.split(' ').any(|word| word == "--quick");
    if !runs.provenances.iter().any(|provenance| quick(&provenance.command)) {
        return String::new();
    }
    "A quick look, for trying out: these runs were made with --quick, on few scenes, few rays and few epochs. Their numbers and what \
     follows from them mean little; `sahara study all` without --quick measures them."
        .into()
}

/// What runs say that are not of the hard scenes: which structure is the fastest where several were compared.
fn otherwise(runs: &Runs) -> (String, Answer) {
    let not = "The source report's question is not measured by these runs: `sahara replicate` measures it.";
    let scenes = distinct(runs.records().iter().map(|record| &record.scene));
    let (title, verdict, mut sentences) = match winner(runs.records(), None) {
        Some(Winner { names, sentence }) => {
            let on = if scenes.len() > SCENES { plural(scenes.len(), "scene") } else { listed(&scenes) };
            (format!("Which structure is the fastest on {on}?"), names, vec![sentence])
        }
        None => (QUESTION.into(), "Not measured".into(), vec![]),
    };
    sentences.push(not.into());
    (title, Answer { banner: banner(runs), verdict, sentences, numbers: vec![], chart: None })
}

/// How many times faster, scene by scene: in the parts that it is due to where `attribution` tells them, else as a whole.
fn chart(runs: &Runs, hard: &[Hard]) -> Bars {
    let attributed = runs.answers.of::<AttributionStudy>().map_or(&[][..], Vec::as_slice);
    let parts = attribution::bars(&attribution::hard(attributed).into_iter().map(|(_, r)| r).collect::<Vec<_>>());
    if parts.labels.len() == hard.len() {
        return parts;
    }
    let row = |hard: &Hard| {
        let bar = Bar::Product(vec![hard.ratio.estimate], hard.ratio);
        (scene_name(&hard.scene, hard.stand_in), bar)
    };
    Bars::of_products(&parts.x_title, vec!["SAH tree".into()], hard.iter().map(row))
}

/// The question that the runs answer, and the answer, or that there is none yet.
pub fn answer(runs: &Runs) -> (String, Answer) {
    let (hard, mean) = hard(runs);
    if hard.is_empty() {
        return otherwise(runs);
    }
    // The scenes are judged together; the mean is one figure.
    let all = |is: &dyn Fn(Estimate) -> bool| hard.iter().all(|own| is(own.ratio.ratio_among(hard.len())));
    let least = hard.iter().map(|hard| hard.ratio.low().unwrap_or(hard.ratio.estimate)).fold(f64::INFINITY, f64::min);
    let most = hard.iter().map(|hard| hard.ratio.high().unwrap_or(hard.ratio.estimate)).fold(0.0, f64::max);
    let known = hard.iter().all(|hard| hard.ratio.interval.is_some());
    let verdict = match () {
        () if !known => "Not decided: one epoch, no interval",
        () if all(&|ratio| ratio.is_above(MUCH)) => "Yes",
        () if mean.is_some_and(|mean| mean.is_above(MUCH)) => "Yes, on average",
        () if all(&|ratio| ratio.is_above(1.0)) || mean.is_some_and(|mean| mean.is_above(1.0)) => {
            "Faster, but not much"
        }
        () if all(&|ratio| ratio.is_below(1.0)) || mean.is_some_and(|mean| mean.is_below(1.0)) => "No",
        () => "Not decided",
    };
    let names: Vec<&str> = hard.iter().map(|hard| hard.scene.as_str()).collect();
    // The question is about three scenes.
    let verdict = if hard.len() < SCENES { format!("{verdict}, on {}", listed(&names)) } else { verdict.into() };
    let stand_ins = match hard.iter().filter(|hard| hard.stand_in).count() {
        0 => "",
        n if n == hard.len() => ", stand-ins of our own with as many triangles as the report's meshes,",
        _ => ", in part stand-ins of our own,",
    };
    let (names, range) = (listed(&names), format!("{} to {}", figures(least), figures(most)));
    let times = match mean {
        Some(mean) if known => format!(
            "{} times as fast as the report's tree (geometric mean, 95 % interval {}; the scenes' intervals reach from {range})",
            figures(mean.estimate),
            ends(mean),
        ),
        None if known => {
            format!("{range} times as fast as the report's tree (the 95 % intervals of the scenes together)")
        }
        _ => format!("{range} times as fast as the report's tree, in one epoch, which tells no interval"),
    };
    let mut sentences = vec![format!(
        "On {names}{stand_ins} the SAH tree answers the same primary rays {times}. Construction is left out, as in the report."
    )];
    let attributed = runs.answers.of::<AttributionStudy>();
    sentences.extend(attributed.map_or(vec![], |results| attribution::sentences(results)));
    sentences.extend(runs.answers.of::<PredictionsStudy>().and_then(|all| predictions::sentence(all)));
    let numbers = hard.iter().map(|hard| Headline {
        number: format!("{} ×", figures(hard.ratio.estimate)),
        interval: ends(hard.ratio),
        label: scene_name(&hard.scene, hard.stand_in),
    });
    let mean = mean.filter(|_| hard.len() > 1).map(|mean| Headline {
        number: format!("{} ×", figures(mean.estimate)),
        interval: ends(mean),
        label: "geometric mean".into(),
    });
    let numbers = numbers.chain(mean).collect();
    let chart = Some(Chart::Bars(chart(runs, &hard)));
    (QUESTION.into(), Answer { banner: banner(runs), verdict, sentences, numbers, chart })
}
