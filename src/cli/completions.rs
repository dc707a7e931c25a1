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
    terminal.print(&text(suite, &args.form)?);
    Ok(Status::Right)
}

fn text(suite: &Suite, form: &str) -> anyhow::Result<String> {
    let (mut output, mut command) = (vec![], super::shown(&suite.studies));
    let Ok(shell) = form.parse::<Shell>() else {
        // The page of the command, then those of all that it can be told to do.
        command = command.disable_help_subcommand(true);
        command.build();
        Man::new(command.clone()).render(&mut output)?;
        command.get_subcommands().try_for_each(|own| Man::new(own.clone()).render(&mut output))?;
        return Ok(String::from_utf8(output)?);
    };
    clap_complete::generate(shell, &mut told(&suite.registry, command), "sahara", &mut output);
    // Where a scene is expected, a file is right as well: zsh offers what is listed and nothing else.
    let scenes = scenes().join(" ");
    Ok(String::from_utf8(output)?.replace(&format!(":({scenes})"), &format!(":{{ compadd {scenes}; _files }}")))
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
    fn the_manual_and_the_scripts_name_everything_and_nothing_hidden() {
        let suite = Suite::from(Registry::builtin());
        let manual = &["sahara\\-compare", "sahara\\-report", "\\-\\-fail\\-on\\-regression", "\\-\\-results"][..];
        let names = &["replicate", "dragon", "sah-hybrid", "image-shadow", "heat", "attribution"];
        for (form, parts) in [("man", manual), ("bash", names), ("zsh", names), ("fish", names)] {
            let text = text(&suite, form).unwrap();
            for part in parts {
                assert!(text.contains(part), "{form}: {part}");
            }
            for hidden in [crate::cli::validate::CHILD, "--case", "compare-runs"] {
                assert!(!text.contains(hidden), "{form}: {hidden}");
            }
        }
        // The command itself takes more than names.
        let args = ["sahara", "compare", "my-mesh.obj", "-s", "sah-kd:leaf=4", "--reference", "median-kd:leaf=8"];
        let whole = || super::super::shown(&suite.studies);
        assert!(whole().try_get_matches_from(args).is_ok());
        assert!(told(&suite.registry, whole()).try_get_matches_from(args).is_err());
    }
}
