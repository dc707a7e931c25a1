//! Tests the commands `golden compare`, `golden check` and `golden update`.

use std::fs;

use sahara::golden::numbers::{packed, unpacked};
use sahara::golden::{read, write as write_picture};
use sahara::image::codecs::png::{CompressionType, FilterType, PngEncoder};
use sahara::image::{DynamicImage, GrayImage, Luma, Rgb, RgbImage};
use serde_json::json as value;

use super::command::{Folder, RIGHT, USAGE, WRONG, assert_contains, json, unwrapped};

impl Folder {
    fn add(&self, name: &str, picture: impl Into<DynamicImage>) {
        write_picture(&self.path(name), &picture.into()).unwrap();
    }

    #[track_caller]
    fn compare(&self, options: &str, status: i32) -> String {
        let [text, _] = self.ends(status, &format!("golden compare expected actual {options}"));
        text
    }
}

fn picture() -> RgbImage {
    RgbImage::from_fn(40, 30, |x, y| Rgb([6 * x as u8, 8 * y as u8, 128]))
}

fn changed(pixels: usize, by: u8) -> RgbImage {
    let mut picture = picture();
    picture.pixels_mut().step_by(7).take(pixels).for_each(|pixel| pixel.0[2] += by);
    picture
}

#[test]
fn folders_of_pictures_are_compared_by_name() {
    let folder = Folder::new();
    for (side, other) in [("expected", picture()), ("actual", changed(9, 2))] {
        folder.add(&format!("{side}/same.png"), picture());
        folder.add(&format!("{side}/deep/er.png"), other);
        folder.write(&format!("{side}/notes.txt"), side);
    }
    let text = folder.compare("", WRONG);
    let difference = "deep/er.png: 9 of 1,200 pixels differ, first at column 0, row 0, by up to 2 of 255";
    assert_contains(&text, &[difference, "1 different, 1 identical"]);
    assert!(!text.contains("notes"), "{text}");
    for (options, accepted) in [
        ("--max-difference 2", true),
        ("--max-difference 1.9", false),
        ("--allow-pixels 9", true),
        ("--allow-pixels 8", false),
        ("--allow-pixels 0.75%", true),
        ("--allow-pixels 0.74%", false),
        ("--max-difference 1 --allow-pixels 9", true),
        ("--max-flip 0.01", true),
        ("--max-flip 0.00001", false),
    ] {
        let text = folder.compare(options, if accepted { RIGHT } else { WRONG });
        assert_eq!(text.contains("1 accepted, 1 identical"), accepted, "{options}: {text}");
    }

    // The message about a failing picture contains the measured value and the limit.
    for (options, sentence, limit) in [
        (
            "--max-difference 1 --allow-pixels 0.7%",
            "9 pixels differ by more than 1 of 255, and 8 are allowed",
            value!({ "max_difference": 1.0, "pixels_over": 9, "allow_pixels": 8 }),
        ),
        ("--max-flip 0", "the mean of FLIP is 0.00", value!({ "max_flip": 0.0 })),
    ] {
        let text = folder.compare(&format!("{options} --export-json run.json"), WRONG);
        assert!(unwrapped(&text).contains(&format!("; {sentence}")), "{text}");
        let own = &json(folder.path("run.json"))["comparisons"][0];
        assert!(own["said"][1].as_str().unwrap().starts_with(sentence), "{own}");
        assert!(limit.as_object().unwrap().iter().all(|(name, value)| own["limit"][name] == *value), "{own}");
    }

    // A missing picture causes the exit status `USAGE` if no picture differs.
    folder.add("expected/gone.png", picture());
    folder.add("actual/new.png", picture());
    let text = folder.compare("--max-difference 2 --export-json run.json", USAGE);
    let sum = "1 missing, 1 additional, 1 accepted, 1 identical";
    assert_contains(&text, &["gone.png: exists in", "new.png: exists in", sum]);
    let run = json(folder.path("run.json"));
    for (i, verdict) in ["accepted", "missing", "additional", "identical"].into_iter().enumerate() {
        assert_eq!(run["comparisons"][i]["verdict"], verdict, "{run}");
    }
    let measures = &run["comparisons"][0]["measures"];
    assert_eq!([&measures["pixels"], &measures["pixels_over"], &measures["compared"]], [9, 0, 1200]);
    assert!(measures["flip"]["mean"].as_f64() > Some(0.0) && measures["ssim"].as_f64() < Some(1.0), "{measures}");

    // A damaged picture counts as failed.
    folder.write("actual/same.png", "no picture");
    assert_contains(&folder.compare("--max-difference 2", USAGE), &["same.png: cannot read", "1 failed"]);
    // If another picture differs, the exit status is `WRONG`.
    folder.compare("", WRONG);
}

