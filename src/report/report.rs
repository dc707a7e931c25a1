//! A study's report on a dataset, as plain data independent of the output format.

use super::inspector::Inspector;
use super::plot::Chart;
use super::{Cell, Table, Tone};
use crate::measure::Estimate;
use crate::names::named_enum;

/// What a study says of a dataset. The renderers make a terminal's text, a page, Markdown and CSV of it.
#[derive(Clone, Debug, Default)]
pub struct Report {
    /// What was found, the most important first.
    pub findings: Vec<Finding>,
    /// Tables, figures and texts in their order. The terminal prints what is not folded.
    pub blocks: Vec<Block>,
    /// Claims that were written before the data, judged.
    pub verdicts: Vec<Verdict>,
    /// Structures without times or with wrong answers: they decide the exit status.
    pub failures: Vec<Failure>,
    /// What spoilt the run, and what to do.
    pub warnings: Vec<String>,
    /// One row for each measured thing, for programs. Empty where nothing was measured.
    pub data: Table,
}

/// A number, and the sentence that the data choose and fill in. The page, `papers/RESULTS.md` and README print the
/// same one; claims and README's marks go by the key.
#[derive(Clone, Debug, PartialEq)]
pub struct Finding {
    /// Letters, digits and hyphens; no two findings of a study share one.
    pub key: String,
    /// Ends with a full stop; empty if the finding is only a number that a claim refers to.
    pub sentence: String,
    /// The number that the sentence is about, where it is about one.
    pub value: Option<Estimate>,
    /// Name that a page shows as its answer: the label of the fastest structure.
    pub name: Option<String>,
    /// Whether the terminal shows the sentence with `--verbose` alone.
    pub is_detail: bool,
}

#[derive(Clone, Debug)]
pub enum Block {
    Text(String),
    /// What columns mean, small.
    Note(String),
    Table(Table),
    Figure(Box<Figure>),
    /// What is not there, and how to make it.
    Missing(Missing),
    /// Blocks that are opened on demand, below their name.
    Fold(String, Vec<Block>),
}

/// One claim that was written before the data, and what the data say.
#[derive(Clone, Debug, PartialEq)]
pub struct Verdict {
    /// Of the prediction that the claim is a part of, from 1.
    pub prediction: u8,
    pub claim: String,
    /// What was expected of it: `at least 20`.
    pub expected: String,
    /// The measured value, with its interval corrected for the number of claims (Bonferroni); `None` if not measured.
    pub value: Option<Estimate>,
    pub outcome: Outcome,
}

named_enum! {
    #[derive(Clone, Copy, Debug, PartialEq, Eq)]
    pub enum Outcome {
        /// The whole interval is as expected.
        Confirmed = "confirmed",
        /// The whole interval is not.
        Refuted = "refuted",
        /// The interval reaches across a bound, or is not known.
        Undecided = "undecided",
        NotMeasured = "not measured",
    }
}

/// A structure without times, or with wrong answers, and why.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Failure {
    pub structure: String,
    /// What to print below the tables; empty where a table says it.
    pub sentence: String,
    pub refused: bool,
    pub wrong: bool,
}

/// A figure with its caption, alternative text and the numbers behind it.
#[derive(Clone, Debug)]
pub struct Figure {
    /// Letters, digits and hyphens; no two figures share one. The name of its files.
    pub id: String,
    /// What it shows, and how to read it.
    pub caption: String,
    /// Alternative text for readers who cannot see the figure.
    pub alt: String,
    pub art: Art,
    /// The numbers in it; a table without columns where it has none.
    pub data: Table,
}

#[derive(Clone, Debug)]
pub enum Art {
    Chart(Chart),
    Gallery(Vec<Picture>),
    Overlay(Overlay),
}

/// Pictures of one size on one scale, side by side, and two of them one upon the other.
#[derive(Clone, Debug, PartialEq)]
pub struct Overlay {
    pub heading: String,
    pub pictures: Vec<Picture>,
    pub colours: Colours,
    /// What can be asked of single pixels.
    pub inspector: Option<Box<Inspector>>,
}

#[derive(Clone, Debug, PartialEq)]
pub enum Colours {
    Ramp {
        title: String,
        /// Colours at equal distances, `#RRGGBB`.
        colours: Vec<String>,
        /// Places on the scale, 0 to 1, and what is there.
        ticks: Vec<(f64, String)>,
    },
    /// Colours, `#RRGGBB`, with a meaning each.
    Key(Vec<(String, String)>),
}

