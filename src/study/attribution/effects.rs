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

    /// Logs made of known effects: each level of each factor, and one interaction.
    fn logs(plane: [f64; 6], stop: [f64; 3], traversal: [f64; 2], both: f64) -> Vec<f64> {
        let of = |Treatment([p, s, t]): Treatment| {
            5.0 + plane[p] + stop[s] + traversal[t] + if p == 5 && s == 2 { both } else { 0.0 }
        };
        Treatment::all().into_iter().map(of).collect()
    }

    const PLANE: [f64; 6] = [0.5, 0.3, 0.1, -0.1, -0.3, -0.5];
    const STOP: [f64; 3] = [2.0, -1.0, -1.0];
    const TRAVERSAL: [f64; 2] = [0.25, -0.25];

    #[track_caller]
    fn close(a: f64, b: f64) {
        assert!((a - b).abs() < 1e-12, "{a} {b}");
    }

    #[test]
    fn without_interaction_a_part_is_the_same_in_every_order() {
        let logs = logs(PLANE, STOP, TRAVERSAL, 0.0);
        for (factor, gain) in Factor::ALL.into_iter().zip([1.0, 3.0, 0.5]) {
            close(value(&part(factor), &logs), gain);
            for order in parts_by_order(factor) {
                close(value(&order, &logs), gain);
            }
        }
    }

    #[test]
    fn an_interaction_is_shared_by_those_that_take_part_in_it() {
        let logs = logs(PLANE, STOP, TRAVERSAL, -0.8);
        close(value(&part(Factor::Plane), &logs), 1.0 + 0.4);
        close(value(&part(Factor::Stop), &logs), 3.0 + 0.4);
        close(value(&part(Factor::Traversal), &logs), 0.5);
        let orders: Vec<f64> = parts_by_order(Factor::Plane).iter().map(|weights| value(weights, &logs)).collect();
        assert_eq!(orders.iter().filter(|&&gain| (gain - 1.0).abs() < 1e-12).count(), 3);
        assert_eq!(orders.iter().filter(|&&gain| (gain - 1.8).abs() < 1e-12).count(), 3);
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
