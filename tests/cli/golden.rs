//! `golden`: pictures of any renderer, and golden images of any scene.

use std::fs;
use std::path::Path;

use sahara::golden::numbers::{packed, unpacked};
use sahara::golden::{read, write as write_picture};
use sahara::image::codecs::png::{CompressionType, FilterType, PngEncoder};
use sahara::image::{DynamicImage, GrayImage, Luma, Rgb, RgbImage};
use tempfile::TempDir;

use super::command::{
    RIGHT, USAGE, WRONG, json, path_text, prints, refuses, refuses_in_a_line, sahara, stdout, words, write,
};

/// Folders of pictures, `expected` and `actual`.
struct Folders(TempDir);

impl Folders {
    fn new() -> Self {
        Self(TempDir::new().unwrap())
    }

    fn path(&self, name: &str) -> String {
        path_text(&self.0.path().join(name))
    }

    fn add(&self, name: &str, picture: impl Into<DynamicImage>) {
        write_picture(Path::new(&self.path(name)), &picture.into()).unwrap();
    }

    /// Compares the folders; returns the status and the output.
    fn compare(&self, options: &str) -> (Option<i32>, String) {
        let (expected, actual) = (self.path("expected"), self.path("actual"));
        let options: Vec<&str> = options.split_whitespace().collect();
        let output = sahara(&[&["golden", "compare", &expected, &actual], &options[..]].concat());
        (output.status.code(), stdout(&output))
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
    let folders = Folders::new();
    for side in ["expected", "actual"] {
        folders.add(&format!("{side}/same.png"), picture());
        folders.add(&format!("{side}/deep/er.png"), if side == "actual" { changed(9, 2) } else { picture() });
        fs::write(folders.path(&format!("{side}/notes.txt")), side).unwrap();
    }
    let (status, text) = folders.compare("");
    assert_eq!(status, Some(WRONG), "{text}");
    assert!(
        text.contains("deep/er.png: 9 of 1,200 pixels differ, first at column 0, row 0, by up to 2 of 255"),
        "{text}"
    );
    assert!(text.contains("1 different, 1 identical") && !text.contains("notes"), "{text}");
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
        let (status, text) = folders.compare(options);
        assert_eq!(status, Some(if accepted { RIGHT } else { WRONG }), "{options}: {text}");
        assert_eq!(text.contains("1 accepted, 1 identical"), accepted, "{options}: {text}");
    }

    // A failing picture names the number that is compared, and its limit.
    let json_file = folders.path("run.json");
    for (options, sentence, limit) in [
        (
            "--max-difference 1 --allow-pixels 0.7%",
            "9 pixels differ by more than 1 of 255, and 8 are allowed",
            serde_json::json!({ "max_difference": 1.0, "pixels_over": 9, "allow_pixels": 8 }),
        ),
        ("--max-flip 0", "the mean of FLIP is 0.00", serde_json::json!({ "max_flip": 0.0 })),
    ] {
        let (status, text) = folders.compare(&format!("{options} --export-json {json_file}"));
        assert_eq!(status, Some(WRONG), "{text}");
        // The terminal breaks lines.
        let line = text.split_whitespace().collect::<Vec<_>>().join(" ");
        assert!(line.contains(&format!("; {sentence}")), "{text}");
        let own = &json(&json_file)["comparisons"][0];
        assert!(own["said"][1].as_str().unwrap().starts_with(sentence), "{own}");
        let is_equal = |(name, value): (&String, &serde_json::Value)| own["limit"][name] == *value;
        assert!(limit.as_object().unwrap().iter().all(is_equal), "{own}");
    }

