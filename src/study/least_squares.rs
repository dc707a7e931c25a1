//! Lines through points.

use crate::measure::{LEVEL, factor};

/// The weights of which the slope over `x` is the sum with heights. Nothing if the places do not differ.
pub fn slope_weights(x: &[f64]) -> Option<Vec<f64>> {
    let mean = x.iter().sum::<f64>() / x.len() as f64;
    let squares: f64 = x.iter().map(|x| (x - mean) * (x - mean)).sum();
    (squares > 0.0).then(|| x.iter().map(|x| (x - mean) / squares).collect())
}

/// Half of the 95 % interval of the slope if points scatter about the line independently and alike (Student's t with n
/// - 2 degrees of freedom). Nothing of fewer than three points.
pub fn scatter(points: &[(f64, f64)]) -> Option<f64> {
    let freedom = points.len().checked_sub(2).filter(|&freedom| freedom > 0)? as f64;
    let (x, y): (Vec<f64>, Vec<f64>) = points.iter().copied().unzip();
    let [mean_x, mean_y] = [&x, &y].map(|all| all.iter().sum::<f64>() / all.len() as f64);
    let slope: f64 = slope_weights(&x)?.iter().zip(&y).map(|(weight, y)| weight * y).sum();
    let squares: f64 = x.iter().map(|x| (x - mean_x) * (x - mean_x)).sum();
    let off = points.iter().map(|(x, y)| y - mean_y - slope * (x - mean_x));
    let rest: f64 = off.map(|off| off * off).sum();
    Some(factor(freedom, LEVEL) * libm::sqrt(rest / freedom / squares))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_line_is_found_where_points_lie_on_one() {
        let points: Vec<(f64, f64)> = [1.0, 2.0, 5.0].map(|x| (x, 3.0 + 0.5 * x)).into();
        assert!(scatter(&points).unwrap() < 1e-6);
        assert_eq!((scatter(&points[..2]), slope_weights(&[1.0; 3])), (None, None));
        let weights = slope_weights(&[1.0, 2.0, 5.0]).unwrap();
        let sum: f64 = weights.iter().zip(&points).map(|(weight, point)| weight * point.1).sum();
        assert!((sum - 0.5).abs() < 1e-12);
    }

    #[test]
    fn the_scatter_of_a_slope_is_students() {
        // Residuals 1, -2, 1 about y = 1 at x = -1, 0, 1: s^2 = 6, the error of the slope sqrt(6 / 2), t(1) = 12.706.
        let points = [(-1.0, 2.0), (0.0, -1.0), (1.0, 2.0)];
        assert!((scatter(&points).unwrap() - 12.706 * libm::sqrt(3.0)).abs() < 1e-3);
    }
}
