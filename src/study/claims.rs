#![doc = include_str!("CLAIMS.md")]

use crate::measure::{Estimate, Interval};
use crate::report::number::figures;
use crate::report::{ClaimVerdict, Finding, Outcome};

struct Claim {
    prediction: u8,
    /// The key of the finding whose value is compared with `range`.
    key: &'static str,
    what: &'static str,
    /// The smallest and the largest expected value. Infinity means no bound.
    range: [f64; 2],
    scale: Scale,
}

/// The correction of an interval for the number of claims.
#[derive(Clone, Copy)]
enum Scale {
    /// The interval of the logarithm is widened.
    Ratio,
    Number,
    /// The interval of the finding is already corrected for all claims.
    Judged,
}
use Scale::{Judged, Number, Ratio};

pub const CLAIMS: usize = REPLICATE.len() + SCALING.len() + ATTRIBUTION.len() + COMPARE.len();

const NONE: f64 = f64::INFINITY;
const RAYS: [f64; 2] = [-2.0, 2.0];
const WHOLE: [f64; 2] = [20.0, NONE];
const PLANE: [f64; 2] = [1.2, 5.0];
// The prediction is "more tests than brute force". Brute force has the value 1.
const MORE: [f64; 2] = [1.0_f64.next_up(), NONE];
// The predictions state no numbers for Kendall's tau. This project chose these bounds.
const WELL: [f64; 2] = [0.7, NONE];
const BADLY: [f64; 2] = [-NONE, 0.5];

const fn claim(prediction: u8, key: &'static str, what: &'static str, range: [f64; 2], scale: Scale) -> Claim {
    Claim { prediction, key, what, range, scale }
}

const REPLICATE: [Claim; 12] = [
    claim(1, "rays-cube", "Cube: our number of rays minus the report's", RAYS, Number),
    claim(1, "rays-sphere", "Sphere: our number of rays minus the report's", RAYS, Number),
    claim(1, "rays-torus", "Torus: our number of rays minus the report's", RAYS, Number),
    claim(1, "rays-teapot", "Teapot: our number of rays minus the report's", RAYS, Number),
    claim(1, "rays-billards", "Billards: our number of rays minus the report's", RAYS, Number),
    claim(1, "rays-cornellbox", "Cornellbox: our number of rays minus the report's", RAYS, Number),
    claim(1, "rays-infinitycandy", "Infinitycandy: our number of rays minus the report's", RAYS, Number),
    claim(1, "rays-metallic", "Metallic: our number of rays minus the report's", RAYS, Number),
    claim(2, "t-prime", "brute force: largest t' / smallest t'", [-NONE, 2.0], Ratio),
    claim(2, "order", "Kendall's tau of the improvements and the order expected", WELL, Judged),
    claim(3, "crowded", "Infinitycandy, 100 / 0.7: tests per ray and triangle (brute force: 1)", [0.9, 1.3], Number),
    claim(3, "crowded-50", "Infinitycandy, 50 / 0.7: tests per ray and triangle (brute force: 1)", MORE, Number),
];

const SCALING: [Claim; 2] = [
    claim(4, "growth-report", "growth exponent b of the report's tree", [0.8, 1.2], Number),
    claim(4, "growth-sah", "growth exponent b of the SAH tree", [-NONE, 0.2], Number),
];

const ATTRIBUTION: [Claim; 9] = [
    claim(5, "whole-dragon", "Dragon: whole speedup of the SAH tree", WHOLE, Ratio),
    claim(5, "plane-dragon", "Dragon: speedup by the split plane alone", PLANE, Ratio),
    claim(5, "whole-lucy", "Lucy: whole speedup of the SAH tree", WHOLE, Ratio),
    claim(5, "plane-lucy", "Lucy: speedup by the split plane alone", PLANE, Ratio),
    claim(5, "whole-sponza", "Sponza: whole speedup of the SAH tree", WHOLE, Ratio),
    claim(5, "plane-sponza", "Sponza: speedup by the split plane alone", PLANE, Ratio),
    claim(6, "gain-dragon", "speedup on Sponza / speedup on Dragon", [1.0, NONE], Ratio),
    claim(6, "gain-lucy", "speedup on Sponza / speedup on Lucy", [1.0, NONE], Ratio),
    claim(7, "tau", "tau of SAH cost and time, trees with the same traversal (mean of scenes)", WELL, Judged),
];

const COMPARE: [Claim; 1] =
    [claim(7, "tau", "tau of SAH cost and time, structures of different families (mean of scenes)", BADLY, Judged)];

fn of_study(study: &str) -> &'static [Claim] {
    match study {
        "replicate" => &REPLICATE,
        "scaling" => &SCALING,
        "attribution" => &ATTRIBUTION,
        "compare" => &COMPARE,
        _ => &[],
    }
}

