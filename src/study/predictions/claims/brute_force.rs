//! What does the report's tree gain over no tree?

use super::{Bounds, Claim, prediction};
use crate::measure::Estimate;
use crate::report::number::count;
use crate::report::words::listed;
use crate::study::predictions::rank::{Order, WELL};
use crate::study::predictions::{CLAIMS, Inputs, Main, Prediction};
use crate::study::replicate::original::MAIN;

/// The scenes by falling improvement, as expected; those on one line are expected alike.
const ORDER: [&[&str]; 8] = [
    &["Torus", "Sphere"],
    &["Teapot"],
    &["Metallic"],
    &["Cornellbox"],
    &["Starters"],
    &["Billards"],
    &["Infinitycandy"],
    &["Cube"],
];

pub(super) fn brute_force(inputs: &Inputs) -> Prediction {
    let words = "Unoptimised t' is constant across scenes within a factor of 2; improvement order Torus ~ Sphere > Teapot > Metallic > \
                 Cornellbox > Starters > Billards > Infinitycandy > Cube.";
    // Both are about all scenes.
    let main: &[Main] = if inputs.replicated.len() == MAIN.len() { &inputs.replicated } else { &[] };
    let by_t_prime = |a: &&Main, b: &&Main| a.brute_force_t_prime.estimate.total_cmp(&b.brute_force_t_prime.estimate);
    let ends = main.iter().max_by(by_t_prime).zip(main.iter().min_by(by_t_prime));
    let factor = ends.map(|(most, least)| most.brute_force_t_prime.over(least.brute_force_t_prime));
    let expected: Vec<(&Main, usize)> = ORDER
        .iter()
        .enumerate()
        .flat_map(|(rank, scenes)| scenes.iter().map(move |scene| (rank, scene)))
        .filter_map(|(rank, scene)| Some((main.iter().find(|main| main.scene == **scene)?, rank)))
        .collect();
    let ranked: Vec<(Estimate, usize)> = expected.iter().map(|(main, rank)| (main.improvement, *rank)).collect();
    let order = (!main.is_empty()).then(|| Order::of(&ranked, CLAIMS));
    let mut why = vec![];
    if let Some((most, least)) = ends {
        let of = |main: &Main| format!("{} ({} triangles)", main.scene, count(main.triangles as u64));
        why.push(format!("t' is largest on {} and smallest on {}.", of(most), of(least)));
    }
    if let Some(order) = order.as_ref().filter(|order| !order.reversed.is_empty()) {
        let reversed = order
            .reversed
            .iter()
            .map(|&[more, less]| format!("{} gains less than {}", expected[more].0.scene, expected[less].0.scene));
        why.push(format!("Surely not in the order expected: {}.", listed(&reversed.collect::<Vec<_>>())));
    }
    let claims = vec![
        Claim::ratio("largest t' without a tree over the smallest", factor, Bounds::at_most(2.0)),
        Claim::judged(
            "Kendall's tau of the improvements and the order expected",
            order.map(|order| order.tau),
            Bounds::at_least(WELL),
        ),
    ];
    prediction(2, words, claims, why.join(" "), "sahara study all")
}
