//! A test that parses the `sahara` commands in the Markdown files.

use std::fs;
use std::path::{Path, PathBuf};

use clap::error::ErrorKind;

use crate::study::Studies;

pub fn files(folder: &Path, ending: &str) -> Vec<(PathBuf, String)> {
    let mut found = vec![];
    for entry in fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        let name = path.file_name().unwrap().to_string_lossy().into_owned();
        if path.is_dir() && name != "target" && !name.starts_with('.') {
            found.extend(files(&path, ending));
        } else if name.ends_with(ending) {
            let text = fs::read_to_string(&path).unwrap();
            found.push((path, text));
        }
    }
    found
}

/// Returns the commands in code blocks and the commands in inline code.
fn commands(text: &str) -> (Vec<String>, Vec<String>) {
    let text = &text.replace("\\\n", " ");
    let own = |text: &str| {
        let rest = text.strip_prefix("$ ").unwrap_or(text);
        let cargo = rest.strip_prefix("cargo run --release");
        let cargo = cargo.map(|rest| rest.split_once("-- ").map_or("", |(_, args)| args));
        // `sahara = ..` is a line of a Cargo manifest, not a command.
        let args = cargo.or_else(|| rest.strip_prefix("sahara ").filter(|rest| !rest.starts_with('=')))?;
        Some(format!("sahara {args}"))
    };
    let code = text.split("```").skip(1).step_by(2).flat_map(str::lines);
    let lines = code.map(|line| line.split("  #").next().unwrap_or(line)).map(str::trim).filter_map(own);
    // Skip text that contains a placeholder or a line break. `sahara 1 THREADS` is a line of the runner protocol.
    let is_command = |span: &&str| {
        span.starts_with("sahara ") && !["NAME", "THREADS", "JSON", "\n"].iter().any(|other| span.contains(other))
    };
    let spans = text.split('`').skip(1).step_by(2).filter(is_command).map(String::from);
    (lines.collect(), spans.collect())
}

#[test]
fn commands_of_documents_are_understood() {
    let parsed = |line: &str| {
        let words = shlex::split(line).unwrap_or_else(|| panic!("{line}"));
        let words = words.into_iter().take_while(|word| !word.starts_with(['#', '>', '|']));
        super::command(&Studies::builtin()).try_get_matches_from(words)
    };
    // A command in inline code may omit required arguments.
    let partial = [ErrorKind::MissingRequiredArgument, ErrorKind::DisplayHelpOnMissingArgumentOrSubcommand];
    let mut understood = 0;
    for (path, text) in files(Path::new(env!("CARGO_MANIFEST_DIR")), ".md") {
        let (lines, spans) = commands(&text);
        understood += lines.len() + spans.len();
        for (command, may_be_partial) in
            lines.iter().map(|line| (line, false)).chain(spans.iter().map(|own| (own, true)))
        {
            if let Err(error) = parsed(command) {
                let is_partial = may_be_partial && partial.contains(&error.kind());
                assert!(is_partial, "{}: {command}: {error}", path.display());
            }
        }
    }
    assert!(understood > 60, "{understood} commands");
}