    // A picture that is missing in one folder is a failure, and less severe than a difference.
    folders.add("expected/gone.png", picture());
    folders.add("actual/new.png", picture());
    let (status, text) = folders.compare(&format!("--max-difference 2 --export-json {json_file}"));
    assert_eq!(status, Some(USAGE), "{text}");
    assert!(text.contains("gone.png: exists in") && text.contains("new.png: exists in"), "{text}");
    assert!(text.contains("1 missing, 1 additional, 1 accepted, 1 identical"), "{text}");
    let run = json(&json_file);
    let verdicts = ["accepted", "missing", "additional", "identical"];
    for (i, verdict) in verdicts.iter().enumerate() {
        assert_eq!(run["comparisons"][i]["verdict"], *verdict, "{run}");
    }
    let measures = &run["comparisons"][0]["measures"];
    assert_eq!([&measures["pixels"], &measures["pixels_over"], &measures["compared"]], [9, 0, 1200]);
    assert!(measures["flip"]["mean"].as_f64() > Some(0.0) && measures["ssim"].as_f64() < Some(1.0), "{measures}");

    // A damaged picture fails, and all others are compared.
    fs::write(folders.path("actual/same.png"), "no picture").unwrap();
    let (status, text) = folders.compare("--max-difference 2");
    assert_eq!(status, Some(USAGE));
    assert!(text.contains("same.png: cannot read") && text.contains("1 failed"), "{text}");
    assert_eq!(folders.compare("").0, Some(WRONG), "a difference weighs more");
}

#[test]
fn pictures_of_another_layout_and_what_cannot_be_compared_are_told() {
    let folders = Folders::new();
    folders.add("a.png", picture());
    folders.add("rgba.png", DynamicImage::from(picture()).to_rgba8());
    folders.add("deep.png", DynamicImage::from(picture()).to_rgb16());
    folders.add("small.png", RgbImage::new(4, 4));
    for (other, words, advice) in [
        ("rgba", "RGBA with 8", "convert one of the pictures, or replace"),
        ("deep", "RGB with 16", "convert one of the pictures, or replace"),
        ("small", "4 x 4 pixels", "at the size of the golden image, or replace"),
    ] {
        let paths = [folders.path("a.png"), folders.path(&format!("{other}.png"))];
        let output = sahara(&["golden", "compare", &paths[0], &paths[1], "--max-difference", "255"]);
        assert_eq!(output.status.code(), Some(WRONG));
        let text = stdout(&output);
        assert!(["40 x 30 pixels of RGB with 8 bits", words, advice].iter().all(|part| text.contains(part)), "{text}");
    }
    // The same picture in other bytes is identical.
    let file = fs::File::create(folders.path("again.png")).unwrap();
    let theirs = PngEncoder::new_with_quality(file, CompressionType::Uncompressed, FilterType::NoFilter);
    picture().write_with_encoder(theirs).unwrap();
    assert!(fs::read(folders.path("a.png")).unwrap() != fs::read(folders.path("again.png")).unwrap());
    assert_eq!(prints(&["golden", "compare", &folders.path("a.png"), &folders.path("again.png")]), "1 identical\n");

    let [a, none, folder] = ["a.png", "none.png", ""].map(|name| folders.path(name));
    refuses_in_a_line(&["golden", "compare", &a, &none], &["none.png", "there is no"]);
    refuses_in_a_line(&["golden", "compare", &a, &folder], &["a folder and a file"]);
    fs::create_dir(folders.path("empty")).unwrap();
    let empty = folders.path("empty");
    refuses_in_a_line(&["golden", "compare", &empty, &empty], &["no pictures"]);
    refuses(&["golden", "compare", &a, &a, "--max-flip", "1", "--allow-pixels", "1"], &["cannot be used with"]);
    refuses(&["golden", "compare", &a, &a, "--max-flip", "5"], &["--max-flip", "give a number from 0 to 1"]);
    refuses(&["golden", "compare", &a, &a, "--allow-pixels", "101%"], &["0.1%"]);
    refuses(&["golden", "compare", &a, &a, "--max-difference", "-1"], &["at least 0"]);
    // Neither result may replace a compared picture.
    if cfg!(feature = "page") {
        let inside = folders.path("empty/page");
        refuses_in_a_line(&["golden", "compare", &empty, &folder, "--page", &inside], &["outside", "empty"]);
        refuses_in_a_line(&["golden", "compare", &a, &a, "--page", &folder], &["a.png", "another folder"]);
    }
    refuses_in_a_line(&["golden", "compare", &a, &a, "--export-json", &a], &["a.png", "an input file"]);
}

