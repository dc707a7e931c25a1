//! The commands `golden check` and `golden update`.

use std::ffi::{OsStr, OsString};
use std::path::{Path, PathBuf};

use anyhow::Context;

use super::blame::Judge;
use super::{Outputs, tally};
use crate::builtin::Builtin;
use crate::cli::terminal::Terminal;
use crate::escaped::{Escaped as _, quoted, stem};
use crate::golden::page::{Page, PicturePair};
use crate::golden::{Comparison, Match, Overwrite, SIZE, SceneGolden, TRIANGLE_TEST, Update, VIEWS, compare};
use crate::names::find;
use crate::registry::{Choice, Registry};
use crate::render::ViewKind;
use crate::report::words::{each_once_by, slug};
use crate::request::{self, BRUTE_FORCE, OUTPUT, SAH_TREE, SCENES, STRUCTURES, ViewArgs, known_defect, stand_in};
use crate::scene::Scene;
use crate::study::Status;

/// Above this product of triangles and pixels, brute force takes minutes.
const WORK: u64 = 1 << 32;

#[derive(Debug, clap::Args)]
struct Targets {
    /// Built-in scenes, scene files (.toml) and mesh files [default: all built-in scenes]
    #[arg(value_name = "SCENE|FILE")]
    scenes: Vec<OsString>,
    /// shaded, depth, normal or primitive
    #[arg(long, help_heading = SCENES, default_value = "shaded", value_name = "VIEW", value_parser = view)]
    view: ViewKind,
    #[command(flatten)]
    from: ViewArgs,
    /// Folder of golden images, NAME.golden.png or NAME.VIEW.golden.png [default: next to each file; built-in scenes
    /// have built-in golden images]
    #[arg(long, help_heading = SCENES, value_name = "DIR")]
    goldens: Option<PathBuf>,
}

#[derive(Debug, clap::Args)]
pub struct CheckArgs {
    #[command(flatten)]
    targets: Targets,
    /// Structure with options (see `sahara list NAME`); may be repeated [default: all structures that offer the exact
    /// triangle test, over this test]
    #[arg(long, short, help_heading = STRUCTURES, value_name = "NAME[:key=value,..]")]
    structure: Vec<String>,
    #[command(flatten)]
    outputs: Outputs,
}

#[derive(Debug, clap::Args)]
pub struct UpdateArgs {
    #[command(flatten)]
    targets: Targets,
    /// Structure that renders [default: brute-force:test=exact, or sah-kd:test=exact if that would take minutes]
    #[arg(long, short, help_heading = STRUCTURES, value_name = "NAME[:key=value,..]")]
    structure: Option<String>,
    /// Also replace pictures that this command did not create
    #[arg(long, help_heading = OUTPUT)]
    force: bool,
}

fn view(name: &str) -> Result<ViewKind, String> {
    find("view of golden images", VIEWS, name, ViewKind::name).map_err(|unknown| unknown.to_string())
}

struct Target {
    scene: Scene,
    golden: SceneGolden,
    /// The argument that names the scene in a printed command.
    word: String,
    /// The default structure of `update`.
    default: &'static str,
}

impl Target {
    fn new(scene: Scene, golden: SceneGolden, word: impl AsRef<OsStr>) -> Self {
        let work = scene.mesh.len() as u64 * golden.size.map(u64::from).iter().product::<u64>();
        let default = if work <= WORK || golden.is_in_program() { BRUTE_FORCE } else { SAH_TREE };
        Self { scene, golden, word: quoted(word), default }
    }
}

impl Targets {
    fn words(&self) -> Vec<OsString> {
        each_once_by(request::words(&self.scenes), |one, other| one.eq_ignore_ascii_case(other))
    }

    fn target(&self, registry: &Registry, word: &OsString) -> anyhow::Result<Target> {
        let Ok(builtin) = Builtin::find(word) else {
            let scene = self.from.seen(request::scene(registry, word)?)?;
            let path = Path::new(word);
            let beside = || path.is_file().then(|| path.parent().unwrap_or(Path::new("")).to_path_buf());
            let folder = self.goldens.clone().or_else(beside);
            let folder = folder
                .with_context(|| format!("{}: pass --goldens DIR, the folder of its golden image", word.escaped()))?;
            let name = if path.is_file() { stem(path) } else { slug(&word.escaped().to_string()) };
            let golden = SceneGolden::file(&folder, &name, self.view, &scene);
            return Ok(Target::new(scene, golden, word));
        };
        // Always use generated meshes. A real mesh on this machine must not change the picture.
        let mut scene = builtin.scene(None)?;
        scene.size = SIZE;
        let scene = self.from.seen(scene)?;
        let name = builtin.name.to_lowercase();
        let golden = match &self.goldens {
            Some(folder) => SceneGolden::file(folder, &name, self.view, &scene),
            None if self.from.is_default() && self.view == ViewKind::Shaded => builtin.golden(),
            None => {
                let ([width, height], view) = (SIZE, self.view.name());
                let options = self.from.words();
                let with = if self.from.is_default() { String::new() } else { format!(" with {options}") };
                anyhow::bail!(
                    "built-in golden images exist only for the shaded view, {width} x {height} pixels, from the scene's \
                     camera; for the {view} view{with} pass --goldens DIR"
                )
            }
        };
        let word = if scene.stand_ins.is_empty() { name.into() } else { stand_in(&name) };
        Ok(Target::new(scene, golden, word))
    }
}

