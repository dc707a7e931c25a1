//! A study's report on a dataset, as plain data independent of the output format.

use super::plot::Chart;
use super::{Cell, Table, Tone};
use crate::measure::Estimate;
use crate::names::named_enum;

/// The result of a study. Renderers write it as text, as a web page, as Markdown and as CSV.
#[derive(Clone, Debug, Default)]
pub struct Report {
    /// The findings, most important first.
    pub findings: Vec<Finding>,
    /// Tables, figures and texts in order. The terminal prints only the tables and notes that are not folded.
    pub blocks: Vec<Block>,
    /// The verdicts on claims, the measurable parts of predictions that were written before the measurement.
    pub verdicts: Vec<ClaimVerdict>,
    /// Structures without times or with wrong hits. They decide the exit status.
    pub failures: Vec<Failure>,
    /// Conditions that disturbed the run, each with a remedy.
    pub warnings: Vec<String>,
    /// The table of `--export-csv`: one row per measurement; empty without measurements.
    pub data: Table,
}

/// A sentence about the data, and the number in this sentence. The page, `papers/RESULTS.md` and README print the
/// sentence. Claims and README refer to the finding by its key.
#[derive(Clone, Debug, PartialEq)]
pub struct Finding {
    /// Letters, digits and hyphens; unique among the findings of a study.
    pub key: String,
    /// Ends with a full stop. Empty if the finding has only a number (for a claim) or only a name.
    pub sentence: String,
    /// The number in the sentence; `None` if the sentence has no number.
    pub value: Option<Estimate>,
    /// A name that answers the question at the top of the page, such as the label of the fastest structure.
    pub name: Option<String>,
    /// Whether the terminal shows the sentence only with `--verbose`.
    pub is_detail: bool,
}

#[derive(Clone, Debug)]
pub enum Block {
    Text(String),
    /// A text in small print, such as the meaning of columns.
    Note(String),
    Table(Table),
    Figure(Box<Figure>),
    /// A result that no run has measured, and the command that measures it.
    Missing(Missing),
    /// A heading, and the blocks below it. The page hides the blocks until the reader unfolds them.
    Fold(String, Vec<Block>),
}

/// The verdict on one claim.
#[derive(Clone, Debug, PartialEq)]
pub struct ClaimVerdict {
    /// The number of the prediction that contains the claim, from 1.
    pub prediction: u8,
    pub claim: String,
    /// The expected range, such as `at least 20`.
    pub expected: String,
    /// The measured value, with its interval corrected for the number of claims (Bonferroni); `None` if not measured.
    pub value: Option<Estimate>,
    pub outcome: Outcome,
}

named_enum! {
    #[derive(Clone, Copy, Debug, PartialEq, Eq)]
    pub enum Outcome {
        /// The whole interval lies inside the expected range.
        Confirmed = "confirmed",
        /// The whole interval lies outside the expected range.
        Refuted = "refuted",
        /// The interval contains a bound of the expected range, or there is no interval.
        Undecided = "undecided",
        NotMeasured = "not measured",
    }
}

/// A structure without times or with wrong hits, and the reason.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Failure {
    pub structure: String,
    /// The sentence to print below the tables; empty if a table already shows the failure.
    pub sentence: String,
    /// Whether the structure has no times on any workload.
    pub refused: bool,
    /// Whether the failure is that the structure returned wrong hits.
    pub wrong: bool,
}

/// A figure with its caption, alternative text and the numbers behind it.
#[derive(Clone, Debug)]
pub struct Figure {
    /// The id, also the stem of its file names: letters, digits and hyphens, unique among the figures.
    pub id: String,
    /// The content of the figure, and how to read it.
    pub caption: String,
    /// Alternative text for readers who cannot see the figure.
    pub alt: String,
    pub art: Art,
    /// The numbers in the figure; a table without columns if the figure has no numbers.
    pub data: Table,
}

#[derive(Clone, Debug)]
pub enum Art {
    Chart(Chart),
    Gallery(Vec<Picture>),
    Overlay(Overlay),
}

/// Pictures of the same size and scale. The page shows them side by side and overlays any two.
#[derive(Clone, Debug, PartialEq)]
pub struct Overlay {
    pub heading: String,
    pub pictures: Vec<Picture>,
    pub colours: Colours,
    /// Data with which the reader of the page inspects single pixels.
    pub inspector: serde_json::Value,
}

#[derive(Clone, Debug, PartialEq)]
pub enum Colours {
    Ramp {
        title: String,
        /// Colours at equal distances, `#RRGGBB`.
        colours: Vec<String>,
        /// The ticks: position on the scale, 0 to 1, and label.
        ticks: Vec<(f64, String)>,
    },
    /// Colours, `#RRGGBB`, each with its meaning.
    Key(Vec<(String, String)>),
}

#[derive(Clone, Debug, PartialEq)]
pub struct Picture {
    pub name: String,
    /// One line below the picture.
    pub note: String,
    pub alt: String,
    pub png: Vec<u8>,
    /// Width and height in pixels.
    pub size: [u32; 2],
}

/// A result that no run has measured, and the command that measures it.
#[derive(Clone, Debug, PartialEq)]
pub struct Missing {
    pub what: String,
    pub command: String,
}

impl Finding {
    /// A finding without a number.
    pub fn new(key: impl Into<String>, sentence: impl Into<String>) -> Self {
        Self { key: key.into(), sentence: sentence.into(), value: None, name: None, is_detail: false }
    }

    /// A finding without a sentence: a name that answers the question at the top of the page.
    pub fn named(key: impl Into<String>, name: impl Into<String>) -> Self {
        Self { name: Some(name.into()), ..Self::new(key, "") }
    }

    pub fn number(key: impl Into<String>, value: Estimate) -> Self {
        Self::new(key, "").with_value(value)
    }

    pub fn with_value(self, value: Estimate) -> Self {
        Self { value: Some(value), ..self }
    }

    /// The same finding; the terminal shows it only with `--verbose`.
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

    /// The verdicts as a table; `None` without verdicts.
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

    /// The pictures of the figure; empty for a chart.
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
