//! What the factors do, as sums of logarithms over the cells.
//!
//! Every figure is a **contrast**: a weight for each cell, times the logarithm of what was measured there. So figures
//! of the same cells add up exactly, and their intervals come from the same replicates (Box, Hunter, Hunter,
//! "Statistics for experimenters", 2nd edition 2005, chapter 5; Montgomery, "Design and analysis of experiments", 8th
//! edition 2013, chapter 5).

use super::design::{CELLS, Factor, Treatment};

/// One weight for each cell.
pub type Weights = [f64; CELLS];

/// The sum of `weights` times `logs`.
pub fn value(weights: &Weights, logs: &[f64]) -> f64 {
    weights.iter().zip(logs).map(|(weight, log)| weight * log).sum()
}

/// How much less `to` takes than `from`.
pub fn gain(from: Treatment, to: Treatment) -> Weights {
    weights(|cell| f64::from(u8::from(cell == from)) - f64::from(u8::from(cell == to)))
}

/// What the whole step from the report's tree to the SAH tree owes to `factor`: its gain, averaged over all orders in
/// which the three factors can be switched (Shapley, "A value for n-person games", 1953). The three parts add up to the
/// whole.
pub fn part(factor: Factor) -> Weights {
    let mut sum = [0.0; CELLS];
    for gain in parts_by_order(factor) {
        sum.iter_mut().zip(gain).for_each(|(sum, weight)| *sum += weight / ORDERS.len() as f64);
    }
    sum
}

/// The gain of `factor` in every order of switching.
pub fn parts_by_order(factor: Factor) -> Vec<Weights> {
    let in_order = |order: &[usize; 3]| {
        let before: usize = order.iter().take_while(|&&f| f != factor as usize).map(|f| 1 << f).sum();
        gain(Treatment::corner(before), Treatment::corner(before | 1 << factor as usize))
    };
    ORDERS.iter().map(in_order).collect()
}

const ORDERS: [[usize; 3]; 6] = [[0, 1, 2], [0, 2, 1], [1, 0, 2], [1, 2, 0], [2, 0, 1], [2, 1, 0]];

fn weights(of: impl Fn(Treatment) -> f64) -> Weights {
    let cells = Treatment::all();
    std::array::from_fn(|i| of(cells[i]))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[track_caller]
    fn close(a: f64, b: f64) {
        assert!((a - b).abs() < 1e-12, "{a} {b}");
    }

    #[test]
    fn parts_add_up_to_the_whole_whatever_the_cells_hold() {
        let logs: Vec<f64> = (0..CELLS).map(|i| libm::sin(i as f64 * 1.7) * 3.0).collect();
        let parts: f64 = Factor::ALL.iter().map(|&factor| value(&part(factor), &logs)).sum();
        close(parts, value(&gain(Treatment::REPORT, Treatment::SAH), &logs));
        // Contrasts take no notice of what all cells share.
        for factor in Factor::ALL {
            close(part(factor).iter().sum(), 0.0);
        }
    }
}
