//! Counts the errors of a structure's hits by comparison with exact hits.

use crate::geometry::Hit;
use crate::measure::beta_quantile;
use crate::oracle::{DepthRule, Outcome, Truth, outcome, ulp};

#[derive(Clone, Debug, Default, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct ErrorCounts {
    pub rays: u64,
    /// Rays that hit the mesh in exact arithmetic.
    pub hits: u64,
    pub missed: u64,
    pub false_hits: u64,
    /// Hits at a depth that the `DepthRule` of the comparison rejects.
    pub wrong_depth: u64,
    /// Hits at any depth on a primitive that is not nearest in exact arithmetic. False hits are excluded.
    pub wrong_primitive: u64,
    /// Errors of `t` for the hits on a primitive that is nearest in exact arithmetic. `None` without such a hit.
    pub ulps: Option<Ulps>,
}

/// Errors of `t`. The unit is the distance of neighbouring `f32` numbers at the exact `t`. A correctly rounded `t` has
/// an error of at most 0.5.
#[derive(Clone, Copy, Debug, Default, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct Ulps {
    #[serde(deserialize_with = "infinite_if_null")]
    pub median: f64,
    #[serde(deserialize_with = "infinite_if_null")]
    pub p99: f64,
    #[serde(deserialize_with = "infinite_if_null")]
    pub max: f64,
}

/// Reads null as infinity, because `serde_json` writes infinity as null.
fn infinite_if_null<'de, D: serde::Deserializer<'de>>(deserializer: D) -> Result<f64, D::Error> {
    Ok(<Option<f64> as serde::Deserialize>::deserialize(deserializer)?.unwrap_or(f64::INFINITY))
}

impl ErrorCounts {
    /// Rays with an error. A wrong primitive at the right depth is no error.
    pub fn errors(&self) -> u64 {
        self.missed + self.false_hits + self.wrong_depth
    }

    /// The error rate. `None` without rays.
    pub fn error_share(&self) -> Option<f64> {
        (self.rays > 0).then(|| self.errors() as f64 / self.rays as f64)
    }

    /// An upper bound of the true error rate, with 95 % confidence. `None` without rays.
    ///
    /// The bound is one-sided. For n rays without an error, the bound is 1 - 0.05^(1 / n), about 3 / n.
    ///
    /// # References
    /// Clopper, Pearson: The use of confidence or fiducial limits illustrated in the case of the binomial. Biometrika
    /// 26, 1934. Hanley, Lippman-Hand: If nothing goes wrong, is everything all right? J. Am. Med. Assoc. 249, 1983.
    pub fn error_bound(&self) -> Option<f64> {
        let (errors, others) = (self.errors() as f64, (self.rays - self.errors()) as f64);
        match self.rays {
            0 => None,
            rays if errors == 0.0 => Some(-libm::expm1(libm::log(LEVEL) / rays as f64)),
            _ if others == 0.0 => Some(1.0),
            _ => Some(beta_quantile(1.0 - LEVEL, errors + 1.0, others)),
        }
    }
}

/// The maximum probability that the bound is below the true error rate.
const LEVEL: f64 = 0.05;

/// Compares the hits `answers` with the exact hits `truths`.
///
/// # Panics
/// If `truths` and `answers` differ in length.
pub fn count_errors(truths: &[Option<Truth>], answers: &[Option<Hit>], rule: DepthRule) -> ErrorCounts {
    assert_eq!(truths.len(), answers.len(), "one hit per ray");
    let mut counts = ErrorCounts { rays: truths.len() as u64, ..ErrorCounts::default() };
    let mut ulps = vec![];
    for (truth, answer) in truths.iter().zip(answers) {
        match outcome(truth.as_ref(), *answer, rule) {
            Outcome::Missed => counts.missed += 1,
            Outcome::FalseHit => counts.false_hits += 1,
            Outcome::WrongDepth => counts.wrong_depth += 1,
            Outcome::RightMiss | Outcome::Right | Outcome::WrongPrimitive => {}
        }
        counts.hits += u64::from(truth.is_some());
        if let (Some(truth), Some(hit)) = (truth, answer) {
            if truth.names(*hit) {
                let t = truth.t.approximate();
                ulps.push((f64::from(hit.t) - t).abs() / ulp(t));
            } else {
                counts.wrong_primitive += 1;
            }
        }
    }
    counts.ulps = summary(ulps);
    counts
}

