//! The command `completions`: prints a shell completion script or the manual page.

use clap_complete::Shell;
use clap_mangen::Man;

use super::Suite;
use super::exit_status::STATUSES;
use super::terminal::Terminal;
use crate::study::Status;

#[derive(Debug, clap::Args)]
pub struct Args {
    /// Shell, or `man` for the manual page
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
        // `man` is the only form that is not a shell.
        command = command.disable_help_subcommand(true).after_long_help(STATUSES);
        command.build();
        Man::new(command.clone()).render(&mut output)?;
        command.get_subcommands().try_for_each(|own| Man::new(own.clone()).render(&mut output))?;
        return Ok(String::from_utf8(output)?);
    };
    clap_complete::generate(shell, &mut command, "sahara", &mut output);
    Ok(String::from_utf8(output)?)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::registry::Registry;

    #[test]
    fn the_manual_and_the_scripts_name_everything_and_nothing_hidden() {
        let suite = Suite::from(Registry::builtin());
        let manual = &["sahara\\-compare", "sahara\\-report", "\\-\\-fail\\-on\\-regression", "\\-\\-results"][..];
        let names = &["replicate", "structure", "attribution"];
        for (form, parts) in [("man", manual), ("bash", names), ("zsh", names), ("fish", names)] {
            let text = text(&suite, form).unwrap();
            for part in parts {
                assert!(text.contains(part), "{form}: {part}");
            }
            for hidden in [crate::cli::validate::CHILD, "--case", "compare-runs"] {
                assert!(!text.contains(hidden), "{form}: {hidden}");
            }
        }
    }
}
