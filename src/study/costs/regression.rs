//! Costs that are not negative, by how many times predictions are off.

/// What a ray, a step and a block cost.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Costs {
    pub ray: f64,
    pub step: f64,
    pub block: f64,
}

impl Costs {
    /// The time of a ray of so many steps and blocks.
    pub fn predict(&self, steps: f64, blocks: f64) -> f64 {
        self.ray + self.step * steps + self.block * blocks
    }
}

/// The costs, none below 0, with the least sum of r - 1 - ln r over `rows` of steps, blocks and time, where r is predicted over
/// measured time. That is half the square of ln r where predictions are good. A case that takes a thousand times as long counts no
/// more than another, and one that an interruption made ten times as long moves a prediction from alike cases as the harmonic
/// mean does. (Least squares of relative errors draw predictions far below the times: to them no prediction at all is off by 1
/// only.) The sum is convex, so there is one answer. Nothing where the rows do not tell the costs apart.
pub fn regress(rows: &[[f64; 3]]) -> Option<Costs> {
    // Of a constant, steps and blocks, each as a share of the time.
    let shares: Vec<[f64; 3]> = rows.iter().map(|[steps, blocks, ns]| [1.0 / ns, steps / ns, blocks / ns]).collect();
    // The slope of the sum is that of squares of (r - 1) / sqrt(r) with the root held: least squares again and again, each time with
    // the roots of the last.
    let mut costs = constrained(&shares, &vec![1.0; rows.len()])?;
    for _ in 0..ROUNDS {
        let ratios: Vec<f64> = shares.iter().map(|share| predicted(share, &costs)).collect();
        let next = constrained(&shares, &ratios)?;
        let settled = next.iter().zip(&costs).all(|(next, last)| (next - last).abs() <= 1e-6 * next);
        costs = next;
        if settled {
            break;
        }
    }
    let [ray, step, block] = costs;
    Some(Costs { ray, step, block })
}

/// Repetitions of the least squares, at most: they end where costs change by less than a millionth.
const ROUNDS: usize = 30;

fn predicted(share: &[f64; 3], costs: &[f64; 3]) -> f64 {
    share.iter().zip(costs).map(|(share, cost)| share * cost).sum()
}

/// The costs, none below 0, with the least sum of squares of (predicted - 1) / sqrt(ratio).
///
/// With three costs every way to leave some of them at 0 is tried, and the best one whose other costs come out positive taken:
/// that is the least under the constraint (Lawson, Hanson, "Solving least squares problems", 1974, chapter 23).
fn constrained(shares: &[[f64; 3]], ratios: &[f64]) -> Option<[f64; 3]> {
    let mut best: Option<(f64, [f64; 3])> = None;
    for used in 1u32..8 {
        let columns: Vec<usize> = (0..3).filter(|column| used >> column & 1 == 1).collect();
        let Some(solution) = solve(shares, ratios, &columns) else { continue };
        let mut costs = [0.0; 3];
        for (&column, cost) in columns.iter().zip(&solution) {
            costs[column] = *cost;
        }
        let off = |(share, ratio): (&[f64; 3], &f64)| {
            (predicted(share, &costs) - 1.0) * (predicted(share, &costs) - 1.0) / ratio
        };
        let rest: f64 = shares.iter().zip(ratios).map(off).sum();
        if solution.iter().all(|&cost| cost > 0.0) && best.is_none_or(|(least, _)| rest < least) {
            best = Some((rest, costs));
        }
    }
    best.map(|(_, costs)| costs)
}

