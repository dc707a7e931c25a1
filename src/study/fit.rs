//! Lines through points, and what is read off many draws.

use crate::measure::{Interval, LEVEL, factor};

/// Draws of a bootstrap: the ends of a 95 % interval are then the 25th value from either end.
pub const DRAWS: usize = 1000;

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

/// Half of the 95 % interval of that slope if points scatter about the line independently and alike (Student's t with n - 2 degrees of
/// freedom). Nothing of fewer than three points.
pub fn slope_error(points: &[(f64, f64)]) -> Option<f64> {
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

/// An estimate with the 2.5 % and 97.5 % quantiles of `draws`, widened to hold the estimate. Nothing without draws.
pub fn percentiles(estimate: f64, mut draws: Vec<f64>) -> Option<Interval> {
    draws.sort_unstable_by(f64::total_cmp);
    let tail = draws.len() / 40;
    let (low, high) = (*draws.get(tail)?, draws[draws.len() - 1 - tail]);
    Some(Interval { estimate, low: low.min(estimate), high: high.max(estimate) })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_line_is_found_where_points_lie_on_one() {
        let points: Vec<(f64, f64)> = [1.0, 2.0, 5.0].map(|x| (x, 3.0 + 0.5 * x)).into();
        let (at_zero, slope) = line(&points).unwrap();
        assert!((at_zero - 3.0).abs() < 1e-12 && (slope - 0.5).abs() < 1e-12);
        assert!(slope_error(&points).unwrap() < 1e-6);
        assert_eq!(line(&[(1.0, 2.0), (1.0, 3.0)]), None);
        assert_eq!((line(&[]), slope_error(&points[..2])), (None, None));
    }

    #[test]
    fn the_error_of_a_slope_is_students() {
        // Residuals 1, -2, 1 about y = 1 at x = -1, 0, 1: s^2 = 6, the error of the slope sqrt(6 / 2), t(1) = 12.706.
        let points = [(-1.0, 2.0), (0.0, -1.0), (1.0, 2.0)];
        let (_, slope) = line(&points).unwrap();
        assert!(slope.abs() < 1e-12);
        assert!((slope_error(&points).unwrap() - 12.706 * libm::sqrt(3.0)).abs() < 1e-3);
    }

    #[test]
    fn percentiles_leave_out_a_fortieth_on_either_side() {
        let draws: Vec<f64> = (0..1000).rev().map(f64::from).collect();
        assert_eq!(percentiles(500.0, draws.clone()), Some(Interval { estimate: 500.0, low: 25.0, high: 974.0 }));
        assert_eq!(percentiles(-1.0, draws).unwrap().low, -1.0);
        assert_eq!(percentiles(1.0, vec![]), None);
    }
}
