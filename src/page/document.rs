//! The content of a page, independent of the file format.

use serde::Serialize;

use crate::report::plot::Chart;
use crate::report::{Block, Figure, Missing};

#[derive(Clone, Debug, Default)]
pub struct Document {
    pub title: String,
    pub answer: Answer,
    pub sections: Vec<Section>,
}

#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct Answer {
    /// May be empty.
    pub banner: String,
    /// A few words, such as `Yes`.
    pub verdict: String,
    /// The first sentence is the most important sentence.
    pub sentences: Vec<String>,
    pub numbers: Vec<Headline>,
    #[serde(skip)]
    pub chart: Option<Chart>,
}

#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Headline {
    pub number: String,
    /// May be empty.
    pub interval: String,
    pub label: String,
}

#[derive(Clone, Debug, Default)]
pub struct Section {
    /// Letters, digits and hyphens. Unique among the sections.
    pub id: &'static str,
    pub title: &'static str,
    /// One command per line. May be empty.
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
