//! Colours for light mode and dark mode.

use std::collections::{BTreeMap, BTreeSet};

use plotters::style::RGBColor;

use crate::measure::checksum;

pub type Colour = RGBColor;

#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Role {
    /// Name of the CSS custom property, without `--`.
    pub name: &'static str,
    pub light: Colour,
    pub dark: Colour,
}

const fn role(name: &'static str, light: [u8; 3], dark: [u8; 3]) -> Role {
    Role { name, light: RGBColor(light[0], light[1], light[2]), dark: RGBColor(dark[0], dark[1], dark[2]) }
}

pub const PAPER: Role = role("paper", [255, 255, 255], [20, 23, 27]);
pub const INK: Role = role("ink", [34, 38, 43], [226, 228, 231]);
pub const MIDDLE: Role = role("middle", [100, 106, 114], [157, 164, 173]);
pub const FAINT: Role = role("faint", [222, 225, 229], [52, 57, 64]);

/// Colours of data series. The first ten colours are distinct for colour-blind readers (after Okabe, Ito: Color
/// universal design, 2008). Every colour has enough contrast for text.
pub const SERIES: [Role; 24] = [
    role("s0", [106, 110, 116], [160, 166, 174]),
    role("s1", [184, 74, 0], [255, 150, 84]),
    role("s2", [0, 98, 163], [96, 180, 244]),
    role("s3", [0, 120, 140], [72, 203, 222]),
    role("s4", [98, 108, 0], [190, 200, 84]),
    role("s5", [176, 48, 95], [248, 132, 170]),
    role("s6", [128, 88, 52], [214, 172, 132]),
    role("s7", [120, 64, 158], [198, 152, 240]),
    role("s8", [0, 118, 82], [74, 208, 160]),
    role("s9", [72, 84, 170], [150, 164, 250]),
    role("s10", [140, 100, 0], [230, 190, 60]),
    role("s11", [203, 11, 203], [245, 60, 245]),
    role("s12", [203, 11, 11], [245, 60, 60]),
    role("s13", [22, 107, 6], [140, 248, 118]),
    role("s14", [174, 9, 64], [246, 78, 134]),
    role("s15", [76, 8, 145], [171, 95, 247]),
    role("s16", [8, 31, 145], [95, 120, 247]),
    role("s17", [25, 87, 56], [144, 223, 183]),
    role("s18", [107, 6, 90], [248, 118, 226]),
    role("s19", [139, 75, 107], [183, 122, 152]),
    role("s20", [66, 87, 25], [196, 223, 144]),
    role("s21", [174, 9, 119], [246, 78, 190]),
    role("s22", [64, 119, 64], [134, 190, 134]),
    role("s23", [6, 90, 107], [118, 226, 248]),
];

/// Colours of the factors of a bar. No structure has one of these colours.
pub const PARTS: [Role; 3] = [
    role("p0", [44, 62, 84], [204, 216, 230]),
    role("p1", [98, 124, 152], [134, 154, 176]),
    role("p2", [172, 190, 208], [76, 92, 110]),
];

pub fn roles() -> impl Iterator<Item = Role> {
    [PAPER, INK, MIDDLE, FAINT].into_iter().chain(SERIES).chain(PARTS)
}

/// The structure `STRUCTURES[i]` has the fixed colour `SERIES[i]`.
const STRUCTURES: [&str; 14] = [
    "brute-force",
    "median-kd",
    "sah-kd",
    "sah-kd-wide",
    "sah-kd-tight",
    "sah-hybrid",
    "sah-bvh",
    "obvhs-bvh2",
    "obvhs-cwbvh",
    "bvh",
    "embree",
    "embree-robust",
    "parry",
    "tinybvh",
];

pub fn colours(labels: &[String]) -> Vec<Colour> {
    roles_of(labels).into_iter().map(|role| role.light).collect()
}

/// Names in `STRUCTURES` have fixed colours. For any other label, a hash selects one of the remaining colours. Without
/// hash collisions, a label has the same colour in every chart.
pub fn roles_of(labels: &[String]) -> Vec<Role> {
    let own = |label: &str| STRUCTURES.iter().position(|structure| *structure == label);
    let others = labels.iter().map(String::as_str).filter(|label| own(label).is_none());
    let others = spread(others, SERIES.len() - STRUCTURES.len());
    let role = |label: &String| SERIES[own(label).unwrap_or_else(|| STRUCTURES.len() + others[label.as_str()])];
    labels.iter().map(role).collect()
}

/// Assigns an index below `n` to each text. Different texts share an index only if there are more than `n` texts. The
/// result does not depend on the order of `texts`.
fn spread<'a>(texts: impl Iterator<Item = &'a str>, n: usize) -> BTreeMap<&'a str, usize> {
    let mut given: BTreeMap<&str, usize> = BTreeMap::new();
    for text in texts.collect::<BTreeSet<_>>() {
        let hash = checksum(text.bytes().map(u64::from));
        let first = (hash ^ hash >> 32) as u32 as usize % n;
        let free = (0..n).map(|step| (first + step) % n).find(|i| given.values().all(|other| other != i));
        given.insert(text, free.unwrap_or(first));
    }
    given
}

pub fn hex(colour: Colour) -> String {
    format!("#{:02X}{:02X}{:02X}", colour.0, colour.1, colour.2)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The contrast ratio of WCAG 2.2.
    fn contrast(a: Colour, b: Colour) -> f64 {
        let part = |c: u8| {
            let c = f64::from(c) / 255.0;
            if c <= 0.04045 { c / 12.92 } else { libm::pow((c + 0.055) / 1.055, 2.4) }
        };
        let luminance = |c: Colour| 0.2126 * part(c.0) + 0.7152 * part(c.1) + 0.0722 * part(c.2);
        let (a, b) = (luminance(a), luminance(b));
        (a.max(b) + 0.05) / (a.min(b) + 0.05)
    }

    #[test]
    fn everything_that_is_read_has_enough_contrast_and_a_colour_and_a_name_of_its_own() {
        let all: Vec<Role> = roles().collect();
        for (i, role) in all.iter().enumerate() {
            let differs = |o: &Role| o.light != role.light && o.dark != role.dark && o.name != role.name;
            assert!(all[..i].iter().all(differs), "{}", role.name);
            let is_read = ![PAPER, FAINT].contains(role) && !PARTS.contains(role);
            for (colour, paper) in [(role.light, PAPER.light), (role.dark, PAPER.dark)] {
                let contrast = contrast(colour, paper);
                assert!(!is_read || contrast >= 4.5, "{}: {contrast}", role.name);
            }
        }
    }

    #[test]
    fn labels_keep_their_colour_in_every_chart_and_never_have_the_colour_of_another_structure() {
        let of = |labels: &[&str]| roles_of(&labels.iter().map(|label| (*label).to_owned()).collect::<Vec<_>>());
        let names = ["grid", "sah-kd:leaf=4", "sah-kd", "sah-kd:leaf=2", "median-kd", "grid:cell=2", "embree"];
        let many = of(&names);
        for (i, (label, role)) in names.iter().zip(&many).enumerate() {
            assert_eq!(STRUCTURES.contains(label), SERIES[..STRUCTURES.len()].contains(role), "{label}");
            assert!(!many[..i].contains(role), "{label}");
        }
        assert_eq!(of(&["embree", "median-kd"]), [many[6], many[4]]);
        let labels: Vec<String> = (0..60).map(|i| format!("sah-kd:leaf={i}")).collect();
        assert!(roles_of(&labels).iter().all(|role| !SERIES[..STRUCTURES.len()].contains(role)));
    }
}
