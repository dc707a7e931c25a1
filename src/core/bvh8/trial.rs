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

/// Groups of rays per strategy that decide which one is faster: a single group varies too much.
const ENOUGH: usize = 128;
/// Minimum number of groups of a call that is halved: fewer would end before many rays are active.
const LEAST: usize = 16;
/// Maximum distance of two trials, in numbers of groups per trial, if the same strategy keeps winning: the distance
/// doubles up to this.
const RAREST: usize = 64;
/// The number of consecutive trials that a long-time winner must lose before the other strategy is chosen.
const LEAD: i32 = 2;

/// The recent speed of both strategies on one workload. Both return the same hits.
///
/// Processors differ in how much memory latency they hide themselves: interleaving has 1.1 to 1.5 of the speed of one
/// ray after the other on one processor, 0.8 to 1.2 on another (`papers/TUNING.md`). Rays differ as well.
#[derive(Debug, Default)]
pub(super) struct Trial {
    in_order: AtomicBool,
    state: Mutex<State>,
}

#[derive(Debug, Default)]
struct State {
    /// Groups until the next trial, and the distance of the trials after that, in numbers of groups per trial.
    wait: usize,
    pause: usize,
    /// The lead of [`Way::InOrder`], in trials.
    lead: i32,
    /// The current trial: time and groups of each strategy.
    spent: [(Duration, usize); 2],
    /// Which strategy goes first: they alternate, because the second finds more data in the caches.
    in_order_first: bool,
}

/// A running trial. Only one thread at a time has it.
pub(super) struct Race<'a> {
    state: MutexGuard<'a, State>,
    in_order: &'a AtomicBool,
}

impl Trial {
    /// The faster strategy so far.
    pub fn choice(&self) -> Way {
        if self.in_order.load(Relaxed) { Way::InOrder } else { Way::Interleaved }
    }

    /// The trial that is due, if any, for a call with this number of groups. Each strategy traces half of them.
    pub fn due(&self, groups: usize) -> Option<Race<'_>> {
        if groups < LEAST {
            return None;
        }
        // If another thread runs the trial, this one need not wait.
        let mut state = self.state.try_lock().ok()?;
        state.wait = state.wait.saturating_sub(groups);
        (state.wait == 0).then_some(Race { state, in_order: &self.in_order })
    }

    /// The state after trials that `way` has won, with no trial soon.
    #[cfg(test)]
    pub fn won_by(way: Way) -> Self {
        let state = State { wait: usize::MAX, ..State::default() };
        Self { in_order: AtomicBool::new(way == Way::InOrder), state: Mutex::new(state) }
    }
}

impl Race<'_> {
    /// Traces both halves of the groups of a call, `groups` in each, and records their times.
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

    /// Runs trials in which the strategies in `winners` are faster, in calls of `groups`; returns the choices between
    /// them.
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
        // The slices of a renderer, and the timed ones.
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
