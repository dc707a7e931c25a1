//! Student's t: how wide an interval must be, and how likely chance alone is, for one difference and for many.

/// The 97.5 % quantile for 1, 2, .. 30 degrees of freedom.
const TABLE: [f64; 30] = [
    12.706, 4.303, 3.182, 2.776, 2.571, 2.447, 2.365, 2.306, 2.262, 2.228, 2.201, 2.179, 2.160, 2.145, 2.131, 2.120,
    2.110, 2.101, 2.093, 2.086, 2.080, 2.074, 2.069, 2.064, 2.060, 2.056, 2.052, 2.048, 2.045, 2.042,
];

/// That of the normal distribution.
pub const NORMAL: f64 = 1.960;

/// The factor that makes a standard error with `freedom` degrees of freedom half a 95 % interval (Student, "The probable
/// error of a mean", 1908): between whole degrees, and above 30, linear in 1 / `freedom`, which errs by less than 0.3 %
/// from 2 on.
///
/// # Panics
/// If `freedom` is less than 1.
pub fn factor(freedom: f64) -> f64 {
    assert!(freedom >= 1.0, "an interval needs a degree of freedom");
    let last = TABLE.len() as f64;
    let (low, high, from, to) = if freedom >= last {
        (last, f64::INFINITY, TABLE[TABLE.len() - 1], NORMAL)
    } else {
        let whole = freedom as usize;
        (whole as f64, whole as f64 + 1.0, TABLE[whole - 1], TABLE[whole])
    };
    let share = (1.0 / low - 1.0 / freedom) / (1.0 / low - 1.0 / high);
    from + (to - from) * share
}

/// The probability that Student's t with `freedom` degrees of freedom is at least as far from 0 as `t` (Abramowitz, Stegun,
/// "Handbook of mathematical functions", 1964, 26.7.3 and 26.7.4).
///
/// # Panics
/// If `freedom` is 0.
pub fn two_sided(t: f64, freedom: usize) -> f64 {
    assert!(freedom > 0, "a t has degrees of freedom");
    let n = freedom as f64;
    let (sine, cosine) = {
        let root = libm::sqrt(n + t * t);
        (libm::fabs(t) / root, libm::sqrt(n) / root)
    };
    // The sum of a series in powers of cos^2, each term from the one before.
    let odd = freedom % 2 == 1;
    let (mut sum, mut term, mut k) = (0.0, if odd { cosine } else { 1.0 }, if odd { 3.0 } else { 2.0 });
    while k <= n {
        sum += term;
        term *= cosine * cosine * (k - 1.0) / k;
        k += 2.0;
    }
    let inside = if odd { std::f64::consts::FRAC_2_PI * (libm::atan2(sine, cosine) + sine * sum) } else { sine * sum };
    (1.0 - inside).clamp(0.0, 1.0)
}

/// Which of many probabilities are too small for chance, when the chance of even one false claim among all may be `level`
/// (Holm, "A simple sequentially rejective multiple test procedure", 1979).
pub fn holm(probabilities: &[f64], level: f64) -> Vec<bool> {
    let mut order: Vec<usize> = (0..probabilities.len()).collect();
    order.sort_by(|&a, &b| probabilities[a].total_cmp(&probabilities[b]));
    let mut real = vec![false; probabilities.len()];
    for (done, &i) in order.iter().enumerate() {
        if probabilities[i] > level / (probabilities.len() - done) as f64 {
            break;
        }
        real[i] = true;
    }
    real
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_factors_are_students() {
        let known = [(1.0, 12.706), (4.0, 2.776), (29.0, 2.045), (30.0, 2.042), (60.0, 2.000), (120.0, 1.980)];
        for (freedom, expected) in known {
            assert!((factor(freedom) - expected).abs() < 2e-3, "{freedom}: {}", factor(freedom));
        }
        // 6.5 degrees: 2.402 by integration.
        assert!((factor(6.5) - 2.402).abs() < 3e-3);
        assert!((factor(1e9) - NORMAL).abs() < 1e-6);
    }

    #[test]
    fn probabilities_are_students() {
        // From printed tables: quantiles with their two-sided probability.
        let known = [
            (12.706, 1, 0.05),
            (4.303, 2, 0.05),
            (3.182, 3, 0.05),
            (2.776, 4, 0.05),
            (8.610, 4, 0.001),
            (5.959, 6, 0.001),
            (2.571, 5, 0.05),
            (2.086, 20, 0.05),
            (2.042, 30, 0.05),
        ];
        for (t, freedom, p) in known {
            assert!((two_sided(t, freedom) / p - 1.0).abs() < 2e-3, "{t} {freedom}: {}", two_sided(t, freedom));
            assert_eq!(two_sided(t, freedom), two_sided(-t, freedom));
        }
        assert_eq!(two_sided(0.0, 3), 1.0);
    }

    #[test]
    fn many_looks_ask_for_more_each() {
        // One of a single comparison is real, the same one of five is not.
        assert_eq!(holm(&[0.03], 0.05), [true]);
        assert_eq!(holm(&[0.03, 0.5, 0.5, 0.5, 0.5], 0.05), [false; 5]);
        // Step by step: 0.05 / 3, 0.05 / 2, 0.05.
        assert_eq!(holm(&[0.04, 0.01, 0.02], 0.05), [true, true, true]);
        assert_eq!(holm(&[0.06, 0.01, 0.03], 0.05), [false, true, false]);
        assert_eq!(holm(&[], 0.05), [false; 0]);
    }
}
