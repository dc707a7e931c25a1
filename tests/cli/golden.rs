//! `golden`: pictures of any renderer, and golden images of any scene.

use std::fs;
use std::path::Path;

use sahara::golden::numbers::{packed, unpacked};
use sahara::golden::{read, write as write_picture};
use sahara::image::codecs::png::{CompressionType, FilterType, PngEncoder};
use sahara::image::{DynamicImage, GrayImage, Luma, Rgb, RgbImage};
use tempfile::TempDir;

use super::command::{
    RIGHT, USAGE, WRONG, at, command, ends, json, prints, refuses, refuses_in_a_line, unwrapped, words, write,
};

/// Folders of pictures, `expected` and `actual`.
struct Folders(TempDir);

impl Folders {
    fn new() -> Self {
        Self(TempDir::new().unwrap())
    }

    fn path(&self, name: &str) -> String {
        at(&self.0, name)
    }

    fn add(&self, name: &str, picture: impl Into<DynamicImage>) {
        write_picture(Path::new(&self.path(name)), &picture.into()).unwrap();
    }

    /// Compares the folders, which must end with this status; returns the output.
    #[track_caller]
    fn compare(&self, options: &str, status: i32) -> String {
        let line = format!("golden compare {} {} {options}", self.path("expected"), self.path("actual"));
        ends(status, &mut command(&words(line.trim_end()))).0
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
    let text = folders.compare("", WRONG);
    let difference = "deep/er.png: 9 of 1,200 pixels differ, first at column 0, row 0, by up to 2 of 255";
    assert!(text.contains(difference) && text.contains("1 different, 1 identical"), "{text}");
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
        let text = folders.compare(options, if accepted { RIGHT } else { WRONG });
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
        let text = folders.compare(&format!("{options} --export-json {json_file}"), WRONG);
        assert!(unwrapped(&text).contains(&format!("; {sentence}")), "{text}");
        let own = &json(&json_file)["comparisons"][0];
        assert!(own["said"][1].as_str().unwrap().starts_with(sentence), "{own}");
        let is_equal = |(name, value): (&String, &serde_json::Value)| own["limit"][name] == *value;
        assert!(limit.as_object().unwrap().iter().all(is_equal), "{own}");
    }

    // A picture that is missing in one folder is a failure, and less severe than a difference.
    folders.add("expected/gone.png", picture());
    folders.add("actual/new.png", picture());
    let text = folders.compare(&format!("--max-difference 2 --export-json {json_file}"), USAGE);
    assert!(text.contains("gone.png: exists in") && text.contains("new.png: exists in"), "{text}");
    assert!(text.contains("1 missing, 1 additional, 1 accepted, 1 identical"), "{text}");
    let run = json(&json_file);
    for (i, verdict) in ["accepted", "missing", "additional", "identical"].into_iter().enumerate() {
        assert_eq!(run["comparisons"][i]["verdict"], verdict, "{run}");
    }
    let measures = &run["comparisons"][0]["measures"];
    assert_eq!([&measures["pixels"], &measures["pixels_over"], &measures["compared"]], [9, 0, 1200]);
    assert!(measures["flip"]["mean"].as_f64() > Some(0.0) && measures["ssim"].as_f64() < Some(1.0), "{measures}");

