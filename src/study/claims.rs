#![doc = include_str!("CLAIMS.md")]

use crate::measure::{Estimate, Interval};
use crate::report::number::figures;
use crate::report::{ClaimVerdict, Finding, Outcome};

/// The expected range of a number. An infinite end is no bound.
pub struct Claim {
    pub prediction: u8,
    /// The study that measures the figure, and the key of its finding.
    pub study: &'static str,
    pub key: &'static str,
    pub what: &'static str,
    pub low: f64,
    pub high: f64,
    pub scale: Scale,
}

/// How the interval of a number is widened, because all claims are judged together.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Scale {
    /// A ratio: widens the interval of its logarithm.
    Ratio,
    /// A plain number.
    Number,
    /// Its interval is already corrected for all claims.
    Judged,
}

/// The number of claims: each interval is corrected for all of them.
pub const CLAIMS: usize = 24;

/// "Well" means a tau of at least this, and "badly" at most the other constant. The predictions use these words without
/// numbers; this project chose the numbers.
const WELL: f64 = 0.7;
const BADLY: f64 = 0.5;

const NONE: f64 = f64::INFINITY;

/// Shortens the table.
const fn claim(
    prediction: u8,
    study: &'static str,
    key: &'static str,
    what: &'static str,
    [low, high]: [f64; 2],
    scale: Scale,
) -> Claim {
    Claim { prediction, study, key, what, low, high, scale }
}

/// All claims, in the order of the predictions.
pub const ALL: [Claim; CLAIMS] = {
    use Scale::{Judged, Number, Ratio};
    const RAYS: [f64; 2] = [-2.0, 2.0];
    const WHOLE: [f64; 2] = [20.0, NONE];
    const PLANE: [f64; 2] = [1.2, 5.0];
    // A number of tests equal to brute force is not "more".
    const MORE: [f64; 2] = [1.0_f64.next_up(), NONE];
    [
        claim(1, "replicate", "rays-cube", "Cube: our number of rays minus the report's", RAYS, Number),
        claim(1, "replicate", "rays-sphere", "Sphere: our number of rays minus the report's", RAYS, Number),
        claim(1, "replicate", "rays-torus", "Torus: our number of rays minus the report's", RAYS, Number),
        claim(1, "replicate", "rays-teapot", "Teapot: our number of rays minus the report's", RAYS, Number),
        claim(1, "replicate", "rays-billards", "Billards: our number of rays minus the report's", RAYS, Number),
        claim(1, "replicate", "rays-cornellbox", "Cornellbox: our number of rays minus the report's", RAYS, Number),
        claim(
            1,
            "replicate",
            "rays-infinitycandy",
            "Infinitycandy: our number of rays minus the report's",
            RAYS,
            Number,
        ),
        claim(1, "replicate", "rays-metallic", "Metallic: our number of rays minus the report's", RAYS, Number),
        claim(2, "replicate", "t-prime", "brute force: largest t' / smallest t'", [-NONE, 2.0], Ratio),
        claim(
            2,
            "replicate",
            "order",
            "Kendall's tau of the improvements and the order expected",
            [WELL, NONE],
            Judged,
        ),
        claim(
            3,
            "replicate",
            "crowded",
            "Infinitycandy, 100 / 0.7: tests per ray and triangle (brute force: 1)",
            [0.9, 1.3],
            Number,
        ),
        claim(
            3,
            "replicate",
            "crowded-50",
            "Infinitycandy, 50 / 0.7: tests per ray and triangle (brute force: 1)",
            MORE,
            Number,
        ),
        claim(4, "scaling", "growth-report", "growth exponent b of the report's tree", [0.8, 1.2], Number),
        claim(4, "scaling", "growth-sah", "growth exponent b of the SAH tree", [-NONE, 0.2], Number),
        claim(5, "attribution", "whole-dragon", "Dragon: whole speedup of the SAH tree", WHOLE, Ratio),
        claim(5, "attribution", "plane-dragon", "Dragon: speedup by the split plane alone", PLANE, Ratio),
        claim(5, "attribution", "whole-lucy", "Lucy: whole speedup of the SAH tree", WHOLE, Ratio),
        claim(5, "attribution", "plane-lucy", "Lucy: speedup by the split plane alone", PLANE, Ratio),
        claim(5, "attribution", "whole-sponza", "Sponza: whole speedup of the SAH tree", WHOLE, Ratio),
        claim(5, "attribution", "plane-sponza", "Sponza: speedup by the split plane alone", PLANE, Ratio),
        claim(6, "attribution", "gain-dragon", "speedup on Sponza / speedup on Dragon", [1.0, NONE], Ratio),
        claim(6, "attribution", "gain-lucy", "speedup on Sponza / speedup on Lucy", [1.0, NONE], Ratio),
        claim(
            7,
            "attribution",
            "tau",
            "tau of SAH cost and time, trees with the same traversal (mean of scenes)",
            [WELL, NONE],
            Judged,
        ),
        claim(
            7,
            "compare",
            "tau",
            "tau of SAH cost and time, structures of different families (mean of scenes)",
            [-NONE, BADLY],
            Judged,
        ),
    ]
};

