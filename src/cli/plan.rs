//! `study plan`: studies as jobs that need each other in nothing, for the machines of a cluster.

use std::collections::HashSet;
use std::path::{Path, PathBuf};

use super::study::RUNS;
use super::{Session, chosen, command};
use crate::measure::quoted;
use crate::simd::Level;
use crate::study::job::{Job, OPTION, OUT};
use crate::study::journal::file_name;
use crate::study::{AnyStudy, Status};

/// Name of the command.
pub const NAME: &str = "plan";

/// Options that write what came of a whole study.
const OUTPUTS: [&str; 4] = ["--export-json", "--export-csv", "--export-markdown", "--plot"];

/// Print a study as jobs for a cluster: one command a line, each of which measures one case and writes one file
#[derive(Clone, Debug, clap::Args)]
pub struct Args {
    /// Studies, or `all`, as `study all` measures them
    #[arg(value_name = "NAME", required = true)]
    name: String,
    /// Folder of journals: each job writes DIR/NAME/CASE.json
    #[arg(long, value_name = "DIR", default_value = RUNS)]
    dir: PathBuf,
    /// The quick form of each study, which `study all --quick` measures
    #[arg(long)]
    quick: bool,
    /// Scenes and mesh files, in place of those of the studies
    #[arg(long, value_name = "SCENE|FILE", num_args = 1..)]
    scenes: Vec<String>,
    /// More studies, the options above, and options of the studies
    #[arg(value_name = "NAME|OPTION", trailing_var_arg = true, allow_hyphen_values = true)]
    rest: Vec<String>,
}

impl Args {
    /// What is asked for: the names of studies, and the options that are theirs.
    fn split(&self) -> anyhow::Result<(Self, Vec<String>, Vec<String>)> {
        let (mut own, mut names, mut options) = (self.clone(), vec![self.name.clone()], vec![]);
        let mut rest = self.rest.iter().peekable();
        while let Some(word) = rest.next_if(|word| !word.starts_with('-')) {
            names.push(word.clone());
        }
        while let Some(word) = rest.next() {
            match word.split_once('=').map_or((word.as_str(), None), |(name, value)| (name, Some(value))) {
                ("--quick", None) => own.quick = true,
                ("--dir", value) => {
                    let value = value.or_else(|| rest.next().map(String::as_str));
                    own.dir = value.ok_or_else(|| anyhow::anyhow!("--dir needs a folder: --dir DIR"))?.into();
                }
                ("--scenes", value) => {
                    let before = own.scenes.len();
                    own.scenes.extend(value.map(String::from));
                    while let Some(scene) = rest.next_if(|word| !word.starts_with('-')) {
                        own.scenes.push(scene.clone());
                    }
                    anyhow::ensure!(own.scenes.len() > before, "--scenes needs a scene: --scenes SCENE..");
                }
                _ => options.push(word.clone()),
            }
        }
        Ok((own, names, options))
    }
}

pub fn run(session: &Session, args: &Args, level: Option<Level>) -> anyhow::Result<Status> {
    let &Session { suite, terminal, .. } = session;
    let (args, names, options) = args.split()?;
    let output = options.iter().find(|word| {
        let name = word.split('=').next().unwrap_or(word);
        OUTPUTS.contains(&name)
    });
    if let Some(output) = output {
        anyhow::bail!(
            "{output} is of a whole study, and each job measures one case of it: give it to the study once all jobs are done"
        );
    }
    anyhow::ensure!(
        !options.iter().any(|word| word == "--fresh"),
        "--fresh empties the folder of a study, and each job measures one case of it: name another folder with --dir, or remove this one"
    );
    let whole = names.iter().any(|name| name == super::all::NAME);
    let studies: Vec<&dyn AnyStudy> = if whole {
        suite.studies.in_order_of_measuring()
    } else {
        names.iter().map(|name| super::find(suite, name)).collect::<anyhow::Result<_>>()?
    };
    let mut lines = String::new();
    // Two jobs of one case would write one file.
    let mut seen = HashSet::new();
    for study in studies.into_iter().filter(|study| seen.insert(study.name())) {
        if study.is_last() {
            let name = study.name();
            terminal.tell(&format!("{name}: no jobs, for it is made from the others: run it when they are measured"));
            continue;
        }
        if let Some(why) = study.cannot_be_measured_here().filter(|_| whole) {
            terminal.tell(&format!("{}: no jobs, for {why}", study.name()));
            continue;
        }
        if !args.scenes.is_empty() && !study.names_scenes() {
            terminal.tell(&format!("{}: on scenes of its own, whatever --scenes names", study.name()));
        }
        // As the job will read it.
        let words = words(study, &args, whole, level, &options);
        let parsed = command(&suite.studies).try_get_matches_from(&words)?;
        for case in study.planned(chosen(&parsed)?, &suite.registry)? {
            let job = serde_json::to_string(&Job::of(study.name(), &case)).expect("a job has text keys");
            let file = args.dir.join(study.name()).join(file_name(&case.key));
            lines += &(line(&words, &job, &file)? + "\n");
        }
    }
    terminal.print(&lines)?;
    Ok(Status::Right)
}

/// The command of a study.
fn words(study: &dyn AnyStudy, args: &Args, whole: bool, level: Option<Level>, options: &[String]) -> Vec<String> {
    let mut words: Vec<&str> = vec!["sahara"];
    words.extend(level.iter().flat_map(|level| ["--level", level.name()]));
    words.push("study");
    let scenes = args.scenes.iter().map(String::as_str).filter(|_| study.names_scenes());
    if whole || args.quick {
        words.push(super::all::NAME);
        words.extend(args.quick.then_some("--quick"));
        let scenes: Vec<&str> = scenes.collect();
        words.extend((!scenes.is_empty()).then_some("--scenes"));
        words.extend(scenes);
    } else {
        words.push(study.name());
        words.extend(scenes);
    }
    words.into_iter().map(String::from).chain(options.iter().cloned()).collect()
}

/// A line that a shell reads as the command with a job and a file.
fn line(words: &[String], job: &str, file: &Path) -> anyhow::Result<String> {
    let name = file.to_str().ok_or_else(|| anyhow::anyhow!("{} is no text: name another folder", file.display()))?;
    let (case, option) = (format!("--{OPTION}={job}"), format!("--{OUT}"));
    let words = words.iter().map(String::as_str).chain([case.as_str(), &option, name]).map(quoted);
    let line = words.collect::<Vec<String>>().join(" ");
    anyhow::ensure!(
        !line.chars().any(char::is_control),
        "{line:?} holds a tab or the end of a line, and would be no line: call the folder or the scene otherwise"
    );
    Ok(line)
}
