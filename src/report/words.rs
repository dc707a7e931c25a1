//! Words that tables, studies and pages share.

use super::number::figures;
use crate::measure::Interval;

/// A scene as keys, tables and figures name it: they say where a mesh of our own stands in for a real one.
pub fn scene_name(scene: &str, stand_in: bool) -> String {
    if stand_in { format!("{scene} (stand-in)") } else { scene.into() }
}

/// `20.6 [19.2, 21.4]`; what does not vary has no interval.
pub fn interval(x: Interval) -> String {
    if x.low == x.high { figures(x.estimate) } else { format!("{} {}", figures(x.estimate), ends(x)) }
}

/// `[19.2, 21.4]`; `[?]` where it is not known: of a single sample, or when it reaches from nearly nothing to a great multiple.
pub fn ends(x: Interval) -> String {
    if x.low > 0.0 && x.high > 1e4 * x.low {
        return "[?]".into();
    }
    format!("[{}, {}]", figures(x.low), figures(x.high))
}

/// `A`, `A and B`, `A, B and C`.
pub fn listed<S: AsRef<str>>(words: &[S]) -> String {
    let words: Vec<&str> = words.iter().map(AsRef::as_ref).collect();
    match words.split_last() {
        None => String::new(),
        Some((only, [])) => (*only).into(),
        Some((last, rest)) => format!("{} and {last}", rest.join(", ")),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lists_and_intervals_read_as_text() {
        assert_eq!([listed::<&str>(&[]), listed(&["a"]), listed(&["a", "b", "c"])], ["", "a", "a, b and c"]);
        let spread = Interval { estimate: 2.0, low: 1.5, high: 2.5 };
        assert_eq!(interval(spread), "2.00 [1.50, 2.50]");
        assert_eq!(interval(Interval { low: 2.0, high: 2.0, ..spread }), "2.00");
        assert_eq!(interval(Interval { low: 1e-200, high: 1e200, ..spread }), "2.00 [?]");
        assert_eq!(interval(Interval { low: 2e-4, high: 4580.56, ..spread }), "2.00 [?]");
        assert_eq!(interval(Interval { low: 0.00421, high: 2.5, ..spread }), "2.00 [0.00421, 2.50]");
        assert_eq!(interval(Interval { estimate: -0.5, low: -0.75, high: 0.25 }), "-0.500 [-0.750, 0.250]");
        assert_eq!(scene_name("Dragon", true), "Dragon (stand-in)");
    }
}