#[test]
fn pictures_of_another_layout_and_what_cannot_be_compared_are_told() {
    let folder = Folder::new();
    folder.add("a.png", picture());
    folder.add("rgba.png", DynamicImage::from(picture()).to_rgba8());
    folder.add("deep.png", DynamicImage::from(picture()).to_rgb16());
    folder.add("small.png", RgbImage::new(4, 4));
    for (other, words, advice) in [
        ("rgba", "RGBA with 8", "convert one of the pictures, or replace"),
        ("deep", "RGB with 16", "convert one of the pictures, or replace"),
        ("small", "4 x 4 pixels", "at the size of the golden image, or replace"),
    ] {
        let [text, _] = folder.ends(WRONG, &format!("golden compare a.png {other}.png --max-difference 255"));
        assert_contains(&text, &["40 x 30 pixels of RGB with 8 bits", words, advice]);
    }
    // The PNG encoding does not affect the comparison.
    let file = fs::File::create(folder.path("again.png")).unwrap();
    let theirs = PngEncoder::new_with_quality(file, CompressionType::Uncompressed, FilterType::NoFilter);
    picture().write_with_encoder(theirs).unwrap();
    assert!(fs::read(folder.path("a.png")).unwrap() != fs::read(folder.path("again.png")).unwrap());
    assert_eq!(folder.prints("golden compare a.png again.png"), "1 identical\n");

    fs::create_dir(folder.path("empty")).unwrap();
    for (line, parts) in [
        ("golden compare a.png none.png", &["none.png", "there is no"][..]),
        ("golden compare a.png .", &["a folder and a file"]),
        ("golden compare empty empty", &["no pictures"]),
        // A result must not replace a compared picture.
        ("golden compare a.png a.png --export-json a.png", &["a.png", "an input file"]),
        #[cfg(feature = "page")]
        ("golden compare empty . --page empty/page", &["outside", "empty"]),
        #[cfg(feature = "page")]
        ("golden compare a.png a.png --page .", &["a.png", "another folder"]),
        #[cfg(not(feature = "page"))]
        ("golden check cube --page page", &["--page", "feature `page`"]),
    ] {
        folder.refuses_in_a_line(line, parts);
    }
    for (options, parts) in [
        ("--max-flip 1 --allow-pixels 1", &["cannot be used with"][..]),
        ("--max-flip 5", &["--max-flip", "give a number from 0 to 1"]),
        ("--allow-pixels 101%", &["0.1%"]),
        ("--max-difference -1", &["at least 0"]),
    ] {
        folder.refuses(&format!("golden compare a.png a.png {options}"), parts);
    }
}

#[test]
fn what_is_black_in_the_mask_is_not_compared() {
    let folder = Folder::new();
    let mut other = picture();
    other.put_pixel(3, 4, Rgb([0; 3]));
    folder.add("a.png", picture());
    folder.add("b.png", other);
    folder.ends(WRONG, "golden compare a.png b.png");
    let masked = "golden compare a.png b.png --mask mask.png";
    folder.add("mask.png", GrayImage::from_fn(40, 30, |_, y| Luma([u8::from(y > 9)])));
    folder.shows(masked, &["mask.png: 400 of 1,200 pixels are masked", "1 identical"]);
    folder.add("mask.png", GrayImage::new(40, 30));
    folder.refuses_in_a_line(masked, &["mask.png", "all black"]);
    folder.add("mask.png", GrayImage::from_pixel(4, 3, Luma([9])));
    let [_, message] = folder.ends(USAGE, masked);
    assert!(message.contains("the mask has 4 x 3 pixels"), "{message}");
}

fn with_a_scene() -> Folder {
    let folder = Folder::new();
    folder.write(
        "mine.toml",
        "name = \"Mine\"\ncamera = { eye = [0, 2, 5], target = [0, 0.5, 0], vertical_fov = 45 }\n\
         lights = [{ pos = [3, 5, 4], col = [1, 1, 1] }]\nobjects = [{ mesh = \"cube\" }]\n",
    );
    folder
}

