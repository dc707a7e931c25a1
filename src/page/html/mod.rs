//! The report as a single self-contained page.

use minijinja::value::Serde;
use minijinja::{AutoEscape, Environment, UndefinedBehavior, Value, context};
use serde::Serialize;

use crate::page::document::{Document, Section};
use crate::report::plot::palette::{Role, hex, roles};
use crate::report::plot::{Chart, WIDTH};
use crate::report::words::ended;
use crate::report::{Art, Block, Cell, Colours, Figure, Overlay, Picture, Table, Tone};

const NARROW: f64 = 360.0;

/// The template escapes everything except charts, the style sheet and scripts.
pub fn page(document: &Document) -> String {
    let mut environment = Environment::new();
    environment.set_auto_escape_callback(|_| AutoEscape::Html);
    environment.set_undefined_behavior(UndefinedBehavior::Strict);
    let section = |section: &Section| {
        let Section { id, title, command, blocks: own } = section;
        context! { id => *id, title => *title, command => command, blocks => blocks(own) }
    };
    let values = context! {
        title => &document.title,
        answer => Serde(&document.answer),
        sections => values(&document.sections, section),
        css => sheet(),
        js => concat!(include_str!("page.js"), include_str!("overlay.js")),
        version => env!("CARGO_PKG_VERSION"),
    };
    let page = environment.render_named_str("page.html", include_str!("page.html"), values);
    page.expect("a test renders the template with all kinds of blocks")
}

/// `<` is escaped, so no text in `data` can end the enclosing script element.
fn in_script(data: &impl Serialize) -> String {
    serde_json::to_string(data).expect("data have text keys").replace('<', "\\u003c")
}

fn sheet() -> String {
    let light = properties(|role| hex(role.light));
    let dark = properties(|role| hex(role.dark));
    let mut sheet = format!(
        ":root {{ color-scheme: light; {light} }}\n\
         @media (prefers-color-scheme: dark) {{ :root:not([data-theme=\"light\"]) {{ color-scheme: dark; {dark} }} }}\n\
         :root[data-theme=\"dark\"] {{ color-scheme: dark; {dark} }}\n"
    );
    sheet += include_str!("page.css");
    // These rules replace the light-mode colours of charts with the colours of the current mode.
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

fn values<'a, T: 'a>(items: impl IntoIterator<Item = &'a T>, value: impl FnMut(&'a T) -> Value) -> Vec<Value> {
    items.into_iter().map(value).collect()
}

fn blocks(list: &[Block]) -> Vec<Value> {
    let block = |block: &Block| match block {
        Block::Text(text) => context! { kind => "text", text => text },
        Block::Note(text) => context! { kind => "note", text => text },
        Block::Table(own) => context! { kind => "table", table => table(own) },
        Block::Figure(f) => context! { kind => "figure", figure => figure(f) },
        Block::Missing(missing) => {
            context! { kind => "missing", text => ended(&missing.what), command => &missing.command }
        }
        Block::Fold(name, inner) => context! { kind => "fold", text => name, blocks => blocks(inner) },
    };
    values(list, block)
}

fn table(table: &Table) -> Value {
    let class_of = |column: usize| match () {
        () if !table.is_words(column) => "",
        () if table.rows.iter().any(|row| row[column].text().chars().count() > 30) => "text",
        () => "word",
    };
    let classes: Vec<&str> = (0..table.columns.len()).map(class_of).collect();
    let cell = |(cell, class): (&Cell, &&str)| {
        let tone = match cell.tone {
            Tone::Best => "best",
            Tone::Wrong => "wrong",
            Tone::Plain => "",
        };
        context! { text => cell.text(), class => [class, tone].join(" ").trim(), key => cell.sort_key() }
    };
    let row = |cells: &Vec<Cell>| -> Value { cells.iter().zip(&classes).map(cell).collect() };
    let column = |(name, class): (&String, &&str)| context! { name => name, class => *class };
    context! {
        title => &table.title,
        columns => table.columns.iter().zip(&classes).map(column).collect::<Vec<_>>(),
        rows => values(&table.rows, row),
        notes => &table.notes,
    }
}

fn figure(figure: &Figure) -> Value {
    let chart = figure.chart();
    // The labels of a scatter plot need the full width.
    let shrinks = |chart: &&Chart| !matches!(chart, Chart::Scatter(_));
    context! {
        id => &figure.id,
        caption => &figure.caption,
        alt => &figure.alt,
        wide => chart.map(|chart| inline(&chart.svg(WIDTH))),
        narrow => chart.filter(shrinks).map(|chart| inline(&chart.svg(NARROW))),
        overlay => if let Art::Overlay(drawn) = &figure.art { Some(overlay(drawn)) } else { None },
        pictures => values(figure.pictures(), picture),
        data => table(&figure.data),
    }
}

fn overlay(overlay: &Overlay) -> Value {
    let colours = match &overlay.colours {
        Colours::Ramp { title, colours, ticks } => {
            context! { ramp_title => title, ramp => colours, ticks => Serde(ticks) }
        }
        Colours::Key(key) => context! { ramp => "", key => Serde(key) },
    };
    context! { heading => &overlay.heading, inspector => in_script(&overlay.inspector), ..colours }
}

fn picture(picture: &Picture) -> Value {
    context! {
        name => &picture.name,
        note => &picture.note,
        alt => &picture.alt,
        base64 => base64::encode(&picture.png),
        width => picture.size[0],
        height => picture.size[1],
    }
}

/// The drawing adapts to the available width. Screen readers skip the drawing.
fn inline(svg: &str) -> String {
    let svg = svg.trim_start();
    let end = svg.find('>').map_or(0, |end| end + 1);
    let (head, body) = svg.split_at(end);
    let view_box = head.split("viewBox=\"").nth(1).and_then(|rest| rest.split('"').next()).unwrap_or("0 0 1 1");
    let body = body.replace(" opacity=\"1\"", "").replace(" font-family=\"sans-serif\"", "");
    format!("<svg viewBox=\"{view_box}\" aria-hidden=\"true\" focusable=\"false\">{body}")
}
