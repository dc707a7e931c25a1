//! Rays as text, so that a ray that a report names can be asked again.

use std::fmt::{Display, Formatter};
use std::str::FromStr;

use glam::Vec3;

use super::Ray;

/// `ox,oy,oz dx,dy,dz`, followed by ` [t_min,t_max]` unless the ray is the whole half-line.
///
/// Every number is the shortest decimal that reads back to the same float, so that the text gives back the same bits
/// (of a NaN, only that it is one).
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

/// Why a text is not a ray.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum RayTextError {
    /// Not two parts, or three.
    #[allow(missing_docs)]
    #[error(
        "the ray {text:?} has {count} parts: write \"ox,oy,oz dx,dy,dz\", then \" [t_min,t_max]\" if it is bounded"
    )]
    Parts { text: String, count: usize },
    /// A part with too few numbers, or too many.
    #[allow(missing_docs)]
    #[error("{part:?} in the ray {text:?} has {count} numbers: it must have {expected}, separated by commas")]
    Count { text: String, part: String, count: usize, expected: usize },
    /// What should be a number is none.
    #[allow(missing_docs)]
    #[error("{number:?} in the ray {text:?} is not a number")]
    Number { text: String, number: String },
    /// An interval without brackets.
    #[allow(missing_docs)]
    #[error("the interval {part:?} in the ray {text:?} must stand in brackets: [t_min,t_max]")]
    Brackets { text: String, part: String },
}

/// Reads what [`Display`] writes; the interval may end with `]` or `)`, which both mean the open end.
impl FromStr for Ray {
    type Err = RayTextError;

    fn from_str(text: &str) -> Result<Self, RayTextError> {
        let mut parts = text.split_whitespace();
        let count = parts.clone().count();
        let (Some(origin), Some(direction), interval, None) = (parts.next(), parts.next(), parts.next(), parts.next())
        else {
            return Err(RayTextError::Parts { text: short(text), count });
        };
        let ray = Self::new(Vec3::from_array(numbers(text, origin)?), Vec3::from_array(numbers(text, direction)?));
        let Some(part) = interval else { return Ok(ray) };
        let inner = part.strip_prefix('[').and_then(|p| p.strip_suffix([']', ')']));
        let inner = inner.ok_or_else(|| RayTextError::Brackets { text: short(text), part: short(part) })?;
        let [t_min, t_max] = numbers(text, inner)?;
        Ok(Self { t_min, t_max, ..ray })
    }
}

/// Text that may be a whole file in one line, as it may stand in a message: cut after 120 characters.
fn short(text: &str) -> String {
    const LONGEST: usize = 120;
    match text.char_indices().nth(LONGEST) {
        Some((end, _)) => format!("{}...", &text[..end]),
        None => text.into(),
    }
}

fn numbers<const N: usize>(text: &str, part: &str) -> Result<[f32; N], RayTextError> {
    let mut found = [0.0; N];
    let count = part.split(',').count();
    if count != N {
        return Err(RayTextError::Count { text: short(text), part: short(part), count, expected: N });
    }
    for (slot, number) in found.iter_mut().zip(part.split(',')) {
        *slot = number.parse().map_err(|_| RayTextError::Number { text: short(text), number: short(number) })?;
    }
    Ok(found)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_ray_reads_back_bit_for_bit() {
        let values = [0.0, -0.0, 0.1, -1.0, 1.0 / 3.0, f32::MAX, f32::MIN_POSITIVE, f32::from_bits(1), f32::INFINITY];
        for (i, &a) in values.iter().enumerate() {
            for (j, &b) in values.iter().enumerate() {
                let ray = Ray { origin: Vec3::new(a, b, 1e-20), t_min: b, direction: Vec3::new(b, -a, 7.0), t_max: a };
                let back: Ray = ray.to_string().parse().unwrap();
                let bits = |r: &Ray| {
                    let (o, d) = (r.origin.to_array(), r.direction.to_array());
                    [o[0], o[1], o[2], d[0], d[1], d[2], r.t_min, r.t_max].map(f32::to_bits)
                };
                assert_eq!(bits(&back), bits(&ray), "{i} {j} {ray}");
            }
        }
        let nan: Ray = Ray { t_min: f32::NAN, ..Ray::new(Vec3::ZERO, Vec3::X) }.to_string().parse().unwrap();
        assert!(nan.t_min.is_nan());
    }

    #[test]
    fn the_whole_half_line_needs_no_interval() {
        let ray = Ray::new(Vec3::new(0.0, 1.5, -2.0), Vec3::new(-0.0, 0.0, 1e-30));
        assert_eq!(ray.to_string(), "0.0,1.5,-2.0 -0.0,0.0,1e-30");
        assert_eq!("0,1.5,-2 -0,0,1e-30 [0,inf)".parse(), Ok(ray));
        assert_eq!(ray.until(2.0).to_string(), "0.0,1.5,-2.0 -0.0,0.0,1e-30 [0.0,2.0]");
    }

    #[test]
    fn what_is_not_a_ray_is_named() {
        let error = |text: &str| text.parse::<Ray>().unwrap_err().to_string();
        assert!(error("1,2,3").contains("has 1 parts"));
        assert!(error("1,2,3 4,5").contains("\"4,5\" in the ray \"1,2,3 4,5\" has 2 numbers"));
        assert!(error("1,2,3 4,5,x").contains("\"x\""));
        assert!(error("1,2,3 4,5,6 0,1").contains("brackets: [t_min,t_max]"));
        assert!(error("1,2,3 4,5,6 [0,1,2]").contains("it must have 2"));
        assert!(error(&"1 ".repeat(1 << 20)).len() < 300);
    }
}
