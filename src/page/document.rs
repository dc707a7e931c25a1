//! The content of a page, independent of its format: the answer, and sections of text, tables and figures.

use serde::Serialize;

use crate::report::plot::Chart;
use crate::report::{Block, Figure, Missing};

#[derive(Clone, Debug, Default)]
pub struct Document {
    pub title: String,
    pub answer: Answer,
    pub sections: Vec<Section>,
}

/// The summary at the top of a page.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct Answer {
    /// A warning above the verdict; may be empty.
    pub banner: String,
    /// A few words, such as `Yes`.
    pub verdict: String,
    /// The sentences that support the verdict, most important first.
    pub sentences: Vec<String>,
    pub numbers: Vec<Headline>,
    /// A chart of the numbers; `None` without numbers.
    #[serde(skip)]
    pub chart: Option<Chart>,
}

/// A single number of the summary.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Headline {
    /// Printed in large type: `20.6 ×`.
    pub number: String,
    /// The interval of the number; may be empty.
    pub interval: String,
    pub label: String,
}

/// A part of a report with its heading.
#[derive(Clone, Debug, Default)]
pub struct Section {
    /// Letters, digits and hyphens; unique among the sections.
    pub id: &'static str,
    pub title: &'static str,
    /// The commands that produced the section, one per line; may be empty.
    pub command: String,
    pub blocks: Vec<Block>,
}

impl Document {
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

    pub fn figures(&self) -> Vec<&Figure> {
        let blocks = self.blocks().into_iter();
        blocks.filter_map(|block| if let Block::Figure(figure) = block { Some(&**figure) } else { None }).collect()
    }

    pub fn missing(&self) -> Vec<&Missing> {
        let blocks = self.blocks().into_iter();
        blocks.filter_map(|block| if let Block::Missing(missing) = block { Some(missing) } else { None }).collect()
    }
}
