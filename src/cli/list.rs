//! `list`.

use serde_json::Value;

use super::Verdict;
use super::terminal::Terminal;
use crate::accel::{Observed, Query};
use crate::registry::Registry;
use crate::render::ViewKind;
use crate::report::number::count;
use crate::report::{Cell, Table, Tone};
use crate::scene::{BUILTIN, WorkloadKind, real_mesh_folder};

pub fn run(registry: &Registry, terminal: &Terminal) -> anyhow::Result<Verdict> {
    terminal.print_table(&scenes()?)?;
    terminal.print_table(&structures(registry))?;
    terminal.print_table(&workloads())?;
    terminal.print_table(&table("Views", &["name"], ViewKind::ALL.map(|view| vec![view.name().into()]).into()))?;
    Ok(Verdict::Right)
}

fn scenes() -> anyhow::Result<Table> {
    let real_meshes = real_mesh_folder();
    let mut rows = vec![];
    for builtin in BUILTIN {
        let scene = builtin.scene(Some(&real_meshes))?;
        let difficulty = format!("{:?}", builtin.difficulty).to_lowercase();
        let meshes = if scene.stand_ins.is_empty() { "as described" } else { "stand-in" };
        let mirrors = if scene.has_mirrors() { "yes" } else { "no" };
        rows.push(
            [
                builtin.name,
                &difficulty,
                &count(scene.mesh.len() as u64),
                &scene.lights.len().to_string(),
                mirrors,
                meshes,
            ]
            .map(Cell::from)
            .into(),
        );
    }
    Ok(table("Scenes", &["name", "difficulty", "triangles", "lights", "mirrors", "meshes"], rows))
}

/// Every structure with the triangle tests it is offered over, the default first; then what it does otherwise than the others
/// by design, whether it is absent, and its keys with their defaults.
fn structures(registry: &Registry) -> Table {
    let (mut rows, mut notes) = (vec![], vec![]);
    for name in registry.names() {
        let mut entries = registry.entries().iter().filter(|entry| entry.name == name).peekable();
        let Some(&first) = entries.peek() else { continue };
        rows.push(vec![name.into(), "".into()]);
        for entry in entries {
            rows.push(vec!["  test".into(), entry.triangle_test.into()]);
        }
        for declined in first.capabilities.declined() {
            rows.push(vec!["  declines".into(), declined.into()]);
        }
        if first.observed != Observed::ALL {
            let what = if first.observed.tests {
                "steps"
            } else if first.observed.steps {
                "triangle tests"
            } else {
                "all counts"
            };
            rows.push(vec!["  declines".into(), what.into()]);
        }
        if !first.conventions.is_empty() {
            notes.push(format!("{name}, otherwise by design: {}.", first.conventions.join("; ")));
        }
        if let Some(absence) = first.absence() {
            rows.push(vec!["  absent".into(), Cell::from("see below").with(Tone::Wrong)]);
            notes.push(format!("{name} is absent: {absence}."));
        }
        for (key, value) in first.config().as_object().into_iter().flatten() {
            let value = match value {
                Value::String(text) => text.clone(),
                other => other.to_string(),
            };
            rows.push(vec![format!("  {key}").into(), value.into()]);
        }
    }
    let title = "Structures, their triangle tests (the first is the default) and keys";
    Table { notes, ..table(title, &["name", "default"], rows) }
}

fn workloads() -> Table {
    let query = |kind: WorkloadKind| if kind.query() == Query::Any { "any hit" } else { "closest hit" };
    let rows = WorkloadKind::ALL.map(|kind| vec![kind.name().into(), query(kind).into()]);
    table("Workloads", &["name", "query"], rows.into())
}

fn table(title: &str, columns: &[&str], rows: Vec<Vec<Cell>>) -> Table {
    Table { title: title.into(), columns: columns.iter().map(|c| (*c).into()).collect(), rows, notes: vec![] }
}
