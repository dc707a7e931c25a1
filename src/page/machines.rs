//! The machines that runs were measured on, and what was compared on each.

use std::fmt;

use crate::measure::Provenance;
use crate::report::number::plural;
use crate::study::Study;
use crate::study::compare::{CompareStudy, Compared};

/// What tells machines apart: samples of two of them are never of the same rounds.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Machine {
    pub cpu: String,
    /// Instruction set of our own lanes.
    pub simd: String,
    /// Threads that built and traced.
    pub threads: usize,
}

/// What was compared on one machine by one build.
#[derive(Clone, Debug, PartialEq)]
pub struct OfMachine {
    pub machine: Machine,
    /// The commit, and the digest of the program: [`Provenance::build`].
    pub build: [String; 2],
    pub compared: Compared,
    /// The files that it was read from, by their places among [`Runs::sources`](super::Runs::sources).
    pub sources: Vec<usize>,
}

impl Machine {
    /// The one of a measurement.
    pub fn of(provenance: &Provenance) -> Self {
        let Provenance { cpu, simd, threads, .. } = provenance;
        Self { cpu: cpu.clone(), simd: simd.clone(), threads: *threads }
    }
}

impl fmt::Display for Machine {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}, {}, {}", self.cpu, self.simd, plural(self.threads, "thread"))
    }
}

impl OfMachine {
    /// The answer of the file `source` in parts of one machine and build each, which the records tell. What was refused belongs to the
    /// first of them. `provenance` tells those of an answer without records; nothing is left where neither does.
    pub fn parts(compared: Compared, provenance: Option<&Provenance>, source: usize) -> Vec<Self> {
        let Compared { records, refused, reference, wide } = compared;
        let empty = |provenance: &Provenance| Self {
            machine: Machine::of(provenance),
            build: [&provenance.commit, &provenance.build].map(String::clone),
            compared: Compared { reference: reference.clone(), wide, ..Compared::default() },
            sources: vec![source],
        };
        let mut parts: Vec<Self> = vec![];
        for record in records {
            let own = empty(&record.provenance);
            let known = parts.iter().position(|part| part.is_like(&own));
            let place = known.unwrap_or(parts.len());
            if known.is_none() {
                parts.push(own);
            }
            parts[place].compared.records.push(record);
        }
        if parts.is_empty() {
            parts.extend(provenance.map(empty));
        }
        if let Some(first) = parts.first_mut() {
            first.compared.refused = refused;
        }
        parts
    }

    /// Whether both are of one machine and build.
    pub fn is_like(&self, other: &Self) -> bool {
        self.machine == other.machine && self.build == other.build
    }

    /// Adds a newer answer of the same machine and build; tells whether some of the older one is replaced.
    pub fn merge(&mut self, newer: Self) -> bool {
        self.sources.extend(newer.sources);
        CompareStudy::merge(&mut self.compared, newer.compared)
    }

    /// How many records have a time.
    pub fn timed(&self) -> usize {
        self.compared.records.iter().filter(|record| record.mrays_per_s.is_some()).count()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::report::{Record, example_record};

    #[test]
    fn records_tell_the_machine_of_an_answer_and_its_provenance_does_where_there_are_none() {
        let on = |cpu: &str, simd: &str, threads: usize| {
            let provenance = Provenance { cpu: cpu.into(), simd: simd.into(), threads, ..example_record().provenance };
            Record { provenance, ..example_record() }
        };
        let records = vec![on("A", "avx2", 1), on("B", "avx2", 1), on("A", "avx2", 1), on("A", "portable", 2)];
        let whole = Compared { records, ..Compared::default() };
        let parts = OfMachine::parts(whole, None, 7);
        let named: Vec<(String, usize)> =
            parts.iter().map(|part| (part.machine.to_string(), part.compared.records.len())).collect();
        let named: Vec<(&str, usize)> = named.iter().map(|(name, n)| (name.as_str(), *n)).collect();
        assert_eq!(named, [("A, avx2, 1 thread", 2), ("B, avx2, 1 thread", 1), ("A, portable, 2 threads", 1)]);
        assert!(parts.iter().all(|part| part.sources == [7]));

        let provenance = on("C", "avx512", 1).provenance;
        let parts = OfMachine::parts(Compared::default(), Some(&provenance), 0);
        assert_eq!((parts.len(), parts[0].machine.cpu.as_str(), parts[0].timed()), (1, "C", 0));
        assert!(OfMachine::parts(Compared::default(), None, 0).is_empty());
    }
}
