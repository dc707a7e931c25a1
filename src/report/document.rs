//! What a report says, before it has a form: sections of text, tables and figures.

use crate::report::Table;
use crate::report::inspector::Inspector;
use crate::report::plot::Chart;

/// A whole report.
#[derive(Clone, Debug, Default)]
pub struct Document {
    /// The question.
    pub title: String,
    pub answer: Answer,
    pub sections: Vec<Section>,
}

/// What a reader must know who reads nothing else.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Answer {
    /// What a reader must know before the verdict; empty where there is nothing.
    pub banner: String,
    /// One or two words.
    pub verdict: String,
    /// The sentences that say why, the most important first.
    pub sentences: Vec<String>,
    /// Headline numbers.
    pub numbers: Vec<Headline>,
    /// The same as a picture, with intervals; nothing where there are none.
    pub chart: Option<Chart>,
}

/// A number that stands for itself.
#[derive(Clone, Debug, PartialEq)]
pub struct Headline {
    /// As large as it is important: `20.6 ×`.
    pub number: String,
    /// Its interval, or nothing.
    pub interval: String,
    /// What it is.
    pub label: String,
}

/// A part of a report with a heading of its own.
#[derive(Clone, Debug)]
pub struct Section {
    /// Letters, digits and hyphens; no two sections share one.
    pub id: &'static str,
    pub title: &'static str,
    pub blocks: Vec<Block>,
}

/// What follows one upon the other in a section.
#[derive(Clone, Debug)]
pub enum Block {
    Text(String),
    /// What columns mean, small.
    Note(String),
    Table(Tabular),
    Figure(Box<Figure>),
    /// What is not there, and how to make it.
    Missing(Missing),
    /// Blocks that are opened on demand, below their name.
    Fold(String, Vec<Block>),
}

/// A table, and the command that measured it.
#[derive(Clone, Debug, PartialEq)]
pub struct Tabular {
    pub table: Table,
    pub command: String,
    /// How far from the middle the colour of a cell is, row by row, from -3 to 3; nothing for tables without colour.
    pub shades: Vec<Vec<Option<i8>>>,
}

/// Something to look at, with all that is needed to do without looking.
#[derive(Clone, Debug)]
pub struct Figure {
    /// Letters, digits and hyphens; no two figures share one. The name of its files.
    pub id: String,
    /// What it shows, and how to read it.
    pub caption: String,
    /// What one sees, for those who do not.
    pub alt: String,
    /// The command that measured it.
    pub command: String,
    pub art: Art,
    /// The numbers in it; a table without columns where it has none.
    pub data: Table,
}

/// What a figure consists of.
#[derive(Clone, Debug)]
pub enum Art {
    Chart(Chart),
    Gallery(Vec<Thumbnail>),
    Overlay(Overlay),
}

/// Pictures of one size on one scale, side by side, and two of them one upon the other.
#[derive(Clone, Debug, PartialEq)]
pub struct Overlay {
    /// What is seen.
    pub heading: String,
    pub pictures: Vec<Thumbnail>,
    pub colours: Colours,
    /// What can be asked of single pixels.
    pub inspector: Option<Box<Inspector>>,
}

/// What the colours of pictures mean.
#[derive(Clone, Debug, PartialEq)]
pub enum Colours {
    /// A scale.
    Ramp {
        /// What it is of.
        title: String,
        /// Colours at equal distances, `#RRGGBB`.
        colours: Vec<String>,
        /// Places on the scale, 0 to 1, and what is there.
        ticks: Vec<(f64, String)>,
    },
    /// Colours, `#RRGGBB`, with a meaning each.
    Key(Vec<(String, String)>),
}

/// A small picture.
#[derive(Clone, Debug, PartialEq)]
pub struct Thumbnail {
    pub name: String,
    /// One line below it.
    pub note: String,
    /// What one sees.
    pub alt: String,
    /// The bytes of a PNG file.
    pub png: Vec<u8>,
    /// Width and height in pixels.
    pub size: [u32; 2],
}

/// A part that no run has measured.
#[derive(Clone, Debug, PartialEq)]
pub struct Missing {
    pub what: String,
    /// The command that measures it.
    pub command: String,
}

impl Figure {
    /// The pictures of pixels that it consists of; none in a chart.
    pub fn pictures(&self) -> &[Thumbnail] {
        match &self.art {
            Art::Chart(_) => &[],
            Art::Gallery(pictures) => pictures,
            Art::Overlay(overlay) => &overlay.pictures,
        }
    }

    /// Where a picture of it is, in the folder of a report.
    pub fn picture_path(&self, index: usize) -> String {
        format!("figures/{}-{}.png", self.id, index + 1)
    }
}

impl Block {
    pub fn figure(figure: Figure) -> Self {
        Self::Figure(Box::new(figure))
    }

    /// A table without colours.
    pub fn table(table: Table, command: &str) -> Self {
        Self::Table(Tabular { table, command: command.into(), shades: vec![] })
    }

    pub fn missing(what: &str, command: &str) -> Self {
        Self::Missing(Missing { what: what.into(), command: command.into() })
    }
}

impl Document {
    /// All blocks, in their order, with those that are folded.
    fn blocks(&self) -> Vec<&Block> {
        fn collect<'a>(blocks: &'a [Block], found: &mut Vec<&'a Block>) {
            for block in blocks {
                found.push(block);
                if let Block::Fold(_, inner) = block {
                    collect(inner, found);
                }
            }
        }
        let mut found = vec![];
        self.sections.iter().for_each(|section| collect(&section.blocks, &mut found));
        found
    }

    /// All figures, in their order.
    pub fn figures(&self) -> Vec<&Figure> {
        let blocks = self.blocks().into_iter();
        blocks.filter_map(|block| if let Block::Figure(figure) = block { Some(&**figure) } else { None }).collect()
    }

    /// What no run has measured.
    pub fn missing(&self) -> Vec<&Missing> {
        let blocks = self.blocks().into_iter();
        blocks.filter_map(|block| if let Block::Missing(missing) = block { Some(missing) } else { None }).collect()
    }
}
