//! The number by which a cell is sorted.

/// What the text of a cell begins with, in one unit: `1.50 MiB` in bytes, `20.6 [19.2, 21.0]` by its estimate, `~3.2` and
/// `1,024` as they are, `3/100 wrong` and other words not at all.
pub fn sort_key(text: &str) -> Option<f64> {
    let text = text.trim().trim_start_matches(['~', '+', '<', '≤', '≥']).trim_start().replace('−', "-");
    let end = text.find(|c: char| !(c.is_ascii_digit() || "+-.,eE".contains(c))).unwrap_or(text.len());
    let (number, rest) = text.split_at(end);
    // A following e may be the beginning of a word.
    let number: f64 = number.trim_end_matches(['e', 'E', ',', '.', '+']).replace(',', "").parse().ok()?;
    let unit = rest.trim_start().split([' ', ',', ';', '[', '(']).next().unwrap_or_default();
    let scale = match unit {
        "" | "B" | "ns" | "×" | "x" | "of" => 1.0,
        "k" => 1e3,
        "M" => 1e6,
        "G" => 1e9,
        "KiB" => 1024.0,
        "MiB" => 1_048_576.0,
        "GiB" => 1_073_741_824.0,
        "us" | "µs" => 1e3,
        "ms" => 1e6,
        "s" => 1e9,
        "%" => 0.01,
        _ if rest.starts_with('%') => 0.01,
        _ => return None,
    };
    Some(number * scale)
}

#[cfg(test)]
mod tests {
    use super::sort_key;

    #[test]
    fn numbers_are_found_with_their_units() {
        let keys = [
            ("1.50 MiB", 1_572_864.0),
            ("20.6 [19.2, 21.0]", 20.6),
            ("~3.2", 3.2),
            ("130,862", 130_862.0),
            ("6.11k [0.123, never]", 6110.0),
            ("4.96e-9", 4.96e-9),
            ("-4", -4.0),
            ("+8", 8.0),
            ("2.50 ms", 2.5e6),
            ("27.9%", 0.279),
            ("0.5 %", 0.005),
            ("20.6 ×", 20.6),
        ];
        for (text, key) in keys {
            let found = sort_key(text).unwrap_or_else(|| panic!("{text} has no key"));
            assert!((found - key).abs() <= 1e-12 * key.abs(), "{text}: {found}");
        }
    }

    #[test]
    fn words_have_none() {
        for text in ["", "all", "declined", "3/100 wrong", "sah-kd", "e", "50 / 0.5", "-"] {
            assert_eq!(sort_key(text), None, "{text}");
        }
    }
}