impl Claim {
    fn expected(&self) -> String {
        match (self.low.is_finite(), self.high.is_finite()) {
            (true, true) => format!("{} to {}", figures(self.low), figures(self.high)),
            (true, false) if self.low == 1.0_f64.next_up() => "more than 1".into(),
            (true, false) => format!("at least {}", figures(self.low)),
            (false, _) => format!("at most {}", figures(self.high)),
        }
    }

    fn outcome(&self, value: Option<Estimate>) -> Outcome {
        let Some(value) = value else { return Outcome::NotMeasured };
        let Some(Interval { low, high, .. }) = value.interval else { return Outcome::Undecided };
        match () {
            () if self.low <= low && high <= self.high => Outcome::Confirmed,
            () if high < self.low || low > self.high => Outcome::Refuted,
            () => Outcome::Undecided,
        }
    }

    fn judge(&self, findings: &[Finding]) -> ClaimVerdict {
        let value = findings.iter().find(|finding| finding.key == self.key).and_then(|finding| finding.value);
        let value = value.map(|value| match self.scale {
            Scale::Ratio => value.ratio_among(CLAIMS),
            Scale::Number => value.among(CLAIMS),
            Scale::Judged => value,
        });
        let (claim, expected) = (self.what.to_owned(), self.expected());
        ClaimVerdict { prediction: self.prediction, claim, expected, value, outcome: self.outcome(value) }
    }
}

/// The verdicts on the claims that `study` measures, from its findings. Empty if none of them is measured.
pub fn judge(study: &str, findings: &[Finding]) -> Vec<ClaimVerdict> {
    let own = ALL.iter().filter(|claim| claim.study == study);
    let verdicts: Vec<ClaimVerdict> = own.map(|claim| claim.judge(findings)).collect();
    let is_measured = verdicts.iter().any(|verdict| verdict.outcome != Outcome::NotMeasured);
    if is_measured { verdicts } else { vec![] }
}

/// The number of claims by outcome: `10 of 24 confirmed, 10 refuted, 4 undecided`.
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
    use super::*;

    #[test]
    fn every_claim_is_of_a_prediction_and_has_a_key_of_its_own() {
        let mut keys: Vec<(&str, &str)> = ALL.iter().map(|claim| (claim.study, claim.key)).collect();
        keys.sort_unstable();
        keys.dedup();
        assert_eq!(keys.len(), CLAIMS);
        let mut predictions: Vec<u8> = ALL.iter().map(|claim| claim.prediction).collect();
        assert!(predictions.is_sorted());
        predictions.dedup();
        assert_eq!(predictions, (1..=7).collect::<Vec<u8>>());
        let expected: Vec<String> = ALL.iter().map(Claim::expected).collect();
        assert_eq!(
            [&expected[0], &expected[8], &expected[11], &expected[14]].map(String::as_str),
            ["-2.00 to 2.00", "at most 2.00", "more than 1", "at least 20.0"]
        );
    }

    #[test]
    fn the_whole_interval_decides() {
        let of = |value: Estimate| {
            let findings = [Finding::number("crowded", value)];
            judge("replicate", &findings)
                .into_iter()
                .find(|verdict| verdict.claim.contains("100 / 0.7"))
                .unwrap()
                .outcome
        };
        assert_eq!(of(Estimate::exact(1.0)), Outcome::Confirmed);
        assert_eq!(of(Estimate::exact(2.0)), Outcome::Refuted);
        assert_eq!(of(Estimate::between(1.2, 1.0, 1.4)), Outcome::Undecided);
        assert_eq!(of(Estimate::alone(1.0)), Outcome::Undecided);
        assert!(judge("replicate", &[]).is_empty(), "nothing is measured");
        let verdicts = judge("replicate", &[Finding::number("crowded-50", Estimate::exact(1.0))]);
        assert_eq!(verdicts.iter().filter(|verdict| verdict.outcome == Outcome::Refuted).count(), 1);
        assert_eq!(tally(&verdicts), "0 of 24 confirmed, 1 refuted, 0 undecided, 23 not measured");
    }
}
