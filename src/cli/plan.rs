//! `study plan`: prints the cases of studies as independent jobs for a cluster.

use std::collections::BTreeMap;
use std::ffi::{OsStr, OsString};
use std::path::{Path, PathBuf};

use clap_lex::OsStrExt as _;

use super::progress::spinner;
use super::study::RUNS;
use super::{Session, study as command};
use crate::escaped::{Escaped as _, quoted};
use crate::measure::{Provenance, Threads};
use crate::report::words::{each_once, each_once_by};
use crate::request::{MEASURING, OUTPUT, SCENES};
use crate::simd::Level;
use crate::study::journal::file_name;
use crate::study::process::{CASE, OUT};
use crate::study::{Case, Status};

pub const NAME: &str = "plan";

const OUTPUTS: [&str; 4] = ["--export-json", "--export-csv", "--export-markdown", "--plot"];

const NO_SCENE: &str = "--scenes needs a scene: --scenes SCENE..";

/// Print a study as jobs for a cluster, one command per line; each job measures one case (one epoch of one scene) and
/// writes one file
#[derive(Clone, Debug, clap::Args)]
pub struct Args {
    /// Study, or `all`: every study, with the settings of `study all` [default: all]
    #[arg(value_name = "NAME", allow_hyphen_values = true)]
    name: Option<OsString>,
    /// Folder of journals: each job writes DIR/NAME/CASE.json [default: runs]
    #[arg(long, help_heading = OUTPUT, value_name = "DIR")]
    dir: Option<PathBuf>,
    /// Use the settings of `study all --quick`
    #[arg(long, help_heading = MEASURING)]
    quick: bool,
    /// Scenes and mesh files instead of the studies' own
    #[arg(long, help_heading = SCENES, value_name = "SCENE|FILE", num_args = 1..)]
    scenes: Vec<OsString>,
    /// More studies, then options of this command or of the named studies
    #[arg(value_name = "NAME|OPTION", trailing_var_arg = true, allow_hyphen_values = true)]
    rest: Vec<OsString>,
}

