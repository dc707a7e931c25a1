//! What a page says, before it has a form: the answer, and sections of text, tables and figures.

use crate::report::plot::Chart;
use crate::report::{Block, Figure, Missing};

#[derive(Clone, Debug, Default)]
pub struct Document {
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
    pub label: String,
}

/// A part of a report with a heading of its own.
#[derive(Clone, Debug, Default)]
pub struct Section {
    /// Letters, digits and hyphens; no two sections share one.
    pub id: &'static str,
    pub title: &'static str,
    /// The commands that made it, a line each; empty where there is none.
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
