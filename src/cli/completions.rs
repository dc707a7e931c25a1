//! `completions`.

use clap::CommandFactory;
use clap_complete::Shell;

use super::terminal::Terminal;
use super::{Cli, Verdict};

#[derive(Debug, clap::Args)]
pub struct Args {
    /// The shell
    shell: Shell,
}

pub fn run(args: &Args, terminal: &Terminal) -> anyhow::Result<Verdict> {
    let mut script = vec![];
    clap_complete::generate(args.shell, &mut Cli::command(), "sahara", &mut script);
    terminal.print(&String::from_utf8_lossy(&script))?;
    Ok(Verdict::Right)
}
