//! Compares pictures of the built-in scenes with the golden images.

use std::path::Path;

use sahara::builtin::BUILTIN;
use sahara::golden::{GoldenError, TRIANGLE_TEST};
use sahara::registry::{Choice, Registry};
use sahara::request::{is_obvhs, known_defect};

/// Structure, scene and number of pixels that differ.
///
/// On an edge between two walls of the Cornell box, obvhs may return either wall. obvhs-cwbvh also loses one
/// hit, because its boxes have no margin.
const FINDINGS: [(&str, &str, usize); 2] =
    [("obvhs-bvh2:test=exact", "Cornellbox", 103), ("obvhs-cwbvh:test=exact", "Cornellbox", 49)];

#[test]
fn a_tree_draws_every_scene_as_committed() {
    let tree = Registry::builtin().choose(&format!("sah-hybrid:test={TRIANGLE_TEST}")).unwrap();
    assert_eq!(draw_as_committed(&[tree]), []);
}

#[test]
#[ignore = "brute force draws every scene: minutes"]
fn every_structure_draws_every_scene_as_committed() {
    let mut common = Registry::builtin().all();
    let is_peer = |name: &str| known_defect(name).is_some() && !is_obvhs(name);
    common.retain(|choice| choice.triangle_test() == TRIANGLE_TEST && !is_peer(&choice.entry.name));
    assert!(common.len() >= 5, "brute force, two KD-trees and both BVHs share the test");
    let expected = FINDINGS.map(|(structure, scene, pixels)| (structure.to_owned(), scene.to_owned(), pixels));
    assert_eq!(draw_as_committed(&common), expected);
}

fn draw_as_committed(choices: &[Choice]) -> Vec<(String, String, usize)> {
    let out = Path::new(env!("CARGO_TARGET_TMPDIR")).join("golden");
    let mut differing = vec![];
    for builtin in BUILTIN {
        // `None`: generated meshes replace the downloaded meshes.
        let scene = builtin.scene(None).expect("built-in scenes are valid");
        let golden = builtin.golden();
        for choice in choices {
            let accel = choice.build(&scene.mesh).expect("a valid mesh builds");
            match golden.check(&scene, &choice.label, &*accel, &out) {
                Ok(()) => {}
                Err(GoldenError::Differs { difference, .. }) => {
                    differing.push((choice.label.clone(), scene.name.clone(), difference.pixels));
                }
                Err(error) => panic!("{error}"),
            }
        }
    }
    differing
}

/// Golden images in formats other than PNG.
#[cfg(feature = "pictures")]
mod pictures {
    use std::fs;

    use sahara::golden::{Match, check_image, read};
    use sahara::image::{ColorType, DynamicImage, ImageFormat, Rgb, Rgb32FImage, RgbImage};

    fn colours() -> RgbImage {
        RgbImage::from_fn(40, 30, |x, y| Rgb([6 * x as u8, 8 * y as u8, 128]))
    }

    fn floats() -> Rgb32FImage {
        Rgb32FImage::from_fn(40, 30, |x, y| Rgb([x as f32 / 7.0, -0.1 * y as f32, 1e-9]))
    }

    /// Writes a huge width and height into the bytes of a picture.
    type Enlarge = fn(&mut [u8]);

    fn of_each_format() -> [(DynamicImage, ImageFormat, Enlarge); 3] {
        [
            (colours().into(), ImageFormat::Jpeg, |bytes| {
                let frame = place(bytes, b"\xff\xc0");
                bytes[frame + 5..frame + 9].fill(0xff);
            }),
            (colours().into(), ImageFormat::WebP, |bytes| {
                let size = place(bytes, b"VP8L") + 9;
                // WebP stores width - 1 and height - 1 in 14 bits each. The decoder misreads the largest value.
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
        // The extension of a file name does not determine the format.
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
            // The number of chunks in an EXR file contradicts the changed size.
            let why = if format == ImageFormat::OpenExr { "chunk count" } else { "512 MiB" };
            assert!(refused.contains(why), "{format:?}: {refused}");
        }
    }
}
