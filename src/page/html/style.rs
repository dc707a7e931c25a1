//! The style sheet: what the page looks like, and the colours of drawings in light and dark.

use crate::report::plot::palette::{Role, hex, roles};

pub fn sheet() -> String {
    let light = properties(|role| hex(role.light));
    let dark = properties(|role| hex(role.dark));
    let mut sheet = format!(
        ":root {{ color-scheme: light; {light} }}\n\
         @media (prefers-color-scheme: dark) {{ :root:not([data-theme=\"light\"]) {{ color-scheme: dark; {dark} }} }}\n\
         :root[data-theme=\"dark\"] {{ color-scheme: dark; {dark} }}\n"
    );
    sheet += include_str!("page.css");
    // Drawings name the colour on white paper.
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