impl Claim {
    fn expected(&self) -> String {
        match self.range {
            MORE => "more than 1".into(),
            [low, NONE] => format!("at least {}", figures(low)),
            [low, high] if low == -NONE => format!("at most {}", figures(high)),
            range => range.map(figures).join(" to "),
        }
    }

    fn outcome(&self, value: Option<Estimate>) -> Outcome {
        let Some(value) = value else { return Outcome::NotMeasured };
        let Some(Interval { low, high, .. }) = value.interval else { return Outcome::Undecided };
        let [least, most] = self.range;
        match () {
            () if least <= low && high <= most => Outcome::Confirmed,
            () if high < least || low > most => Outcome::Refuted,
            () => Outcome::Undecided,
        }
    }

    fn judge(&self, findings: &[Finding]) -> ClaimVerdict {
        let value = findings.iter().find(|finding| finding.key == self.key).and_then(|finding| finding.value);
        let value = value.map(|value| match self.scale {
            Ratio => value.ratio_among(CLAIMS),
            Number => value.among(CLAIMS),
            Judged => value,
        });
        let (claim, expected) = (self.what.to_owned(), self.expected());
        ClaimVerdict { prediction: self.prediction, claim, expected, value, outcome: self.outcome(value) }
    }
}

/// Empty if no claim of the study is measured.
pub fn judge(study: &str, findings: &[Finding]) -> Vec<ClaimVerdict> {
    let verdicts: Vec<ClaimVerdict> = of_study(study).iter().map(|claim| claim.judge(findings)).collect();
    let is_measured = verdicts.iter().any(|verdict| verdict.outcome != Outcome::NotMeasured);
    if is_measured { verdicts } else { vec![] }
}

pub fn tally<'a>(verdicts: impl IntoIterator<Item = &'a ClaimVerdict>) -> String {
    let outcomes: Vec<Outcome> = verdicts.into_iter().map(|verdict| verdict.outcome).collect();
    let count = |outcome: Outcome| outcomes.iter().filter(|own| **own == outcome).count();
    let judged = [Outcome::Confirmed, Outcome::Refuted, Outcome::Undecided].map(count);
    let [confirmed, refuted, undecided] = judged;
    let missing = CLAIMS - judged.iter().sum::<usize>();
    let missing = if missing == 0 { String::new() } else { format!(", {missing} not measured") };
    format!("{confirmed} of {CLAIMS} confirmed, {refuted} refuted, {undecided} undecided{missing}")
}

#[cfg(test)]
mod tests {
    use std::collections::BTreeSet;

    use super::*;
    use crate::study::Studies;

    #[test]
    fn every_claim_is_of_a_prediction_and_has_a_key_of_its_own() {
        let studies = Studies::builtin();
        let all: Vec<(&str, &Claim)> =
            studies.iter().flat_map(|study| of_study(study.name).iter().map(|claim| (study.name, claim))).collect();
        let keys = BTreeSet::from_iter(all.iter().map(|(study, claim)| (study, claim.key)));
        assert_eq!((all.len(), keys.len(), CLAIMS), (24, 24, 24), "every claim belongs to a study");
        let predictions = BTreeSet::from_iter(all.iter().map(|(_, claim)| claim.prediction));
        assert_eq!(predictions, BTreeSet::from_iter(1..=7));
        let expected = [0, 8, 11].map(|i| REPLICATE[i].expected());
        assert_eq!(expected, ["-2.00 to 2.00", "at most 2.00", "more than 1"]);
        assert_eq!(ATTRIBUTION[0].expected(), "at least 20.0");
    }

    #[test]
    fn the_whole_interval_decides() {
        for (value, outcome) in [
            (Estimate::exact(1.0), Outcome::Confirmed),
            (Estimate::exact(2.0), Outcome::Refuted),
            (Estimate::between(1.2, 1.0, 1.4), Outcome::Undecided),
            (Estimate::alone(1.0), Outcome::Undecided),
        ] {
            let verdicts = judge("replicate", &[Finding::number("crowded", value)]);
            let own = verdicts.iter().find(|verdict| verdict.claim.contains("100 / 0.7"));
            assert_eq!(own.unwrap().outcome, outcome, "{value:?}");
        }
        assert!(judge("replicate", &[]).is_empty(), "nothing is measured");
        let verdicts = judge("replicate", &[Finding::number("crowded-50", Estimate::exact(1.0))]);
        assert_eq!(verdicts.iter().filter(|verdict| verdict.outcome == Outcome::Refuted).count(), 1);
        assert_eq!(tally(&verdicts), "0 of 24 confirmed, 1 refuted, 0 undecided, 23 not measured");
    }
}
