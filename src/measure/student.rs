//! Student's t, as far as intervals need it.

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
}
