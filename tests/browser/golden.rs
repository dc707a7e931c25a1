//! Tests the page of `golden compare` in a browser.

use std::path::PathBuf;
use std::sync::LazyLock;

use sahara::golden::write;
use serde_json::json;

use super::chromium::Chromium;
use super::{assert_readable_everywhere, tab_to};
use crate::cli::command::{Folder, WRONG};
use crate::controls::{SIZE, pictures};

/// The headings that precede the heading "Identical".
const NAMES: [&str; 7] = ["0.png", "1.png", "2.png", "3.png", "gone.png", "4.png", "5.png"];

fn page() -> PathBuf {
    static PAGE: LazyLock<Folder> = LazyLock::new(|| {
        let folder = Folder::new();
        let add = |name: &str, picture| write(&folder.path(name), picture).unwrap();
        let (right, others) = pictures();
        for (i, (_, other)) in others.iter().enumerate() {
            add(&format!("a/{i}.png"), &right);
            add(&format!("b/{i}.png"), other);
        }
        ["a/same.png", "b/same.png", "a/gone.png"].iter().for_each(|name| add(name, &right));
        // `--max-difference 2` accepts `4.png` and `5.png`.
        folder.ends(WRONG, "golden compare a b --max-difference 2 --page page");
        folder
    });
    PAGE.path("page/index.html")
}

/// Waits until the values of the selected pixel are loaded.
fn pixel(browser: &mut Chromium, number: usize) -> String {
    let text = format!("document.querySelector('#comparison-{number} .pixel').textContent");
    browser.text_once(&text, |shown| shown.contains("expected"))
}

fn property(name: &str) -> String {
    format!("document.querySelector('#comparison-0 .stage').style.getPropertyValue('--{name}')")
}

#[test]
fn failing_comparisons_are_first_and_all_is_reached_by_keyboard_alone() {
    let Some(mut browser) = Chromium::launch() else { return };
    browser.open(&page(), 1400, false);
    let names = "[...document.querySelectorAll('h2')].map((head) => head.firstChild.textContent.trim())";
    assert_eq!(browser.evaluate(names), json!([&NAMES[..], &["Identical"]].concat()));
    assert_eq!(browser.text("document.querySelector('.summary strong').textContent"), "5 of 8 failing");

    // The page initially selects the worst pixel.
    let (right, others) = pictures();
    let expected = |[x, y]: [u32; 2]| {
        let [expected, actual] = [&right, &others[0].1]
            .map(|picture| picture.as_rgb8().unwrap().get_pixel(x, y).0.map(|value| value.to_string()).join(", "));
        format!("Column {x}, row {y}: expected {expected}; actual {actual}")
    };
    assert_eq!(pixel(&mut browser, 0), expected([100, 80]));
    tab_to(&mut browser, "#comparison-0 .stage");
    browser.press("ArrowRight");
    browser.press("ArrowUp");
    assert_eq!(pixel(&mut browser, 0), expected([101, 79]));

    // Key `w` zooms to the worst pixel. Key `z` resets the zoom. Key `b` alternates between the two pictures.
    assert!(browser.text(&property("zoom")).ends_with("scale(1)"));
    browser.press("w");
    assert_eq!(pixel(&mut browser, 0), expected([100, 80]));
    assert!(browser.text(&property("zoom")).ends_with("scale(12)"), "{}", SIZE[1] / 16);
    browser.press("z");
    assert!(browser.text(&property("zoom")).ends_with("scale(1)"));
    assert_eq!(browser.text(&property("cut")), "50%");
    browser.press("b");
    for cut in ["100%", "0%", "100%"] {
        browser.text_once(&property("cut"), |own| own == cut);
    }
    browser.press("b");
    assert_eq!(browser.text(&property("cut")), "50%");
    tab_to(&mut browser, "#comparison-0 input");
    browser.press("ArrowLeft");
    assert_eq!(browser.text(&property("cut")), "49%");

    browser.press("n");
    let own = "document.activeElement.closest('section').id";
    assert_eq!(browser.text(own), "comparison-1");
    tab_to(&mut browser, "#comparison-1 [data-side=\"1\"], #comparison-2 select");
    assert_eq!(browser.text(own), "comparison-2", "tabulator goes on to the next");
    browser.press("ArrowDown");
    let shown = "document.querySelector('#comparison-2 .stage img').src.split('/').pop()";
    assert_eq!(browser.text(shown), "2-actual.png");
}

#[test]
fn the_pointer_shows_values_and_the_page_is_read_in_light_and_dark_on_a_desk_and_on_a_telephone() {
    assert_readable_everywhere(page, |browser| {
        browser.click("#comparison-2 .stage", [0.25, 0.75]);
        let shown = pixel(browser, 2);
        let [column, row] = [SIZE[0] / 4, SIZE[1] * 3 / 4];
        let at = |x: u32, y: u32| shown.starts_with(&format!("Column {x}, row {y}:"));
        let is_near = (column - 1..=column + 1).any(|x| (row - 1..=row + 1).any(|y| at(x, y)));
        assert!(is_near, "{shown}");
        let broken = "[...document.images].filter((own) => own.complete && !own.naturalWidth).length";
        assert_eq!(browser.evaluate(broken), 0);
    });
}
