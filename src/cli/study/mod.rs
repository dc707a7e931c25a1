//! `study`: experiments with one question each.

mod all;
mod attribution;
mod break_even;
mod costs;
mod crossover;
mod epochs;
mod folder;
mod meshes;
mod parameters;
mod partitions;
mod predictions;
mod scaling;

use std::path::PathBuf;

use clap::Subcommand;

use crate::cli::terminal::Terminal;
use crate::cli::{Verdict, sources};
use crate::output::OutputFile;
use crate::registry::{Choice, Registry};
use crate::report::{to_json, to_markdown};
use crate::study::SAH_TREE;
use crate::study::self_intersection::{self, Settings};

#[derive(Debug, clap::Args)]
pub struct Args {
    #[command(subcommand)]
    name: Name,
}

#[derive(Debug, Subcommand)]
enum Name {
    /// What of the SAH tree's speed is due to the stop rule, what to the plane and what to the traversal?
    Attribution(attribution::Args),
    /// Which differences of the report's sweep of leaf limit and threshold are real?
    Parameters(parameters::Args),
    /// What was expected, and what came of it: each confirmed or refuted
    Predictions(predictions::Args),
    /// Every study, `compare` and `replicate`: a run that is killed goes on with the step, or the epoch of one, that it was at
    All(all::Args),
    /// How do time, build and memory grow with the number of triangles?
    Scaling(scaling::Args),
    /// Does a KD-tree overtake a BVH where rays would meet more surfaces?
    Crossover(crossover::Args),
    /// After how many rays does a dearer build pay?
    BreakEven(break_even::Args),
    /// What does a step, and what does a triangle test cost on this machine?
    Costs(costs::Args),
    /// Which way to start a secondary ray neither meets its own surface again nor passes another one?
    SelfIntersection(SelfIntersection),
    /// Which way to divide the triangles is the fastest, for the same node, leaf and walk?
    Partitions(partitions::Args),
}

#[derive(Debug, clap::Args)]
struct SelfIntersection {
    /// A structure, with keys that differ from their defaults; may be repeated [default: sah-kd over every triangle test]
    #[arg(long, short, value_name = "NAME[:key=value,..]")]
    structure: Vec<String>,
    /// Rays outwards of each case; as many go in
    #[arg(long, value_name = "N", default_value_t = 6000, value_parser = clap::value_parser!(u32).range(1..=1 << 24))]
    rays: u32,
    /// Seed of the rays
    #[arg(long, value_name = "N", default_value_t = 1)]
    seed: u64,
    /// Write every case as JSON
    #[arg(long, value_name = "FILE")]
    export_json: Option<PathBuf>,
    /// Write the table as Markdown
    #[arg(long, value_name = "FILE")]
    export_markdown: Option<PathBuf>,
}

pub fn run(registry: &Registry, args: &Args, terminal: &Terminal) -> anyhow::Result<Verdict> {
    match &args.name {
        Name::Attribution(args) => attribution::run(registry, args, terminal),
        Name::Parameters(args) => parameters::run(registry, args, terminal),
        Name::Predictions(args) => predictions::run(registry, args, terminal),
        Name::All(args) => all::run(registry, args, terminal),
        Name::Scaling(args) => scaling::run(registry, args, terminal),
        Name::Crossover(args) => crossover::run(registry, args, terminal),
        Name::BreakEven(args) => break_even::run(registry, args, terminal),
        Name::Costs(args) => costs::run(registry, args, terminal),
        Name::SelfIntersection(args) => self_intersection(registry, args, terminal),
        Name::Partitions(args) => partitions::run(registry, args, terminal),
    }
}

fn self_intersection(registry: &Registry, args: &SelfIntersection, terminal: &Terminal) -> anyhow::Result<Verdict> {
    let structures = if args.structure.is_empty() {
        registry.all().into_iter().filter(|choice| choice.entry.name == SAH_TREE).collect::<Vec<Choice>>()
    } else {
        sources::structures(registry, &args.structure)?
    };
    anyhow::ensure!(!structures.is_empty(), "{SAH_TREE} is not registered: name a structure with --structure");
    let check = |path: &Option<PathBuf>| path.as_deref().map(OutputFile::check).transpose();
    let (json, markdown) = (check(&args.export_json)?, check(&args.export_markdown)?);

    let settings = Settings { rays: args.rays as usize, seed: args.seed };
    let study = self_intersection::study(&structures, settings).map_err(anyhow::Error::msg)?;
    let table = self_intersection::table(&study);
    terminal.print_table(&table)?;
    if let Some(file) = json {
        file.write(&to_json(&study))?;
    }
    if let Some(file) = markdown {
        file.write(&to_markdown(&[table], &[study.provenance.line()]))?;
    }
    Ok(Verdict::Right)
}
