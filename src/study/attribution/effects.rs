//! What the factors do, as sums of logarithms over the cells.
//!
//! Every figure is a **contrast**: a weight for each cell, times the logarithm of what was measured there. So figures of the
//! same cells add up exactly, and their intervals come from the same replicates (Box, Hunter, Hunter, "Statistics for
//! experimenters", 2nd edition 2005, chapter 5; Montgomery, "Design and analysis of experiments", 8th edition 2013, chapter 5).

use super::design::{CELLS, Factor, Treatment};

/// One weight for each cell.
pub type Weights = [f64; CELLS];

/// The sum of `weights` times `logs`.
pub fn value(weights: &Weights, logs: &[f64]) -> f64 {
    weights.iter().zip(logs).map(|(weight, log)| weight * log).sum()
}

/// The main effect of a level: the mean of its cells less the mean of all.
pub fn main_effect(factor: Factor, level: usize) -> Weights {
    let share = factor.levels().len() as f64 / CELLS as f64;
    weights(|cell| if cell.level(factor) == level { share } else { 0.0 } - 1.0 / CELLS as f64)
}

/// How much less `to` takes than `from`.
pub fn gain(from: Treatment, to: Treatment) -> Weights {
    weights(|cell| f64::from(u8::from(cell == from)) - f64::from(u8::from(cell == to)))
}

/// What the whole step from the report's tree to the SAH tree owes to `factor`: its gain, averaged over all orders in which the
/// three factors can be switched (Shapley, "A value for n-person games", 1953). The three parts add up to the whole.
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

/// The terms of the decomposition: each is the set of its factors, as bits in the order of [`Factor::ALL`].
pub const TERMS: [usize; 7] = [0b001, 0b010, 0b100, 0b011, 0b101, 0b110, 0b111];

/// As tables print it: `plane x traversal`.
pub fn term_name(term: usize) -> String {
    let factors = Factor::ALL.into_iter().filter(|&factor| term >> factor as usize & 1 == 1);
    factors.map(Factor::name).collect::<Vec<_>>().join(" x ")
}

/// The shares of the variance of `logs` over the cells that the [`TERMS`] have; they add up to 1. Nothing where all cells are
/// the same.
pub fn shares(logs: &[f64]) -> Option<[f64; 7]> {
    let cells = Treatment::all();
    // The mean over all cells that agree with a cell in the factors of a set.
    let mean = |cell: Treatment, set: usize| {
        let agrees = |other: &Treatment| (0..3).all(|f| set >> f & 1 == 0 || other.0[f] == cell.0[f]);
        let agreeing = cells.iter().zip(logs).filter(|(other, _)| agrees(other));
        let (sum, n) = agreeing.fold((0.0, 0.0), |(sum, n), (_, log)| (sum + log, n + 1.0));
        sum / n
    };
    let means: Vec<[f64; 8]> = cells.iter().map(|&cell| std::array::from_fn(|set| mean(cell, set))).collect();
    // What a term adds to those within it: means of its subsets with alternating signs.
    let effect = |means: &[f64; 8], term: usize| -> f64 {
        let subsets = (0..8_usize).filter(|set| set & term == *set);
        subsets.map(|set| if (term ^ set).count_ones().is_multiple_of(2) { means[set] } else { -means[set] }).sum()
    };
    let squares = TERMS.map(|term| means.iter().map(|means| effect(means, term)).map(|x| x * x).sum::<f64>());
    let total: f64 = squares.iter().sum();
    (total > 0.0).then(|| squares.map(|square| square / total))
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
    fn main_effects_are_those_put_in() {
        let logs = logs(PLANE, STOP, TRAVERSAL, 0.0);
        for (factor, effects) in Factor::ALL.into_iter().zip([&PLANE[..], &STOP, &TRAVERSAL]) {
            for (level, &effect) in effects.iter().enumerate() {
                close(value(&main_effect(factor, level), &logs), effect);
            }
        }
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
            close(main_effect(factor, 1).iter().sum(), 0.0);
        }
    }

    #[test]
    fn shares_are_those_of_the_squares_put_in() {
        let shares = shares(&logs(PLANE, STOP, TRAVERSAL, 0.0)).unwrap();
        let squares = [0.7 / 6.0, 2.0, 0.0625];
        let total: f64 = squares.iter().sum();
        for (share, square) in shares.iter().zip(squares) {
            close(*share, square / total);
        }
        shares[3..].iter().for_each(|&share| close(share, 0.0));
        close(shares.iter().sum(), 1.0);
        assert_eq!(super::shares(&[1.0; CELLS]), None);
    }

    #[test]
    fn a_pure_interaction_is_found_as_such() {
        let sign = |i: usize| if i.is_multiple_of(2) { 1.0 } else { -1.0 };
        let logs: Vec<f64> = Treatment::all().iter().map(|cell| sign(cell.0[0]) * sign(cell.0[2])).collect();
        let shares = shares(&logs).unwrap();
        close(shares[4], 1.0);
        assert_eq!(term_name(TERMS[4]), "plane x traversal");
    }

    #[test]
    fn the_three_way_interaction_is_what_is_left() {
        let logs: Vec<f64> = (0..CELLS).map(|i| libm::cos(i as f64 * 2.3)).collect();
        close(shares(&logs).unwrap().iter().sum(), 1.0);
        let only_last = |cell: &Treatment| if *cell == Treatment::SAH { 1.0 } else { 0.0 };
        let spike: Vec<f64> = Treatment::all().iter().map(only_last).collect();
        // One cell apart: a share of (6-1)(3-1)(2-1) of 35 degrees of freedom is three-way.
        close(shares(&spike).unwrap()[6], 10.0 / 35.0);
    }
}
