//! The colour map of the heat view.

/// Nine colours of the map "inferno" at equal distances: lightness rises evenly, also in grey and for colour-blind
/// eyes.
///
/// # References
/// Smith, van der Walt, Firing: the colour maps of Matplotlib 1.5, 2015 (dedicated to the public domain, CC0).
const INFERNO: [[u8; 3]; 9] = [
    [0, 0, 4],
    [31, 12, 72],
    [85, 15, 109],
    [136, 34, 106],
    [186, 54, 85],
    [227, 89, 51],
    [249, 140, 10],
    [249, 201, 50],
    [252, 255, 164],
];

/// The colour of `cost` on a logarithmic scale from 0 to `hottest`; above that it stays the same.
///
/// Costs of structures differ by factors of a hundred: on a linear scale that fits the worst, the best is black.
pub fn heat(cost: u64, hottest: u64) -> [u8; 3] {
    // 255 steps between neighbouring colours. The logarithm is libm's: the same on every machine.
    let steps = ((INFERNO.len() - 1) * 255) as f64;
    let share = match hottest {
        0 => 0.0,
        _ => libm::log1p(cost.min(hottest) as f64) / libm::log1p(hottest as f64),
    };
    let place = libm::round(share * steps) as usize;
    let (index, part) = (place / 255, (place % 255) as u32);
    let below = INFERNO[index];
    let above = INFERNO[(index + 1).min(INFERNO.len() - 1)];
    std::array::from_fn(|c| ((u32::from(below[c]) * (255 - part) + u32::from(above[c]) * part + 127) / 255) as u8)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_scale_runs_from_black_to_pale_yellow_and_stays_there() {
        // 9 is in the middle between 0 and 99: a factor of ten up to 1 + cost, and another one.
        assert_eq!([heat(0, 99), heat(9, 99), heat(99, 99)], [INFERNO[0], INFERNO[4], INFERNO[8]]);
        assert_eq!([heat(11, 10), heat(u64::MAX, 10), heat(u64::MAX, u64::MAX)], [INFERNO[8]; 3]);
        assert_eq!(heat(3, 0), INFERNO[0]);
    }

    #[test]
    fn a_hundredth_more_cost_is_not_darker() {
        let lightness = |[r, g, b]: [u8; 3]| 2126 * u32::from(r) + 7152 * u32::from(g) + 722 * u32::from(b);
        let scale: Vec<u32> = (0..=100).map(|cost| lightness(heat(cost, 100))).collect();
        assert!(scale.is_sorted());
    }
}