#[test]
fn depths_and_triangles_are_compared_as_numbers() {
    let folder = with_a_scene();
    for (view, changed, words) in [
        ("depth", 100f32.to_bits(), "the golden image has t = 100, and sah-kd gives t = "),
        ("depth", f32::INFINITY.to_bits(), "the golden image has no hit, and sah-kd gives t = "),
        ("primitive", 70_001, "the golden image has triangle 70001, and sah-kd gives triangle "),
    ] {
        let own = format!("mine.toml --size 32x24 --view {view}");
        folder.prints(&format!("golden update {own} --force"));
        let golden = folder.path(&format!("mine.{view}.golden.png"));
        let mut numbers = unpacked(&read(&golden).unwrap()).unwrap();
        numbers[12 * 32 + 16] = changed;
        write_picture(&golden, &packed([32, 24], &numbers)).unwrap();
        let [text, _] = folder.ends(WRONG, &format!("golden check {own} -s sah-kd --export-json run.json"));
        assert_contains(&text, &["1 of 768 pixels differs, first at column 16, row 12", words]);
        let measures = &json(folder.path("run.json"))["comparisons"][0]["measures"];
        assert!(measures["flip"].is_null() && measures["pixels"] == 1, "{measures}");
        assert_eq!(measures["largest"].as_f64().is_some(), changed == 100f32.to_bits(), "{measures}");
    }
}

#[test]
fn scene_files_and_meshes_have_golden_images_beside_them() {
    let folder = with_a_scene();
    let check = |options: &str| format!("golden check mine.toml --size 32x24 -s sah-kd -s sah-bvh {options}");
    let update = |options: &str| folder.prints(&format!("golden update mine.toml --size 32x24 {options}"));
    folder.refuses_in_a_line(&check(""), &["mine.golden.png", "sahara golden update"]);
    for (view, file) in
        [("shaded", "mine.golden.png"), ("depth", "mine.depth.golden.png"), ("primitive", "mine.primitive.golden.png")]
    {
        let view = format!("--view {view}");
        let text = update(&view);
        assert!(text.contains("created") && text.contains(file) && folder.path(file).exists(), "{text}");
        folder.shows(&check(&view), &["identical to the golden image: sah-kd, sah-bvh"]);
        assert!(update(&view).contains("unchanged"));
    }
    let cameras = ["--camera '0,2,5 0,0.5,0 45'", "--camera '0,1,5 0,0,0 30'"];
    folder.refuses_in_a_line(&check(cameras[1]), &cameras);
    let sizes = ["32 x 24 pixels, but 512 x 512", "--size 32x24"];
    folder.refuses_in_a_line("golden check mine.toml -s sah-kd", &sizes);
    folder.refuses(&check("--view heat"), &["heat", "shaded, depth, normal, primitive"]);

    // A file of another program is not replaced without `--force`.
    folder.write("mine.golden.png", "mine");
    folder.refuses_in_a_line("golden update mine.toml --size 32x24", &["mine.golden.png", "--force"]);
    update("--force");
    folder.prints(&check(""));

    for action in ["update", "check"] {
        folder.prints(&format!("golden {action} cube --size 16x16 --view normal --goldens goldens -s sah-hybrid"));
        assert!(folder.path("goldens/cube.normal.golden.png").exists());
    }
    folder.refuses_in_a_line("golden check cube --view depth", &["160 x 160", "depth", "--goldens DIR"]);
    folder.refuses_in_a_line("golden check icosphere:2", &["icosphere:2", "--goldens DIR"]);
}

#[test]
#[cfg(feature = "page")]
fn a_wrong_pixel_is_named_with_its_ray_and_who_is_right() {
    let folder = with_a_scene();
    folder.prints("golden update mine.toml --size 32x24");
    let mut picture = read(&folder.path("mine.golden.png")).unwrap().into_rgb8();
    picture.put_pixel(16, 12, Rgb([1, 2, 3]));
    folder.add("mine.golden.png", picture);

    let line = "golden check mine.toml --size 32x24 -s sah-kd --page page --export-json run.json";
    let [text, _] = folder.ends(WRONG, line);
    let sentences = [
        "Mine with sah-kd: differs from",
        "1 of 768 pixels differs, first at column 16, row 12",
        "the golden image has 1, 2, 3, and sah-kd gives",
        "exact arithmetic confirms sah-kd: the golden image is out of date",
    ];
    assert_contains(&text, &sentences);
    let command = text.lines().find_map(|line| line.trim().strip_prefix("sahara ")).expect("a command");
    let traced = folder.shows(command, &["sah-kd"]);
    assert!(command.starts_with("validate "), "{traced}");
    assert!(folder.path("page/index.html").exists());
    let run = json(folder.path("run.json"));
    assert_eq!(run["comparisons"][0]["command"], format!("sahara {command}"));
    assert_eq!(run["comparisons"][0]["measures"]["worst"], value!([16, 12]));
}
