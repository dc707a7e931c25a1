//! Formats whole numbers for sentences.

/// A whole number in groups of three digits: `130,858`.
pub fn count(n: u64) -> String {
    let digits = n.to_string();
    let mut text = String::new();
    for (i, digit) in digits.chars().enumerate() {
        if i > 0 && (digits.len() - i).is_multiple_of(3) {
            text.push(',');
        }
        text.push(digit);
    }
    text
}

/// A number with its noun: `1 scene`, `2 scenes`.
pub fn plural(n: usize, noun: &str) -> String {
    format!("{} {noun}{}", count(n as u64), if n == 1 { "" } else { "s" })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn counts_are_grouped() {
        assert_eq!([count(7), count(1000), count(130_858), count(1_234_567)], ["7", "1,000", "130,858", "1,234,567"]);
        assert_eq!([plural(1, "ray"), plural(2000, "ray")], ["1 ray", "2,000 rays"]);
    }
}
