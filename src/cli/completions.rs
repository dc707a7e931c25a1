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
    // The manual page is for no shell.
    let Ok(shell) = args.form.parse::<Shell>() else {
        terminal.print(&String::from_utf8_lossy(&manual(super::command(&suite.studies))?))?;
        return Ok(Status::Right);
    };
    let names = Names::of(&suite.registry);
    let mut script = vec![];
    clap_complete::generate(shell, &mut names.told(&super::command(&suite.studies)), "sahara", &mut script);
    let script = String::from_utf8_lossy(&script);
    // Where a scene is expected, a file is right as well: zsh offers what is listed and nothing else.
    let scenes = names.scenes.join(" ");
    let both = format!(":{{ compadd {scenes}; _files }}");
    terminal.print(&script.replace(&format!(":({scenes})"), &both))?;
    Ok(Status::Right)
}

/// The manual page of the command and of all that it can be told to do, in one.
fn manual(command: Command) -> std::io::Result<Vec<u8>> {
    let mut command = command.name("sahara").disable_help_subcommand(true);
    command.build();
    let mut page = vec![];
    Man::new(command.clone()).render(&mut page)?;
    for own in command.get_subcommands().filter(|own| !own.is_hide_set()) {
        let man = Man::new(own.clone());
        let mut part = vec![];
        man.render_description_section(&mut part)?;
        man.render_options_section(&mut part)?;
        let part = String::from_utf8_lossy(&part).replace("\n.SH ", "\n.SS ");
        page.extend_from_slice(format!("\n.SH \"sahara {}\"\n{part}", own.get_name()).as_bytes());
    }
    Ok(page)
}

/// Commands keep names for ever, and this process ends soon.
fn lasting(name: &str) -> &'static str {
    String::leak(name.to_owned())
}

/// What a shell can offer besides options.
struct Names {
    scenes: Vec<&'static str>,
    structures: Vec<&'static str>,
    workloads: Vec<&'static str>,
    views: Vec<&'static str>,
}

impl Names {
    fn of(registry: &Registry) -> Self {
        Self {
            scenes: BUILTIN.iter().map(|builtin| lasting(&builtin.name.to_lowercase())).collect(),
            structures: registry.names().into_iter().map(lasting).collect(),
            workloads: WorkloadKind::ALL.map(WorkloadKind::name).into(),
            views: ViewKind::ALL.map(ViewKind::name).into(),
        }
    }

    /// `command` as a shell is told of it: without what is hidden, with names in the place of what is free text for the command itself,
    /// which takes files, keys and values as well.
    fn told(&self, command: &Command) -> Command {
        let mut told = Command::new(lasting(command.get_name()));
        if let Some(about) = command.get_about() {
            told = told.about(about.clone());
        }
        if let Some(version) = command.get_version() {
            told = told.version(lasting(version));
        }
        let shown = command.get_subcommands().filter(|subcommand| !subcommand.is_hide_set());
        let args = command.get_arguments().filter(|arg| !arg.is_hide_set());
        told.args(args.map(|arg| self.arg(arg))).subcommands(shown.map(|inner| self.told(inner)))
    }

    fn arg(&self, arg: &Arg) -> Arg {
        let expected = arg.get_value_names().and_then(|names| names.first()).map_or("", |name| name.as_str());
        let id = arg.get_id().as_str();
        let names = match (expected, id) {
            ("SCENE|FILE" | "SCENE" | "SCENE|F.toml", _) => &self.scenes,
            (_, "structure" | "against" | "reference") => &self.structures,
            (_, "workload") => &self.workloads,
            (_, "view") => &self.views,
            ("DIR", _) => return arg.clone().value_hint(ValueHint::DirPath),
            (file, _) if file.starts_with("FILE") || file.starts_with("F.") => {
                return arg.clone().value_hint(ValueHint::FilePath);
            }
            _ => return arg.clone(),
        };
        arg.clone().value_parser(PossibleValuesParser::new(names.clone()))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_manual_has_every_command_with_its_options() {
        let page = manual(super::super::command(&Suite::from(Registry::builtin()).studies)).unwrap();
        let page = String::from_utf8(page).unwrap();
        assert!(page.starts_with(".ie") || page.starts_with(".TH"), "{}", &page[..80]);
        for part in ["sahara compare", "sahara report", "\\-\\-fail\\-on\\-regression", "\\-\\-results"] {
            assert!(page.contains(part), "{part}");
        }
    }

    #[test]
    fn shells_know_scenes_structures_workloads_and_views_and_nothing_hidden() {
        let suite = Suite::from(Registry::builtin());
        let names = Names::of(&suite.registry);
        let whole = || super::super::command(&suite.studies);
        for shell in [Shell::Bash, Shell::Zsh, Shell::Fish] {
            let mut script = vec![];
            clap_complete::generate(shell, &mut names.told(&whole()), "sahara", &mut script);
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
        assert!(names.told(&whole()).try_get_matches_from(args).is_err());
    }
}
