//! Reads and writes rays as text.

use std::fmt::{Display, Formatter};
use std::str::FromStr;

use glam::Vec3;

use super::Ray;

/// Writes `ox,oy,oz dx,dy,dz`. If the interval is not [0, infinity), ` [t_min,t_max]` follows.
///
/// Every number except NaN reads back as the same float. A NaN loses its sign and payload.
impl Display for Ray {
    fn fmt(&self, f: &mut Formatter<'_>) -> std::fmt::Result {
        let [o, d] = [self.origin, self.direction];
        write!(f, "{:?},{:?},{:?} {:?},{:?},{:?}", o.x, o.y, o.z, d.x, d.y, d.z)?;
        if self.t_min.to_bits() == 0 && self.t_max == f32::INFINITY {
            return Ok(());
        }
        write!(f, " [{:?},{:?}]", self.t_min, self.t_max)
    }
}

/// The reason why a text is not a ray, or why the ray can hit nothing.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("{0}")]
pub struct RayTextError(String);

/// Reads the format that [`Display`] writes. Two numbers are separated by white space, a comma or both.
///
/// The interval may end with `]` or `)`. `t_max` is always exclusive.
impl FromStr for Ray {
    type Err = RayTextError;

    fn from_str(text: &str) -> Result<Self, RayTextError> {
        let (six, interval) = match text.split_once('[') {
            Some((six, rest)) => (six.trim_end().trim_end_matches(','), Some(rest)),
            None => (text, None),
        };
        let shown = short(text);
        let not_a_number = |number: &str| format!("{:?} in the ray {shown:?} is not a number", short(number));
        let numbers = |part| numbers(part).map_err(|number| RayTextError(not_a_number(number)));
        let needs = "must be two numbers in brackets after the six numbers: [t_min,t_max]";
        let no_interval = || RayTextError(format!("the interval of the ray {shown:?} {needs}"));
        let ray = match numbers(six)?[..] {
            [a, b, c, d, e, f] => Self::new(Vec3::new(a, b, c), Vec3::new(d, e, f)),
            [_, _, _, _, _, _, _, _] if interval.is_none() => return Err(no_interval()),
            ref other => {
                let format = "write \"ox,oy,oz dx,dy,dz\", then \" [t_min,t_max]\" if it is bounded";
                return Err(RayTextError(format!("the ray {shown:?} has {} numbers: {format}", other.len())));
            }
        };
        let Some(rest) = interval else { return Ok(ray) };
        let inner = rest.trim_end().strip_suffix([']', ')']).ok_or_else(no_interval)?;
        match numbers(inner)?[..] {
            [t_min, t_max] => Ok(Self { t_min, t_max, ..ray }),
            _ => Err(no_interval()),
        }
    }
}

impl Ray {
    /// Reads a ray that can hit something.
    ///
    /// # Errors
    /// If the text is not a ray, or the ray is not [valid](Self::is_valid).
    pub fn parse_valid(text: &str) -> Result<Self, RayTextError> {
        let ray: Self = text.parse()?;
        let fault = if ray.is_valid() {
            return Ok(ray);
        } else if !ray.origin.is_finite() {
            "its origin is not finite: give three finite numbers"
        } else if !ray.direction.is_finite() {
            "its direction is not finite: give three finite numbers"
        } else if ray.direction == Vec3::ZERO {
            "its direction is zero: give a nonzero direction"
        } else {
            "its interval is empty: give a t_max above 0 and above t_min"
        };
        Err(RayTextError(format!("the ray {:?} cannot hit anything: {fault}", short(text))))
    }
}

/// Reads numbers that are separated by white space, a comma or both.
///
/// # Errors
/// The first field that is not a number. A missing number before or after a comma counts as an empty field.
pub fn numbers(text: &str) -> Result<Vec<f32>, &str> {
    if text.trim().is_empty() {
        return Ok(vec![]);
    }
    let fields = text.split(',').flat_map(|field| {
        let is_empty = field.trim().is_empty();
        field.split_whitespace().chain(is_empty.then_some(""))
    });
    fields.map(|number| number.parse().map_err(|_| number)).collect()
}

/// Shortens a text for an error message.
fn short(text: &str) -> String {
    const LONGEST: usize = 120;
    match text.char_indices().nth(LONGEST) {
        Some((end, _)) => format!("{}...", &text[..end]),
        None => text.into(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn half_lines_omit_the_interval_and_blanks_or_commas_separate_numbers() {
        let ray = Ray::new(Vec3::new(0.0, 1.5, -2.0), Vec3::new(-0.0, 0.0, 1e-30));
        assert_eq!(ray.to_string(), "0.0,1.5,-2.0 -0.0,0.0,1e-30");
        assert_eq!("0,1.5,-2 -0,0,1e-30 [0,inf)".parse(), Ok(ray));
        assert_eq!(ray.until(2.0).to_string(), "0.0,1.5,-2.0 -0.0,0.0,1e-30 [0.0,2.0]");

        let ray = Ray::new(Vec3::new(0.0, 0.5, 100.0), Vec3::new(0.0, 0.0, -1.0));
        for text in ["0 0.5 100 0 0 -1", "0,0.5,100,0,0,-1", "0, 0.5, 100, 0, 0, -1", " 0,.5 , 100\t0 0,-1 "] {
            assert_eq!(text.parse(), Ok(ray), "{text}");
        }
        for text in ["0 0.5 100 0 0 -1 [0 2]", "0,0.5,100,0,0,-1,[0, 2]", "0 0.5 100  0,0,-1[ 0 , 2 )"] {
            assert_eq!(text.parse(), Ok(ray.until(2.0)), "{text}");
        }
    }

    #[test]
    fn parse_errors_quote_the_fault() {
        let error = |text: &str| text.parse::<Ray>().unwrap_err().to_string();
        assert!(error("").contains("has 0 numbers") && error("1,2,3 [0,1]").contains("has 3 numbers"));
        assert!(error("1,2,3 4,5").contains("the ray \"1,2,3 4,5\" has 5 numbers"));
        assert!(error("1,2,3 4,5,x").contains("\"x\""));
        for gap in ["1,,3 4,5,6", "1,2,3,4,5,6,", ",1 2 3 4 5 6", "1 2 3 4 5 6 [,1]"] {
            assert!(error(gap).starts_with("\"\" in the ray"), "{gap}");
        }
        let intervals = ["1,2,3 4,5,6 0,1", "1,2,3 4,5,6 [0,1,2]", "1 2 3 4 5 6 [0 1", "1 2 3 4 5 6 [0 1] 7"];
        for interval in intervals {
            assert!(error(interval).contains("in brackets after the six numbers: [t_min,t_max]"), "{interval}");
        }
        assert!(error(&"1 ".repeat(1 << 20)).len() < 300);
    }

    #[test]
    fn rays_that_cannot_hit_are_rejected_with_the_reason() {
        let fault = |text: &str| Ray::parse_valid(text).unwrap_err().to_string();
        for (text, part) in [
            ("0 0 0 0 -0 0", "direction is zero"),
            ("0 0 0 1 0 inf", "direction is not finite"),
            ("0 nan 0 1 0 0", "origin is not finite"),
            ("0 0 0 1 0 0 [2 1]", "t_max above 0 and above t_min"),
            ("0 0 0 1 0 0 [nan 1]", "t_max above 0 and above t_min"),
        ] {
            assert!(fault(text).contains(part) && fault(text).contains(text), "{text}");
        }
        assert_eq!(Ray::parse_valid("0 0 0 1 0 0 [-2 1]").unwrap().t_min, -2.0);
    }
}
