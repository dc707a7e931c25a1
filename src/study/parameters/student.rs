//! How likely chance alone is, for one difference and for many.

/// The probability that Student's t with `freedom` degrees of freedom is at least as far from 0 as `t` (Abramowitz, Stegun,
/// "Handbook of mathematical functions", 1964, 26.7.3 and 26.7.4).
///
/// # Panics
/// If `freedom` is 0.
pub(super) fn two_sided(t: f64, freedom: usize) -> f64 {
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
pub(super) fn holm(probabilities: &[f64], level: f64) -> Vec<bool> {
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
