//! `completions`, and the manual page.

use clap::builder::PossibleValuesParser;
use clap::{Arg, Command, ValueHint};
use clap_complete::Shell;
use clap_mangen::Man;

use super::Suite;
use super::terminal::Terminal;
use crate::registry::Registry;
use crate::render::ViewKind;
use crate::scene::{BUILTIN, WorkloadKind};
use crate::study::Status;

#[derive(Debug, clap::Args)]
pub struct Args {
    /// The shell; or `man` for the manual page
    #[arg(value_name = "SHELL|man", value_parser = ["bash", "elvish", "fish", "powershell", "zsh", "man"])]
    form: String,
}

pub fn run(suite: &Suite, args: &Args, terminal: &Terminal) -> anyhow::Result<Status> {
    let mut output = vec![];
    match args.form.parse::<Shell>() {
        Ok(shell) => {
            let mut command = told(&suite.registry, super::shown(&suite.studies));
            clap_complete::generate(shell, &mut command, "sahara", &mut output);
            // Where a scene is expected, a file is right as well: zsh offers what is listed and nothing else.
            let scenes = scenes().join(" ");
            let both = format!(":{{ compadd {scenes}; _files }}");
            output = String::from_utf8_lossy(&output).replace(&format!(":({scenes})"), &both).into_bytes();
        }
        // The manual page is for no shell.
        Err(_) => manual(super::shown(&suite.studies), &mut output)?,
    }
    terminal.print(&String::from_utf8_lossy(&output));
    Ok(Status::Right)
}

/// The manual page of the command, then those of all that it can be told to do.
fn manual(command: Command, output: &mut Vec<u8>) -> std::io::Result<()> {
    let mut command = command.disable_help_subcommand(true);
    command.build();
    Man::new(command.clone()).render(output)?;
    command.get_subcommands().try_for_each(|own| Man::new(own.clone()).render(output))
}

/// `command` as a shell is told of it: with names in the place of what is free text for the command itself, which takes
/// files, keys and values as well.
fn told(registry: &Registry, command: Command) -> Command {
    command.mut_args(|arg| arg_told(registry, arg)).mut_subcommands(|inner| told(registry, inner))
}

fn arg_told(registry: &Registry, arg: Arg) -> Arg {
    let expected = arg.get_value_names().and_then(|names| names.first()).map_or("", |name| name.as_str());
    let names = match (expected, arg.get_id().as_str()) {
        ("SCENE|FILE" | "SCENE" | "SCENE|F.toml", _) => scenes(),
        (_, "structure" | "against" | "reference") => registry.names().into_iter().map(String::from).collect(),
        (_, "workload") => WorkloadKind::ALL.map(|kind| kind.name().into()).into(),
        (_, "view") => ViewKind::ALL.map(|view| view.name().into()).into(),
        ("DIR", _) => return arg.value_hint(ValueHint::DirPath),
        (file, _) if file.starts_with("FILE") || file.starts_with("F.") => {
            return arg.value_hint(ValueHint::FilePath);
        }
        _ => return arg,
    };
    arg.value_parser(PossibleValuesParser::new(names))
}

fn scenes() -> Vec<String> {
    BUILTIN.iter().map(|builtin| builtin.name.to_lowercase()).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_manual_has_every_command_with_its_options() {
        let mut page = vec![];
        manual(super::super::shown(&Suite::from(Registry::builtin()).studies), &mut page).unwrap();
        let page = String::from_utf8(page).unwrap();
        assert!(page.starts_with(".ie") || page.starts_with(".TH"), "{}", &page[..80]);
        for part in ["sahara\\-compare", "sahara\\-report", "\\-\\-fail\\-on\\-regression", "\\-\\-results"] {
            assert!(page.contains(part), "{part}");
        }
    }

    #[test]
    fn shells_know_scenes_structures_workloads_and_views_and_nothing_hidden() {
        let suite = Suite::from(Registry::builtin());
        let whole = || super::super::shown(&suite.studies);
        for shell in [Shell::Bash, Shell::Zsh, Shell::Fish] {
            let mut script = vec![];
            clap_complete::generate(shell, &mut told(&suite.registry, whole()), "sahara", &mut script);
            let script = String::from_utf8(script).unwrap();
            for word in ["replicate", "dragon", "sah-hybrid", "image-shadow", "heat", "attribution"] {
                assert!(script.contains(word), "{shell}: {word}");
            }
            for hidden in [crate::cli::validate::CHILD, "--case", "compare-runs"] {
                assert!(!script.contains(hidden), "{shell}: {hidden}");
            }
        }
        // The command itself takes more than names.
        let args = ["sahara", "compare", "my-mesh.obj", "-s", "sah-kd:leaf=4", "--reference", "median-kd:leaf=8"];
        assert!(whole().try_get_matches_from(args).is_ok());
        assert!(told(&suite.registry, whole()).try_get_matches_from(args).is_err());
    }
}
