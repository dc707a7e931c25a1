//! The report as one page that needs nothing else.

mod scatter;
mod style;
mod view;

use minijinja::{AutoEscape, Environment, UndefinedBehavior};
use serde::Serialize;

use crate::page::document::Document;

/// The page.
///
/// Everything that is text is escaped; drawings, style and script are our own.
pub fn page(document: &Document) -> String {
    let mut environment = Environment::new();
    environment.set_auto_escape_callback(|_| AutoEscape::Html);
    environment.set_undefined_behavior(UndefinedBehavior::Strict);
    environment.add_template("page.html", include_str!("page.html")).expect(RENDERED);
    let template = environment.get_template("page.html").expect(RENDERED);
    template.render(view::page(document, style::sheet())).expect(RENDERED)
}

/// JSON as it may stand in a script element, which no text in it can end.
fn in_script(data: &impl Serialize) -> String {
    serde_json::to_string(data).expect("data have text keys").replace('<', "\\u003c")
}

const RENDERED: &str = "a test renders the template with all kinds of blocks";
