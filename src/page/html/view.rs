//! The document as the template sees it.

use serde::Serialize;

use super::sort_key::sort_key;
use super::{inspector, scatter};
use crate::page::base64::base64;
use crate::report::document::{self, Answer, Art, Block, Colours, Overlay, Tabular, Thumbnail};
use crate::report::plot::Chart;
use crate::report::{Table, Tone};

/// Widths of drawings: on a desk, and on a telephone.
pub const WIDE: f64 = 900.0;
const NARROW: f64 = 360.0;

#[derive(Serialize)]
pub struct PageView {
    title: String,
    answer: AnswerView,
    sections: Vec<SectionView>,
    css: String,
    js: &'static str,
    version: &'static str,
}

#[derive(Serialize)]
struct AnswerView {
    banner: Vec<SpanView>,
    verdict: String,
    sentences: Vec<Vec<SpanView>>,
    numbers: Vec<HeadlineView>,
}

#[derive(Serialize)]
struct HeadlineView {
    number: String,
    interval: String,
    label: String,
}

#[derive(Serialize)]
struct SectionView {
    id: &'static str,
    title: &'static str,
    blocks: Vec<BlockView>,
}

/// A block of any kind: fields that a kind does not have are empty.
#[derive(Serialize, Default)]
struct BlockView {
    kind: &'static str,
    text: String,
    spans: Vec<SpanView>,
    command: String,
    table: Option<TableView>,
    figure: Option<FigureView>,
    blocks: Vec<BlockView>,
}

#[derive(Serialize)]
struct TableView {
    title: String,
    columns: Vec<ColumnView>,
    rows: Vec<Vec<CellView>>,
    notes: Vec<String>,
}

#[derive(Serialize)]
struct ColumnView {
    name: String,
    class: String,
}

/// A piece of a sentence.
#[derive(Serialize)]
struct SpanView {
    text: String,
    is_code: bool,
}

#[derive(Serialize)]
struct CellView {
    text: String,
    class: String,
    key: Option<f64>,
}

#[derive(Serialize)]
struct FigureView {
    id: String,
    caption: String,
    alt: String,
    command: String,
    wide: Option<String>,
    narrow: Option<String>,
    /// The data of a chart that can be changed.
    scatter: Option<String>,
    overlay: Option<OverlayView>,
    thumbnails: Vec<ThumbnailView>,
    data: TableView,
}

#[derive(Serialize)]
struct OverlayView {
    heading: String,
    /// Above the scale.
    ramp_title: String,
    ramp: String,
    ticks: Vec<TickView>,
    /// Colours with their meaning, where there is no scale.
    key: Vec<KeyView>,
    /// The data of the inspector.
    inspector: Option<String>,
}

#[derive(Serialize)]
struct KeyView {
    colour: String,
    text: String,
}

#[derive(Serialize)]
struct ThumbnailView {
    name: String,
    note: String,
    alt: String,
    base64: String,
    width: u32,
    height: u32,
}

#[derive(Serialize)]
struct TickView {
    /// Percent of the width.
    at: f64,
    text: String,
}

pub fn page(document: &document::Document, css: String) -> PageView {
    PageView {
        title: document.title.clone(),
        answer: answer(&document.answer),
        sections: document.sections.iter().map(section).collect(),
        css,
        js: concat!(include_str!("page.js"), include_str!("overlay.js"), include_str!("scatter.js")),
        version: env!("CARGO_PKG_VERSION"),
    }
}

fn answer(answer: &Answer) -> AnswerView {
    let numbers = answer.numbers.iter().map(|n| HeadlineView {
        number: n.number.clone(),
        interval: n.interval.clone(),
        label: n.label.clone(),
    });
    AnswerView {
        banner: if answer.banner.is_empty() { vec![] } else { spans(&answer.banner) },
        verdict: answer.verdict.clone(),
        sentences: answer.sentences.iter().map(|sentence| spans(sentence)).collect(),
        numbers: numbers.collect(),
    }
}

fn section(section: &document::Section) -> SectionView {
    SectionView { id: section.id, title: section.title, blocks: section.blocks.iter().map(block).collect() }
}

/// A sentence with what stands between backticks as code.
fn spans(text: &str) -> Vec<SpanView> {
    let span = |(i, text): (usize, &str)| SpanView { text: text.into(), is_code: i % 2 == 1 };
    text.split('`').enumerate().map(span).collect()
}

fn block(block: &Block) -> BlockView {
    let view = BlockView::default();
    match block {
        Block::Text(text) => BlockView { kind: "text", spans: spans(text), ..view },
        Block::Note(text) => BlockView { kind: "note", spans: spans(text), ..view },
        Block::Table(tabular) => BlockView {
            kind: "table",
            table: Some(table(&tabular.table, Some(tabular))),
            command: tabular.command.clone(),
            ..view
        },
        Block::Figure(f) => BlockView { kind: "figure", figure: Some(figure(f)), ..view },
        Block::Missing(missing) => {
            BlockView { kind: "missing", text: missing.what.clone(), command: missing.command.clone(), ..view }
        }
        Block::Fold(name, inner) => {
            BlockView { kind: "fold", text: name.clone(), blocks: inner.iter().map(self::block).collect(), ..view }
        }
    }
}

