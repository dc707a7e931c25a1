//! Uses the findings of the studies to answer the open question of the source report. The source report is a student
//! report that this project reproduces.

use crate::measure::Estimate;
use crate::page::document::{Answer, Headline};
use crate::page::runs::{COMPARE, Runs, scene_titles};
use crate::report::Figure;
use crate::report::number::{figures, plural};
use crate::report::plot::{Bar, Bars, Chart};
use crate::report::words::{ended, interval_text, listed, slug};
use crate::study::claims;
use crate::study::compare::FASTEST;

const QUESTION: &str = "Would a SAH tree have been much faster on the hard scenes?";

/// The names of the hard scenes in the keys of findings.
const SCENES: [&str; 3] = ["dragon", "lucy", "sponza"];

/// If the interval of a speedup lies above this ratio, the tree counts as "much faster".
const MUCH: f64 = 2.0;

/// The study that measures the SAH tree's speedup on the hard scenes.
const REPLICATE: &str = "replicate";
/// The study that divides the speedup of the SAH tree into factors.
const ATTRIBUTION: &str = "attribution";

struct Hard {
    key: &'static str,
    title: String,
    /// The speedup of the SAH tree.
    ratio: Estimate,
}

/// Returns the measured hard scenes, their mean speedup, and a sentence about the mean.
fn hard(runs: &Runs) -> Option<(Vec<Hard>, Option<Estimate>, String)> {
    let run = runs.of(REPLICATE)?;
    let hard = |key: &'static str| {
        let ratio = run.report.finding(&format!("hard-{key}"))?.value?;
        let case = run.dataset.measured.iter().map(|own| &own.case).find(|case| slug(&case.scene.name) == key);
        Some(Hard { key, title: case.map_or(key.into(), |case| case.scene_title()), ratio })
    };
    let hard: Vec<Hard> = SCENES.into_iter().filter_map(hard).collect();
    let mean = run.report.finding("hard");
    let sentence = mean.map_or(String::new(), |finding| finding.sentence.clone());
    (!hard.is_empty()).then_some((hard, mean.and_then(|finding| finding.value), sentence))
}

fn banner(runs: &Runs) -> String {
    if !runs.commands().iter().any(|command| command.split(' ').any(|word| word == "--quick")) {
        return String::new();
    }
    "A quick trial: these runs used --quick, with few scenes, rays and epochs. Their numbers and conclusions mean \
     little; run `sahara study all` without --quick for real results."
        .into()
}

pub fn answer(runs: &Runs) -> (String, Answer) {
    let Some((hard, mean, sentence)) = hard(runs) else { return answer_without_hard_scenes(runs) };
    let numbers = hard.iter().map(|own| headline(&own.title, own.ratio));
    let numbers = numbers.chain(mean.filter(|_| hard.len() > 1).map(|mean| headline("geometric mean", mean)));
    let mut answer = Answer {
        banner: banner(runs),
        verdict: verdict(&hard, mean),
        sentences: vec![sentence],
        numbers: numbers.collect(),
        chart: Some(Chart::Bars(chart(runs, &hard))),
    };
    if let Some(run) = runs.of(ATTRIBUTION) {
        let splits = hard.iter().filter_map(|own| run.report.finding(&format!("split-{}", own.key)));
        answer.sentences.extend(splits.map(|finding| finding.sentence.clone()));
    }
    if runs.studies.iter().any(|run| !run.report.verdicts.is_empty()) {
        answer.sentences.push(tally(runs));
    }
    answer.sentences.retain(|sentence| !sentence.is_empty());
    (QUESTION.into(), answer)
}

pub fn tally(runs: &Runs) -> String {
    let verdicts = runs.studies.iter().flat_map(|run| &run.report.verdicts);
    format!("Claims written before the measurement: {}.", claims::tally(verdicts))
}

fn headline(label: &str, ratio: Estimate) -> Headline {
    Headline {
        number: format!("{} ×", figures(ratio.estimate)),
        interval: interval_text(ratio, figures),
        label: label.into(),
    }
}

fn verdict(hard: &[Hard], mean: Option<Estimate>) -> String {
    // `ratio_among` widens an interval because several scenes are judged together.
    let all = |is: &dyn Fn(Estimate) -> bool| hard.iter().all(|own| is(own.ratio.ratio_among(hard.len())));
    let either = |is: &dyn Fn(Estimate) -> bool| all(is) || mean.is_some_and(is);
    let verdict = match () {
        () if hard.iter().any(|own| own.ratio.interval.is_none()) => "Not decided: one epoch, no interval",
        () if all(&|ratio| ratio.is_above(MUCH)) => "Yes",
        () if mean.is_some_and(|mean| mean.is_above(MUCH)) => "Yes, on average",
        () if either(&|ratio| ratio.is_above(1.0)) => "Faster, but not much",
        () if either(&|ratio| ratio.is_below(1.0)) => "No",
        () => "Not decided",
    };
    if hard.len() == SCENES.len() {
        return verdict.into();
    }
    let titles: Vec<&str> = hard.iter().map(|own| own.title.as_str()).collect();
    format!("{verdict}, on {}", listed(&titles))
}

/// Returns the chart of `attribution` if this chart contains all scenes of `hard`.
fn chart(runs: &Runs, hard: &[Hard]) -> Bars {
    let mut figures = runs.of(ATTRIBUTION).into_iter().flat_map(|run| run.report.figures());
    if let Some(Chart::Bars(bars)) = figures.find(|figure| figure.id == ATTRIBUTION).and_then(Figure::chart)
        && hard.iter().all(|own| bars.labels.contains(&own.title))
    {
        return bars.clone();
    }
    let bar = |own: &Hard| (own.title.clone(), Bar::Product(vec![own.ratio.estimate], own.ratio));
    Bars::of_products("speedup over the report's tree", vec!["SAH tree".into()], hard.iter().map(bar))
}

/// The verdict is the fastest structure of `compare`, or `Not measured`.
fn answer_without_hard_scenes(runs: &Runs) -> (String, Answer) {
    let mut answer = Answer { banner: banner(runs), verdict: "Not measured".into(), ..Answer::default() };
    let mut title = QUESTION.to_owned();
    if let Some(run) = runs.of(COMPARE) {
        let finding = |key: &str| run.report.finding(key);
        if let Some(fastest) = finding(FASTEST).and_then(|finding| finding.name.clone()) {
            let scenes = scene_titles(&run.dataset);
            let on = if scenes.len() > 3 { plural(scenes.len(), "scene") } else { listed(&scenes) };
            title = format!("Which structure is the fastest on {on}?");
            answer.verdict = fastest;
            answer.sentences.extend(finding("right").or(finding("single")).map(|found| ended(&found.sentence)));
        }
    }
    answer.sentences.push("These runs do not measure the source report's question; `sahara replicate` does.".into());
    (title, answer)
}
