//! The colour map of the heat view, which shows the cost of each pixel.

use image::RgbImage;

use super::picture::from_pixels;

/// Nine equally spaced colours of the colour map "inferno". The lightness of the map increases evenly, also in
/// greyscale and for colour-blind people.
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

/// The colour of `cost` on a logarithmic scale. The scale ends at `hottest`.
///
/// The costs of two structures can differ by a factor of 100. A linear scale would show the cheaper structure in black.
pub fn heat(cost: u64, hottest: u64) -> [u8; 3] {
    // The logarithm of `libm` is the same on every machine.
    ramp(match hottest {
        0 => 0.0,
        _ => libm::log1p(cost.min(hottest) as f64) / libm::log1p(hottest as f64),
    })
}

/// The colour at position `share` of the map. `share` is from 0 to 1.
pub fn ramp(share: f64) -> [u8; 3] {
    // Two neighbouring colours of `INFERNO` are 255 steps apart.
    let steps = ((INFERNO.len() - 1) * 255) as f64;
    let step = libm::round(share * steps) as usize;
    let (index, fraction) = (step / 255, (step % 255) as u32);
    let below = INFERNO[index];
    let above = INFERNO[(index + 1).min(INFERNO.len() - 1)];
    std::array::from_fn(|c| {
        ((u32::from(below[c]) * (255 - fraction) + u32::from(above[c]) * fraction + 127) / 255) as u8
    })
}

pub fn with_bar(picture: RgbImage, hottest: u64) -> RgbImage {
    let (width, bar) = (picture.width(), bar(picture.width(), hottest));
    let height = picture.height() + bar.height();
    let rows = [picture.into_raw(), bar.into_raw()].concat();
    RgbImage::from_raw(width, height, rows).expect("both have one width")
}

fn bar(width: u32, hottest: u64) -> RgbImage {
    let black = vec![[0; 3]; width as usize];
    let (last, whole) = (f64::from(width.max(2) - 1), libm::log1p(hottest as f64));
    let colour = |x: u32| heat(libm::round(libm::expm1(f64::from(x) / last * whole)) as u64, hottest);
    let mut marks = black.clone();
    let tens = std::iter::successors(Some(1_u64), |ten| ten.checked_mul(10)).take_while(|&ten| ten <= hottest);
    tens.for_each(|ten| marks[libm::round(libm::log1p(ten as f64) / whole * f64::from(width - 1)) as usize] = [255; 3]);
    let colours: Vec<[u8; 3]> = (0..width).map(colour).collect();
    let rows = [vec![black; 2], vec![colours; 10], vec![marks; 3]].concat();
    from_pixels([width, rows.len() as u32], rows.concat())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_bar_has_every_colour_of_the_scale_and_marks_at_powers_of_ten() {
        let bar = bar(101, 999);
        let row = |y: u32| (0..101).map(|x| bar.get_pixel(x, y).0).collect::<Vec<_>>();
        assert_eq!((row(5)[0], row(5)[100], bar.dimensions()), (INFERNO[0], INFERNO[8], (101, 15)));
        assert_eq!(row(5)[50], heat(31, 999), "the root of 1000, less one, is in the middle");
        let marks: Vec<usize> = (0..101).filter(|&x| row(14)[x] != [0; 3]).collect();
        assert_eq!(marks, [10, 35, 67], "1, 10 and 100 of 999");
        assert_eq!(super::bar(1, 1).dimensions(), (1, 15));

        let picture = RgbImage::from_pixel(101, 2, image::Rgb([7; 3]));
        let both = with_bar(picture, 999);
        assert_eq!((both.height(), both.get_pixel(100, 1).0, both.get_pixel(0, 2 + 5).0), (17, [7; 3], INFERNO[0]));
    }

    #[test]
    fn the_scale_runs_from_black_to_pale_yellow_and_stays_there() {
        // The logarithm of 1 + 9 is halfway between the logarithms of 1 + 0 and 1 + 99.
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
