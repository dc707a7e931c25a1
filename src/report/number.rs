//! Formats numbers, durations and byte counts.

pub use crate::plural::{count, plural};

/// Formats `x` with three significant digits: `0.00123`, `12.3`. All digits before the decimal point are kept: `1234`.
/// Nonzero magnitudes outside [1e-3, 1e7) are in scientific notation.
pub fn figures(x: f64) -> String {
    let size = x.abs();
    if x == 0.0 {
        "0".into()
    } else if !x.is_finite() || !(1e-3..1e7).contains(&size) {
        format!("{x:.2e}")
    } else {
        // The number of decimals depends on the rounded value: 9.996 becomes 10.0, not 10.00.
        let rounded: f64 = format!("{size:.2e}").parse().expect("a formatted number");
        let decimals = 2 - libm::floor(libm::log10(rounded)) as i32;
        format!("{x:.*}", decimals.max(0) as usize)
    }
}

pub fn duration(ns: f64) -> String {
    let (scale, unit) = match ns {
        ns if ns < 999.5 => (1.0, "ns"),
        ns if ns < 999.5e3 => (1e3, "us"),
        ns if ns < 999.5e6 => (1e6, "ms"),
        _ => (1e9, "s"),
    };
    format!("{} {unit}", figures(ns / scale))
}

pub fn bytes(bytes: usize) -> String {
    let (scale, unit) = match bytes {
        0..1024 => (0, "B"),
        1024..0x10_0000 => (10, "KiB"),
        0x10_0000..0x4000_0000 => (20, "MiB"),
        _ => (30, "GiB"),
    };
    format!("{} {unit}", figures(bytes as f64 / f64::from(1u32 << scale)))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn three_digits_whatever_the_size() {
        let cases = [
            (0.0, "0"),
            (0.001_234, "0.00123"),
            (0.0996, "0.0996"),
            (0.999_6, "1.00"),
            (1.0, "1.00"),
            (9.996, "10.0"),
            (12.345, "12.3"),
            (999.6, "1000"),
            (262_144.0, "262144"),
            (-1.5, "-1.50"),
            (4.959e-9, "4.96e-9"),
            (1.25e8, "1.25e8"),
        ];
        for (x, text) in cases {
            assert_eq!(figures(x), text);
        }
    }

    #[test]
    fn units_change_where_three_digits_end() {
        assert_eq!(
            [duration(12.0), duration(999.9), duration(2.5e6), duration(1.5e10)],
            ["12.0 ns", "1.00 us", "2.50 ms", "15.0 s"]
        );
        assert_eq!([bytes(0), bytes(1023), bytes(1536), bytes(5 << 20)], ["0 B", "1023 B", "1.50 KiB", "5.00 MiB"]);
    }
}
