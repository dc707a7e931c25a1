//! The beta distribution, from which Student's t and the binomial distribution follow.

/// The regularised incomplete beta function I_x(a, b): the probability that a beta variable with these parameters, both
/// positive, is at most `x`, in [0, 1]. Its error is about 1e-14 for parameters up to a thousand, and grows with them
/// (1e-7 at a thousand million).
///
/// # References
/// Abramowitz, Stegun: Handbook of mathematical functions, 1964, 26.5.8 (the continued fraction). Lentz: Generating
/// Bessel functions in Mie scattering calculations using continued fractions, 1976 (its evaluation).
pub fn incomplete_beta(x: f64, a: f64, b: f64) -> f64 {
    if x <= 0.0 {
        return 0.0;
    }
    if x >= 1.0 {
        return 1.0;
    }
    // The fraction converges fast below the mean; above it, compute the other tail.
    if x < (a + 1.0) / (a + b + 2.0) { lower_tail(x, a, b) } else { 1.0 - lower_tail(1.0 - x, b, a) }
}

fn lower_tail(x: f64, a: f64, b: f64) -> f64 {
    let log_beta = libm::lgamma(a) + libm::lgamma(b) - libm::lgamma(a + b);
    let front = libm::exp(a * libm::log(x) + b * libm::log1p(-x) - log_beta) / a;
    (front * fraction(x, a, b)).clamp(0.0, 1.0)
}

/// The terms converge after about as many as the square root of the larger parameter.
const MOST_TERMS: usize = 1_000_000;

fn fraction(x: f64, a: f64, b: f64) -> f64 {
    const TINY: f64 = 1e-300;
    let nonzero = |y: f64| if y.abs() < TINY { TINY } else { y };
    let mut c = 1.0;
    let mut d = 1.0 / nonzero(1.0 - (a + b) * x / (a + 1.0));
    let mut value = d;
    for m in 1..MOST_TERMS {
        let m = m as f64;
        let even = m * (b - m) * x / ((a + 2.0 * m - 1.0) * (a + 2.0 * m));
        let odd = -(a + m) * (a + b + m) * x / ((a + 2.0 * m) * (a + 2.0 * m + 1.0));
        let mut last = 1.0;
        for term in [even, odd] {
            d = 1.0 / nonzero(1.0 + term * d);
            c = nonzero(1.0 + term / c);
            last = c * d;
            value *= last;
        }
        if (last - 1.0).abs() < 1e-15 {
            break;
        }
    }
    value
}

/// The `x` at which I_x(a, b) is `probability`.
pub fn beta_quantile(probability: f64, a: f64, b: f64) -> f64 {
    let (mut low, mut high) = (0.0, 1.0);
    // Bisect, first in the exponent, so that quantiles near 0 have the same relative precision.
    while high > 1e-300 && incomplete_beta(high * 0.5, a, b) > probability {
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
        if incomplete_beta(middle, a, b) < probability { low = middle } else { high = middle }
    }
    0.5 * (low + high)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The binomial tail, summed: the chance of at least `k` events in `n` trials of chance `p`.
    fn at_least(k: u32, n: u32, p: f64) -> f64 {
        let term = |i: u32| {
            let choose: f64 = (0..i).map(|j| f64::from(n - j) / f64::from(j + 1)).product();
            choose * libm::pow(p, f64::from(i)) * libm::pow(1.0 - p, f64::from(n - i))
        };
        (k..=n).map(term).sum()
    }

    #[test]
    fn the_sum_of_the_binomial_tail_is_the_same() {
        for (k, n) in [(1, 1), (1, 10), (3, 10), (10, 10), (7, 40)] {
            for p in [1e-6, 0.01, 0.3, 0.5, 0.9, 0.999] {
                let (a, b) = (f64::from(k), f64::from(n - k + 1));
                let (found, sum) = (incomplete_beta(p, a, b), at_least(k, n, p));
                assert!((found - sum).abs() < 1e-13 * sum.max(1e-3), "{k} of {n}, {p}: {found} {sum}");
            }
        }
    }

    #[test]
    fn it_is_known_where_it_has_a_closed_form() {
        for x in [0.0, 1e-9, 0.2, 0.5, 0.75, 1.0] {
            assert!((incomplete_beta(x, 1.0, 1.0) - x).abs() < 1e-15);
            assert!((incomplete_beta(x, 3.0, 1.0) - x * x * x).abs() < 1e-15);
            // Arcsine.
            let arcsine = std::f64::consts::FRAC_2_PI * libm::asin(libm::sqrt(x));
            assert!((incomplete_beta(x, 0.5, 0.5) - arcsine).abs() < 1e-13, "{x}");
        }
        // Symmetric about the half, however large.
        assert!((incomplete_beta(0.5, 1e6, 1e6) - 0.5).abs() < 1e-8);
    }

    #[test]
    fn a_quantile_is_the_inverse() {
        for (a, b) in [(1.0, 10.0), (0.5, 2.0), (6.0, 5.0), (1.0, 1e9), (4.0, 1e6)] {
            for p in [0.025, 0.5, 0.95] {
                let x = beta_quantile(p, a, b);
                assert!((incomplete_beta(x, a, b) - p).abs() < 1e-6, "{a} {b} {p}: {x}");
            }
        }
        assert!((beta_quantile(0.95, 1.0, 1e9) / 2.995_732_27e-9 - 1.0).abs() < 1e-6);
    }
}
