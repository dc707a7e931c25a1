//! `rays corpus`: writes meshes, rays and exact hits for tests of other programs.

#[cfg(test)]
mod tests;

use std::collections::BTreeMap;
use std::ffi::OsString;
use std::path::{Path, PathBuf};

use indicatif::ProgressBar;
use rayon::prelude::*;

use crate::accel::Query;
use crate::builtin::{BUILTIN, Builtin};
use crate::cli::progress::spinner;
use crate::cli::terminal::Terminal;
use crate::escaped::Escaped as _;
use crate::exact;
use crate::geometry::Ray;
use crate::measure::program::digest;
use crate::oracle::Oracle;
use crate::output::OutputFolder;
use crate::registry::Registry;
use crate::report::Table;
use crate::report::number::{bytes, count, plural};
use crate::report::words::{listed, slug};
use crate::request::{self, OUTPUT, RAYS as HEADING, RayKind, stand_in};
use crate::scene::files::{ExactHit, RayFile, exact_hits_bytes, mesh_bytes};
use crate::scene::{Scene, Workload};
use crate::study::Status;

/// The SHA-256 of `SHA256SUMS` in the corpus with default options.
const CORPUS_SHA256: &str = "80236458bcb0a6bbaadffad14093129fc1b00782e4f0118cc37d15f480bc129d";

const SUMS: &str = "SHA256SUMS";

const RAYS: u32 = 256;
const SEED: u64 = 1;

#[derive(Debug, clap::Args)]
pub struct Args {
    /// Scenes (stand-ins replace meshes that `fetch` downloads), scene files or mesh files [default: all built-in
    /// scenes]
    #[arg(value_name = "SCENE|FILE")]
    scenes: Vec<OsString>,
    /// Folder to write; replaces an older corpus there
    #[arg(long, short, help_heading = OUTPUT, value_name = "DIR")]
    output: PathBuf,
    /// Rays per workload
    #[arg(long, help_heading = HEADING, value_name = "N", default_value_t = RAYS, value_parser = clap::value_parser!(u32).range(1..=1 << 20))]
    rays: u32,
    /// Seed of the rays
    #[arg(long, help_heading = HEADING, value_name = "N", default_value_t = SEED)]
    seed: u64,
}

impl Args {
    fn is_default(&self) -> bool {
        self.scenes.is_empty() && (self.rays, self.seed) == (RAYS, SEED)
    }
}

type Files = BTreeMap<String, Vec<u8>>;

pub fn run(registry: &Registry, args: &Args, terminal: &Terminal) -> anyhow::Result<Status> {
    let inputs = args.scenes.iter().filter(|name| Builtin::find(name).is_err()).map(Path::new);
    let folder = OutputFolder::check(&args.output)?.apart_from(inputs)?;
    let all = || BUILTIN.iter().map(|builtin| builtin.name.into()).collect();
    let named = if args.scenes.is_empty() { all() } else { args.scenes.clone() };

    let waiting = spinner("loading scenes", terminal);
    // Stand-ins replace the downloaded meshes of built-in scenes. Stand-ins are the same on every machine.
    let own = |name: &OsString| if Builtin::find(name).is_ok() { stand_in(name) } else { name.clone() };
    let scenes = request::scenes(registry, &named.iter().map(own).collect::<Vec<OsString>>())?;

    // Process one scene at a time, because an oracle needs much memory.
    let (mut files, mut rows, mut stand_ins) = (Files::new(), vec![], vec![]);
    for scene in scenes {
        let (own, [rays, hits]) = part(&scene, args, &waiting)?;
        if let Some(twice) = own.keys().find(|name| files.contains_key(*name)) {
            anyhow::bail!("two of these scenes would write the same file, {twice}: rename one scene");
        }
        let [triangles, rays, hits] = [scene.mesh.len(), rays, hits].map(|n| count(n as u64));
        let size = bytes(own.values().map(Vec::len).sum());
        rows.push([scene.name.clone(), triangles, rays, hits, size]);
        if !scene.stand_ins.is_empty() {
            stand_ins.push(scene.name);
        }
        files.extend(own);
    }

    waiting.set_message(format!("writing {}", folder.path.escaped()));
    let sums: String = files.iter().map(|(name, bytes)| format!("{}  {name}\n", digest(bytes))).collect();
    let digest_of_sums = digest(sums.as_bytes());
    files.insert(SUMS.into(), sums.into_bytes());
    folder.write(&files.into_iter().collect::<Vec<_>>())?;
    drop(waiting);

    let title = format!("{}: {} workloads with exact hits", args.output.escaped(), RayKind::ALL.len());
    let note = format!("{}: stand-in meshes, whether or not the real ones are present.", listed(&stand_ins));
    let notes = if stand_ins.is_empty() { vec![] } else { vec![note] };
    let columns = ["scene", "triangles", "rays", "hits", "bytes"];
    terminal.print_table(&Table::of_texts(&title, columns, rows).noted(notes));
    Ok(verdict(args, &digest_of_sums, terminal))
}

