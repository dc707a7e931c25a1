//! Golden images: every structure over the exact triangle test renders every built-in scene byte for byte as committed,
//! and so does the SAH tree over the default test.

use std::path::Path;

use sahara::builtin::{BUILTIN, Builtin};
use sahara::golden::{GoldenError, Layout, Overwrite, SceneGolden, TRIANGLE_TEST, Update, read, write};
use sahara::image::{DynamicImage, RgbaImage};
use sahara::registry::{Choice, Registry};
use sahara::render::ViewKind;

/// Pixels of the baseline that differ: structure, scene, number of pixels and cause. Any other number of pixels or
/// another scene fails the test.
///
/// In the Cornell box, rays of the picture's diagonals meet the edges between walls exactly, and hit two walls of
/// different colours at one t. The structures of this crate must return the lower primitive number; obvhs returns
/// either, which the contract allows.
const FINDINGS: &[(&str, &str, usize, &str)] = &[
    ("obvhs-bvh2:test=exact", "Cornellbox", 103, "ties at the edges between walls; no ray is lost"),
    (
        "obvhs-cwbvh:test=exact",
        "Cornellbox",
        49,
        "ties at the edges between walls; and one ray lost there, since boxes have no slack",
    ),
];

#[test]
fn a_tree_draws_every_scene_as_committed() {
    let tree =
        Registry::builtin().choose(&format!("sah-hybrid:test={TRIANGLE_TEST}")).expect("it is offered with the test");
    assert_eq!(draw_as_committed(&[tree]), 0);
}

#[test]
#[ignore = "brute force draws every scene: minutes"]
fn every_structure_draws_every_scene_as_committed() {
    let registry = Registry::builtin();
    let mut common: Vec<_> =
        registry.all().into_iter().filter(|choice| choice.triangle_test() == TRIANGLE_TEST).collect();
    assert!(common.len() >= 5, "brute force, two KD-trees and both BVHs share the test");
    common.push(registry.choose("sah-kd").expect("the default test"));
    assert_eq!(draw_as_committed(&common), FINDINGS.len());
}