#[test]
fn what_is_black_in_the_mask_is_not_compared() {
    let folders = Folders::new();
    let mut other = picture();
    other.put_pixel(3, 4, Rgb([0; 3]));
    folders.add("a.png", picture());
    folders.add("b.png", other);
    let [a, b, mask] = ["a.png", "b.png", "mask.png"].map(|name| folders.path(name));
    assert_eq!(sahara(&["golden", "compare", &a, &b]).status.code(), Some(WRONG));
    folders.add("mask.png", GrayImage::from_fn(40, 30, |_, y| Luma([u8::from(y > 9)])));
    let text = prints(&["golden", "compare", &a, &b, "--mask", &mask]);
    assert!(text.contains("mask.png: 400 of 1,200 pixels are masked") && text.contains("1 identical"), "{text}");
    folders.add("mask.png", GrayImage::new(40, 30));
    refuses_in_a_line(&["golden", "compare", &a, &b, "--mask", &mask], &["mask.png", "all black"]);
    folders.add("mask.png", GrayImage::from_pixel(4, 3, Luma([9])));
    let output = sahara(&["golden", "compare", &a, &b, "--mask", &mask]);
    let message = String::from_utf8_lossy(&output.stderr).into_owned();
    assert_eq!(output.status.code(), Some(USAGE));
    assert!(message.contains("the mask has 4 x 3 pixels"), "{message}");
}

#[test]
fn depths_and_triangles_are_compared_as_numbers() {
    let directory = TempDir::new().unwrap();
    let scene = write(&directory, "mine.toml", SCENE);
    let export = path_text(&directory.path().join("run.json"));
    for (view, changed, words) in [
        ("depth", 100f32.to_bits(), "the golden image has t = 100, and sah-kd gives t = "),
        ("depth", f32::INFINITY.to_bits(), "the golden image has no hit, and sah-kd gives t = "),
        ("primitive", 70_001, "the golden image has triangle 70001, and sah-kd gives triangle "),
    ] {
        let own = ["--size", "32x24", "--view", view];
        prints(&[&["golden", "update", &scene, "--force"], &own[..]].concat());
        let golden = directory.path().join(format!("mine.{view}.golden.png"));
        let mut numbers = unpacked(&read(&golden).unwrap()).unwrap();
        numbers[12 * 32 + 16] = changed;
        write_picture(&golden, &packed([32, 24], &numbers)).unwrap();
        let output =
            sahara(&[&["golden", "check", &scene, "-s", "sah-kd", "--export-json", &export], &own[..]].concat());
        let text = stdout(&output);
        assert_eq!(output.status.code(), Some(WRONG), "{text}");
        assert!(text.contains("1 of 768 pixels differs, first at column 16, row 12") && text.contains(words), "{text}");
        let measures = &json(&export)["comparisons"][0]["measures"];
        assert!(measures["flip"].is_null() && measures["pixels"] == 1, "{measures}");
        assert_eq!(measures["largest"].as_f64().is_some(), changed == 100f32.to_bits(), "{measures}");
    }
}

/// A user's scene.
const SCENE: &str = "name = \"Mine\"\ncamera = { eye = [0, 2, 5], target = [0, 0.5, 0], vertical_fov = 45 }\n\
                     lights = [{ pos = [3, 5, 4], col = [1, 1, 1] }]\nobjects = [{ mesh = \"cube\" }]\n";