pub fn check(registry: &Registry, args: &CheckArgs, terminal: &Terminal) -> anyhow::Result<Status> {
    let inputs = request::scene_files(registry, &args.targets.scenes);
    let outputs = args.outputs.check(inputs.iter().map(PathBuf::as_path))?;
    // All structures with the same triangle test must render the same picture.
    let choices: Vec<Choice> = if args.structure.is_empty() {
        registry.all().into_iter().filter(|choice| choice.triangle_test() == TRIANGLE_TEST).collect()
    } else {
        request::structures(registry, &args.structure)?
    };
    let mut comparisons = vec![];
    let mut status = Status::Right;
    outputs.with_page("Golden images", |page| {
        Ok(args.targets.words().iter().try_for_each(|word| {
            let target = args.targets.target(registry, word)?;
            let mut choices = choices.clone();
            if args.structure.is_empty() && target.default != BRUTE_FORCE {
                choices.retain(|choice| choice.entry.name != BRUTE_FORCE);
                terminal.print(&format!(
                    "{}: {BRUTE_FORCE} is skipped (it would take minutes); pass -s {BRUTE_FORCE} to run it\n",
                    target.scene.name
                ));
            }
            let found = check_scene(registry, &target, &choices, page, terminal, &mut comparisons)?;
            status = status.and(found);
            anyhow::Ok(())
        }))
    })??;
    if comparisons.iter().any(Comparison::fails) {
        let advice = if args.outputs.page.is_none() { "; --page DIR shows the pictures" } else { "" };
        terminal.print(&format!("{}{advice}\n", tally(&comparisons)));
    }
    outputs.export(&comparisons, terminal)?;
    Ok(status)
}

fn check_scene(
    registry: &Registry,
    Target { scene, golden, word, .. }: &Target,
    choices: &[Choice],
    page: Option<&Page>,
    terminal: &Terminal,
    comparisons: &mut Vec<Comparison>,
) -> anyhow::Result<Status> {
    let expected = golden.expected()?;
    let (mut right, mut status, mut judge) = (vec![], Status::Right, None);
    for choice in choices {
        let accel = choice.build(&scene.mesh)?;
        let actual = golden.drawn(scene, accel.as_ref());
        let pictures = [&expected, &actual];
        let (mut comparison, maps) =
            compare(&format!("{} with {}", scene.name, choice.label), pictures, Match::Exact, None);
        if golden.view == ViewKind::Primitive {
            comparison = comparison.without_sizes(golden.size);
        }
        if comparison.fails() {
            let is_known = known_defect(&choice.entry.name).is_some();
            if let Some(measures) = &comparison.measures {
                if judge.is_none() {
                    judge = Some(Judge::new(registry, scene, golden, word)?);
                }
                let judge = judge.as_ref().expect("it was made");
                let place = measures.difference.first;
                let (sentence, command) = judge.blame(&choice.label, accel.as_ref(), pictures, place);
                comparison.said.push(sentence);
                comparison.command = Some(command);
            }
            if is_known {
                comparison.said.push("this structure has known defects: the exit status does not change".into());
            } else {
                status = Status::Wrong;
            }
            let lines = comparison.said.iter().chain(&comparison.command).map(|line| format!("  {line}\n"));
            terminal.print(&format!("{}: differs from {}\n", comparison.name, golden.display_path().escaped()));
            terminal.print(&lines.collect::<String>());
        } else {
            right.push(choice.label.as_str());
        }
        if let Some(page) = page {
            let sides = PicturePair { expected: Some(&expected), actual: Some(&actual), values: golden.view.into() };
            page.add(comparisons.len(), &comparison, sides, maps.as_ref())?;
        }
        comparisons.push(comparison);
    }
    if !right.is_empty() {
        terminal.print(&format!("{}: identical to the golden image: {}\n", scene.name, right.join(", ")));
    }
    Ok(status)
}

pub fn update(registry: &Registry, args: &UpdateArgs, terminal: &Terminal) -> anyhow::Result<Status> {
    let overwrite = if args.force { Overwrite::Any } else { Overwrite::Own };
    for word in args.targets.words() {
        let Target { scene, golden, default, .. } = args.targets.target(registry, &word)?;
        let spec = args.structure.clone().unwrap_or_else(|| format!("{default}:test={TRIANGLE_TEST}"));
        let accel = registry.choose(&spec)?.build(&scene.mesh)?;
        let what = match golden.update(&scene, accel.as_ref(), overwrite)? {
            Update::Same => "unchanged".into(),
            Update::New => "created".into(),
            Update::Layout(old) => format!("replaced (it had {old})"),
            Update::Changed(difference) => format!("replaced: {}", difference.sentence(golden.size)),
        };
        terminal.print(&format!("{}: {what}, {}\n", scene.name, golden.path().escaped()));
    }
    Ok(Status::Right)
}
