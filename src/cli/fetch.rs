//! The command `fetch`: downloads the real meshes of scenes.

use std::ffi::OsString;
use std::path::{Path, PathBuf};

use anyhow::Context;

use super::terminal::Terminal;
use crate::builtin::{BUILTIN, Builtin, real_mesh_folder};
use crate::escaped::Escaped as _;
use crate::fetch::DataFile;
#[cfg(feature = "fetch")]
use crate::fetch::{Client, FetchOutcome};
use crate::report::number::bytes;
use crate::report::words::each_once_by;
use crate::scene::format::{RealMesh, SceneFile};
use crate::study::Status;

#[derive(Debug, clap::Args)]
pub struct Args {
    /// Built-in scenes and scene files (.toml) [default: all built-in scenes]
    #[arg(value_name = "SCENE|F.toml")]
    scenes: Vec<OsString>,
    /// Only list files, sources and licences
    #[arg(long)]
    list: bool,
    /// Folder of real meshes [default: SAHARA_DATA, or scenes/data]
    #[arg(long, value_name = "FOLDER")]
    data: Option<PathBuf>,
}

pub fn run(args: &Args, terminal: &Terminal) -> anyhow::Result<Status> {
    let folder = args.data.clone().unwrap_or_else(real_mesh_folder);
    let real_meshes = |scene: SceneFile| {
        scene.objects.into_iter().filter_map(|object| object.real).map(move |real| (scene.name.clone(), real))
    };
    let files = scenes(&args.scenes)?.into_iter().flat_map(real_meshes);
    let files = each_once_by(files, |one, other| (&one.0, &one.1.file) == (&other.0, &other.1.file));
    if files.is_empty() {
        terminal.print("these scenes use no real mesh: nothing to fetch\n");
        return Ok(Status::Right);
    }
    // Print all licences before the first download.
    let lines = files.iter().flat_map(|(scene, real)| described(scene, real));
    terminal.print(&lines.map(|line| format!("{}\n", line.escaped())).collect::<String>());
    if args.list {
        return Ok(Status::Right);
    }
    let mut failed = 0;
    for (_, real) in &files {
        let path = folder.join(&real.file);
        if real.sha256.is_none() && path.is_file() {
            terminal.print(&format!("{}: present, not verified (its scene file has no sha256)\n", path.escaped()));
            continue;
        }
        if let Err(error) = fetch(real, &folder, terminal) {
            crate::output::print_error(format_args!("{error:#}"));
            failed += 1;
        }
    }
    anyhow::ensure!(failed == 0, "{failed} of {} files could not be fetched (see above)", files.len());
    Ok(Status::Right)
}

fn scenes(named: &[OsString]) -> anyhow::Result<Vec<SceneFile>> {
    if named.is_empty() {
        return Ok(BUILTIN.iter().map(Builtin::file).collect());
    }
    let read = |name: &OsString| -> anyhow::Result<SceneFile> {
        match Path::new(name).extension() {
            Some(_) => {
                let text = std::fs::read_to_string(name).with_context(|| format!("cannot read {}", name.escaped()))?;
                Ok(SceneFile::parse(&text, &name.escaped().to_string())?)
            }
            None => Ok(Builtin::find(name)?.file()),
        }
    };
    named.iter().map(read).collect()
}

fn described(scene: &str, real: &RealMesh) -> [String; 3] {
    let size = real.bytes.map_or(String::new(), |n| format!(", {}", bytes(n as usize)));
    let RealMesh { file, origin, licence, url, .. } = real;
    [format!("{scene}: {file}{size}: {origin}"), format!("  licence: {licence}"), format!("  from {url}")]
}

#[cfg(feature = "fetch")]
fn fetch(real: &RealMesh, folder: &Path, terminal: &Terminal) -> anyhow::Result<()> {
    let file = DataFile::new(real, folder)?;
    let bar = super::progress::download(&real.file, real.bytes, terminal);
    let fetched = Client::default().fetch(&file, &mut |got| bar.set_position(got));
    bar.finish_and_clear();
    let what = match fetched? {
        FetchOutcome::AlreadyThere => "present, SHA-256 verified".to_owned(),
        FetchOutcome::Downloaded { bytes: n } => format!("fetched, {}, SHA-256 verified", bytes(n as usize)),
    };
    terminal.print(&format!("{}: {what}\n", file.path.escaped()));
    Ok(())
}

#[cfg(not(feature = "fetch"))]
fn fetch(real: &RealMesh, folder: &Path, terminal: &Terminal) -> anyhow::Result<()> {
    let file = DataFile::new(real, folder)?;
    let (url, path, is_there) = (&file.url, file.path.escaped(), file.is_there()?);
    anyhow::ensure!(
        is_there,
        "this sahara was built without the feature `fetch`: download {url} to {path} yourself, or rebuild with `--features fetch`"
    );
    terminal.print(&format!("{path}: present, SHA-256 verified\n"));
    Ok(())
}
