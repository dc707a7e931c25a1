//! Tests HTML pages in Chromium. The tests are skipped if Chromium is not installed.

mod chromium;
#[cfg(feature = "page")]
mod golden;

use std::path::PathBuf;
use std::sync::LazyLock;

use serde_json::json;

use crate::cli::command::{Folder, command, output_texts};
use chromium::Chromium;

/// Some structures of this report have wrong hits in some pixels.
fn report() -> PathBuf {
    static REPORT: LazyLock<Folder> = LazyLock::new(|| {
        let folder = Folder::new();
        let structures = "-s median-kd -s sah-kd -s sah-kd:test=moller-trumbore -s obvhs-bvh2";
        let few = "--rays 300 --runs 1 --epochs 2 --budget 1 --export-json run.json";
        folder.prints(&format!("compare torus cube {structures} {few}"));
        folder.prints("report run.json -o page");
        folder
    });
    REPORT.path("page/index.html")
}

fn tab_to(browser: &mut Chromium, selector: &str) {
    for _ in 0..500 {
        browser.press("Tab");
        if browser.evaluate(&format!("document.activeElement.matches('{selector}')")) == true {
            return;
        }
    }
    panic!("the focus never comes to {selector}");
}

const HEAT: &str = "#figure-heat-torus";
const ERRORS: &str = "#figure-errors-torus";

/// Column and row of the selected pixel of a figure.
fn pixel(browser: &mut Chromium, figure: &str) -> [i64; 2] {
    let shown = browser.text(&format!("document.querySelector('{figure} .pixel').textContent"));
    let numbers = shown.strip_prefix("Pixel ").and_then(|rest| rest.split(" from").next());
    let numbers = numbers.unwrap_or_else(|| panic!("no pixel: {shown}"));
    let (column, row) = numbers.split_once(", ").unwrap();
    [column, row].map(|number| number.parse().unwrap())
}

fn rows(browser: &mut Chromium, figure: &str) -> Vec<Vec<String>> {
    let rows = browser.evaluate(&format!(
        "[...document.querySelectorAll('{figure} .inspector tbody tr')].map((row) => [...row.cells].map((cell) => cell.textContent))"
    ));
    serde_json::from_value(rows).unwrap()
}

fn inspector_output(browser: &mut Chromium, figure: &str) -> String {
    let line = browser.text(&format!("document.querySelector('{figure} .inspector code').textContent"));
    let [text, _] = output_texts(&command(line.strip_prefix("sahara ").expect("a command")).output().unwrap());
    text
}

#[test]
fn the_ray_inspector_works_by_keyboard_alone_and_shows_what_the_command_prints() {
    let Some(mut browser) = Chromium::launch() else { return };
    browser.open(&report(), 1400, false);
    tab_to(&mut browser, &format!("{HEAT} .stage"));
    let start = pixel(&mut browser, HEAT);
    for (key, [across, down]) in
        [("ArrowRight", [1, 0]), ("ArrowUp", [0, -1]), ("ArrowLeft", [-1, 0]), ("ArrowDown", [0, 1])]
    {
        let before = pixel(&mut browser, HEAT);
        browser.press(key);
        let after = pixel(&mut browser, HEAT);
        assert_eq!([0, 1].map(|i| i64::signum(after[i] - before[i])), [across, down], "{key}");
    }
    assert_eq!(pixel(&mut browser, HEAT), start);

    for _ in 0..30 {
        if rows(&mut browser, HEAT)[0][4] != "no hit" {
            break;
        }
        browser.press("ArrowDown");
    }
    let shown = rows(&mut browser, HEAT);
    assert_eq!(shown[0][0], "exact arithmetic");
    assert_eq!(shown.len(), 5, "{shown:?}");
    let printed = inspector_output(&mut browser, HEAT);
    for row in &shown[1..] {
        assert!(row[1..4].iter().all(|count| count.parse::<u64>().is_ok()), "{row:?}");
        let [t, triangle, u, v] = [&row[4], &row[5], &row[6], &row[7]];
        // The command omits the name of a structure if the row above has the same name.
        let name = row[0].split_once(':').map_or(row[0].as_str(), |(_, keys)| keys);
        let is_line = |line: &&str| [name, t, triangle, u, v].iter().all(|cell| line.contains(cell));
        assert!(u.len() > 5 && printed.lines().any(|line| is_line(&line)), "{row:?} is not in {printed}");
    }

    browser.press("Enter");
    // The page copies the command asynchronously.
    let text = format!("document.querySelector('{HEAT} .pixel').textContent");
    let shown = browser.text_once(&text, |shown| shown.starts_with("Command "));
    assert!(shown.contains("copied") || shown.contains("selected"), "{shown}");
}

#[test]
fn a_click_asks_the_nearest_pixel_of_any_picture() {
    let Some(mut browser) = Chromium::launch() else { return };
    browser.open(&report(), 1400, true);
    for (selector, [across, down]) in [(".stage", [0.25, 0.4]), (".maps li:nth-child(2) img", [0.7, 0.6])] {
        browser.click(&format!("{HEAT} {selector}"), [across, down]);
        let [column, row] = pixel(&mut browser, HEAT);
        let off = [column as f64 - 320.0 * across, row as f64 - 320.0 * down];
        assert!(off.iter().all(|off| off.abs() < 8.0), "{column}, {row}");
    }
    // A click on the border between two structures selects no pixel.
    let before = pixel(&mut browser, HEAT);
    browser.click(&format!("{HEAT} .stage"), [0.5, 0.9]);
    assert_eq!(pixel(&mut browser, HEAT), before);

    // In a picture of errors, only pixels with a wrong hit can be selected.
    browser.click(&format!("{ERRORS} .stage"), [0.9, 0.9]);
    for _ in 0..5 {
        let shown = rows(&mut browser, ERRORS);
        let wrong = ["missed", "false hit", "wrong depth", "wrong primitive"];
        let names = shown.iter().filter(|row| wrong.iter().any(|wrong| row[0].contains(wrong)));
        let names: Vec<&str> = names.map(|row| row[0].split(' ').next().unwrap()).collect();
        assert!(!names.is_empty() && !names.contains(&"median-kd") && !names.contains(&"sah-kd"), "{shown:?}");
        browser.press("PageUp");
    }
}

/// A script that returns the texts whose contrast is below the limit of WCAG.
const PALE: &str = include_str!("pale.js");

/// A script that reports content to the right of the visible area.
const WIDE: &str = include_str!("wide.js");

fn assert_readable_everywhere(page: impl Fn() -> PathBuf, look: impl Fn(&mut Chromium)) {
    let Some(mut browser) = Chromium::launch() else { return };
    for (width, dark) in [(1400, false), (1400, true), (400, false), (400, true)] {
        browser.open(&page(), width, dark);
        look(&mut browser);
        let paper = browser.text("getComputedStyle(document.documentElement).backgroundColor");
        assert_eq!(paper == "rgb(255, 255, 255)", !dark, "{paper}");
        assert_eq!(browser.evaluate(PALE), json!([]), "{width}, dark: {dark}");
        assert_eq!(browser.evaluate(WIDE), json!([]), "{width}, dark: {dark}");
    }
}

#[test]
fn the_page_is_read_in_light_and_dark_on_a_desk_and_on_a_telephone() {
    assert_readable_everywhere(report, |browser| {
        assert!(browser.evaluate("document.querySelectorAll('.table th').length").as_u64() > Some(10));
    });
}
