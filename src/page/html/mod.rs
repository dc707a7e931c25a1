//! The report as a single self-contained page.

mod view;

use minijinja::{AutoEscape, Environment, UndefinedBehavior};
use serde::Serialize;

use crate::page::document::Document;
use crate::report::plot::palette::{Role, hex, roles};

/// The page.
///
/// All text is escaped; drawings, style and script are from this program.
pub fn page(document: &Document) -> String {
    let mut environment = Environment::new();
    environment.set_auto_escape_callback(|_| AutoEscape::Html);
    environment.set_undefined_behavior(UndefinedBehavior::Strict);
    let page = environment.render_named_str("page.html", include_str!("page.html"), view::page(document, sheet()));
    page.expect("a test renders the template with all kinds of blocks")
}

/// JSON for a script element: no text in it can end the element.
fn in_script(data: &impl Serialize) -> String {
    serde_json::to_string(data).expect("data have text keys").replace('<', "\\u003c")
}

/// The style sheet: the layout of the page, and the colours of drawings in light and dark mode.
fn sheet() -> String {
    let light = properties(|role| hex(role.light));
    let dark = properties(|role| hex(role.dark));
    let mut sheet = format!(
        ":root {{ color-scheme: light; {light} }}\n\
         @media (prefers-color-scheme: dark) {{ :root:not([data-theme=\"light\"]) {{ color-scheme: dark; {dark} }} }}\n\
         :root[data-theme=\"dark\"] {{ color-scheme: dark; {dark} }}\n"
    );
    sheet += include_str!("page.css");
    // Drawings contain the colours on white paper.
    for role in roles() {
        let (name, light) = (role.name, hex(role.light));
        sheet += &format!(".chart [fill=\"{light}\"] {{ fill: var(--{name}); }}\n");
        sheet += &format!(".chart [stroke=\"{light}\"] {{ stroke: var(--{name}); }}\n");
    }
    sheet + &format!("@media print {{ :root:root:root {{ color-scheme: light; {light} }} }}\n")
}

fn properties(colour: impl Fn(&Role) -> String) -> String {
    roles().map(|role| format!("--{}: {};", role.name, colour(&role))).collect::<Vec<_>>().join(" ")
}
