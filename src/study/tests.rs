//! Tests the presets of all studies, and a run with failing scenes.

use clap::Command;

use super::case::tests::example as case;
use super::epoch::tests::example as epoch;
use super::*;
use crate::measure::Provenance;
use crate::report::{Block, Report, Table};

const TINY: Study = Study {
    name: "tiny",
    question: "What becomes of a run in which scenes fail?",
    presets: Presets { full: "", quick: "" },
    options: || Command::new("tiny"),
    plan: |_, _| Ok(plan()),
    report: |dataset, _| {
        let names: Vec<&str> = dataset.scenes().iter().map(|scene| scene.case.scene.name.as_str()).collect();
        let titled = |title: String| Table { title, ..Table::default() };
        let mut blocks: Vec<Block> =
            names.iter().map(|name| Block::Table(titled((*name).into()).of_one_scene())).collect();
        blocks.push(Block::Table(titled(format!("mean of {}", names.join(" ")))));
        Report { blocks, failures: dataset.failures(), ..Report::default() }
    },
};

fn plan() -> Plan {
    let cases = ["a", "b", "c"].iter().flat_map(|scene| [0, 1].map(|epoch| (scene, epoch)));
    Plan { cases: cases.map(|(scene, epoch)| case(scene, epoch, &["x"])).collect(), ..Plan::default() }
}

/// Writes all cases except `without` into the journal. `change` edits each epoch before the write.
fn measured(folder: &std::path::Path, without: &[(&str, usize)], change: fn(&Case, &mut Epoch)) {
    let provenance = Provenance { process_per_epoch: false, ..Provenance::of(&crate::measure::Threads::unstarted(1)) };
    let journal = journal::Journal::open(&folder.join("tiny"), provenance.clone(), false, &[]).unwrap();
    for case in plan().cases {
        if without.contains(&(case.scene.name.as_str(), case.epoch)) {
            continue;
        }
        let mut epoch = epoch(&case.scene.name, 10, case.epoch, &[("x", 50, &[1000; 3])]);
        change(&case, &mut epoch);
        let file = journal::CaseFile::place(&journal.place(&case)).unwrap();
        journal::CaseFile::write(&file, &provenance, &case, &epoch).unwrap();
    }
}

#[derive(Default)]
struct RecordingScreen {
    titles: Vec<String>,
}

impl Screen for RecordingScreen {
    fn table(&mut self, table: &Table) {
        self.titles.push(table.title.clone());
    }
}

fn outcome(folder: &std::path::Path, screen: &mut RecordingScreen) -> RunOutcome {
    let registry = Registry::builtin();
    let mut own = Run { registry: &registry, folder, keep_journal: Some(true), fresh: false, processes: None, screen };
    run(&TINY, &TINY.defaults(), &plan(), &mut own).unwrap()
}

#[test]
fn failing_scenes_are_reported_and_left_out_of_means() {
    let folder = tempfile::tempdir().unwrap();
    // Epoch 1 of scene c has other hits than epoch 0. The journal lacks epoch 1 of scene b. The scenes have no files,
    // so the run cannot measure a missing epoch.
    let other = |case: &Case, epoch: &mut Epoch| {
        if (case.scene.name.as_str(), case.epoch) == ("c", 1) {
            epoch.structures[0].rays[0].checksum = 2;
        }
    };
    measured(folder.path(), &[("b", 1)], other);
    let mut screen = RecordingScreen::default();
    let outcome = outcome(folder.path(), &mut screen);
    let sentences: Vec<String> = outcome.failures.iter().map(ToString::to_string).collect();
    assert!(
        sentences.len() == 2
            && sentences[0].contains("b epoch 1")
            && sentences[1].contains("x on c, primary rays: epochs 0 and 1"),
        "{sentences:?}"
    );
    assert_eq!(outcome.status, Status::Wrong, "wrong hits take precedence over failed measurements");
    assert_eq!(screen.titles, ["a", "b (1 of 2 epochs)"]);
    let titles: Vec<&str> = outcome.tables.iter().map(|table| table.title.as_str()).collect();
    assert!(titles == ["mean of a"] && outcome.dataset.is_some(), "{titles:?}");
}

#[test]
fn presets_are_options_of_each_study() {
    for study in Studies::builtin().iter() {
        for preset in [study.presets.full, study.presets.quick] {
            for scenes in [vec![], vec!["a.ply".into()]] {
                let taken = study.matches(&study.preset(preset, &scenes));
                assert!(taken.is_ok(), "{}: {:?}", study.name, taken.err());
            }
        }
        study.defaults();
    }
}