/// Those of some columns without the constraint, by normal equations in units in which every column is as long: nothing where they
/// are singular.
fn solve(shares: &[[f64; 3]], ratios: &[f64], columns: &[usize]) -> Option<Vec<f64>> {
    let squares =
        |column: usize| shares.iter().zip(ratios).map(move |(share, ratio)| share[column] * share[column] / ratio);
    let lengths: Vec<f64> = columns.iter().map(|&column| libm::sqrt(squares(column).sum())).collect();
    if lengths.iter().any(|&length| length == 0.0 || !length.is_finite()) {
        return None;
    }
    let n = columns.len();
    let mut rows = vec![vec![0.0; n + 1]; n];
    for (share, ratio) in shares.iter().zip(ratios) {
        let mut unit = [0.0; 3];
        for ((unit, &column), length) in unit.iter_mut().zip(columns).zip(&lengths) {
            *unit = share[column] / length;
        }
        for i in 0..n {
            for j in 0..n {
                rows[i][j] += unit[i] * unit[j] / ratio;
            }
            rows[i][n] += unit[i] / ratio;
        }
    }
    for pivot in 0..n {
        let largest = (pivot..n).max_by(|&a, &b| rows[a][pivot].abs().total_cmp(&rows[b][pivot].abs()))?;
        rows.swap(pivot, largest);
        if rows[pivot][pivot].abs() < 1e-10 {
            return None;
        }
        let own = rows[pivot].clone();
        for row in rows.iter_mut().enumerate().filter(|(i, _)| *i != pivot).map(|(_, row)| row) {
            let factor = row[pivot] / own[pivot];
            row.iter_mut().zip(&own).for_each(|(x, own)| *x -= factor * own);
        }
    }
    Some((0..n).map(|i| rows[i][n] / rows[i][i] / lengths[i]).collect())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn row(costs: Costs, steps: f64, blocks: f64) -> [f64; 3] {
        [steps, blocks, costs.predict(steps, blocks)]
    }

    const PLACES: [(f64, f64); 6] = [(1.0, 2.0), (10.0, 3.0), (40.0, 5.0), (5.0, 300.0), (100.0, 1000.0), (2.0, 0.5)];

    #[test]
    fn costs_are_found_where_times_are_made_of_them() {
        let true_costs = Costs { ray: 20.0, step: 3.0, block: 1.25 };
        let rows = PLACES.map(|(steps, blocks)| row(true_costs, steps, blocks));
        let found = regress(&rows).unwrap();
        for (found, expected) in [(found.ray, 20.0), (found.step, 3.0), (found.block, 1.25)] {
            assert!((found / expected - 1.0).abs() < 1e-9, "{found} {expected}");
        }
    }

    #[test]
    fn no_cost_is_negative() {
        // The more blocks the faster: a step alone explains it best.
        let rows = PLACES.map(|(steps, blocks)| [steps, blocks, 10.0 * steps / (1.0 + 0.001 * blocks)]);
        let found = regress(&rows).unwrap();
        assert!(found.ray >= 0.0 && found.step > 0.0 && found.block == 0.0, "{found:?}");
        // The constraint costs: every neighbour that keeps it is worse.
        let off = |costs: Costs| -> f64 {
            let ratios = rows.iter().map(|[steps, blocks, ns]| costs.predict(*steps, *blocks) / ns);
            ratios.map(|ratio| ratio - 1.0 - libm::log(ratio)).sum()
        };
        for (ray, step, block) in [(0.01, 0.0, 0.0), (0.0, 0.01, 0.0), (0.0, -0.01, 0.0), (0.0, 0.0, 0.001)] {
            let near = Costs { ray: found.ray + ray, step: found.step + step, block: found.block + block };
            assert!(off(near) > off(found), "{near:?}");
        }
    }

    #[test]
    fn slow_cases_do_not_rule() {
        // One case of a thousand times the time and a tenth too slow moves the costs as little as any other.
        let true_costs = Costs { ray: 20.0, step: 3.0, block: 1.25 };
        let mut rows = PLACES.map(|(steps, blocks)| row(true_costs, steps, blocks)).to_vec();
        rows.push([20_000.0, 100_000.0, true_costs.predict(20_000.0, 100_000.0) * 1.1]);
        let found = regress(&rows).unwrap();
        assert!((found.predict(10.0, 3.0) / true_costs.predict(10.0, 3.0) - 1.0).abs() < 0.03, "{found:?}");
    }

    #[test]
    fn an_interrupted_case_does_not_rule_either() {
        let true_costs = Costs { ray: 20.0, step: 3.0, block: 1.25 };
        let mut rows =
            PLACES.iter().cycle().take(24).map(|&(steps, blocks)| row(true_costs, steps, blocks)).collect::<Vec<_>>();
        rows[7][2] *= 10.0;
        let found = regress(&rows).unwrap();
        // The harmonic mean of 1, 1, 1 and 10 is 1.29: so far its own place may be moved, if it were alone.
        for (steps, blocks) in PLACES {
            let ratio = found.predict(steps, blocks) / true_costs.predict(steps, blocks);
            assert!((0.9..1.3).contains(&ratio), "{ratio}: {found:?}");
        }
    }

    #[test]
    fn what_cannot_be_told_apart_is_left_out() {
        assert_eq!(regress(&[]), None);
        // Steps and blocks in one proportion: one of the two stands for both.
        let found = regress(&[[1.0, 2.0, 10.0], [2.0, 4.0, 15.0], [10.0, 20.0, 55.0]]).unwrap();
        assert!((found.predict(4.0, 8.0) - 25.0).abs() < 1e-9, "{found:?}");
        assert!(found.step == 0.0 || found.block == 0.0);
    }
}
