//! The values of the template.

use std::collections::BTreeMap;

use minijinja::value::Serde;
use minijinja::{Value, context};
use serde_json::json;

use super::in_script;
use crate::page::document::{Document, Section};
use crate::report::plot::palette::{Role, roles_of};
use crate::report::plot::{Chart, Tradeoff, TradeoffCase, TradeoffPoint, WIDTH};
use crate::report::words::ended;
use crate::report::{Art, Block, Cell, Colours, Figure, Overlay, Picture, Table, Tone};

const NARROW: f64 = 360.0;

/// The page. The value of each part is built with the part.
pub fn page(document: &Document, css: String) -> Value {
    let section = |section: &Section| {
        let Section { id, title, command, blocks: own } = section;
        context! { id => *id, title => *title, command => command, blocks => blocks(own) }
    };
    context! {
        title => &document.title,
        answer => Serde(&document.answer),
        sections => values(&document.sections, section),
        css => css,
        js => concat!(include_str!("page.js"), include_str!("overlay.js"), include_str!("scatter.js")),
        version => env!("CARGO_PKG_VERSION"),
    }
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
    // Scatter plots have labels everywhere: they keep their width, and scroll.
    let shrinks = |chart: &&Chart| !matches!(chart, Chart::Scatter(_));
    context! {
        id => &figure.id,
        caption => &figure.caption,
        alt => &figure.alt,
        wide => chart.map(|chart| inline(&chart.svg(WIDTH))),
        narrow => chart.filter(shrinks).map(|chart| inline(&chart.svg(NARROW))),
        // The data of an interactive chart.
        scatter => if let Some(Chart::Tradeoff(tradeoff)) = chart { Some(scatter(tradeoff)) } else { None },
        overlay => if let Art::Overlay(drawn) = &figure.art { Some(overlay(drawn)) } else { None },
        pictures => values(figure.pictures(), picture),
        data => table(&figure.data),
    }
}

/// The data of a scatter plot for its script.
fn scatter(tradeoff: &Tradeoff) -> String {
    let all: Vec<String> = tradeoff.cases.iter().flat_map(|case| &case.points).map(|p| p.label.clone()).collect();
    // A structure has one colour in all cases.
    let roles: BTreeMap<&String, Role> = all.iter().zip(roles_of(&all)).collect();
    let point = |p: &TradeoffPoint| {
        json!({
            "label": p.label,
            // Name of the custom property with its colour.
            "colour": format!("--{}", roles[&p.label].name),
            "bytes": p.bytes,
            "build": p.build_ns,
            "ray": p.ns_per_ray,
            "ratio": p.ratio,
        })
    };
    let case = |case: &TradeoffCase| {
        let points: Vec<_> = case.points.iter().map(point).collect();
        json!({ "scene": case.scene, "rays": case.workload, "points": points })
    };
    in_script(&tradeoff.cases.iter().map(case).collect::<Vec<_>>())
}

/// Colours with a scale and its title; or with their meanings.
fn overlay(overlay: &Overlay) -> Value {
    let colours = match &overlay.colours {
        Colours::Ramp { title, colours, ticks } => {
            context! { ramp_title => title, ramp => colours, ticks => Serde(ticks) }
        }
        Colours::Key(key) => context! { ramp => "", key => Serde(key) },
    };
    let inspector = overlay.inspector.as_ref().map(in_script);
    context! { heading => &overlay.heading, inspector => inspector, ..colours }
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

/// An inline drawing: it adapts to the available width, and screen readers skip it.
fn inline(svg: &str) -> String {
    let svg = svg.trim_start();
    let end = svg.find('>').map_or(0, |end| end + 1);
    let (head, body) = svg.split_at(end);
    let view_box = head.split("viewBox=\"").nth(1).and_then(|rest| rest.split('"').next()).unwrap_or("0 0 1 1");
    let body = body.replace(" opacity=\"1\"", "").replace(" font-family=\"sans-serif\"", "");
    format!("<svg viewBox=\"{view_box}\" aria-hidden=\"true\" focusable=\"false\">{body}")
}
