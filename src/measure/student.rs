//! Student's t distribution: the width of intervals and the significance of one difference or of many.

use std::cell::Cell;

use super::beta::incomplete_beta;

/// The probability that an interval does not contain the value, for one interval or for all that are judged together: 5
/// %.
pub const LEVEL: f64 = 0.05;

/// The half-width of an interval that misses with probability `level`, in standard errors with `freedom` degrees of
/// freedom (Student, "The probable error of a mean", 1908).
///
/// # Panics
/// If `freedom` is less than 1, or `level` does not lie between 0 and 1.
pub fn factor(freedom: f64, level: f64) -> f64 {
    assert!(freedom >= 1.0, "an interval needs a degree of freedom");
    assert!(0.0 < level && level < 1.0, "an interval leaves a chance to its outside");
    // Tables use the same factor again and again.
    thread_local! {
        static LAST: Cell<(f64, f64, f64)> = const { Cell::new((0.0, 0.0, 0.0)) };
    }
    let (of, at, factor) = LAST.get();
    if (of, at) == (freedom, level) {
        return factor;
    }
    let factor = quantile(freedom, level);
    LAST.set((freedom, level, factor));
    factor
}

/// The t that is exceeded in magnitude with probability `level`.
fn quantile(freedom: f64, level: f64) -> f64 {
    // Newton's method on logarithms: the tail is concave there, so no step after the first overshoots.
    let mut log_t = 0.0;
    for _ in 0..100 {
        let t = libm::exp(log_t);
        let tail = two_sided(t, freedom);
        if tail <= 0.0 {
            log_t -= 0.5;
            continue;
        }
        let slope = -2.0 * t * density(t, freedom) / tail;
        let step = libm::log(tail / level) / slope;
        log_t -= step;
        if step.abs() < 1e-12 {
            break;
        }
    }
    libm::exp(log_t)
}

/// With more degrees of freedom t is treated as a normal variable.
const NORMAL: f64 = 1e9;

fn density(t: f64, freedom: f64) -> f64 {
    let n = freedom.min(NORMAL);
    let log = libm::lgamma((n + 1.0) / 2.0)
        - libm::lgamma(n / 2.0)
        - 0.5 * libm::log(n * std::f64::consts::PI)
        - (n + 1.0) / 2.0 * libm::log1p(t * t / n);
    if freedom < 1e6 { libm::exp(log) } else { libm::exp(-t * t / 2.0) / libm::sqrt(2.0 * std::f64::consts::PI) }
}

/// The probability that Student's t with `freedom` degrees of freedom is at least as far from 0 as `t` (Abramowitz,
/// Stegun, "Handbook of mathematical functions", 1964, 26.7.1).
///
/// # Panics
/// If `freedom` is not positive.
fn two_sided(t: f64, freedom: f64) -> f64 {
    assert!(freedom > 0.0, "a t has degrees of freedom");
    if freedom >= 1e6 {
        return libm::erfc(t.abs() / std::f64::consts::SQRT_2);
    }
    incomplete_beta(freedom / (freedom + t * t), freedom / 2.0, 0.5)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_factors_are_students() {
        // From printed tables.
        let known = [
            (1.0, 0.05, 12.706),
            (2.0, 0.05, 4.303),
            (3.0, 0.05, 3.182),
            (4.0, 0.05, 2.776),
            (5.0, 0.05, 2.571),
            (20.0, 0.05, 2.086),
            (120.0, 0.05, 1.980),
            (1.0, 0.001, 636.619),
            (4.0, 0.01, 4.604),
            (4.0, 0.001, 8.610),
            (6.0, 0.001, 5.959),
            (10.0, 0.002, 4.144),
            (f64::INFINITY, 0.05, 1.960),
            (f64::INFINITY, 0.001, 3.291),
        ];
        for (freedom, level, expected) in known {
            let found = factor(freedom, level);
            assert!((found / expected - 1.0).abs() < 5e-4, "{freedom} {level}: {found}");
        }
        // 6.5 degrees: 2.402 by integration.
        assert!((factor(6.5, 0.05) - 2.402).abs() < 1e-3);
    }

    #[test]
    fn a_factor_leaves_its_level_outside() {
        for freedom in [1.0, 1.7, 4.0, 33.3, 1e5, 1e8] {
            for level in [0.5, 0.05, 0.05 / 24.0, 1e-6] {
                let t = factor(freedom, level);
                let outside = two_sided(t, freedom);
                assert!((outside / level - 1.0).abs() < 1e-6, "{freedom} {level}: {outside}");
                assert_eq!(outside, two_sided(-t, freedom));
            }
        }
        assert_eq!(two_sided(0.0, 3.0), 1.0);
    }
}