    // A damaged picture fails, and all others are compared.
    fs::write(folders.path("actual/same.png"), "no picture").unwrap();
    let text = folders.compare("--max-difference 2", USAGE);
    assert!(text.contains("same.png: cannot read") && text.contains("1 failed"), "{text}");
    // A difference is more severe.
    folders.compare("", WRONG);
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
        let [one, other] = ["a", other].map(|name| folders.path(&format!("{name}.png")));
        let mut compare = command(&["golden", "compare", &one, &other, "--max-difference", "255"]);
        let (text, _) = ends(WRONG, &mut compare);
        assert!(["40 x 30 pixels of RGB with 8 bits", words, advice].iter().all(|part| text.contains(part)), "{text}");
    }
    // The same picture in other bytes is identical.
    let file = fs::File::create(folders.path("again.png")).unwrap();
    let theirs = PngEncoder::new_with_quality(file, CompressionType::Uncompressed, FilterType::NoFilter);
    picture().write_with_encoder(theirs).unwrap();
    let [a, again, none, folder] = ["a.png", "again.png", "none.png", ""].map(|name| folders.path(name));
    assert!(fs::read(&a).unwrap() != fs::read(&again).unwrap());
    assert_eq!(prints(&["golden", "compare", &a, &again]), "1 identical\n");

    refuses_in_a_line(&["golden", "compare", &a, &none], &["none.png", "there is no"]);
    refuses_in_a_line(&["golden", "compare", &a, &folder], &["a folder and a file"]);
    let empty = folders.path("empty");
    fs::create_dir(&empty).unwrap();
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
    ends(WRONG, &mut command(&["golden", "compare", &a, &b]));
    folders.add("mask.png", GrayImage::from_fn(40, 30, |_, y| Luma([u8::from(y > 9)])));
    let text = prints(&["golden", "compare", &a, &b, "--mask", &mask]);
    assert!(text.contains("mask.png: 400 of 1,200 pixels are masked") && text.contains("1 identical"), "{text}");
    folders.add("mask.png", GrayImage::new(40, 30));
    refuses_in_a_line(&["golden", "compare", &a, &b, "--mask", &mask], &["mask.png", "all black"]);
    folders.add("mask.png", GrayImage::from_pixel(4, 3, Luma([9])));
    let (_, message) = ends(USAGE, &mut command(&["golden", "compare", &a, &b, "--mask", &mask]));
    assert!(message.contains("the mask has 4 x 3 pixels"), "{message}");
}

#[test]
fn depths_and_triangles_are_compared_as_numbers() {
    let directory = TempDir::new().unwrap();
    let scene = write(&directory, "mine.toml", SCENE);
    let export = at(&directory, "run.json");
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
        let check = ["golden", "check", &scene, "-s", "sah-kd", "--export-json", &export];
        let (text, _) = ends(WRONG, &mut command(&[&check, &own[..]].concat()));
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
    let goldens = at(&directory, "goldens");
    let own = ["cube", "--size", "16x16", "--view", "normal", "--goldens", &goldens, "-s", "sah-hybrid"];
    for action in ["update", "check"] {
        prints(&[&["golden", action], &own[..]].concat());
        assert!(Path::new(&goldens).join("cube.normal.golden.png").exists());
    }
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

    let [page, export] = ["page", "run.json"].map(|name| at(&directory, name));
    let line = format!("golden check {scene} --size 32x24 -s sah-kd --page {page} --export-json {export}");
    let (text, _) = ends(WRONG, command(&words(&line)).current_dir(directory.path()));
    for part in [
        "Mine with sah-kd: differs from",
        "1 of 768 pixels differs, first at column 16, row 12",
        "the golden image has 1, 2, 3, and sah-kd gives",
        "exact arithmetic confirms sah-kd: the golden image is out of date",
    ] {
        assert!(text.contains(part), "{part:?} is not in {text}");
    }
    let command = text.lines().find_map(|line| line.trim().strip_prefix("sahara validate ")).expect("a command");
    let (words_before, ray) = command.split_once(" \"").unwrap();
    let traced = prints(&[&["validate"], &words(words_before)[..], &[ray.trim_end_matches('"')]].concat());
    assert!(traced.contains("sah-kd"), "{traced}");
    assert!(Path::new(&page).join("index.html").exists());
    let run = json(&export);
    assert_eq!(run["comparisons"][0]["command"], format!("sahara validate {command}"));
    assert_eq!(run["comparisons"][0]["measures"]["worst"], serde_json::json!([16, 12]));
}