fn summary(mut ulps: Vec<f64>) -> Option<Ulps> {
    ulps.sort_unstable_by(f64::total_cmp);
    let max = *ulps.last()?;
    // The nearest-rank quantile.
    let quantile = |percent: usize| ulps[(ulps.len() * percent).div_ceil(100) - 1];
    Some(Ulps { median: quantile(50), p99: quantile(99), max })
}

#[cfg(test)]
mod tests {
    use std::sync::Arc;

    use glam::Vec3;

    use super::*;
    use crate::geometry::{Mesh, Ray};
    use crate::oracle::Oracle;

    /// The first ray meets two triangles, at `t` = 1 and at `t` = 1 + `gap`. The second ray misses.
    fn truths(gap: f32) -> [Option<Truth>; 2] {
        let corners = |z: f32| [Vec3::new(-1.0, -1.0, z), Vec3::new(3.0, -1.0, z), Vec3::new(-1.0, 3.0, z)];
        let positions = [corners(1.0), corners(1.0 + gap)].concat();
        let oracle = Oracle::new(&Arc::new(Mesh::new(positions, vec![[0, 1, 2], [3, 4, 5]]).unwrap()));
        [Vec3::Z, -Vec3::Z].map(|direction| oracle.nearest(&Ray::new(Vec3::ZERO, direction)))
    }

    #[test]
    fn sums_and_rates() {
        let [hit, none] = truths(0.5);
        let truths = [hit.clone(), hit.clone(), hit.clone(), hit, none.clone(), none];
        let answers = [None, Some((1.0, 0)), Some((1.0 + 2.0 * f32::EPSILON, 0)), Some((1.5, 1)), None, Some((9.0, 1))];
        let answers = answers.map(|answer| answer.map(|(t, id)| Hit::new(t, id)));
        let counts = count_errors(&truths, &answers, DepthRule::STRICT);
        assert_eq!((counts.hits, counts.missed, counts.false_hits), (4, 1, 1));
        assert_eq!((counts.wrong_depth, counts.wrong_primitive), (1, 1));
        assert_eq!(counts.error_share(), Some(0.5));
        assert_eq!(counts.ulps, Some(Ulps { median: 0.0, p99: 2.0, max: 2.0 }));
        assert_eq!(count_errors(&[], &[], DepthRule::STRICT), ErrorCounts::default());
    }

    #[test]
    fn bounds_are_those_of_printed_tables_and_about_three_in_n_without_an_error() {
        let bound = |missed, rays| ErrorCounts { missed, rays, ..ErrorCounts::default() }.error_bound();
        for (missed, rays, printed) in
            [(0, 10, 0.2589), (0, 100, 0.02951), (1, 10, 0.3942), (5, 10, 0.7776), (9, 10, 0.9949), (10, 10, 1.0)]
        {
            let found = bound(missed, rays).unwrap();
            assert!((found - printed).abs() < 5e-5, "{missed} of {rays}: {found}");
        }
        assert_eq!(bound(0, 0), None);
        for n in [100_u64, 1_000_000, 1_000_000_000] {
            let bound = bound(0, n).unwrap();
            // If the error rate is `bound`, the probability of no error in `n` rays is 5 %.
            assert!((libm::exp(n as f64 * libm::log1p(-bound)) - 0.05).abs() < 1e-9, "{n}: {bound}");
            assert!((bound * n as f64 - 2.9957).abs() < 0.05, "{n}: {bound}");
        }
    }
}
