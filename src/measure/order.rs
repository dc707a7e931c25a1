//! Random orders of samples.

use rand_core::{RngCore, SeedableRng};
use rand_pcg::Pcg64Mcg;

pub struct RandomOrder(Pcg64Mcg);

impl RandomOrder {
    pub fn new(seed: u64) -> Self {
        Self(Pcg64Mcg::seed_from_u64(seed))
    }

    /// A uniform random integer below `n`. The probability of each integer has a relative error below `n` / 2^64.
    ///
    /// # Panics
    /// If `n` is 0.
    pub fn below(&mut self, n: usize) -> usize {
        assert!(n > 0, "`n` must be at least 1");
        ((u128::from(self.0.next_u64()) * n as u128) >> 64) as usize
    }

    /// Returns the integers `0..n` in random order (Fisher, Yates 1938; Durstenfeld 1964).
    pub fn shuffled(&mut self, n: usize) -> Vec<usize> {
        let mut order: Vec<usize> = (0..n).collect();
        for last in (1..n).rev() {
            order.swap(last, self.below(last + 1));
        }
        order
    }

    /// `groups` contains the group of each member. In the result, the members of a group are consecutive.
    pub fn shuffled_by_group(&mut self, groups: &[usize]) -> Vec<usize> {
        let ranks = self.shuffled(groups.iter().max().map_or(0, |last| last + 1));
        let mut order = self.shuffled(groups.len());
        order.sort_by_key(|&member| ranks[groups[member]]);
        order
    }
}

#[cfg(test)]
impl RandomOrder {
    /// A uniform random number strictly between 0 and 1.
    pub fn uniform(&mut self) -> f64 {
        (self.below(1 << 30) as f64 + 0.5) / f64::from(1 << 30)
    }

    /// A random number with standard normal distribution (Box, Muller 1958).
    pub fn normal(&mut self) -> f64 {
        let (radius, turn) = (self.uniform(), self.uniform());
        libm::sqrt(-2.0 * libm::log(radius)) * libm::cos(std::f64::consts::TAU * turn)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_order_repeats_with_its_seed_and_every_order_of_three_comes_about_as_often() {
        assert_eq!(RandomOrder::new(1).shuffled(20), RandomOrder::new(1).shuffled(20));
        assert_ne!(RandomOrder::new(1).shuffled(20), RandomOrder::new(2).shuffled(20));
        let mut orders = RandomOrder::new(7);
        let mut counts = std::collections::BTreeMap::new();
        for _ in 0..6000 {
            *counts.entry(orders.shuffled(3)).or_insert(0) += 1;
        }
        let is_order = |order: &Vec<usize>| (0..3).all(|i| order.contains(&i));
        assert!(counts.len() == 6 && counts.keys().all(is_order), "{counts:?}");
        // The count of each order has mean 1000. Five standard deviations of the count are 144.
        assert!(counts.values().all(|&n| (856..=1144).contains(&n)), "{counts:?}");
    }

    #[test]
    fn members_of_a_group_follow_each_other() {
        let mut orders = RandomOrder::new(3);
        let groups = [0, 1, 2, 0, 1, 2, 0, 1];
        let mut seen = std::collections::BTreeSet::new();
        for _ in 0..20_000 {
            let mut order = orders.shuffled_by_group(&groups);
            let mut blocks: Vec<usize> = order.iter().map(|&member| groups[member]).collect();
            seen.insert(order.clone());
            blocks.dedup();
            assert_eq!(blocks.len(), 3, "{order:?}");
            order.sort_unstable();
            assert_eq!(order, (0..groups.len()).collect::<Vec<_>>());
        }
        assert_eq!(seen.len(), 6 * 6 * 6 * 2, "all orders of groups, and of the members of each");
        assert!(orders.shuffled_by_group(&[]).is_empty());
    }
}