#[derive(Clone, Debug, PartialEq)]
pub struct Picture {
    pub name: String,
    /// One line below it.
    pub note: String,
    pub alt: String,
    pub png: Vec<u8>,
    /// Width and height in pixels.
    pub size: [u32; 2],
}

/// A part that no run has measured.
#[derive(Clone, Debug, PartialEq)]
pub struct Missing {
    pub what: String,
    pub command: String,
}

impl Finding {
    /// A finding without a number of its own.
    pub fn new(key: impl Into<String>, sentence: impl Into<String>) -> Self {
        Self { key: key.into(), sentence: sentence.into(), value: None, name: None, is_detail: false }
    }

    /// A name that a page's answer goes by, and no sentence.
    pub fn named(key: impl Into<String>, name: impl Into<String>) -> Self {
        Self { name: Some(name.into()), ..Self::new(key, "") }
    }

    pub fn number(key: impl Into<String>, value: Estimate) -> Self {
        Self::new(key, "").of(value)
    }

    pub fn of(self, value: Estimate) -> Self {
        Self { value: Some(value), ..self }
    }

    /// The same finding, which the terminal shows with `--verbose` alone.
    pub fn detail(self) -> Self {
        Self { is_detail: true, ..self }
    }
}

impl Report {
    pub fn finding(&self, key: &str) -> Option<&Finding> {
        self.findings.iter().find(|finding| finding.key == key)
    }

    pub fn sentences(&self) -> impl Iterator<Item = &str> {
        self.findings.iter().map(|finding| finding.sentence.as_str()).filter(|sentence| !sentence.is_empty())
    }

    /// The sentences that the terminal always shows.
    pub fn headlines(&self) -> impl Iterator<Item = &str> {
        let shown = self.findings.iter().filter(|finding| !finding.is_detail && !finding.sentence.is_empty());
        shown.map(|finding| finding.sentence.as_str())
    }

    /// The claims as a table; nothing without a claim.
    pub fn verdict_table(&self) -> Option<Table> {
        let table = Table::of(
            "Claims written before the measurement",
            &self.verdicts,
            &[
                ("claim", &|v| format!("{}. {}", v.prediction, v.claim).into()),
                ("expected", &|v| v.expected.as_str().into()),
                ("measured", &|v| v.value.into()),
                ("verdict", &|v| Cell::from(v.outcome.name()).with(v.outcome.tone())),
            ],
        );
        (!self.verdicts.is_empty()).then_some(table)
    }

    /// Figures that are not folded, in their order.
    pub fn figures(&self) -> impl Iterator<Item = &Figure> {
        self.blocks.iter().filter_map(|block| if let Block::Figure(figure) = block { Some(&**figure) } else { None })
    }

    /// Tables that are not folded, in their order.
    pub fn tables(&self) -> impl Iterator<Item = &Table> {
        self.blocks.iter().filter_map(|block| if let Block::Table(table) = block { Some(table) } else { None })
    }
}

impl Outcome {
    fn tone(self) -> Tone {
        match self {
            Self::Confirmed => Tone::Best,
            Self::Refuted => Tone::Wrong,
            Self::Undecided | Self::NotMeasured => Tone::Plain,
        }
    }
}

impl Figure {
    pub fn chart(&self) -> Option<&Chart> {
        if let Art::Chart(chart) = &self.art { Some(chart) } else { None }
    }

    /// The pictures of pixels that it consists of; none in a chart.
    pub fn pictures(&self) -> &[Picture] {
        match &self.art {
            Art::Chart(_) => &[],
            Art::Gallery(pictures) => pictures,
            Art::Overlay(overlay) => &overlay.pictures,
        }
    }

    pub fn picture_path(&self, index: usize) -> String {
        format!("figures/{}-{}.png", self.id, index + 1)
    }
}

impl Block {
    pub fn figure(figure: Figure) -> Self {
        Self::Figure(Box::new(figure))
    }

    pub fn missing(what: &str, command: &str) -> Self {
        Self::Missing(Missing { what: what.into(), command: command.into() })
    }
}

impl From<Table> for Block {
    fn from(table: Table) -> Self {
        Self::Table(table)
    }
}
