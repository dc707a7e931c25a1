//! `rays`: files of rays, so that others replay exactly ours.

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
use crate::request::{self, rays_or_all};
use crate::scene::files::RayFile;
use crate::scene::{Sampling, Workload, WorkloadKind};
use crate::study::Status;

#[derive(Debug, clap::Args)]
pub struct Args {
    #[command(subcommand)]
    action: Action,
}

#[derive(Debug, Subcommand)]
enum Action {
    /// Write the rays of a workload, as `compare` makes them
    Record(Record),
    /// Make a ray file from text, one ray a line: "ox,oy,oz dx,dy,dz [t_min,t_max]", with blanks or commas
    Import(Import),
    /// Say what a ray file holds
    Show(Show),
    /// Write a folder of meshes, rays and exact answers: whoever answers these rays can count the wrong answers
    Corpus(corpus::Args),
}

#[derive(Debug, clap::Args)]
struct Record {
    /// A built-in scene, a scene file (.toml) or a mesh file
    #[arg(value_name = "SCENE|FILE")]
    scene: OsString,
    /// The kind of rays
    #[arg(long, short, value_name = "KIND", default_value = "primary")]
    workload: WorkloadKind,
    /// The ray file
    #[arg(long, short, value_name = "F.rays")]
    output: PathBuf,
    /// Rays at most, evenly spread over the workload
    #[arg(long, value_name = "N|all", default_value = "all", value_parser = rays_or_all)]
    rays: usize,
    /// Seed of the rays
    #[arg(long, value_name = "N", default_value_t = 1)]
    seed: u64,
}

#[derive(Debug, clap::Args)]
struct Import {
    /// The text; empty lines and what follows a `#` are left out
    text: PathBuf,
    /// The ray file
    #[arg(long, short, value_name = "F.rays")]
    output: PathBuf,
    /// The scene that the rays are for [default: none in particular]
    #[arg(long, value_name = "SCENE|FILE")]
    scene: Option<OsString>,
    /// What to call the rays
    #[arg(long, value_name = "NAME", default_value = "imported")]
    name: String,
    /// Ask whether anything is hit, not what is hit first
    #[arg(long)]
    any: bool,
}

#[derive(Debug, clap::Args)]
struct Show {
    /// The ray file
    file: PathBuf,
    /// Print the rays as text, and nothing else
    #[arg(long)]
    text: bool,
}

pub fn run(registry: &Registry, args: &Args, terminal: &Terminal) -> anyhow::Result<Status> {
    match &args.action {
        Action::Record(args) => record(registry, args, terminal),
        Action::Import(args) => import(registry, args, terminal),
        Action::Show(args) => show(args, terminal),
        Action::Corpus(args) => corpus::run(registry, args, terminal),
    }
}

fn record(registry: &Registry, args: &Record, terminal: &Terminal) -> anyhow::Result<Status> {
    let output = request::output(registry, &args.output, std::slice::from_ref(&args.scene), None)?;
    let waiting = spinner(format!("loads {}", args.scene.escaped()), terminal);
    let scene = request::scene(registry, &args.scene)?;
    let guide = request::guide(registry)?;
    waiting.set_message(format!("{} builds {}", scene.name, guide.label));
    let guide = guide.build(&scene.mesh)?;
    waiting.set_message(format!("{} makes {} rays", scene.name, args.workload.name()));
    let sampling = Sampling::some(&scene, args.rays, args.seed);
    let workload = Workload::new(&scene, args.workload, &sampling, guide.as_ref());
    drop(waiting);
    anyhow::ensure!(!workload.rays.is_empty(), "{} has no {} rays: nothing to record", scene.name, workload.name);
    finish(&RayFile::new(&scene, workload), &output, terminal)
}

fn import(registry: &Registry, args: &Import, terminal: &Terminal) -> anyhow::Result<Status> {
    let output = request::output(registry, &args.output, args.scene.as_slice(), [args.text.as_path()])?;
    let waiting = spinner(format!("reads {}", args.text.escaped()), terminal);
    let text = std::fs::read_to_string(&args.text).with_context(|| format!("cannot read {}", args.text.escaped()))?;
    let rays = parse(&text).map_err(|problem| anyhow::anyhow!("{}: {problem}", args.text.escaped()))?;
    let query = if args.any { Query::Any } else { Query::Closest };
    let workload = Workload { name: args.name.clone(), query, rays };
    let file = match &args.scene {
        Some(scene) => {
            waiting.set_message(format!("loads {}", scene.escaped()));
            RayFile::new(&request::scene(registry, scene)?, workload)
        }
        None => RayFile { scene: String::new(), scene_hash: None, workload },
    };
    drop(waiting);
    finish(&file, &output, terminal)
}

fn parse(text: &str) -> Result<Vec<Ray>, String> {
    let mut rays = vec![];
    for (number, line) in text.lines().enumerate() {
        let line = line.split('#').next().unwrap_or("").trim();
        if line.is_empty() {
            continue;
        }
        rays.push(Ray::parse_valid(line).map_err(|error| format!("line {}: {error}", number + 1))?);
    }
    RayFile::check(&rays).map(|()| rays)
}

fn finish(file: &RayFile, output: &OutputFile, terminal: &Terminal) -> anyhow::Result<Status> {
    RayFile::check_names(&file.scene, &file.workload.name).map_err(anyhow::Error::msg)?;
    file.write(output)?;
    terminal.print(&format!("{}: {}\n", output.path().escaped(), described(file)));
    Ok(Status::Right)
}

fn show(args: &Show, terminal: &Terminal) -> anyhow::Result<Status> {
    let waiting = spinner(format!("reads {}", args.file.escaped()), terminal);
    let file = RayFile::read(&args.file)?;
    drop(waiting);
    if args.text {
        terminal.print(&file.workload.rays.iter().map(|ray| format!("{ray}\n")).collect::<String>());
        return Ok(Status::Right);
    }
    terminal.print(&format!("{}: {}\n", args.file.escaped(), described(&file)));
    let scene = file.scene_hash.as_deref().unwrap_or("none in particular");
    terminal.print(&format!("scene hash: {scene}\nfirst ray: {}\n", file.workload.rays[0]));
    Ok(Status::Right)
}

fn described(file: &RayFile) -> String {
    let (workload, scene) = (&file.workload, if file.scene.is_empty() { "no scene" } else { &file.scene });
    let query = if workload.query == Query::Any { "any hit" } else { "the closest hit" };
    let (rays, hash) = (plural(workload.rays.len(), "ray"), workload.hash());
    format!("{rays} of the kind {:?} for {scene}, asking for {query}, hash {hash}", workload.name)
}
