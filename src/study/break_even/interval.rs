//! The interval of a break-even point.
//!
//! After n rays the dear structure has taken D(n) and the cheap one C(n), builds included. ln (D(n) / C(n)) is a figure
//! of each epoch, and [the one interval](mod@crate::measure::interval) says for which n another run may find it at 0:
//! that is where it may find the two even (Fieller, "Some problems in interval estimation", 1954). So an end may be `at
//! once` or `never`.

use super::Payoff;
use crate::measure::{Estimate, Rerun, Variance};
use crate::study::epoch::{Line, Twins, middles};

/// From one ray to a hundred million million, four steps a decade.
const STEPS: i32 = 4;
const DECADES: i32 = 14;

/// The ends about the estimate `rays`; nothing with a single epoch.
pub(super) fn interval(cheap: &Line, dear: &Line, rays: Payoff, twins: &Twins) -> Option<[Payoff; 2]> {
    let race = Race { cheap: Costs::of(cheap), dear: Costs::of(dear), twins };
    race.after(0.0)?.interval?;
    let is = |rays: f64, ahead: fn(Estimate) -> bool| race.after(rays).is_some_and(ahead);
    let cheap_ahead = |rays: f64| is(rays, |lead| lead.is_above(0.0));
    let dear_ahead = |rays: f64| is(rays, |lead| lead.is_below(0.0));
    let numbers: Vec<f64> = std::iter::once(0.0)
        .chain((0..=DECADES * STEPS).map(|i| libm::pow(10.0, f64::from(i) / f64::from(STEPS))))
        .chain([f64::INFINITY])
        .collect();

    // Up to here the cheap one is ahead, from there on the dear one.
    let low = match numbers.iter().position(|&rays| !cheap_ahead(rays)) {
        None => Payoff::Never,
        Some(0) => Payoff::AtOnce,
        Some(i) => border(numbers[i - 1], numbers[i], cheap_ahead),
    };
    let high = match numbers.iter().rposition(|&rays| !dear_ahead(rays)) {
        None => Payoff::AtOnce,
        Some(i) if i + 1 == numbers.len() => Payoff::Never,
        Some(i) => border(numbers[i], numbers[i + 1], |rays| !dear_ahead(rays)),
    };
    let low = if low > rays { rays } else { low };
    let high = if high < rays { rays } else { high };
    Some([low, high])
}

/// Where `is` ends to be true, which it is at `from` and not at `to`.
fn border(from: f64, to: f64, is: impl Fn(f64) -> bool) -> Payoff {
    // Less than a ray is one, and more than can be traced is never.
    let (mut from, mut to) = (from.max(0.1), to.min(libm::pow(10.0, f64::from(DECADES + 1))));
    if !is(from) {
        return Payoff::AtOnce;
    }
    if is(to) {
        return Payoff::Never;
    }
    while to / from > 1.0 + 1e-6 {
        let middle = libm::sqrt(from * to);
        if is(middle) { from = middle } else { to = middle }
    }
    Payoff::Rays(from)
}

struct Costs(Vec<(f64, f64)>);

impl Costs {
    fn of(line: &Line) -> Self {
        let [builds, rays] = [&line.build, &line.trace].map(|logs| middles(logs).into_iter().map(libm::exp));
        Self(builds.zip(rays).collect())
    }

    /// ln of what so many rays take with the build, or of what one takes without it where they are infinitely many.
    fn log(&self, epoch: usize, rays: f64) -> f64 {
        let (build, ray) = self.0[epoch];
        libm::log(if rays.is_finite() { build + rays * ray } else { ray })
    }

    fn share(&self, rays: f64) -> f64 {
        let n = self.0.len() as f64;
        let share = |&(build, ray): &(f64, f64)| if rays.is_finite() { rays * ray / (build + rays * ray) } else { 1.0 };
        self.0.iter().map(share).sum::<f64>() / n
    }
}

struct Race<'a> {
    cheap: Costs,
    dear: Costs,
    twins: &'a Twins,
}

impl Race<'_> {
    /// By how much the cheap structure is ahead after so many rays, a logarithm. Nothing if the two were not measured
    /// together.
    fn after(&self, rays: f64) -> Option<Estimate> {
        let epochs = self.cheap.0.len().min(self.dear.0.len());
        let values: Vec<f64> = (0..epochs).map(|e| self.dear.log(e, rays) - self.cheap.log(e, rays)).collect();
        let shares = [&self.dear, &self.cheap].map(|costs| costs.share(rays));
        let noise = Variance::sum(&[
            self.twins.trace.weighted(&shares),
            self.twins.build.weighted(&shares.map(|share| 1.0 - share)),
        ]);
        Some(Rerun::of(&values, noise)?.plain())
    }
}
