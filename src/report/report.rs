//! A study's report, independent of the output format.

use super::plot::Chart;
use super::{Cell, Table, Tone};
use crate::measure::Estimate;
use crate::names::named_enum;

#[derive(Clone, Debug, Default)]
pub struct Report {
    /// The most important finding comes first.
    pub findings: Vec<Finding>,
    pub blocks: Vec<Block>,
    /// Verdicts on claims that were written before the measurement.
    pub verdicts: Vec<ClaimVerdict>,
    /// Missing measurements and wrong hits. The failures decide the exit status.
    pub failures: Vec<Failure>,
    /// Conditions that disturbed the run.
    pub warnings: Vec<String>,
    /// The table of `--export-csv`.
    pub data: Table,
}

/// A statement about the data: a sentence, a number or a name. Claims refer to a finding by the key.
#[derive(Clone, Debug, PartialEq)]
pub struct Finding {
    /// Letters, digits and hyphens. Unique among the findings of a study.
    pub key: String,
    /// A sentence with a full stop, or an empty text.
    pub sentence: String,
    pub value: Option<Estimate>,
    /// A name, such as the label of the fastest structure.
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
    Missing(Missing),
    /// A heading, and the blocks that the page initially hides.
    Fold(String, Vec<Block>),
}

#[derive(Clone, Debug, PartialEq)]
pub struct ClaimVerdict {
    /// The number of the prediction that contains the claim. The first prediction has the number 1.
    pub prediction: u8,
    pub claim: String,
    /// The expected range, such as `at least 20`.
    pub expected: String,
    /// The interval is corrected for the number of claims (Bonferroni).
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
        /// The interval is missing, or contains a bound of the expected range.
        Undecided = "undecided",
        NotMeasured = "not measured",
    }
}

#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Failure {
    pub structure: String,
    /// Empty if a table already shows the failure.
    pub sentence: String,
    /// Whether the structure has no result.
    pub refused: bool,
    /// Whether the structure returned wrong hits.
    pub wrong: bool,
}

#[derive(Clone, Debug)]
pub struct Figure {
    /// Letters, digits and hyphens. The names of picture files begin with the id.
    pub id: String,
    pub caption: String,
    pub alt: String,
    pub art: Art,
    /// The numbers in the figure. The table has no columns if the figure has no numbers.
    pub data: Table,
}

#[derive(Clone, Debug)]
pub enum Art {
    Chart(Chart),
    Gallery(Vec<Picture>),
    Overlay(Overlay),
}

/// Pictures of equal size, to be compared on the page.
#[derive(Clone, Debug, PartialEq)]
pub struct Overlay {
    pub heading: String,
    pub pictures: Vec<Picture>,
    pub colours: Colours,
    /// Data for the inspection of single pixels on the page.
    pub inspector: serde_json::Value,
}

#[derive(Clone, Debug, PartialEq)]
pub enum Colours {
    Ramp {
        title: String,
        /// Colours at equal distances on the ramp, as `#RRGGBB`.
        colours: Vec<String>,
        /// Each tick has a position on the ramp, from 0 to 1, and a label.
        ticks: Vec<(f64, String)>,
    },
    /// Pairs of a colour, as `#RRGGBB`, and the meaning of the colour.
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

/// A missing result, and the command that measures this result.
#[derive(Clone, Debug, PartialEq)]
pub struct Missing {
    pub what: String,
    pub command: String,
}

impl Finding {
    pub fn new(key: impl Into<String>, sentence: impl Into<String>) -> Self {
        Self { key: key.into(), sentence: sentence.into(), value: None, name: None, is_detail: false }
    }

    pub fn named(key: impl Into<String>, name: impl Into<String>) -> Self {
        Self { name: Some(name.into()), ..Self::new(key, "") }
    }

    pub fn number(key: impl Into<String>, value: Estimate) -> Self {
        Self::new(key, "").with_value(value)
    }

    pub fn with_value(self, value: Estimate) -> Self {
        Self { value: Some(value), ..self }
    }

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

    /// Figures that are not folded.
    pub fn figures(&self) -> impl Iterator<Item = &Figure> {
        self.blocks.iter().filter_map(|block| if let Block::Figure(figure) = block { Some(&**figure) } else { None })
    }

    /// Tables that are not folded.
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
