//! `sahara render`.

use std::path::Path;

use sahara::render::Picture;

use super::command::{path_text, prints};

#[test]
fn the_error_view_says_what_its_colours_mean() {
    let directory = tempfile::tempdir().unwrap();
    let picture = path_text(&directory.path().join("error.png"));
    let args = ["render", "cube", "-o", &picture, "--size", "24x24", "--view", "error", "-s", "sah-kd:test=exact"];
    let text = prints(&args);
    assert!(text.contains("missed 0 (vermilion)"), "{text}");
    assert_eq!(Picture::read(Path::new(&picture)).unwrap().size()[0], 24);
}
