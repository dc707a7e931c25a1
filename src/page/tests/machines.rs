//! Comparisons of several machines stand side by side and are never mixed.

use super::*;
use crate::page::results::{Results, ResultsError};
use crate::report::Table;
use crate::report::document::Block;

/// The records as another machine would measure them, which takes so many times as long; our trees over an exact triangle test.
fn on(cpu: &str, factor: f64, records: Vec<Record>) -> Vec<Record> {
    let of = |mut record: Record| {
        record.provenance.cpu = cpu.into();
        record.workload_hash = record.workload.clone();
        record.trace_ns = record.trace_ns.map(|ns| factor * ns);
        record.mrays_per_s = record.mrays_per_s.map(|speed| speed / factor);
        record.samples_ns.iter_mut().for_each(|ns| *ns *= factor);
        if !record.structure.starts_with("obvhs") {
            record.triangle_test = "exact".into();
        }
        record
    };
    records.into_iter().map(of).collect()
}

fn runs_of(files: &[(&str, Vec<Record>)]) -> Runs {
    let files: Vec<(&str, Vec<u8>)> = files.iter().map(|(name, records)| (*name, to_json(records))).collect();
    read(runs_folder(&files).path())
}

/// The blocks of the section, if there is one.
fn section(runs: &Runs) -> Option<Vec<Block>> {
    let sections = document(runs, vec![]).sections;
    let place = sections.iter().position(|section| section.id == "machines")?;
    assert_eq!(sections[place - 1].id, "compare");
    Some(sections[place].blocks.clone())
}

fn tables(blocks: &[Block]) -> Vec<&Table> {
    blocks
        .iter()
        .filter_map(|block| if let Block::Table(tabular) = block { Some(&tabular.table) } else { None })
        .collect()
}

fn first_text(blocks: &[Block]) -> &str {
    let Some(Block::Text(text)) = blocks.first() else { panic!("no text") };
    text
}

#[test]
fn a_machine_that_is_slower_throughout_has_the_same_ratios_and_replaces_nothing() {
    let both = [records_of("Dragon"), records_of("Cube")].concat();
    let runs = runs_of(&[("a.json", on("Quick", 1.0, both)), ("b.json", on("Slow", 3.0, records_of("Dragon")))]);
    assert!(runs.sources.iter().all(|source| source.replaced.is_empty()), "{:?}", runs.sources);
    assert!(runs.records().len() == 12 && runs.records().iter().all(|r| r.provenance.cpu == "Quick"));

    let blocks = section(&runs).unwrap();
    let tables = tables(&blocks);
    assert_eq!(
        tables.iter().map(|table| table.rows.len()).collect::<Vec<_>>(),
        [2, 1],
        "right answers, single precision"
    );
    for table in tables {
        assert_eq!(table.columns, ["structure", "M1 #", "M1 x obvhs", "M2 #", "M2 x obvhs"]);
        for row in &table.rows {
            assert_eq!(row[1..3], row[3..5], "{row:?}");
            assert!(!row[2].text.is_empty(), "{row:?}");
        }
        let notes = table.notes.join("\n");
        assert!(notes.contains("M1: Quick, ") && notes.contains("M2: Slow, "), "{notes}");
        // Three structures on two kinds of rays of the other scene.
        assert!(notes.contains("Over 6 cases") && notes.contains("Left out: 6 cases"), "{notes}");
        assert!(notes.contains("No number relates one machine to another"), "{notes}");
    }
    let text = first_text(&blocks);
    assert!(text.contains("The fastest with right answers: sah-kd on M1 and M2."), "{text}");
    assert!(text.contains("The fastest in single precision: obvhs-bvh2 on M1 and M2."), "{text}");
    assert!(text.contains("Of 2 structures none has"), "the reference is not counted: {text}");
    let Some(Block::Figure(figure)) = blocks.iter().find(|block| matches!(block, Block::Figure(_))) else {
        panic!("no chart")
    };
    let Art::Chart(crate::report::plot::Chart::Bars(bars)) = &figure.art else { panic!("no bars") };
    assert_eq!((bars.labels.len(), bars.groups.len()), (3, 2));

    let whole = document(&runs, vec![]);
    assert!(page(&whole).contains("M2: Slow, "));
    let Err(error) = Results::new(&whole, &runs, &Studies::builtin()) else { panic!("two machines are one run") };
    assert!(matches!(error, ResultsError::Mixed { what: "machine", .. }), "{error}");
}

#[test]
fn ratios_that_differ_between_machines_are_named() {
    let mut other = on("Other", 1.0, records_of("Dragon"));
    for record in other.iter_mut().filter(|record| record.label == "median-kd") {
        record.samples_ns.iter_mut().for_each(|ns| *ns /= 100.0);
    }
    let blocks = section(&runs_of(&[("a.json", on("One", 1.0, records_of("Dragon"))), ("b.json", other)])).unwrap();
    let text = first_text(&blocks);
    // The newer one of two with as many times leads.
    assert!(text.contains("The fastest with right answers: median-kd on M1; sah-kd on M2."), "{text}");
    assert!(
        text.contains("Of 2 structures 1 has ratios whose intervals lie apart on two machines: median-kd."),
        "{text}"
    );
}

