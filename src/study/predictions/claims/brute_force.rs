//! What does the report's tree gain over no tree?

use super::{prediction, quotient};
use crate::report::number::count;
use crate::report::words::listed;
use crate::study::predictions::{Finding, Inputs, Prediction};
use crate::study::replicate::original::MAIN;

pub(super) fn brute_force(inputs: &Inputs) -> Prediction {
    let claim = "Without a tree t' is constant across scenes within a factor of 2, and the tree improves Torus and Sphere most, then Teapot, \
                 Metallic, Cornellbox, Starters, Billards, Infinitycandy, Cube.";
    let command = "sahara study all";
    let Some(replicated) = &inputs.replicated else {
        return prediction(2, claim, vec![], false, String::new(), command);
    };
    let main = |scene: &str| replicated.main.iter().find(|main| main.scene == scene);
    let t_primes = || replicated.main.iter().map(|main| (main.brute_force.t_prime, main));
    let (Some(most), Some(least)) = (
        t_primes().max_by(|a, b| a.0.estimate.total_cmp(&b.0.estimate)),
        t_primes().min_by(|a, b| a.0.estimate.total_cmp(&b.0.estimate)),
    ) else {
        return prediction(2, claim, vec![], false, String::new(), command);
    };
    let mut findings = vec![Finding::within(
        "largest t' without a tree over the smallest",
        quotient(most.0, least.0),
        f64::NEG_INFINITY,
        2.0,
    )];
    const ORDER: [(&str, &str); 9] = [
        ("Torus", "Teapot"),
        ("Sphere", "Teapot"),
        ("Teapot", "Metallic"),
        ("Metallic", "Cornellbox"),
        ("Cornellbox", "Starters"),
        ("Starters", "Billards"),
        ("Billards", "Infinitycandy"),
        ("Infinitycandy", "Cube"),
        ("Torus", "Cube"),
    ];
    for (better, worse) in ORDER {
        if let (Some(a), Some(b)) = (main(better), main(worse)) {
            let ratio = quotient(a.improvement, b.improvement);
            findings.push(Finding::within(
                format!("improvement of {better} over that of {worse}"),
                ratio,
                1.0,
                f64::INFINITY,
            ));
        }
    }
    let mut why = format!(
        "t' is largest on {} ({} triangles) and smallest on {} ({}).",
        most.1.scene,
        count(most.1.triangles as u64),
        least.1.scene,
        count(least.1.triangles as u64)
    );
    if replicated.main.iter().all(|main| main.triangles >= most.1.triangles) {
        why += " What a ray costs besides its tests weighs most where triangles are fewest, the more so as eight of them are tested at once.";
    }
    let wrong: Vec<String> =
        findings[1..].iter().filter(|f| !f.holds).map(|f| f.what.replace("improvement of ", "")).collect();
    if !wrong.is_empty() {
        why += &format!(" Not in the order expected: {}.", listed(&wrong));
    }
    let complete = replicated.main.len() == MAIN.len();
    prediction(2, claim, findings, complete, why, command)
}