/// Renders all built-in scenes and fails if a picture differs, except for the findings; returns the number of findings.
fn draw_as_committed(choices: &[Choice]) -> usize {
    let out = Path::new(env!("CARGO_TARGET_TMPDIR")).join("golden");
    let mut wrong = vec![];
    let mut found = 0;
    for builtin in BUILTIN {
        // A real mesh on this machine must not change the picture.
        let scene = builtin.scene(None).expect("a built-in scene is whole");
        let golden = builtin.golden();
        for choice in choices {
            let accel = choice.build(&scene.mesh).expect("a valid mesh builds");
            let finding = FINDINGS.iter().find(|f| f.0 == choice.label && f.1 == scene.name);
            match golden.check(&scene, &choice.label, &*accel, &out) {
                Ok(()) if finding.is_none() => {}
                Err(GoldenError::Differs { difference, .. }) if finding.is_some_and(|f| f.2 == difference.pixels) => {
                    found += 1;
                }
                Ok(()) => {
                    wrong.push(format!("{} draws {} right: the finding is out of date", choice.label, scene.name))
                }
                Err(error) => wrong.push(error.to_string()),
            }
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
    found
}

#[test]
fn alpha_and_depth_of_a_golden_image_count() {
    let committed = Path::new(env!("CARGO_MANIFEST_DIR")).join("scenes/cube/golden.png");
    let colours = read(&committed).unwrap().into_rgb8();
    let mut clear: RgbaImage = DynamicImage::from(colours.clone()).into_rgba8();
    clear.pixels_mut().for_each(|pixel| pixel.0[3] = 0);
    let deep = DynamicImage::from(colours.clone()).into_rgb16();
    assert_eq!(deep.get_pixel(0, 0).0, colours.get_pixel(0, 0).0.map(|value| 257 * u16::from(value)));

    let folder = tempfile::tempdir().unwrap();
    let mut scene = Builtin::find("cube").unwrap().scene(None).unwrap();
    scene.size = [160, 160];
    let tree = Registry::builtin().choose(&format!("sah-kd:test={TRIANGLE_TEST}")).unwrap();
    let accel = tree.build(&scene.mesh).unwrap();
    let own = SceneGolden::file(folder.path(), "cube", ViewKind::Shaded, &scene);
    for (golden, channels, bits) in [(clear.into(), 4, 8), (deep.into(), 3, 16)] {
        write(own.path(), &golden).unwrap();
        let refused = own.check(&scene, "sah-kd", &*accel, &folder.path().join("out")).unwrap_err();
        let GoldenError::Layout { expected, found, .. } = refused else { panic!("{refused}") };
        assert_eq!((expected, found), (Layout { channels, bits, ..found }, Layout::of(&colours.clone().into())));
        let updated = own.update(&scene, &*accel, Overwrite::Own).unwrap();
        assert_eq!(updated, Update::Layout(expected), "it is another picture");
        own.check(&scene, "sah-kd", &*accel, &folder.path().join("out")).unwrap();
        assert_eq!(read(own.path()).unwrap(), read(&committed).unwrap());
    }
}

/// Other formats than PNG.
#[cfg(feature = "pictures")]
mod pictures {
    use std::fs;

    use sahara::golden::{Match, check_image};
    use sahara::image::{ColorType, ImageFormat, Rgb, Rgb32FImage, RgbImage};

    use super::*;

    fn colours() -> RgbImage {
        RgbImage::from_fn(40, 30, |x, y| Rgb([6 * x as u8, 8 * y as u8, 128]))
    }

    fn floats() -> Rgb32FImage {
        Rgb32FImage::from_fn(40, 30, |x, y| Rgb([x as f32 / 7.0, -0.1 * y as f32, 1e-9]))
    }

    /// Writes a width and a height that exceed any memory into the bytes of a picture.
    type Enlarge = fn(&mut [u8]);

    /// A picture of each format, and the function that makes its bytes describe a picture that is too large.
    fn of_each_format() -> [(DynamicImage, ImageFormat, Enlarge); 3] {
        [
            (colours().into(), ImageFormat::Jpeg, |bytes| {
                let frame = place(bytes, b"\xff\xc0");
                bytes[frame + 5..frame + 9].fill(0xff);
            }),
            (colours().into(), ImageFormat::WebP, |bytes| {
                let size = place(bytes, b"VP8L") + 9;
                // Less one, in 14 bits each; the decoder misreads the largest number.
                let side = 16_382_u32;
                let flags = u32::from(bytes[size + 3] & 0xf0) << 24;
                bytes[size..size + 4].copy_from_slice(&(side | side << 14 | flags).to_le_bytes());
            }),
            (floats().into(), ImageFormat::OpenExr, |bytes| {
                for mark in [&b"dataWindow\0box2i\0"[..], b"displayWindow\0box2i\0"] {
                    let corner = place(bytes, mark) + mark.len() + 4 + 8;
                    bytes[corner..corner + 8].copy_from_slice(&[0, 0, 1, 0, 0, 0, 1, 0]);
                }
            }),
        ]
    }

    fn place(bytes: &[u8], mark: &[u8]) -> usize {
        bytes.windows(mark.len()).position(|part| part == mark).unwrap()
    }

    #[test]
    fn golden_images_may_be_jpeg_webp_or_exr() {
        let folder = tempfile::tempdir().unwrap();
        // The name does not determine the format.
        let (golden, out) = (folder.path().join("golden.png"), folder.path().join("out"));
        for (picture, format, _) in of_each_format() {
            picture.save_with_format(&golden, format).unwrap();
            let how = if format == ImageFormat::Jpeg { Match::within(20.0) } else { Match::Exact };
            check_image(&golden, &picture, how, &out).unwrap();
        }
        assert_eq!(read(&golden).unwrap().color(), ColorType::Rgb32F);
        let mut other = floats();
        other.get_pixel_mut(7, 3).0[1] += 0.5;
        let refused = check_image(&golden, &other.into(), Match::within(0.49), &out).unwrap_err().to_string();
        assert!(refused.contains("column 7, row 3, by up to 0.5"), "{refused}");
    }

    #[test]
    fn damaged_pictures_are_refused_in_a_line_that_names_them() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("golden.png");
        for (picture, format, enlarge) in of_each_format() {
            picture.save_with_format(&path, format).unwrap();
            let bytes = fs::read(&path).unwrap();
            let refusal = |bytes: &[u8]| {
                fs::write(&path, bytes).unwrap();
                let refused = read(&path).map(|_| bytes.len()).unwrap_err().to_string();
                assert!(refused.contains("golden.png") && refused.lines().count() == 1, "{format:?}: {refused}");
                refused
            };
            for part in 0..16 {
                refusal(&bytes[..bytes.len() * part / 16]);
            }
            let mut huge = bytes.clone();
            enlarge(&mut huge);
            let refused = refusal(&huge);
            // EXR also contains the number of chunks, which then does not fit.
            let why = if format == ImageFormat::OpenExr { "chunk count" } else { "512 MiB" };
            assert!(refused.contains(why), "{format:?}: {refused}");
        }
    }
}
