//! Compares FLIP and SSIM of generated pictures with the results of other programs.

use image::{DynamicImage, GrayImage, Luma, Rgb, RgbImage, Rgba, RgbaImage};

use super::*;

const SIZE: [u32; 2] = [96, 80];

fn base() -> RgbImage {
    RgbImage::from_fn(SIZE[0], SIZE[1], |x, y| {
        let tile = if (x / 12 + y / 10).is_multiple_of(2) { 200 - x } else { 40 + y };
        Rgb([x * 5 + y * 3, tile, (x * x + y * y) / 37].map(|value| (value % 256) as u8))
    })
}

fn changed(of: impl Fn(u32, u32, [u8; 3]) -> [u8; 3]) -> DynamicImage {
    let base = base();
    RgbImage::from_fn(SIZE[0], SIZE[1], |x, y| Rgb(of(x, y, base.get_pixel(x, y).0))).into()
}

fn pictures() -> [DynamicImage; 4] {
    let base = base();
    let noise = |x, y, pixel: [u8; 3]| match (y * SIZE[0] + x) * 7919 % 10 {
        0 => pixel.map(|value| if value < 255 { value + 1 } else { value - 1 }),
        _ => pixel,
    };
    let is_hole = |x: u32, y: u32| (20..50).contains(&y) && (30..10 + y).contains(&x);
    [
        changed(|x, y, _| base.get_pixel(x.saturating_sub(1), y).0),
        changed(|_, _, pixel| pixel.map(|value| (u32::from(value) * 98 / 100) as u8)),
        changed(noise),
        changed(|x, y, pixel| if is_hole(x, y) { [51, 64, 77] } else { pixel }),
    ]
}

fn flip_of(one: &DynamicImage, other: &DynamicImage) -> Flip {
    FlipMap::new(one, other, PIXELS_PER_DEGREE).unwrap().summary(None)
}

fn plain(colour: [u8; 3]) -> DynamicImage {
    RgbImage::from_pixel(40, 30, Rgb(colour)).into()
}

/// Pixels per degree, then four FLIP values: mean, maximum, pixel (40, 40), pixel (0, 0).
type Known = (f64, [f64; 4]);

/// Computed in single precision by the program of the FLIP authors, `flip-evaluator` 1.7. The call was
/// `evaluate(reference, test, "LDR", True, False, True, {"ppd": ...})`.
const KNOWN_FLIP: [[Known; 2]; 4] = [
    [
        (PIXELS_PER_DEGREE, [0.19847115874290466, 0.7354356050491333, 0.09452274441719055, 0.03482626751065254]),
        (30.0, [0.20969107747077942, 0.9660061001777649, 0.08098583668470383, 0.03239578753709793]),
    ],
    [
        (PIXELS_PER_DEGREE, [0.11225476115942001, 0.15658298134803772, 0.09944378584623337, 0.14551648497581482]),
        (30.0, [0.11028609424829483, 0.1640402376651764, 0.08737701922655106, 0.14438188076019287]),
    ],
    [
        (PIXELS_PER_DEGREE, [0.007930079475045204, 0.03136463463306427, 0.0072986166924238205, 0.03136463463306427]),
        (30.0, [0.008005153387784958, 0.04799293354153633, 0.02601911872625351, 0.04662788659334183]),
    ],
    [
        (PIXELS_PER_DEGREE, [0.06015080213546753, 0.9696925282478333, 0.7372069954872131, 0.0]),
        (30.0, [0.0507083497941494, 0.9797979593276978, 0.6036754250526428, 0.0]),
    ],
];

#[test]
fn flip_matches_its_authors_program() {
    let base = base().into();
    for (i, (other, known)) in pictures().iter().zip(KNOWN_FLIP).enumerate() {
        for (pixels_per_degree, known) in known {
            let map = FlipMap::new(&base, other, pixels_per_degree).unwrap();
            let at = |x: u32, y: u32| f64::from(map.values[(y * SIZE[0] + x) as usize]);
            let summary = map.summary(None);
            let found = [summary.mean, summary.largest, at(40, 40), at(0, 0)];
            let is_near = found.iter().zip(known).all(|(found, known)| (found - known).abs() < 1e-4);
            assert!(is_near, "{i} at {pixels_per_degree}: {found:?}, not {known:?}");
        }
    }
}

#[test]
fn flip_of_plain_colours_is_known() {
    let grey = plain([9, 99, 199]);
    assert_eq!(flip_of(&grey, &grey), Flip { mean: 0.0, percentile_95: 0.0, largest: 0.0 });
    let [green, blue] = [[0, 255, 0], [0, 0, 255]].map(plain);
    assert!((flip_of(&green, &blue).mean - 1.0).abs() < 1e-6);
    let black_white = flip_of(&plain([0; 3]), &plain([255; 3]));
    // 0.96737976 is the result of the formulas in double precision.
    // In single precision, the crate nv-flip 0.1.2 returns 0.967392.
    assert!((black_white.mean - 0.96737976).abs() < 1e-6, "{black_white:?}");
    assert_eq!(flip_of(&green, &blue), flip_of(&blue, &green));
    let deep = |picture: &DynamicImage| DynamicImage::from(picture.to_rgb16());
    let [base, other] = [base().into(), pictures()[1].clone()];
    let (eight, sixteen) = (flip_of(&base, &other), flip_of(&deep(&base), &deep(&other)));
    assert!((eight.mean - sixteen.mean).abs() < 1e-9 && (eight.largest - sixteen.largest).abs() < 1e-6);
}

