//! Which of two ways to answer rays is faster on this machine, tried now and then on the rays that are asked.

use std::sync::atomic::{AtomicI32, AtomicU32, Ordering::Relaxed};
use std::time::{Duration, Instant};

/// Times from one trial to the next while the same way wins: they double up to here, so that trials cost less than a hundredth.
const RAREST: u32 = 64;
/// How many trials in a row the winner of many has to lose before the other way is chosen.
const LEAD: i32 = 2;

/// How two ways, which give the same answers, have done on the same kind of work lately.
///
/// Processors differ in how much of what a ray waits for they hide themselves: several rays under way at once are 1.1 to 1.5 times as fast as
/// one after the other on one, 0.8 to 1.2 times on another (`papers/TUNING.md`); and so do rays.
#[derive(Debug, Default)]
pub(super) struct Trial {
    times: AtomicU32,
    /// At which time the next trial is due, and how many times after the last one that is.
    due: AtomicU32,
    pause: AtomicU32,
    /// By how many trials the second way is ahead.
    lead: AtomicI32,
}

/// What to do next.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Next {
    /// All in one way, 0 or 1.
    All(usize),
    /// One half in this way, then the other half in the other way, by [`Trial::run`].
    Both { first: usize },
}

impl Trial {
    #[inline(always)]
    pub fn next(&self) -> Next {
        // Threads that ask at once may try more often or less, which changes no answer.
        let time = self.times.fetch_add(1, Relaxed);
        let choice = self.choice();
        let early = self.due.load(Relaxed).wrapping_sub(time);
        if early == 0 || early > RAREST { Next::Both { first: 1 - choice } } else { Next::All(choice) }
    }

    fn choice(&self) -> usize {
        usize::from(self.lead.load(Relaxed) > 0)
    }

    /// Runs both ways, each of which does half of the work, and takes note of the faster one.
    #[inline(always)]
    pub fn run(&self, first: usize, mut way: impl FnMut(usize)) {
        let mut time = |number: usize| {
            let start = Instant::now();
            way(number);
            start.elapsed()
        };
        let first_time = time(first);
        let second_time = time(1 - first);
        self.note(first, [first_time, second_time]);
    }

    fn note(&self, first: usize, [first_time, second_time]: [Duration; 2]) {
        let winner = if second_time < first_time { 1 - first } else { first };
        let as_before = winner == self.choice();
        let lead = self.lead.load(Relaxed) + if winner == 1 { 1 } else { -1 };
        self.lead.store(lead.clamp(1 - LEAD, LEAD), Relaxed);
        let pause = if as_before { (2 * self.pause.load(Relaxed)).clamp(1, RAREST) } else { 1 };
        self.pause.store(pause, Relaxed);
        self.due.store(self.times.load(Relaxed).wrapping_add(pause), Relaxed);
    }

    /// As after trials that `way` has won, and with none soon.
    #[cfg(test)]
    pub fn won_by(way: usize) -> Self {
        let lead = if way == 1 { LEAD } else { 1 - LEAD };
        Self { due: AtomicU32::new(RAREST), lead: AtomicI32::new(lead), ..Self::default() }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Plays trials in which the ways of `winners` are faster; what is chosen between them.
    fn chosen(trial: &Trial, winners: &[usize]) -> Vec<usize> {
        let [slow, fast] = [2, 1].map(Duration::from_micros);
        let (mut winners, mut chosen) = (winners.iter(), vec![]);
        loop {
            match trial.next() {
                Next::All(way) => chosen.push(way),
                Next::Both { first } => match winners.next() {
                    Some(&winner) => trial.note(first, if winner == first { [fast, slow] } else { [slow, fast] }),
                    None => return chosen,
                },
            }
        }
    }

    #[test]
    fn trials_that_the_same_way_wins_become_rare_and_one_that_is_disturbed_changes_nothing() {
        for way in [0, 1] {
            let steady = chosen(&Trial::default(), &[way; 20]);
            assert!(steady.iter().all(|&chosen| chosen == way));
            assert!(steady.len() > 12 * RAREST as usize, "{}", steady.len());
            let disturbed = chosen(&Trial::default(), &[way, way, 1 - way, way, way, way, 1 - way, way]);
            assert!(disturbed.len() > 10 && disturbed.iter().all(|&chosen| chosen == way), "{disturbed:?}");
        }
    }

    #[test]
    fn the_choice_follows_when_the_other_way_becomes_faster() {
        for way in [0, 1] {
            let chosen = chosen(&Trial::default(), &[[way; 10], [1 - way; 10]].concat());
            let before = chosen.iter().take_while(|&&chosen| chosen == way).count();
            assert!(chosen[before..].iter().all(|&chosen| chosen != way) && chosen.len() > before + 50, "{chosen:?}");
            assert!((100..=6 * RAREST as usize).contains(&before), "{before}");
        }
    }

    #[test]
    fn both_ways_run_each_once() {
        let (trial, mut order) = (Trial::default(), vec![]);
        for first in [0, 1] {
            trial.run(first, |way| order.push(way));
        }
        assert_eq!(order, [0, 1, 1, 0]);
    }
}
