//! The command `rays`: records, imports and prints ray files, and writes the corpus.

mod corpus;

use std::ffi::OsString;
use std::path::PathBuf;

use anyhow::Context;
use clap::Subcommand;

use crate::accel::Query;
use crate::cli::progress::spinner;
use crate::cli::terminal::Terminal;
use crate::escaped::Escaped as _;
use crate::geometry::Ray;
use crate::output::OutputFile;
use crate::registry::Registry;
use crate::report::number::plural;
use crate::request::{self, OUTPUT, RAYS, SCENES, rays_or_all};
use crate::scene::files::RayFile;
use crate::scene::{Sampling, Workload, WorkloadKind};
use crate::study::Status;

#[derive(Debug, Subcommand)]
pub enum Action {
    /// Write the rays of a workload that `compare` would trace
    Record(Record),
    /// Convert text to a ray file, one ray per line: "ox,oy,oz dx,dy,dz [t_min,t_max]", with spaces or commas
    Import(Import),
    /// Print the contents of a ray file
    Show(Show),
    /// Write meshes, rays and exact hits, for other ray tracers to count their errors
    Corpus(corpus::Args),
}

#[derive(Debug, clap::Args)]
pub struct Record {
    /// Built-in scene, scene file (.toml) or mesh file
    #[arg(value_name = "SCENE|FILE")]
    scene: OsString,
    /// Workload (see `sahara list`)
    #[arg(long, short, help_heading = RAYS, value_name = "WORKLOAD", default_value = "primary")]
    workload: WorkloadKind,
    /// Ray file to write
    #[arg(long, short, help_heading = OUTPUT, value_name = "F.rays")]
    output: PathBuf,
    /// Maximum number of rays, evenly spread over the workload
    #[arg(long, help_heading = RAYS, value_name = "N|all", default_value = "all", value_parser = rays_or_all)]
    rays: usize,
    /// Seed of the rays
    #[arg(long, help_heading = RAYS, value_name = "N", default_value_t = 1)]
    seed: u64,
}

#[derive(Debug, clap::Args)]
pub struct Import {
    /// Text file; empty lines and `#` comments are ignored
    text: PathBuf,
    /// Ray file to write
    #[arg(long, short, help_heading = OUTPUT, value_name = "F.rays")]
    output: PathBuf,
    /// Scene that the rays belong to [default: none]
    #[arg(long, help_heading = SCENES, value_name = "SCENE|FILE")]
    scene: Option<OsString>,
    /// Workload name of the rays
    #[arg(long, help_heading = RAYS, value_name = "NAME", default_value = "imported")]
    name: String,
    /// Any-hit rays instead of closest-hit rays
    #[arg(long, help_heading = RAYS)]
    any: bool,
}

#[derive(Debug, clap::Args)]
pub struct Show {
    /// Ray file
    file: PathBuf,
    /// Print only the rays, as text
    #[arg(long, help_heading = OUTPUT)]
    text: bool,
}

pub fn run(registry: &Registry, action: &Action, terminal: &Terminal) -> anyhow::Result<Status> {
    match action {
        Action::Record(args) => record(registry, args, terminal),
        Action::Import(args) => import(registry, args, terminal),
        Action::Show(args) => show(args, terminal),
        Action::Corpus(args) => corpus::run(registry, args, terminal),
    }
}

fn record(registry: &Registry, args: &Record, terminal: &Terminal) -> anyhow::Result<Status> {
    let output = request::output(registry, &args.output, std::slice::from_ref(&args.scene), None)?;
    let waiting = spinner(format!("loading {}", args.scene.escaped()), terminal);
    let scene = request::scene(registry, &args.scene)?;
    let tracer = request::secondary_ray_structure(registry)?;
    waiting.set_message(format!("{}: building {}", scene.name, tracer.label));
    let tracer = tracer.build(&scene.mesh)?;
    waiting.set_message(format!("{}: generating {} rays", scene.name, args.workload.name()));
    let sampling = Sampling::some(&scene, args.rays, args.seed);
    let workload = Workload::new(&scene, args.workload, &sampling, tracer.as_ref());
    drop(waiting);
    let (name, kind) = (&scene.name, &workload.name);
    anyhow::ensure!(!workload.rays.is_empty(), "{name} has no {kind} rays to record: name another workload");
    finish(&RayFile::new(&scene, workload), &output, terminal)
}

fn import(registry: &Registry, args: &Import, terminal: &Terminal) -> anyhow::Result<Status> {
    let output = request::output(registry, &args.output, args.scene.as_slice(), [args.text.as_path()])?;
    let waiting = spinner(format!("reading {}", args.text.escaped()), terminal);
    let text = std::fs::read_to_string(&args.text).with_context(|| format!("cannot read {}", args.text.escaped()))?;
    let rays = parse(&text).map_err(|problem| anyhow::anyhow!("{}: {problem}", args.text.escaped()))?;
    let query = if args.any { Query::Any } else { Query::Closest };
    let workload = Workload { name: args.name.clone(), query, rays };
    let file = match &args.scene {
        Some(scene) => {
            waiting.set_message(format!("loading {}", scene.escaped()));
            RayFile::new(&request::scene(registry, scene)?, workload)
        }
        None => RayFile { scene: String::new(), scene_hash: None, workload },
    };
    drop(waiting);
    finish(&file, &output, terminal)
}

fn parse(text: &str) -> Result<Vec<Ray>, String> {
    let lines = text.lines().map(|line| line.split('#').next().unwrap_or("").trim());
    let lines = lines.zip(1_usize..).filter(|(line, _)| !line.is_empty());
    let ray = |(line, number)| Ray::parse_valid(line).map_err(|error| format!("line {number}: {error}"));
    let rays = lines.map(ray).collect::<Result<Vec<Ray>, String>>()?;
    RayFile::check(&rays).map(|()| rays)
}

fn finish(file: &RayFile, output: &OutputFile, terminal: &Terminal) -> anyhow::Result<Status> {
    RayFile::check_names(&file.scene, &file.workload.name).map_err(anyhow::Error::msg)?;
    file.write(output)?;
    terminal.print(&format!("{}: {}\n", output.path.escaped(), described(file)));
    Ok(Status::Right)
}

fn show(args: &Show, terminal: &Terminal) -> anyhow::Result<Status> {
    let waiting = spinner(format!("reading {}", args.file.escaped()), terminal);
    let file = RayFile::read(&args.file)?;
    drop(waiting);
    if args.text {
        terminal.print(&file.workload.rays.iter().map(|ray| format!("{ray}\n")).collect::<String>());
        return Ok(Status::Right);
    }
    terminal.print(&format!("{}: {}\n", args.file.escaped(), described(&file)));
    let scene = file.scene_hash.as_deref().unwrap_or("none");
    terminal.print(&format!("scene hash: {scene}\nfirst ray: {}\n", file.workload.rays[0]));
    Ok(Status::Right)
}

fn described(file: &RayFile) -> String {
    let (workload, scene) = (&file.workload, if file.scene.is_empty() { "no scene" } else { &file.scene });
    let query = if workload.query == Query::Any { "any hit" } else { "closest hit" };
    let (rays, hash) = (plural(workload.rays.len(), "ray"), workload.hash());
    format!("{rays} of the workload {:?} for {scene}, query {query}, hash {hash}", workload.name)
}