impl Args {
    /// Returns the arguments of this command, the names of studies, and the options of the studies.
    /// Clap does not parse `rest`, so this function rejects a repeated `--quick` or `--dir` with the message of clap.
    fn split(&self) -> anyhow::Result<(Self, Vec<OsString>, Vec<OsString>)> {
        let (mut own, mut options) = (self.clone(), vec![]);
        // After `--scenes`, clap parses options of studies as scenes. Without a name, clap parses the first option of a
        // study as the name.
        let scenes = own.scenes.iter().take_while(|word| !word.starts_with("-")).count();
        let behind = own.scenes.split_off(scenes);
        anyhow::ensure!(scenes > 0 || behind.is_empty(), NO_SCENE);
        let mut rest = self.name.iter().chain(&self.rest).chain(&behind).peekable();
        let is_option = |word: &OsString| word.starts_with("-");
        let mut names: Vec<OsString> = std::iter::from_fn(|| rest.next_if(|word| !is_option(word)).cloned()).collect();
        if names.is_empty() {
            names.push(super::all::NAME.into());
        }
        while let Some(word) = rest.next() {
            let (option, value) = word.split_once("=").map_or((&**word, None), |(name, value)| (name, Some(value)));
            match (option.to_str().unwrap_or_default(), value) {
                ("--quick", None) => {
                    anyhow::ensure!(!own.quick, "the argument '--quick' cannot be used multiple times");
                    own.quick = true;
                }
                ("--dir", value) => {
                    anyhow::ensure!(own.dir.is_none(), "the argument '--dir <DIR>' cannot be used multiple times");
                    let value = value.or_else(|| rest.next().map(OsString::as_os_str));
                    own.dir = Some(value.ok_or_else(|| anyhow::anyhow!("--dir needs a folder: --dir DIR"))?.into());
                }
                ("--scenes", value) => {
                    let before = own.scenes.len();
                    own.scenes.extend(value.map(OsString::from));
                    own.scenes.extend(std::iter::from_fn(|| rest.next_if(|word| !is_option(word)).cloned()));
                    anyhow::ensure!(own.scenes.len() > before, NO_SCENE);
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
    if let Some(name) = options.iter().filter_map(|word| word.to_str()).find(|word| suite.studies.find(word).is_some())
    {
        anyhow::bail!("{name} follows an option: put the names of studies first, `sahara study plan {name} ..`");
    }
    for word in &options {
        let name = word.split_once("=").map_or(&**word, |(name, _)| name);
        anyhow::ensure!(
            !OUTPUTS.iter().any(|output| name == *output),
            "{} writes the results of a whole study, but each job measures one case: pass it to the study when all jobs \
             are done",
            word.escaped()
        );
        anyhow::ensure!(
            word != "--fresh",
            "--fresh has no effect on jobs, which never measure a case again whose file exists: choose another folder \
             with --dir"
        );
    }
    let named = names.iter().filter(|name| *name != super::all::NAME);
    let named = named.map(|name| super::find(suite, &name.to_string_lossy())).collect::<anyhow::Result<Vec<_>>>()?;
    let whole = named.len() < names.len();
    let studies = if whole { suite.studies.iter().collect() } else { named };
    let dir = args.dir.as_deref().unwrap_or(Path::new(RUNS));
    let mut commands = vec![];
    // Plan a repeated study once. Otherwise two jobs would write the same file.
    for study in each_once_by(studies, |one, other| one.name == other.name) {
        if !args.scenes.is_empty() && !study.names_scenes() {
            terminal.print_message(&format!("{} has its own scenes and ignores --scenes", study.name));
        }
        // Parse the options of all studies before the slow planning starts.
        let mut words = match (args.quick, whole) {
            (true, _) => study.preset(study.presets.quick, &args.scenes),
            (false, true) => study.preset(study.presets.full, &args.scenes),
            (false, false) if study.names_scenes() => args.scenes.clone(),
            (false, false) => vec![],
        };
        words.extend(options.iter().cloned());
        let parsed = command::command(study).no_binary_name(true).try_get_matches_from(&words);
        commands.push((study, words, parsed?));
    }
    let (mut lines, mut warnings) = (String::new(), vec![]);
    let level = level.iter().flat_map(|level| ["--level", level.name()]);
    let program: Vec<&str> = ["sahara"].into_iter().chain(level).collect();
    // Making a provenance takes a tenth of a second, so reuse each provenance.
    let of = |&threads: &usize| Provenance { process_per_epoch: true, ..Provenance::of(&Threads::unstarted(threads)) };
    let mut provenances: BTreeMap<usize, Provenance> = BTreeMap::new();
    for (study, words, matches) in commands {
        let waiting = spinner(format!("planning {}", study.name), terminal);
        let plan = (study.plan)(&matches, &suite.registry)?;
        drop(waiting);
        warnings.extend(plan.warnings);
        let command =
            line(["sahara", "study", study.name].map(OsStr::new).into_iter().chain(words.iter().map(|own| &**own)));
        for case in plan.cases {
            let provenance = provenances.entry(case.settings.threads).or_insert_with_key(of);
            let file = dir.join(study.name).join(file_name(&case, provenance) + ".json");
            let case = serde_json::to_string(&Case { command: command.clone(), ..case }).expect("a case has text keys");
            let options = [&*format!("--{CASE}={case}"), &*format!("--{OUT}")];
            let words = program.iter().chain(&options).map(OsStr::new).chain([file.as_os_str()]);
            lines += &(line(words) + "\n");
        }
    }
    each_once(warnings).iter().for_each(|warning| terminal.print_message(&format!("warning: {warning}")));
    terminal.print(&lines);
    Ok(Status::Right)
}

fn line<'a>(words: impl Iterator<Item = &'a OsStr>) -> String {
    words.map(quoted).collect::<Vec<String>>().join(" ")
}