#[test]
fn flip_sees_alpha_where_it_shows() {
    let clear = |colour: [u8; 3], alpha| {
        let [r, g, b] = colour;
        DynamicImage::from(RgbaImage::from_pixel(40, 30, Rgba([r, g, b, alpha])))
    };
    let (red, green) = ([255, 0, 0], [0, 255, 0]);
    assert_eq!(flip_of(&clear(red, 255), &clear(green, 255)), flip_of(&plain(red), &plain(green)));
    assert_eq!(flip_of(&clear(red, 0), &clear(green, 0)).mean, 0.0, "nobody sees either");
    // Half-transparent black over a white background is grey.
    assert!(flip_of(&clear([0; 3], 255), &clear([0; 3], 128)).mean > 0.5);
    let grey = |alpha| DynamicImage::from(clear([77; 3], alpha).to_luma_alpha8());
    assert!(flip_of(&grey(255), &grey(200)).mean > 0.1);
    assert_eq!(FlipMap::new(&plain(red).to_rgb32f().into(), &plain(green).to_rgb32f().into(), 67.0), None);
}

/// Computed by scikit-image 0.26.0: `structural_similarity(base, other, channel_axis=2, gaussian_weights=True,
/// sigma=1.5, use_sample_covariance=False, data_range=255)`.
const KNOWN_SSIM: [f64; 4] = [0.8621161479649783, 0.9990751234845643, 0.9995319084231279, 0.927046817324572];

#[test]
fn ssim_is_that_of_another_program() {
    let base = DynamicImage::from(base());
    for (other, known) in pictures().iter().zip(KNOWN_SSIM) {
        let found = ssim::ssim(&base, other, |_| true).unwrap();
        // `ssim` rounds intermediate results to single precision.
        assert!((found - known).abs() < 1e-7, "{found}, not {known}");
    }
    assert_eq!(ssim::ssim(&base, &base, |_| true), Some(1.0));
    let small = DynamicImage::from(RgbImage::new(10, 30));
    assert_eq!(ssim::ssim(&small, &small, |_| true), None, "no window has room");
}

#[test]
fn masked_pixels_are_in_no_measure() {
    let (base, hole) = (DynamicImage::from(base()), pictures()[3].clone());
    let mask = GrayImage::from_fn(SIZE[0], SIZE[1], |x, y| Luma([u8::from(!(18..52).contains(&y) || x < 20)]));
    let mask = Mask::new(&mask.into());
    assert_eq!(mask.masked_pixels(), 34 * 76);
    let masked = mask.applied(&base, hole.clone());
    assert_eq!(masked, base, "nothing else differs");

    let mask = Mask::new(&GrayImage::from_fn(SIZE[0], SIZE[1], |_, y| Luma([u8::from(y < 40)])).into());
    let masked = mask.applied(&base, hole.clone());
    let measures = |actual: &DynamicImage, mask: Option<&Mask>| {
        let difference = Difference::between(&base, actual).unwrap();
        let flip = FlipMap::new(&base, actual, PIXELS_PER_DEGREE);
        Measures::new([&base, actual], difference, 100.0, flip.as_ref(), mask)
    };
    let (whole, half) = (measures(&hole, None), measures(&masked, Some(&mask)));
    assert_eq!([whole.compared, half.compared, half.masked], [7680, 3840, 3840]);
    assert_eq!([whole.difference.pixels, half.difference.pixels], [30 * 29 / 2, 20 * 19 / 2]);
    assert!(half.pixels_over < half.difference.pixels && half.difference.worst[1] < 40);
    let sums = |found: &Measures| [found.mean, found.flip.unwrap().mean].map(|mean| mean * found.compared as f64);
    let [half_sums, whole_sums] = [sums(&half), sums(&whole)];
    assert!(half_sums.iter().zip(whole_sums).all(|(half, whole)| *half > 0.0 && *half < whole));
    let noise = |found: &Measures| 10f64.powf(-found.psnr / 10.0) * found.compared as f64;
    assert!(noise(&half) < noise(&whole) && half.ssim != whole.ssim);
}

#[test]
fn mean_and_psnr_are_those_of_the_channels() {
    let (one, mut other) = (RgbImage::new(10, 1), RgbImage::new(10, 1));
    other.put_pixel(3, 0, Rgb([10, 20, 0]));
    other.put_pixel(5, 0, Rgb([0, 0, 30]));
    let [one, other] = [one, other].map(DynamicImage::from);
    let measures = Measures::new([&one, &other], Difference::between(&one, &other).unwrap(), 20.0, None, None);
    assert_eq!((measures.mean, measures.pixels_over, measures.ssim, measures.flip), (2.0, 1, None, None));
    assert!((measures.psnr - 10.0 * libm::log10(65025.0 * 30.0 / 1400.0)).abs() < 1e-12);
    let halves = FlipMap { size: [20, 1], values: (0..20).map(|i| i as f32 / 32.0).collect() };
    assert_eq!(halves.summary(None), Flip { mean: 0.296875, percentile_95: 0.5625, largest: 0.59375 });
}
