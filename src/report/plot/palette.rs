//! Colours: one for each structure, the same in every figure, in light and in dark.

use plotters::style::RGBColor;

/// A colour of a drawing, by its value on white paper; a page in dark colours shows another in its place.
pub type Colour = RGBColor;

/// A colour by its role: what a drawing says, what white paper shows, and what dark paper shows.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Role {
    /// Name of the custom property of style sheets.
    pub name: &'static str,
    pub light: Colour,
    pub dark: Colour,
}

const fn role(name: &'static str, light: [u8; 3], dark: [u8; 3]) -> Role {
    Role { name, light: RGBColor(light[0], light[1], light[2]), dark: RGBColor(dark[0], dark[1], dark[2]) }
}

/// Paper, text, lines.
pub const PAPER: Role = role("paper", [255, 255, 255], [20, 23, 27]);
pub const INK: Role = role("ink", [34, 38, 43], [226, 228, 231]);
pub const MIDDLE: Role = role("middle", [100, 106, 114], [157, 164, 173]);
pub const FAINT: Role = role("faint", [222, 225, 229], [52, 57, 64]);

/// Colours of series, told apart by colour-blind eyes as far as the first ten can be (after Okabe, Ito: Color universal design,
/// 2008), dark or light enough for text.
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

/// Colours of the parts of a whole, which are no structures: shades of one colour, dark to pale.
pub const PARTS: [Role; 3] = [
    role("p0", [44, 62, 84], [204, 216, 230]),
    role("p1", [98, 124, 152], [134, 154, 176]),
    role("p2", [172, 190, 208], [76, 92, 110]),
];

/// All roles.
pub fn roles() -> impl Iterator<Item = Role> {
    [PAPER, INK, MIDDLE, FAINT].into_iter().chain(SERIES).chain(PARTS)
}

/// The structures with a colour of their own, the same in every chart.
const STRUCTURES: [&str; 15] = [
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
    "kdtree-ray",
    "parry",
    "tinybvh",
];

/// A colour for each label, all different as long as there are enough. The bare name of a structure always has that of its structure; a
/// structure with keys, or of another name, has one of the others, which its label decides: in another chart it is the same, but where
/// two labels of one chart meet in a colour.
pub fn colours(labels: &[String]) -> Vec<Colour> {
    const OTHERS: usize = SERIES.len() - STRUCTURES.len();
    let own = |label: &String| STRUCTURES.iter().position(|structure| structure == label);
    let mut given: Vec<Option<usize>> = labels.iter().map(own).collect();
    // In the order of their names: that of a chart does not matter.
    let mut rest: Vec<usize> = (0..labels.len()).filter(|&i| given[i].is_none()).collect();
    rest.sort_by_key(|&i| &labels[i]);
    for i in rest {
        let first = number(&labels[i]) % OTHERS;
        let order = (0..OTHERS).map(|step| STRUCTURES.len() + (first + step) % OTHERS).chain(0..STRUCTURES.len());
        let free = order.clone().find(|colour| !given.contains(&Some(*colour)));
        given[i] = free.or(Some(STRUCTURES.len() + first));
    }
    given.into_iter().map(|colour| SERIES[colour.unwrap_or(0)].light).collect()
}

/// A number that depends on nothing but the text (Fowler, Noll, Vo: FNV-1a).
fn number(text: &str) -> usize {
    let hash = text
        .bytes()
        .fold(0xcbf2_9ce4_8422_2325_u64, |hash, byte| (hash ^ u64::from(byte)).wrapping_mul(0x100_0000_01b3));
    (hash ^ hash >> 32) as u32 as usize
}

/// The colour as style sheets and drawings write it.
pub fn hex(colour: Colour) -> String {
    format!("#{:02X}{:02X}{:02X}", colour.0, colour.1, colour.2)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Contrast by WCAG 2.2.
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
    fn everything_that_is_read_has_enough_contrast_in_light_and_dark() {
        for role in [INK, MIDDLE].into_iter().chain(SERIES) {
            for (colour, paper) in [(role.light, PAPER.light), (role.dark, PAPER.dark)] {
                assert!(contrast(colour, paper) >= 4.5, "{}: {}", role.name, contrast(colour, paper));
            }
        }
    }

    #[test]
    fn no_two_roles_share_a_colour() {
        let all: Vec<Role> = roles().collect();
        for (i, role) in all.iter().enumerate() {
            assert!(all[..i].iter().all(|other| other.light != role.light && other.dark != role.dark), "{}", role.name);
        }
    }

    #[test]
    fn structures_keep_their_colour_in_every_chart_and_variants_get_one_of_their_own() {
        let labels = |names: &[&str]| names.iter().map(|name| (*name).to_owned()).collect::<Vec<_>>();
        let alone = |name: &str| colours(&labels(&[name]))[0];
        let names = ["grid", "sah-kd:leaf=4", "sah-kd", "sah-kd:leaf=8", "median-kd", "embree"];
        let many = colours(&labels(&names));
        for (name, colour) in names.iter().zip(&many) {
            assert_eq!(*colour, alone(name), "{name}");
        }
        // In another order, and without the bare name, too.
        let few = colours(&labels(&["median-kd", "sah-kd:leaf=8"]));
        assert_eq!(few, [many[4], many[3]]);
        for (i, colour) in many.iter().enumerate() {
            assert!(!many[..i].contains(colour), "{i}");
        }
        assert_eq!(colours(&vec!["x".into(); 30]).len(), 30);
    }
}
