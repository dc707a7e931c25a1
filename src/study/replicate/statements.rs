//! What is found again of the report.

use super::Replication;
use crate::report::Statement;
use crate::report::number::{count, plural};
use crate::report::words::{interval, listed, scene_name};

/// How much faster the SAH tree is, scene by scene, and whether the rays are the report's.
pub fn statements(answer: &Replication) -> Vec<Statement> {
    [hard(answer), rays(answer)].into_iter().flatten().collect()
}

fn hard(answer: &Replication) -> Option<Statement> {
    let of = |hard: &super::Hard| {
        format!("{} {} times", scene_name(&hard.scene, hard.stand_in), interval(hard.sah_over_median))
    };
    let scenes: Vec<String> = answer.hard.iter().map(of).collect();
    let mean = answer.conclusion.sah_over_median?;
    let told = match () {
        () if mean.is_above(1.0) => "are faster with the SAH tree than with",
        () if mean.holds(1.0) => "cannot be told to be faster or slower with the SAH tree than with",
        () => "are slower with the SAH tree than with",
    };
    let sentence = format!(
        "Primary rays {told} the report's tree, by this much: {}; geometric mean {}.",
        listed(&scenes),
        interval(mean)
    );
    Some(Statement::new("hard", sentence).of(mean))
}

/// So many rays may be decided otherwise at edges.
const CLOSE: u64 = 2;

fn rays(answer: &Replication) -> Option<Statement> {
    let main = || answer.rays.iter().filter(|rays| answer.main.iter().any(|main| main.scene == rays.scene));
    let far: Vec<String> = main()
        .filter(|rays| rays.total.abs_diff(rays.report) > CLOSE)
        .map(|rays| {
            format!("{} is {} of {} off", rays.scene, count(rays.total.abs_diff(rays.report)), count(rays.report))
        })
        .collect();
    let all = main().count();
    let exceptions = if far.is_empty() { String::new() } else { format!("; {}", listed(&far)) };
    let close = all - far.len();
    (all > 0).then(|| {
        Statement::new(
            "rays",
            format!(
                "The report's ray counts are found again to within {CLOSE} rays in {close} of {}{exceptions}.",
                plural(all, "scene")
            ),
        )
    })
}