#[test]
fn scenes_of_different_machines_are_no_common_rank() {
    let (dragon, cube) = (records_of("Dragon"), records_of("Cube"));
    let mut other = on("Other", 1.0, cube);
    other.truncate(5);
    let runs = runs_of(&[("a.json", on("One", 1.0, dragon)), ("b.json", other)]);
    assert!(runs.records().len() == 6 && runs.records().iter().all(|record| record.scene == "Dragon"));
    let blocks = section(&runs).unwrap();
    let text = first_text(&blocks);
    assert!(tables(&blocks).is_empty() && text.contains("nothing is side by side"), "{text}");
    assert!(text.contains("One, ") && text.contains("Other, ") && text.contains("Left out: 11 cases"), "{text}");
}

#[test]
fn one_machine_has_no_such_section_and_replaces_its_own_runs_alone() {
    let dragon = |cpu: &str| on(cpu, 1.0, records_of("Dragon"));
    assert!(section(&runs_of(&[("a.json", dragon("One"))])).is_none());
    let files = ["a.json", "b.json", "c.json"].into_iter().zip(["One", "Other", "One"].map(dragon));
    let runs = runs_of(&files.collect::<Vec<_>>());
    let replaced: Vec<bool> = runs.sources.iter().map(|source| !source.replaced.is_empty()).collect();
    assert_eq!(replaced, [true, false, false]);
    assert_eq!(runs.machines.iter().map(|one| one.machine.cpu.as_str()).collect::<Vec<_>>(), ["One", "Other"]);
}

#[test]
fn of_two_builds_the_one_with_the_most_times_counts() {
    let built = |commit: &str, mut records: Vec<Record>| {
        records.iter_mut().for_each(|record| record.provenance.commit = commit.into());
        records
    };
    let both = [records_of("Dragon"), records_of("Cube")].concat();
    let runs = runs_of(&[("a.json", built("c0ffee", both)), ("b.json", built("decade", records_of("Torus")))]);
    assert!(runs.records().len() == 12 && runs.records().iter().all(|r| r.provenance.commit == "c0ffee"));
    let replaced: Vec<bool> = runs.sources.iter().map(|source| !source.replaced.is_empty()).collect();
    assert_eq!(replaced, [false, true]);
    assert!(section(&runs).is_none());
}

#[test]
fn a_machine_of_other_scenes_is_named_and_the_others_stand_side_by_side() {
    let dragon = |cpu: &str| on(cpu, 1.0, records_of("Dragon"));
    // The newest of as many times leads the page, and shares nothing with the others.
    let third = on("Third", 1.0, records_of("Cube"));
    let runs = runs_of(&[("a.json", dragon("One")), ("b.json", dragon("Other")), ("c.json", third)]);
    assert!(runs.records().iter().all(|record| record.scene == "Cube"));
    let blocks = section(&runs).unwrap();
    let tables = tables(&blocks);
    assert_eq!(tables[0].columns, ["structure", "M1 #", "M1 x obvhs", "M2 #", "M2 x obvhs"]);
    let notes = tables[0].notes.join("\n");
    assert!(notes.contains("M1: One, ") && notes.contains("M2: Other, ") && notes.contains("Over 6 cases"), "{notes}");
    let text = format!("{blocks:?}");
    assert!(text.contains("Not beside them") && !text.contains("Left out"), "{text}");
}

#[test]
fn a_machine_with_a_few_of_the_cases_does_not_keep_the_others_from_being_shown() {
    let both = |cpu: &str| on(cpu, 1.0, [records_of("Dragon"), records_of("Cube")].concat());
    let mut few = on("Third", 1.0, records_of("Cube"));
    let kind = few[0].workload.clone();
    few.retain(|record| record.workload == kind);
    let runs = runs_of(&[("a.json", both("One")), ("b.json", both("Other")), ("c.json", few.clone())]);
    let text = format!("{:?}", section(&runs).unwrap());
    assert!(text.contains("Over 12 cases") && text.contains("Not beside them"), "{text}");
    // Beside one machine alone they are better than nothing.
    let runs = runs_of(&[("a.json", both("One")), ("b.json", few)]);
    let text = format!("{:?}", section(&runs).unwrap());
    assert!(text.contains("Over 3 cases") && text.contains("Left out: 9 cases"), "{text}");
}

#[test]
fn a_study_of_another_machine_says_so() {
    let files = |cpu: &str| {
        let files = [exported(&on(cpu, 1.0, records_of("Cube"))), accuracy("Cube")].concat();
        read(runs_folder(&files).path())
    };
    let says = |runs: &Runs| page(&document(runs, vec![])).contains("Measured on a processor, ");
    assert!(says(&files("Other")) && !says(&files("a processor")));
}
