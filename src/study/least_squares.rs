//! Lines through points.

use crate::measure::{LEVEL, factor};

/// Height at 0 and slope of the line of least squares through `points`. Nothing if they do not differ in x.
pub fn line(points: &[(f64, f64)]) -> Option<(f64, f64)> {
    let n = points.len() as f64;
    let (x, y) = points.iter().fold((0.0, 0.0), |(x, y), p| (x + p.0 / n, y + p.1 / n));
    let (xx, xy) = points.iter().fold((0.0, 0.0), |(xx, xy), p| {
        let d = p.0 - x;
        (xx + d * d, xy + d * (p.1 - y))
    });
    (xx > 0.0).then(|| (y - xy / xx * x, xy / xx))
}

/// The weights of which the slope over `x` is the sum with heights. Nothing if the places do not differ.
pub fn slope_weights(x: &[f64]) -> Option<Vec<f64>> {
    let mean = x.iter().sum::<f64>() / x.len() as f64;
    let squares: f64 = x.iter().map(|x| (x - mean) * (x - mean)).sum();
    (squares > 0.0).then(|| x.iter().map(|x| (x - mean) / squares).collect())
}

/// Half of the 95 % interval of the slope if points scatter about the line independently and alike (Student's t with n
/// - 2 degrees of freedom). Nothing of fewer than three points.
pub fn scatter(points: &[(f64, f64)]) -> Option<f64> {
    let (at_zero, slope) = line(points)?;
    let freedom = points.len().checked_sub(2).filter(|&freedom| freedom > 0)? as f64;
    let x = points.iter().map(|p| p.0).sum::<f64>() / points.len() as f64;
    let (mut xx, mut rest) = (0.0, 0.0);
    for p in points {
        xx += (p.0 - x) * (p.0 - x);
        let off = p.1 - at_zero - slope * p.0;
        rest += off * off;
    }
    Some(factor(freedom, LEVEL) * libm::sqrt(rest / freedom / xx))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_line_is_found_where_points_lie_on_one() {
        let points: Vec<(f64, f64)> = [1.0, 2.0, 5.0].map(|x| (x, 3.0 + 0.5 * x)).into();
        let (at_zero, slope) = line(&points).unwrap();
        assert!((at_zero - 3.0).abs() < 1e-12 && (slope - 0.5).abs() < 1e-12);
        assert!(scatter(&points).unwrap() < 1e-6);
        assert_eq!(line(&[(1.0, 2.0), (1.0, 3.0)]), None);
        assert_eq!((line(&[]), scatter(&points[..2]), slope_weights(&[1.0; 3])), (None, None, None));
        let weights = slope_weights(&[1.0, 2.0, 5.0]).unwrap();
        let sum: f64 = weights.iter().zip(&points).map(|(weight, point)| weight * point.1).sum();
        assert!((sum - 0.5).abs() < 1e-12);
    }

    #[test]
    fn the_scatter_of_a_slope_is_students() {
        // Residuals 1, -2, 1 about y = 1 at x = -1, 0, 1: s^2 = 6, the error of the slope sqrt(6 / 2), t(1) = 12.706.
        let points = [(-1.0, 2.0), (0.0, -1.0), (1.0, 2.0)];
        let (_, slope) = line(&points).unwrap();
        assert!(slope.abs() < 1e-12);
        assert!((scatter(&points).unwrap() - 12.706 * libm::sqrt(3.0)).abs() < 1e-3);
    }
}
