//! A logarithmic axis.

/// Maps positive values to places.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LogAxis {
    /// Logarithms of the values at both ends.
    ends: [f64; 2],
    /// Places of these.
    places: [f64; 2],
}

impl LogAxis {
    /// From `low` at the first of `places` to `high`, which is larger, at the second.
    pub fn new(low: f64, high: f64, places: [f64; 2]) -> Self {
        Self { ends: [libm::log10(low), libm::log10(high)], places }
    }

    /// Where it begins and ends.
    pub fn places(&self) -> [f64; 2] {
        self.places
    }

    /// Where `value` is.
    pub fn place(&self, value: f64) -> f64 {
        let share = (libm::log10(value) - self.ends[0]) / (self.ends[1] - self.ends[0]);
        self.places[0] + share * (self.places[1] - self.places[0])
    }

    /// The powers of ten on the axis; where they are few, round numbers between them as well. Ascending.
    pub fn ticks(&self) -> Vec<f64> {
        let [low, high] = self.ends;
        let factors: &[f64] = match high - low {
            decades if decades > 2.5 => &[1.0],
            decades if decades > 1.2 => &[1.0, 2.0, 5.0],
            _ => &[1.0, 1.5, 2.0, 3.0, 4.0, 5.0, 7.0],
        };
        let slack = 1e-9;
        (libm::floor(low) as i32..=libm::ceil(high) as i32)
            .flat_map(|exponent| factors.iter().map(move |factor| factor * power(exponent)))
            .filter(|tick| (low - slack..=high + slack).contains(&libm::log10(*tick)))
            .collect()
    }
}

/// A power of ten, as exact as it can be.
pub fn power(exponent: i32) -> f64 {
    format!("1e{exponent}").parse().expect("a number")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn places_are_even_in_the_logarithm() {
        let axis = LogAxis::new(1e-3, 1.0, [300.0, 0.0]);
        for (value, place) in [(1e-3, 300.0), (1e-2, 200.0), (1e-1, 100.0), (1.0, 0.0)] {
            assert!((axis.place(value) - place).abs() < 1e-9, "{value}");
        }
    }

    #[test]
    fn ticks_are_round_numbers_on_the_axis() {
        assert_eq!(LogAxis::new(90.0, 6000.0, [0.0, 1.0]).ticks(), [100.0, 200.0, 500.0, 1000.0, 2000.0, 5000.0]);
        assert_eq!(LogAxis::new(140.0, 410.0, [0.0, 1.0]).ticks(), [150.0, 200.0, 300.0, 400.0]);
        assert_eq!(LogAxis::new(1e-4, 1.0, [0.0, 1.0]).ticks(), [1e-4, 1e-3, 1e-2, 1e-1, 1.0]);
    }
}
