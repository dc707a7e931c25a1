//! Quantiles of Student's t and of the beta distribution.

use std::cell::Cell;

use statrs::distribution::{ContinuousCDF, Normal, StudentsT};
use statrs::function::beta::beta_reg;

/// The probability that an interval, or any of the intervals judged together, does not contain its value.
pub const LEVEL: f64 = 0.05;

/// The half-width of an interval, in standard errors (Student, "The probable error of a mean", 1908).
///
/// `freedom` is the number of degrees of freedom. `level` is the probability that the interval does not contain the
/// true value.
///
/// # Panics
/// If `freedom` is below 1, or `level` is outside the range `1e-6..1.0`.
pub fn factor(freedom: f64, level: f64) -> f64 {
    assert!(freedom >= 1.0, "an interval needs a degree of freedom");
    assert!((1e-6..1.0).contains(&level), "the level must be at least 1e-6 and below 1");
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

/// For many degrees of freedom, `statrs` is inaccurate or does not return. Above 1000 degrees of freedom, `quantile`
/// uses the series of Cornish and Fisher (Abramowitz, Stegun, "Handbook of mathematical functions", 1964, 26.7.5). The
/// relative error of the result is below 1e-10.
fn quantile(freedom: f64, level: f64) -> f64 {
    const MANY: f64 = 1000.0;
    if freedom <= MANY {
        return -StudentsT::new(0.0, 1.0, freedom).expect("freedom is positive").inverse_cdf(level / 2.0);
    }
    let z = -Normal::standard().inverse_cdf(level / 2.0);
    let s = z * z;
    let terms = [
        (s + 1.0) / 4.0,
        ((5.0 * s + 16.0) * s + 3.0) / 96.0,
        (((3.0 * s + 19.0) * s + 17.0) * s - 15.0) / 384.0,
        ((((79.0 * s + 776.0) * s + 1482.0) * s - 1920.0) * s - 945.0) / 92160.0,
    ];
    z * (1.0 + terms.iter().rev().fold(0.0, |sum, term| (sum + term) / freedom))
}

/// For a `probability` of 0.95, the relative error is below 1e-5 for `a` and `b` up to 1e9. For a `probability` of at
/// most 0.5, the relative error is below 1e-5 for `a` and `b` up to 1e5. The continued fraction of `statrs` ends after
/// 140 terms.
///
/// `beta_quantile` bisects, because the quantile function of `statrs` is inaccurate for small quantiles and may never
/// return (for example for `a` = 2 and `b` = 1e7).
pub fn beta_quantile(probability: f64, a: f64, b: f64) -> f64 {
    let (mut low, mut high) = (0.0, 1.0);
    // Bisecting the exponent first gives quantiles near 0 the same relative precision.
    while high > 1e-300 && beta_reg(a, b, high * 0.5) > probability {
        high *= 0.5;
    }
    if high < 1.0 {
        low = high * 0.5;
    }
    while high - low > 1e-13 * high {
        let middle = 0.5 * (low + high);
        if middle <= low || middle >= high {
            break;
        }
        if beta_reg(a, b, middle) < probability { low = middle } else { high = middle }
    }
    0.5 * (low + high)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_factors_are_students() {
        // These factors were computed by bisection of the incomplete beta function with 30 digits.
        let computed = [
            (1.0, 0.05, 12.7062047361747),
            (1.0, 1e-6, 636619.7723670577),
            (2.0, 0.05, 4.302652729749464),
            (4.0, 0.05, 2.776445105197794),
            (6.5, 0.05, 2.402002007910278),
            (30.0, 0.05, 2.042272456301238),
            (124.0, 1e-6, 5.148608079466605),
            (999.0, 0.05, 1.96234146113345),
            (1000.0, 1e-6, 4.922289523429588),
            (1001.0, 0.05, 1.96233670528088),
            (1001.0, 1e-6, 4.922258736463622),
            (3000.0, 0.05, 1.960755055322458),
            (1e5, 0.001, 3.290624031411883),
            (1e7, 0.05, 1.959964221767205),
            (f64::INFINITY, 0.05, 1.959963984540054),
            (f64::INFINITY, 1e-6, 4.89163847569859),
        ];
        for (freedom, level, expected) in computed {
            let found = factor(freedom, level);
            assert!((found / expected - 1.0).abs() < 1e-10, "{freedom} {level}: {found}");
        }
    }

    #[test]
    fn it_is_known_where_it_has_a_closed_form() {
        let close = |found: f64, expected: f64, error: f64| {
            assert!((found / expected - 1.0).abs() < error, "{found} {expected}");
        };
        for p in [1e-9, 0.05, 0.5, 0.95] {
            close(beta_quantile(p, 1.0, 1.0), p, 1e-12);
            close(beta_quantile(p, 3.0, 1.0), libm::cbrt(p), 1e-12);
            for (n, error) in [(10.0, 1e-12), (1e4, 1e-9), (1e5, 1e-8)] {
                close(beta_quantile(p, 1.0, n), -libm::expm1(libm::log1p(-p) / n), error);
            }
            let sine = libm::sin(std::f64::consts::FRAC_PI_2 * p);
            close(beta_quantile(p, 0.5, 0.5), sine * sine, 1e-12);
        }
        for n in [1e7, 1e9] {
            close(beta_quantile(0.95, 1.0, n), -libm::expm1(libm::log(0.05) / n), 1e-5);
        }
        // For large `n`, the beta distribution with the parameters `n` and `n` is nearly normal. The 0.95 quantile of
        // a normal distribution is 1.645 standard deviations above the mean.
        for n in [1e3, 1e5, 1e7, 1e9] {
            let deviation = 0.5 / libm::sqrt(2.0 * n + 1.0);
            close(beta_quantile(0.95, n, n), 0.5 + 1.644_853_627 * deviation, deviation / n + 1e-9);
        }
    }
}