fn table(table: &Table, shaded: Option<&Tabular>) -> TableView {
    // Numbers stand to the right, words to the left.
    let column_of = |column: usize| table.rows.iter().filter_map(move |row| row.get(column));
    let class_of = |column: usize| {
        let said: Vec<&str> =
            column_of(column).map(|cell| cell.text.as_str()).filter(|text| !text.is_empty()).collect();
        match () {
            () if said.is_empty() || said.iter().any(|text| sort_key(text).is_some()) => "",
            () if said.iter().any(|text| text.chars().count() > 30) => "text",
            () => "word",
        }
    };
    let words: Vec<&str> = (0..table.columns.len()).map(class_of).collect();
    let cell = |row: usize, column: usize, cell: &crate::report::Cell| {
        let shade = shaded.and_then(|s| *s.shades.get(row)?.get(column)?);
        let key = sort_key(&cell.text);
        let tone = match (shade, cell.tone) {
            (Some(shade), _) if shade > 0 => ["", "f1", "f2", "f3"][shade.min(3) as usize],
            (Some(shade), _) => ["", "w1", "w2", "w3"][shade.unsigned_abs().min(3) as usize],
            (None, Tone::Best) => "best",
            (None, Tone::Wrong) => "wrong",
            (None, Tone::Plain) => "",
        };
        let class = [words[column], tone].join(" ").trim().to_owned();
        CellView { text: cell.text.clone(), class, key }
    };
    let row = |(i, cells): (usize, &Vec<crate::report::Cell>)| {
        cells.iter().enumerate().map(|(column, c)| cell(i, column, c)).collect()
    };
    TableView {
        title: table.title.clone(),
        columns: table
            .columns
            .iter()
            .zip(&words)
            .map(|(name, &class)| ColumnView { name: name.clone(), class: class.into() })
            .collect(),
        rows: table.rows.iter().enumerate().map(row).collect(),
        notes: table.notes.clone(),
    }
}

fn figure(figure: &document::Figure) -> FigureView {
    let mut view = FigureView {
        id: figure.id.clone(),
        caption: figure.caption.clone(),
        alt: figure.alt.clone(),
        command: figure.command.clone(),
        wide: None,
        narrow: None,
        scatter: None,
        overlay: None,
        thumbnails: vec![],
        data: table(&figure.data, None),
    };
    match &figure.art {
        Art::Chart(chart) => {
            view.wide = Some(inline(&chart.svg(WIDE)));
            // Points have labels all over: they are as wide as they are, and scroll.
            view.scatter = if let Chart::Scatter(points) = chart { Some(scatter::data(points)) } else { None };
            view.narrow = (!matches!(chart, Chart::Points(_))).then(|| inline(&chart.svg(NARROW)));
        }
        Art::Gallery(thumbnails) => view.thumbnails = thumbnails.iter().map(thumbnail).collect(),
        Art::Overlay(drawn) => {
            view.thumbnails = drawn.pictures.iter().map(thumbnail).collect();
            view.overlay = Some(overlay(drawn));
        }
    }
    view
}

fn overlay(overlay: &Overlay) -> OverlayView {
    let mut view = OverlayView {
        heading: overlay.heading.clone(),
        ramp_title: String::new(),
        ramp: String::new(),
        ticks: vec![],
        key: vec![],
        inspector: overlay.inspector.as_deref().map(inspector::data),
    };
    match &overlay.colours {
        Colours::Ramp { title, colours, ticks } => {
            view.ramp_title = title.clone();
            view.ramp = colours.join(",");
            view.ticks = ticks.iter().map(|(at, text)| TickView { at: at * 100.0, text: text.clone() }).collect();
        }
        Colours::Key(key) => {
            view.key =
                key.iter().map(|(colour, text)| KeyView { colour: colour.clone(), text: text.clone() }).collect();
        }
    }
    view
}

fn thumbnail(thumbnail: &Thumbnail) -> ThumbnailView {
    ThumbnailView {
        name: thumbnail.name.clone(),
        note: thumbnail.note.clone(),
        alt: thumbnail.alt.clone(),
        base64: base64(&thumbnail.png),
        width: thumbnail.size[0],
        height: thumbnail.size[1],
    }
}

/// A drawing within a page: it takes the width it is given, and its text stands in its place.
fn inline(svg: &str) -> String {
    let svg = svg.trim_start();
    let end = svg.find('>').map_or(0, |end| end + 1);
    let (head, body) = svg.split_at(end);
    let view_box = head.split("viewBox=\"").nth(1).and_then(|rest| rest.split('"').next()).unwrap_or("0 0 1 1");
    let body = body.replace(" opacity=\"1\"", "").replace(" font-family=\"sans-serif\"", "");
    format!("<svg viewBox=\"{view_box}\" aria-hidden=\"true\" focusable=\"false\">{body}")
}
