//! The beta distribution, which gives the bounds of the binomial distribution.

use statrs::function::beta::beta_reg;

/// The quantile of the beta distribution with the positive parameters `a` and `b`: the `x` for which the regularised
/// incomplete beta function I_x(a, b) is `probability`.
///
/// At 0.95 its relative error is below 1e-5 for parameters up to a thousand million; near the median and below only up
/// to a hundred thousand, because the continued fraction of `statrs` ends after 140 terms. It bisects: the quantile of
/// `statrs` never returns if it is small, as for (2, 10^7), and is wrong before that.
pub fn beta_quantile(probability: f64, a: f64, b: f64) -> f64 {
    let (mut low, mut high) = (0.0, 1.0);
    // Bisect first in the exponent: quantiles near 0 then have the same relative precision.
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
            // Arcsine.
            let sine = libm::sin(std::f64::consts::FRAC_PI_2 * p);
            close(beta_quantile(p, 0.5, 0.5), sine * sine, 1e-12);
        }
        // No event in n trials: about three in n.
        for n in [1e7, 1e9] {
            close(beta_quantile(0.95, 1.0, n), -libm::expm1(libm::log(0.05) / n), 1e-5);
        }
        // Nearly normal: 1.645 deviations from one half.
        for n in [1e3, 1e5, 1e7, 1e9] {
            let deviation = 0.5 / libm::sqrt(2.0 * n + 1.0);
            close(beta_quantile(0.95, n, n), 0.5 + 1.644_853_627 * deviation, deviation / n + 1e-9);
        }
    }
}
