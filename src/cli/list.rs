//! The command `list`: prints lists of names, or the options of one structure.

use super::Suite;
use super::terminal::Terminal;
use super::validate::described;
use crate::accel::Observed;
use crate::builtin::{BUILTIN, real_mesh_folder};
use crate::names::suggestion;
use crate::registry::{Entry, Registry};
use crate::render::ViewKind;
use crate::report::number::count;
use crate::report::words::each_once;
use crate::report::{Cell, Table, Tone};
use crate::request::RayKind;
use crate::scene::WorkloadKind;
use crate::scene::meshes::GENERATORS;
use crate::study::Status;

#[derive(Debug, clap::Args)]
pub struct Args {
    /// A structure (prints its options), `scenes`, `structures`, `studies` or `hard` [default: all names]
    #[arg(value_name = "STRUCTURE|KIND")]
    what: Option<String>,
}

const KINDS: [&str; 4] = ["scenes", "structures", "studies", "hard"];

pub fn run(suite: &Suite, args: &Args, terminal: &Terminal) -> anyhow::Result<Status> {
    let registry = &suite.registry;
    let table = match args.what.as_deref().map(str::to_lowercase).as_deref() {
        None => names(suite),
        Some("scenes") => scenes()?,
        Some("structures") => structures(registry),
        Some("studies") => {
            let rows = suite.studies.iter().map(|study| [study.name, study.question].map(String::from)).collect();
            Table::of_texts("Studies", ["name", "what it does"], rows)
        }
        Some("hard") => {
            terminal.print_lines(described());
            return Ok(Status::Right);
        }
        Some(name) => {
            let known = registry.names();
            let (near, all, lists) = (suggestion(name, known.iter().copied()), known.join(", "), KINDS.join(", "));
            anyhow::ensure!(
                known.iter().any(|known| known.eq_ignore_ascii_case(name)),
                "there is no structure {name:?}{near}; the structures are: {all}; other lists: {lists}"
            );
            keys(registry, name)
        }
    };
    terminal.print_table(&table);
    Ok(Status::Right)
}

fn names(suite: &Suite) -> Table {
    let tests = each_once(suite.registry.entries().iter().map(|entry| entry.triangle_test));
    let lines = [
        ("scenes", BUILTIN.iter().map(|builtin| builtin.name).collect()),
        ("meshes of scene files", GENERATORS.iter().map(|generator| generator.name).collect()),
        ("structures", suite.registry.names()),
        ("triangle tests", tests),
        ("workloads", WorkloadKind::ALL.map(WorkloadKind::name).into()),
        ("workloads of `study accuracy`", RayKind::ALL.map(RayKind::name).into()),
        ("views", ViewKind::ALL.map(ViewKind::name).into()),
        ("studies", suite.studies.iter().map(|study| study.name).collect()),
    ];
    // Unlike the cells of a table, notes are wrapped.
    let notes = lines.into_iter().map(|(what, names): (&str, Vec<&str>)| format!("{what}: {}.", names.join(", ")));
    let more = format!("More: `sahara list STRUCTURE` (its options), or: {}.", KINDS.join(", "));
    Table { title: "Names".into(), ..Table::default() }.noted(notes.chain([more]))
}

fn scenes() -> anyhow::Result<Table> {
    let real_meshes = real_mesh_folder();
    let mut rows = vec![];
    for builtin in BUILTIN {
        let scene = builtin.scene(Some(&real_meshes))?;
        let difficulty = format!("{:?}", builtin.difficulty).to_lowercase();
        let meshes = if scene.stand_ins.is_empty() { "" } else { "stand-in" };
        let mirrors = if scene.has_mirrors() { "yes" } else { "no" };
        let (triangles, lights) = (count(scene.mesh.len() as u64), scene.lights.len().to_string());
        rows.push([builtin.name, &difficulty, &triangles, &lights, mirrors, meshes].map(String::from));
    }
    Ok(Table::of_texts("Scenes", ["name", "difficulty", "triangles", "lights", "mirrors", "meshes"], rows))
}

fn structures(registry: &Registry) -> Table {
    let (mut rows, mut notes) = (vec![], vec![]);
    for name in registry.names() {
        let entries: Vec<&Entry> = registry.entries().iter().filter(|entry| entry.name == name).collect();
        let first = entries[0];
        let tests: Vec<&str> = entries.iter().map(|entry| entry.triangle_test).collect();
        let (shown, rest) = tests.split_at(tests.len().min(2));
        let more = if rest.is_empty() { String::new() } else { format!(" and {} more", rest.len()) };
        let absent = if first.absence().is_some() { Cell::from("absent").with(Tone::Wrong) } else { Cell::empty() };
        let declined = declined(first).join(", ");
        rows.push(vec![name.into(), format!("{}{more}", shown.join(", ")).into(), declined.into(), absent]);
        notes.extend(remarks(first));
    }
    let title = "Structures and their triangle tests; the first is the default";
    Table::new(title, ["name", "triangle tests", "declines", ""], rows).noted(notes)
}

fn declined(entry: &Entry) -> Vec<&'static str> {
    let mut declined = entry.capabilities.declined();
    if entry.observed != Observed::ALL {
        declined.push(match entry.observed {
            Observed { tests: true, .. } => "counts of steps",
            Observed { steps: true, .. } => "counts of triangle tests",
            _ => "all counts",
        });
    }
    declined
}

fn remarks(entry: &Entry) -> impl Iterator<Item = String> {
    let (name, conventions) = (&entry.name, entry.conventions.join("; "));
    let deviation = format!("{name} deviates by design from the contract of `Accel`: {conventions}.");
    let absence = entry.absence().map(|absence| format!("{name} is not available: {absence}."));
    (!conventions.is_empty()).then_some(deviation).into_iter().chain(absence)
}

fn keys(registry: &Registry, name: &str) -> Table {
    let entries: Vec<&Entry> = registry.entries().iter().filter(|e| e.name.eq_ignore_ascii_case(name)).collect();
    let first = entries[0];
    let tests: Vec<&str> = entries.iter().map(|entry| entry.triangle_test).collect();
    let test = [String::from("test"), tests[0].into(), "the triangle test".into(), tests.join(", ")];
    let key = |key: crate::registry::Key| [key.name, key.default, key.meaning.into(), key.values];
    let rows = std::iter::once(test).chain(first.keys().into_iter().map(key));
    // Long lists of values become notes. Unlike the cells of a table, notes are wrapped.
    let (mut shown, mut notes) = (vec![], vec![]);
    for [key, default, meaning, values] in rows {
        let short = values.chars().count() <= 28;
        shown.push([key.clone(), default, if short { values.clone() } else { "see below".into() }]);
        let parts = [meaning, if short { String::new() } else { values }];
        let words = parts.into_iter().filter(|words| !words.is_empty()).collect::<Vec<_>>().join(": ");
        if !words.is_empty() {
            notes.push(format!("{key}: {words}."));
        }
    }
    let declined = declined(first);
    if !declined.is_empty() {
        notes.push(format!("{} does not support: {}.", first.name, declined.join(", ")));
    }
    notes.extend(remarks(first));
    let title = format!("{}: options, as in --structure {}:key=value,..", first.name, first.name);
    Table::of_texts(&title, ["key", "default", "values"], shown).noted(notes)
}
