//! Selects the faster of two strategies for rays that do not form a packet. It occasionally tries both on the current
//! rays.

use std::sync::atomic::{AtomicBool, Ordering::Relaxed};
use std::sync::{Mutex, MutexGuard};
use std::time::{Duration, Instant};

/// The strategy for rays that do not form a packet.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Way {
    /// Several rays are interleaved.
    Interleaved,
    /// One ray after the other.
    InOrder,
}

/// Groups of rays in each way that show which one is faster: what one group takes says little.
const ENOUGH: usize = 128;
/// Groups of a call that can be halved: fewer would end before the rays under way at once are many.
const LEAST: usize = 16;
/// Trials' worth of groups from one trial to the next while the same way wins: they double up to here.
const RAREST: usize = 64;
/// How many trials in a row the winner of many has to lose before the other way is chosen.
const LEAD: i32 = 2;

/// The recent speed of both strategies on one kind of rays. Both return the same hits.
///
/// Processors differ in how much memory latency they hide themselves: interleaving is 1.1 to 1.5 times as fast as one
/// ray after the other on one processor, 0.8 to 1.2 times on another (`papers/TUNING.md`). Rays differ as well.
#[derive(Debug, Default)]
pub(super) struct Trial {
    in_order: AtomicBool,
    state: Mutex<State>,
}

#[derive(Debug, Default)]
struct State {
    /// Groups until the next trial, and as many trials' worth after the last one.
    wait: usize,
    pause: usize,
    /// By how many trials [`Way::InOrder`] is ahead.
    lead: i32,
    /// The trial so far: time and groups of each way.
    spent: [(Duration, usize); 2],
    /// Which way goes first: they take turns, since the second finds more in the caches.
    in_order_first: bool,
}

/// A trial under way. One thread at a time has it.
pub(super) struct Race<'a> {
    state: MutexGuard<'a, State>,
    in_order: &'a AtomicBool,
}

impl Trial {
    /// The faster way so far.
    pub fn choice(&self) -> Way {
        if self.in_order.load(Relaxed) { Way::InOrder } else { Way::Interleaved }
    }

    /// The trial that is due, if one is, of a call with so many groups. Half of them are to be answered in each way.
    pub fn due(&self, groups: usize) -> Option<Race<'_>> {
        if groups < LEAST {
            return None;
        }
        // Where another thread has it, this one need not wait.
        let mut state = self.state.try_lock().ok()?;
        state.wait = state.wait.saturating_sub(groups);
        (state.wait == 0).then_some(Race { state, in_order: &self.in_order })
    }

    /// As after trials that `way` has won, and with none soon.
    #[cfg(test)]
    pub fn won_by(way: Way) -> Self {
        let state = State { wait: usize::MAX, ..State::default() };
        Self { in_order: AtomicBool::new(way == Way::InOrder), state: Mutex::new(state) }
    }
}

impl Race<'_> {
    /// Answers both halves of the groups of a call, `groups` many each, and takes note of what that takes.
    pub fn run(mut self, groups: [usize; 2], mut half: impl FnMut(Way, usize)) {
        let ways = [Way::Interleaved, Way::InOrder];
        let first = usize::from(self.state.in_order_first);
        self.state.in_order_first ^= true;
        for (place, way) in [first, 1 - first].into_iter().enumerate() {
            let start = Instant::now();
            half(ways[way], place);
            let spent = &mut self.state.spent[way];
            *spent = (spent.0 + start.elapsed(), spent.1 + groups[place]);
        }
        if self.state.spent.iter().all(|&(_, groups)| groups >= ENOUGH) {
            self.note();
        }
    }

    /// Ends the trial.
    fn note(&mut self) {
        let [interleaved, in_order] =
            std::mem::take(&mut self.state.spent).map(|(time, groups)| time.as_secs_f64() / groups as f64);
        let state = &mut *self.state;
        let was_in_order = self.in_order.load(Relaxed);
        let is_faster = if was_in_order { in_order <= interleaved } else { in_order < interleaved };
        state.lead = (state.lead + if is_faster { 1 } else { -1 }).clamp(1 - LEAD, LEAD);
        state.pause = if is_faster == was_in_order { (2 * state.pause).clamp(1, RAREST) } else { 1 };
        state.wait = 2 * ENOUGH * state.pause;
        self.in_order.store(state.lead > 0, Relaxed);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Plays trials in which the ways of `winners` are faster, in calls of `groups`; what is chosen between them.
    fn chosen(trial: &Trial, groups: usize, winners: &[Way]) -> Vec<Way> {
        let (mut winners, mut chosen) = (winners.iter(), vec![]);
        while let Some(&winner) = winners.as_slice().first() {
            match trial.due(groups) {
                None => chosen.push(trial.choice()),
                Some(mut race) => {
                    for way in [Way::Interleaved, Way::InOrder] {
                        let time = Duration::from_micros(if way == winner { 1 } else { 2 });
                        let spent = &mut race.state.spent[way as usize];
                        *spent = (spent.0 + time, spent.1 + groups / 2);
                    }
                    if race.state.spent[0].1 >= ENOUGH {
                        race.note();
                        winners.next();
                    }
                }
            }
        }
        chosen
    }

    fn other(way: Way) -> Way {
        if way == Way::InOrder { Way::Interleaved } else { Way::InOrder }
    }

    #[test]
    fn trials_that_the_same_way_wins_become_rare_and_one_that_is_disturbed_changes_nothing() {
        // The slices that a renderer asks, and those that are timed.
        for groups in [256, 64] {
            for way in [Way::Interleaved, Way::InOrder] {
                let steady = chosen(&Trial::default(), groups, &[way; 20]);
                assert!(steady.iter().all(|&chosen| chosen == way));
                let calls = 12 * RAREST * 2 * ENOUGH / groups;
                assert!(steady.len() > calls, "{}", steady.len());
                let disturbed = [way, way, other(way), way, way, way, other(way), way, way];
                let disturbed = chosen(&Trial::default(), groups, &disturbed);
                assert!(disturbed.len() > 10 && disturbed.iter().all(|&chosen| chosen == way), "{disturbed:?}");
            }
        }
    }

    #[test]
    fn the_choice_follows_when_the_other_way_becomes_faster() {
        for way in [Way::Interleaved, Way::InOrder] {
            let chosen = chosen(&Trial::default(), 256, &[[way; 10], [other(way); 10]].concat());
            let before = chosen.iter().take_while(|&&chosen| chosen == way).count();
            assert!(chosen[before..].iter().all(|&chosen| chosen != way) && chosen.len() > before + 50, "{chosen:?}");
            assert!((100..=6 * RAREST).contains(&before), "{before}");
        }
    }

    #[test]
    fn both_ways_run_each_once_and_take_turns_to_be_first() {
        let (trial, mut order) = (Trial::default(), vec![]);
        for _ in 0..2 {
            trial.due(64).unwrap().run([32; 2], |way, half| order.push((way, half)));
        }
        let [first, second] = [Way::Interleaved, Way::InOrder];
        assert_eq!(order, [(first, 0), (second, 1), (second, 0), (first, 1)]);
    }

    #[test]
    fn short_calls_and_other_threads_do_not_try() {
        let trial = Trial::default();
        assert!(trial.due(LEAST - 1).is_none());
        let race = trial.due(LEAST);
        assert!(race.is_some() && trial.due(256).is_none());
    }
}