fn verdict(args: &Args, digest: &str, terminal: &Terminal) -> Status {
    let is_published = digest == CORPUS_SHA256;
    let is_wrong = args.is_default() && !is_published;
    if is_wrong {
        terminal.print_lines([format!(
            "This corpus differs from the published one, whose {SUMS} has the SHA-256 {CORPUS_SHA256}: do not compare \
             its numbers with published ones, and report this as a bug."
        )]);
    }
    let published = if args.is_default() && is_published { ", as published" } else { "" };
    terminal.print(&format!("SHA-256 of {SUMS}: {digest}{published}\n"));
    if is_wrong { Status::Wrong } else { Status::Right }
}

/// Returns the files of a scene, the number of rays and the number of hits.
fn part(scene: &Scene, args: &Args, waiting: &ProgressBar) -> anyhow::Result<(Files, [usize; 2])> {
    let stem = slug(&scene.name);
    let (mut files, mut counts) = (Files::new(), [0, 0]);
    files.insert(format!("{stem}.ply"), mesh_bytes(&scene.mesh));
    waiting.set_message(format!("{}: building the oracle", scene.name));
    let oracle = Oracle::new(&scene.mesh);
    for kind in RayKind::ALL {
        let name = kind.name();
        let rays = args.rays as usize;
        waiting.set_message(format!("{}: computing exact hits of {}: {name}", scene.name, plural(rays, "ray")));
        let (file, truth) = rays_with_exact_hits(scene, kind, rays, args.seed, &oracle)
            .map_err(|problem| anyhow::anyhow!("{} has no {name} rays: {problem}: scale the mesh", scene.name))?;
        counts[0] += truth.len();
        counts[1] += truth.iter().flatten().count();
        files.insert(format!("{stem}-{name}.rays"), file.to_bytes());
        files.insert(format!("{stem}-{name}.truth"), exact_hits_bytes(&file.workload, &truth));
    }
    Ok((files, counts))
}

/// The ray file stores no scene hash. A scene loaded from the PLY file may have a different hash than `scene`.
fn rays_with_exact_hits(
    scene: &Scene,
    kind: RayKind,
    count: usize,
    seed: u64,
    oracle: &Oracle,
) -> Result<(RayFile, Vec<ExactHit>), String> {
    let workload = Workload { name: kind.name().into(), query: Query::Closest, rays: kind.rays(scene, count, seed) };
    RayFile::check(&workload.rays)?;
    RayFile::check_names(&scene.name, &workload.name)?;
    // Returns the nearest `t` and all triangles that are hit at this `t`. The relative error of `t` is below 2^-50.
    let exact_answer = |ray: &Ray| {
        let ids = oracle.nearest(ray)?.ids;
        // Always use the triangle with the smallest id, because the rounding of `t` depends on the triangle.
        let t = exact::hit(ray, scene.mesh.corners(ids[0])).expect("the oracle has found it");
        Some((t.approximate(), ids))
    };
    let truth = workload.rays.par_iter().map(exact_answer).collect();
    Ok((RayFile { scene: scene.name.clone(), scene_hash: None, workload }, truth))
}