#[test]
fn scene_files_and_meshes_have_golden_images_beside_them() {
    let directory = TempDir::new().unwrap();
    let scene = write(&directory, "mine.toml", SCENE);
    let small = ["--size", "32x24", "-s", "sah-kd", "-s", "sah-bvh"];
    let check = |view: &'static str| [&["golden", "check", &scene, "--view", view], &small[..]].concat();
    refuses_in_a_line(&check("shaded"), &["mine.golden.png", "sahara golden update"]);
    for (view, file) in
        [("shaded", "mine.golden.png"), ("depth", "mine.depth.golden.png"), ("primitive", "mine.primitive.golden.png")]
    {
        let text = prints(&["golden", "update", &scene, "--size", "32x24", "--view", view]);
        assert!(text.contains("created") && text.contains(file), "{text}");
        assert!(directory.path().join(file).exists());
        let text = prints(&check(view));
        assert!(text.contains("identical bytes with sah-kd, sah-bvh"), "{text}");
        assert!(prints(&["golden", "update", &scene, "--size", "32x24", "--view", view]).contains("unchanged"));
    }
    refuses_in_a_line(&["golden", "check", &scene, "-s", "sah-kd"], &["32 x 24 pixels, but 512 x 512", "--size 32x24"]);
    let moved = [&check("shaded")[..], &["--camera", "0,1,5 0,0,0 30"]].concat();
    refuses_in_a_line(&moved, &["--camera '0,2,5 0,0.5,0 45'", "--camera '0,1,5 0,0,0 30'"]);
    refuses(&check("heat"), &["heat", "shaded, depth, normal, primitive"]);

    // A picture of another program is not replaced.
    let golden = directory.path().join("mine.golden.png");
    fs::write(&golden, "mine").unwrap();
    refuses_in_a_line(&["golden", "update", &scene, "--size", "32x24"], &["mine.golden.png", "--force"]);
    prints(&["golden", "update", &scene, "--size", "32x24", "--force"]);
    prints(&check("shaded"));

    // In a folder.
    let goldens = path_text(&directory.path().join("goldens"));
    prints(&["golden", "update", "cube", "--size", "16x16", "--view", "normal", "--goldens", &goldens]);
    assert!(Path::new(&goldens).join("cube.normal.golden.png").exists());
    let own = ["--size", "16x16", "--view", "normal", "--goldens", &goldens, "-s", "sah-hybrid"];
    prints(&[&["golden", "check", "cube"], &own[..]].concat());
    refuses_in_a_line(&["golden", "check", "cube", "--view", "depth"], &["160 x 160", "depth", "--goldens DIR"]);
    refuses_in_a_line(&["golden", "check", "icosphere:2"], &["icosphere:2", "--goldens DIR"]);
}

#[test]
#[cfg(not(feature = "page"))]
fn a_page_is_refused_by_a_program_that_makes_none() {
    refuses_in_a_line(&["golden", "check", "cube", "--page", "page"], &["--page", "feature `page`"]);
}

#[test]
#[cfg(feature = "page")]
fn a_wrong_pixel_is_named_with_its_ray_and_who_is_right() {
    let directory = TempDir::new().unwrap();
    let scene = write(&directory, "mine.toml", SCENE);
    let golden = directory.path().join("mine.golden.png");
    prints(&["golden", "update", &scene, "--size", "32x24"]);
    let mut picture = read(&golden).unwrap().into_rgb8();
    picture.put_pixel(16, 12, Rgb([1, 2, 3]));
    write_picture(&golden, &picture.into()).unwrap();

    let page = path_text(&directory.path().join("page"));
    let export = path_text(&directory.path().join("run.json"));
    let args =
        ["golden", "check", &scene, "--size", "32x24", "-s", "sah-kd", "--page", &page, "--export-json", &export];
    let output = super::command::command(&args).current_dir(directory.path()).output().unwrap();
    let text = stdout(&output);
    assert_eq!(output.status.code(), Some(WRONG), "{text}");
    assert!(
        text.contains("Mine with sah-kd: differs from")
            && text.contains("1 of 768 pixels differs, first at column 16, row 12"),
        "{text}"
    );
    assert!(text.contains("the golden image has 1, 2, 3, and sah-kd gives"), "{text}");
    assert!(text.contains("exact arithmetic confirms sah-kd: the golden image is out of date"), "{text}");
    let command = text.lines().find_map(|line| line.trim().strip_prefix("sahara validate ")).expect("a command");
    let (words_before, ray) = command.split_once(" \"").unwrap();
    let traced = prints(&[&["validate"], &words(words_before)[..], &[ray.trim_end_matches('"')]].concat());
    assert!(traced.contains("sah-kd"), "{traced}");
    assert!(Path::new(&page).join("index.html").exists());
    let run = json(&export);
    assert_eq!(run["comparisons"][0]["command"], format!("sahara validate {command}"));
    assert_eq!(run["comparisons"][0]["measures"]["worst"], serde_json::json!([16, 12]));
}
