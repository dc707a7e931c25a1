//! The data of a ray inspector as its script reads them: columns, so that a few thousand rays stay small.

use serde::ser::SerializeSeq;
use serde::{Serialize, Serializer};

use super::json::json;
use crate::report::inspector::{Answer, InspectedStructure, Inspector};

#[derive(Serialize)]
struct InspectorData<'a> {
    size: [u32; 2],
    which: &'a str,
    command: &'a str,
    pixels: Vec<u32>,
    rays: Vec<&'a str>,
    truths: Vec<AnswerData<'a>>,
    answers: Vec<Vec<AnswerData<'a>>>,
    structures: Vec<StructureData<'a>>,
}

#[derive(Serialize)]
struct StructureData<'a> {
    label: &'a str,
    nodes: &'a [u64],
    leaves: &'a [u64],
    tests: &'a [u64],
    answers: &'a [usize],
}

impl<'a> From<&'a InspectedStructure> for StructureData<'a> {
    fn from(s: &'a InspectedStructure) -> Self {
        Self { label: &s.label, nodes: &s.nodes, leaves: &s.leaves, tests: &s.tests, answers: &s.answers }
    }
}

/// `[t, triangle, u, v]`, or `[]` of a miss; what is wrong with it stands behind.
struct AnswerData<'a>(&'a Answer);

impl Serialize for AnswerData<'_> {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let mut fields = serializer.serialize_seq(None)?;
        if let Some(hit) = &self.0.hit {
            fields.serialize_element(&hit.t)?;
            fields.serialize_element(&hit.triangle)?;
            for weight in hit.weights {
                // As many digits as are printed.
                fields.serialize_element(&(libm::round(weight * 1e9) / 1e9))?;
            }
        }
        if !self.0.wrong.is_empty() {
            fields.serialize_element(self.0.wrong)?;
        }
        fields.end()
    }
}

/// As JSON that may stand in a script element.
pub fn data(inspector: &Inspector) -> String {
    let rays = &inspector.rays;
    let data = InspectorData {
        size: inspector.size,
        which: &inspector.which,
        command: &inspector.command,
        pixels: rays.iter().map(|ray| ray.pixel).collect(),
        rays: rays.iter().map(|ray| ray.text.as_str()).collect(),
        truths: rays.iter().map(|ray| AnswerData(&ray.truth)).collect(),
        answers: rays.iter().map(|ray| ray.answers.iter().map(AnswerData).collect()).collect(),
        structures: inspector.structures.iter().map(StructureData::from).collect(),
    };
    json(&data)
}
