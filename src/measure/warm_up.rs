//! When a case has warmed up.

/// The last passes that must be steady.
const STEADY: usize = 2;

/// What they may take longer than the fastest pass so far.
const SLACK: f64 = 1.05;

/// A case that is not steady by then is measured as it is, and said to be unsteady.
pub const MOST_PASSES: usize = 12;

/// Decides, pass by pass, whether a case is warm: caches and predictors have learnt it, clock rates have risen.
#[derive(Clone, Debug, Default)]
pub struct WarmUp {
    passes: usize,
    fastest: f64,
    /// Passes in a row, up to the last, that were about as fast as the fastest.
    steady: usize,
}

impl WarmUp {
    /// Takes the nanoseconds of the next pass.
    pub fn pass(&mut self, ns: u64) {
        let ns = ns.max(1) as f64;
        // A pass that is much faster than all before shows that those were not warm: count anew from here.
        let improved = self.passes == 0 || ns * SLACK < self.fastest;
        self.fastest = if self.passes == 0 { ns } else { ns.min(self.fastest) };
        self.passes += 1;
        self.steady = match () {
            () if improved => 1,
            () if ns <= self.fastest * SLACK => self.steady + 1,
            () => 0,
        };
    }

    /// Passes taken.
    pub fn passes(&self) -> usize {
        self.passes
    }

    /// Whether the last passes took as long as each other, and none before was faster.
    pub fn is_steady(&self) -> bool {
        self.steady >= STEADY
    }

    /// Whether to go on to samples: at least `least` passes are taken, and they are steady or as many as can be spent.
    pub fn is_over(&self, least: usize) -> bool {
        self.passes >= least && (self.is_steady() || self.passes >= MOST_PASSES)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Passes until the warm-up is over, and whether they were steady then.
    fn after(times: impl IntoIterator<Item = u64>, least: usize) -> (usize, bool) {
        let mut warm_up = WarmUp::default();
        for ns in times {
            warm_up.pass(ns);
            if warm_up.is_over(least) {
                break;
            }
        }
        (warm_up.passes(), warm_up.is_steady())
    }

    #[test]
    fn a_case_is_warm_when_it_gets_no_faster() {
        assert_eq!(after([100; 20], 1), (2, true));
        assert_eq!(after([200, 150, 120, 100, 101, 100], 1), (5, true));
        // Slowly faster, below what can be told from noise.
        assert_eq!(after([104, 103, 102], 1), (2, true));
    }

    #[test]
    fn an_interruption_is_not_steadiness() {
        assert_eq!(after([100, 300, 310, 100, 102, 100], 1), (5, true));
        assert_eq!(after([300, 100, 150, 101, 100], 1), (5, true));
    }

    #[test]
    fn the_least_and_the_most_passes_are_kept() {
        assert_eq!(after([100; 20], 6), (6, true));
        let restless = (0..40).map(|i| if i % 2 == 0 { 100 } else { 200 });
        assert_eq!(after(restless, 1), (MOST_PASSES, false));
        assert_eq!(after([100; 40], 20), (20, true));
    }
}
