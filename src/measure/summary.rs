//! Medians, means and variances.

/// # Panics
/// If a value is NaN.
pub fn median(values: &[f64]) -> Option<f64> {
    let mut sorted = values.to_vec();
    sorted.sort_unstable_by(|a, b| a.partial_cmp(b).expect("a sample is a number"));
    let middle = sorted.len() / 2;
    match sorted.len() {
        0 => None,
        n if n % 2 == 1 => Some(sorted[middle]),
        _ => Some((sorted[middle - 1] + sorted[middle]) * 0.5),
    }
}

pub fn mean(values: &[f64]) -> f64 {
    values.iter().sum::<f64>() / values.len() as f64
}

#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Variance {
    /// At least 0.
    pub square: f64,
    /// Degrees of freedom of Student's t, at least 1.
    pub freedom: f64,
}

impl Variance {
    pub const NONE: Self = Self { square: 0.0, freedom: f64::INFINITY };

    pub fn of_mean(values: &[f64]) -> Option<Self> {
        let (n, centre) = (values.len() as f64, mean(values));
        let squares: f64 = values.iter().map(|v| (v - centre) * (v - centre)).sum();
        (values.len() > 1).then(|| Self { square: squares / (n - 1.0) / n, freedom: n - 1.0 })
    }

    /// If `self` is the variance of `x`, the result is the variance of `factor * x`.
    pub fn times(self, factor: f64) -> Self {
        Self { square: self.square * factor * factor, ..self }
    }

    /// The parts must be independent.
    ///
    /// # References
    /// Satterthwaite, "An approximate distribution of estimates of variance components", 1946.
    ///
    /// Welch, "The generalization of Student's problem when several different population variances are involved", 1947
    /// (for two parts).
    pub fn sum(parts: &[Self]) -> Self {
        let square: f64 = parts.iter().map(|part| part.square).sum();
        let spread: f64 = parts.iter().map(|part| part.square * part.square / part.freedom).sum();
        let least = parts.iter().map(|part| part.freedom).fold(f64::INFINITY, f64::min);
        Self { square, freedom: if spread > 0.0 { square * square / spread } else { least } }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn medians() {
        assert_eq!(median(&[]), None);
        assert_eq!(median(&[3.0]), Some(3.0));
        assert_eq!(median(&[9.0, 1.0, 5.0]), Some(5.0));
        assert_eq!(median(&[4.0, 1.0, 100.0, 2.0]), Some(3.0));
    }

    #[test]
    fn parts_add_up_and_the_less_known_one_weighs() {
        let part = |square, freedom| Variance { square, freedom };
        assert_eq!(Variance::sum(&[part(1.0, 4.0), part(1.0, 4.0)]), part(2.0, 8.0));
        assert_eq!(Variance::sum(&[part(1.0, 4.0), Variance::NONE]), part(1.0, 4.0));
        assert_eq!(Variance::sum(&[part(0.0, 4.0), part(0.0, 8.0)]), part(0.0, 4.0));
        assert_eq!(part(3.0, 2.0).times(2.0), part(12.0, 2.0));
    }
}
