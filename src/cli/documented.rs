//! Checks that every command in a document of this repository exists.

use std::fs;
use std::path::{Path, PathBuf};

use clap::error::ErrorKind;

use crate::study::Studies;

/// All documents below `folder`, except those in build folders.
pub fn documents(folder: &Path, into: &mut Vec<PathBuf>) {
    for entry in fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        let name = path.file_name().unwrap().to_string_lossy().into_owned();
        if path.is_dir() && name != "target" && !name.starts_with('.') {
            documents(&path, into);
        } else if name.ends_with(".md") {
            into.push(path);
        }
    }
}

/// The lines of code in a document.
fn code(text: &str) -> impl Iterator<Item = &str> {
    text.split("```").skip(1).step_by(2).flat_map(str::lines)
}

/// The commands of a document: its lines of code that begin with a command, including continuation lines, and the
/// commands within sentences.
fn commands(text: &str) -> (Vec<String>, Vec<String>) {
    let text = &text.replace("\\\n", " ");
    let own = |text: &str| {
        let rest = text.strip_prefix("$ ").unwrap_or(text);
        let cargo = rest.strip_prefix("cargo run --release");
        let cargo = cargo.map(|rest| rest.split_once("-- ").map_or("", |(_, args)| args));
        // The line of a manifest names the crate.
        let args = cargo.or_else(|| rest.strip_prefix("sahara ").filter(|rest| !rest.starts_with('=')))?;
        Some(format!("sahara {args}"))
    };
    let lines = code(text).map(|line| line.split("  #").next().unwrap_or(line)).map(str::trim).filter_map(own);
    let spans = text.split('`').skip(1).step_by(2).filter(|span| span.starts_with("sahara ")).map(String::from);
    (lines.collect(), spans.collect())
}

#[test]
fn commands_of_documents_are_understood() {
    let mut found = vec![];
    documents(Path::new(env!("CARGO_MANIFEST_DIR")), &mut found);
    let parsed = |line: &str| {
        let words = shlex::split(line).unwrap_or_else(|| panic!("{line}"));
        let words = words.into_iter().take_while(|word| !word.starts_with(['#', '>', '|']));
        super::command(&Studies::builtin()).try_get_matches_from(words)
    };
    let mut understood = 0;
    for path in &found {
        let (lines, spans) = commands(&fs::read_to_string(path).unwrap());
        for line in &lines {
            parsed(line).unwrap_or_else(|error| panic!("{}: {line}: {error}", path.display()));
        }
        // Sentences name commands without their arguments.
        let whole = |error: &clap::Error| {
            matches!(
                error.kind(),
                ErrorKind::MissingRequiredArgument | ErrorKind::DisplayHelpOnMissingArgumentOrSubcommand
            )
        };
        // A placeholder is not a name, and a line of a protocol is not a command.
        let is_command = |span: &&String| !["NAME", "THREADS", "JSON", "\n"].iter().any(|other| span.contains(other));
        let spans: Vec<&String> = spans.iter().filter(is_command).collect();
        for span in &spans {
            if let Some(error) = parsed(span).err().filter(|error| !whole(error)) {
                panic!("{}: {span}: {error}", path.display());
            }
        }
        understood += lines.len() + spans.len();
    }
    assert!(understood > 60, "{understood} commands in {} documents", found.len());
}
