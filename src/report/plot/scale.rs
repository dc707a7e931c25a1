//! An axis, linear or logarithmic, with ticks that do not run into each other.

use super::canvas;
use crate::report::number::count;

/// How values become places.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Scale {
    Linear,
    /// For positive values.
    Log,
}

impl Scale {
    /// A value as the scale counts it.
    fn of(self, value: f64) -> f64 {
        match self {
            Self::Linear => value,
            Self::Log => libm::log10(value),
        }
    }
}

/// A scale between two values, drawn between two places.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Axis {
    scale: Scale,
    /// The values at both ends, as the scale counts them.
    ends: [f64; 2],
    /// Places of these.
    places: [f64; 2],
}

impl Axis {
    /// From `low` at the first of `places` to `high`, which is larger, at the second.
    pub fn new(scale: Scale, [low, high]: [f64; 2], places: [f64; 2]) -> Self {
        Self { scale, ends: [scale.of(low), scale.of(high)], places }
    }

    /// Where `value` is.
    pub fn place(&self, value: f64) -> f64 {
        let share = (self.scale.of(value) - self.ends[0]) / (self.ends[1] - self.ends[0]);
        self.places[0] + share * (self.places[1] - self.places[0])
    }

    /// Where it begins and ends.
    pub fn places(&self) -> [f64; 2] {
        self.places
    }

    /// Round values on the axis, ascending. On a logarithmic one the powers of ten; where they are few, numbers between them as well.
    pub fn round_values(&self) -> Vec<f64> {
        const SLACK: f64 = 1e-9;
        let [low, high] = self.ends;
        let span = high - low;
        if self.scale == Scale::Linear {
            let unit = power(libm::floor(libm::log10(span)) as i32);
            let step = [0.1, 0.2, 0.5, 1.0, 2.0].map(|f| f * unit).into_iter().find(|s| span / s <= 8.5);
            let step = step.unwrap_or(unit);
            let steps = libm::ceil(low / step - SLACK) as i64..=libm::floor(high / step + SLACK) as i64;
            return steps.map(|i| i as f64 * step).collect();
        }
        let factors: &[f64] = match span {
            decades if decades > 2.5 => &[1.0],
            decades if decades > 1.2 => &[1.0, 2.0, 5.0],
            _ => &[1.0, 1.5, 2.0, 3.0, 4.0, 5.0, 7.0],
        };
        (libm::floor(low) as i32..=libm::ceil(high) as i32)
            .flat_map(|exponent| factors.iter().map(move |factor| factor * power(exponent)))
            .filter(|tick| (low - SLACK..=high + SLACK).contains(&libm::log10(*tick)))
            .collect()
    }

    /// Values with their texts, for a horizontal axis: as many as fit beside each other.
    pub fn ticks_across(&self) -> Vec<(f64, String)> {
        self.ticks(across)
    }

    /// The values 1, 2 and so on with these names, for a horizontal axis: the last one, and before it at even distances as
    /// many as fit.
    pub fn names_across(&self, names: &[String]) -> Vec<(f64, String)> {
        let all: Vec<(f64, String)> = (1..=names.len()).map(|n| n as f64).zip(names.iter().cloned()).collect();
        let sparse = |step: usize| all.iter().rev().step_by(step).cloned().collect::<Vec<_>>();
        (1..=all.len()).map(sparse).find(|ticks| self.fit(ticks, &across)).unwrap_or_default()
    }

    /// Values with their texts, for a vertical axis: as many as fit above each other.
    pub fn ticks_up(&self) -> Vec<(f64, String)> {
        self.ticks(|_| 24.0)
    }

    fn ticks(&self, room: impl Fn(&str) -> f64) -> Vec<(f64, String)> {
        let all: Vec<(f64, String)> = self.round_values().into_iter().map(|tick| (tick, plain(tick))).collect();
        // Every one, or every second, third or fifth: what is left out must be even.
        let fits = |ticks: &[(f64, String)]| self.fit(ticks, &room);
        let sparse = |step: usize| all.iter().step_by(step).cloned().collect::<Vec<_>>();
        if fits(&all) {
            return all;
        }
        // On a logarithmic axis powers of ten stay together, else the ones that start at zero.
        let is_power = |(tick, _): &&(f64, String)| self.scale == Scale::Log && is_power(*tick);
        let powers: Vec<(f64, String)> = all.iter().filter(is_power).cloned().collect();
        if powers.len() > 1 && fits(&powers) {
            return powers;
        }
        if powers.len() > 4 {
            let of_powers = |step: usize| powers.iter().step_by(step).cloned().collect::<Vec<_>>();
            return [2, 3, 4, 6].into_iter().map(of_powers).find(|ticks| fits(ticks)).unwrap_or_default();
        }
        [2, 3, 4, 6].into_iter().map(sparse).find(|ticks| fits(ticks)).unwrap_or_default()
    }

    /// Whether these texts do not touch, each of which takes so much `room`.
    fn fit(&self, ticks: &[(f64, String)], room: &impl Fn(&str) -> f64) -> bool {
        ticks.windows(2).all(|pair| {
            let gap = (self.place(pair[1].0) - self.place(pair[0].0)).abs();
            gap >= 0.5 * (room(&pair[0].1) + room(&pair[1].1))
        })
    }
}

/// The room that a text takes beside others.
fn across(text: &str) -> f64 {
    canvas::width_of(text, canvas::SMALL) + 10.0
}

/// A power of ten, as exact as it can be.
pub fn power(exponent: i32) -> f64 {
    format!("1e{exponent}").parse().expect("a number")
}

fn is_power(value: f64) -> bool {
    let exponent = libm::log10(value);
    (exponent - libm::round(exponent)).abs() < 1e-9
}

/// A round number as an axis says it: `0.001`, `20`, `5,000`, `10⁶`.
pub fn plain(value: f64) -> String {
    let size = value.abs();
    if size >= 1e5 || (size > 0.0 && size < 1e-3) {
        let exponent = libm::floor(libm::log10(size) + 1e-9) as i32;
        let mantissa = value / power(exponent);
        let factor = if (mantissa - 1.0).abs() < 1e-9 { String::new() } else { format!("{}·", plain(mantissa)) };
        format!("{factor}10{}", superscript(exponent))
    } else if size >= 1000.0 {
        let sign = if value < 0.0 { "−" } else { "" };
        format!("{sign}{}", count(size.round() as u64))
    } else {
        rounded(value).to_string().replace('-', "−")
    }
}

/// Without the last digits, which the product of a round number and a power of ten may have.
pub fn rounded(value: f64) -> f64 {
    format!("{value:.6e}").parse().expect("a number")
}

fn superscript(exponent: i32) -> String {
    const DIGITS: [char; 10] = ['⁰', '¹', '²', '³', '⁴', '⁵', '⁶', '⁷', '⁸', '⁹'];
    let raised = |c: char| c.to_digit(10).map_or('⁻', |digit| DIGITS[digit as usize]);
    exponent.to_string().chars().map(raised).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_short() {
        let texts = [0.0, 0.001, 0.5, 20.0, -3.0, 5000.0, 1e6, 2e6, 1e-5].map(plain);
        assert_eq!(texts, ["0", "0.001", "0.5", "20", "−3", "5,000", "10⁶", "2·10⁶", "10⁻⁵"]);
    }

    #[test]
    fn places_are_even_in_the_logarithm() {
        let axis = Axis::new(Scale::Log, [1e-3, 1.0], [300.0, 0.0]);
        for (value, place) in [(1e-3, 300.0), (1e-2, 200.0), (1e-1, 100.0), (1.0, 0.0)] {
            assert!((axis.place(value) - place).abs() < 1e-9, "{value}");
        }
    }

    #[test]
    fn logarithmic_ticks_are_round_numbers_on_the_axis() {
        let of = |low, high| Axis::new(Scale::Log, [low, high], [0.0, 1.0]).round_values();
        assert_eq!(of(90.0, 6000.0), [100.0, 200.0, 500.0, 1000.0, 2000.0, 5000.0]);
        assert_eq!(of(140.0, 410.0), [150.0, 200.0, 300.0, 400.0]);
        assert_eq!(of(1e-4, 1.0), [1e-4, 1e-3, 1e-2, 1e-1, 1.0]);
    }

    #[test]
    fn linear_ticks_are_round_and_few() {
        let axis = Axis::new(Scale::Linear, [0.0, 1.0], [0.0, 300.0]);
        let texts: Vec<String> = axis.ticks_up().into_iter().map(|(_, text)| text).collect();
        assert_eq!(texts, ["0", "0.2", "0.4", "0.6", "0.8", "1"]);
        assert_eq!(axis.place(0.5), 150.0);
    }

    #[test]
    fn crowded_ticks_are_thinned_evenly() {
        for (low, high) in [(1.0, 1e12), (1.0, 30.0), (3.0, 7.0), (1e-8, 1e3)] {
            let axis = Axis::new(Scale::Log, [low, high], [100.0, 0.0]);
            let ticks = axis.ticks_up();
            assert!(ticks.len() >= 2, "{low} to {high}: {ticks:?}");
            let gap = |pair: &[(f64, String)]| axis.place(pair[0].0) - axis.place(pair[1].0);
            assert!(ticks.windows(2).all(|pair| gap(pair) >= 24.0), "{low} to {high}: {ticks:?}");
        }
    }
}
