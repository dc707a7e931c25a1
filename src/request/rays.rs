//! Rays that are generated or read from a file.

use std::ffi::{OsStr, OsString};
use std::path::{Path, PathBuf};

use clap::builder::{OsStringValueParser, TryMapValueParser, TypedValueParser, ValueParserFactory};
use serde::{Deserialize, Serialize};

use super::{RayKind, scene};
use crate::accel::{DynAccel, Query};
use crate::builtin::Builtin;
use crate::escaped::Escaped as _;
use crate::registry::Registry;
use crate::report::words::each_once;
use crate::scene::files::RayFile;
use crate::scene::{Sampling, Scene, Workload, WorkloadKind};

/// The default workloads of `compare`.
pub const WORKLOADS: [WorkloadKind; 4] =
    [WorkloadKind::Primary, WorkloadKind::Shadow, WorkloadKind::Diffuse, WorkloadKind::Random];

/// Width and height in pixels.
const PICTURE: [u32; 2] = [512, 512];

/// The field `rays` is the maximum number of timed rays per workload. `None` is unlimited.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(tag = "from", rename_all = "kebab-case")]
pub enum WorkloadRequest {
    Scene {
        kinds: Vec<WorkloadKind>,
        #[serde(default, skip_serializing_if = "Option::is_none")]
        rays: Option<usize>,
    },
    /// All rays of a picture of 512 × 512 pixels.
    Picture,
    /// The primary rays of a picture of 512 × 512 pixels.
    PrimaryPicture,
    File {
        #[serde(with = "super::os_text")]
        path: PathBuf,
        /// [`Workload::hash`] of the rays in the file.
        hash: String,
        #[serde(default, skip_serializing_if = "Option::is_none")]
        rays: Option<usize>,
    },
    /// Workloads of `study accuracy`. Each workload has `count` rays.
    Hard { kinds: Vec<RayKind>, count: usize },
}

impl WorkloadRequest {
    /// `usize::MAX` represents all rays.
    pub fn of_scene(kinds: Vec<WorkloadKind>, rays: usize) -> Self {
        Self::Scene { kinds, rays: Some(rays).filter(|&rays| rays < usize::MAX) }
    }

    /// Secondary rays start at the hits of `tracer`.
    pub fn workloads(
        &self,
        scene: &Scene,
        seed: u64,
        tracer: &dyn DynAccel,
        progress: &mut dyn FnMut(&str),
    ) -> anyhow::Result<Vec<Workload>> {
        let picture = Sampling { size: PICTURE, ..Sampling::of(scene) };
        let (kinds, sampling): (&[WorkloadKind], Sampling) = match self {
            Self::Scene { kinds, .. } => (kinds, Sampling { seed, ..Sampling::of(scene) }),
            Self::Picture => (&[WorkloadKind::Image, WorkloadKind::ImageShadow], picture),
            Self::PrimaryPicture => (&[WorkloadKind::Primary], picture),
            Self::File { path, hash, .. } => {
                let file = RayFile::read(path)?;
                anyhow::ensure!(file.workload.hash() == *hash, "{} has changed since it was planned", path.escaped());
                return Ok(vec![file.workload]);
            }
            Self::Hard { kinds, count } => {
                let workload = |kind: &RayKind| {
                    progress(kind.name());
                    let rays = kind.rays(scene, *count, seed);
                    Workload { name: kind.name().into(), query: Query::Closest, rays }
                };
                return Ok(kinds.iter().map(workload).collect());
            }
        };
        let mut workloads = vec![];
        for &kind in kinds.iter().filter(|&&kind| kind != WorkloadKind::Mirror || scene.has_mirrors()) {
            progress(kind.name());
            workloads.push(Workload::new(scene, kind, &sampling, tracer));
        }
        workloads.retain(|workload| !workload.rays.is_empty());
        Ok(workloads)
    }

    pub fn most_rays(&self) -> usize {
        match self {
            Self::Scene { rays, .. } | Self::File { rays, .. } => rays.unwrap_or(usize::MAX),
            Self::Picture | Self::PrimaryPicture | Self::Hard { .. } => usize::MAX,
        }
    }

    /// The maximum number of workloads.
    pub fn kinds(&self) -> usize {
        match self {
            Self::Scene { kinds, .. } => kinds.len(),
            Self::Hard { kinds, .. } => kinds.len(),
            Self::Picture => 2,
            Self::PrimaryPicture | Self::File { .. } => 1,
        }
    }
}

/// Removes repeated workloads, which would count twice in means.
pub fn each_kind<K: Copy + PartialEq>(named: &[K], own: &[K]) -> Vec<K> {
    each_once(if named.is_empty() { own } else { named }.iter().copied())
}

/// Rays on the command line.
#[derive(Clone, Debug, clap::Args)]
#[command(next_help_heading = super::RAYS)]
pub struct Rays {
    /// Workload (see `sahara list`); may be repeated [default: primary, random]
    #[arg(long, short, value_name = "WORKLOAD")]
    pub workload: Vec<WorkloadKind>,
    /// Maximum number of rays to time per workload, in whole tiles of the scene's picture
    #[arg(long, value_name = "N|all", default_value = "all", value_parser = rays_or_all)]
    pub rays: usize,
}

impl Rays {
    pub fn request(&self, own: &[WorkloadKind]) -> WorkloadRequest {
        WorkloadRequest::of_scene(each_kind(&self.workload, own), self.rays)
    }
}

/// A value of `--rays`: a number of rays, `all`, or a ray file. A file named `100` is written `./100`.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum RaySource {
    /// The maximum number of rays. `usize::MAX` represents all rays.
    Count(usize),
    File(PathBuf),
}

const MOST: usize = 1 << 26;

pub fn rays_or_all(text: &str) -> Result<usize, String> {
    match text.parse() {
        _ if text == "all" => Ok(usize::MAX),
        Ok(count @ 1..=MOST) => Ok(count),
        _ => Err(format!("give a number of rays from 1 to {MOST}, or `all`")),
    }
}

impl ValueParserFactory for RaySource {
    type Parser = TryMapValueParser<OsStringValueParser, fn(OsString) -> Result<Self, String>>;

    fn value_parser() -> Self::Parser {
        OsStringValueParser::new().try_map(|named| Self::of(&named))
    }
}

impl RaySource {
    pub fn of(named: &OsStr) -> Result<Self, String> {
        let Some(text) = named.to_str() else { return Ok(Self::File(named.into())) };
        // A number that `rays_or_all` rejects is an error, not a file name.
        let is_number = text.trim_start_matches(['-', '+']).bytes().all(|byte| byte.is_ascii_digit());
        match rays_or_all(text) {
            Ok(count) => Ok(Self::Count(count)),
            Err(sentence) if is_number => Err(format!("{sentence}, or a ray file")),
            Err(_) => Ok(Self::File(text.into())),
        }
    }

    pub fn file(&self) -> Option<&Path> {
        if let Self::File(path) = self { Some(path) } else { None }
    }

    pub fn count(&self) -> usize {
        if let Self::Count(count) = self { *count } else { usize::MAX }
    }

    /// The number of rays to generate. The number is 0 for a file.
    pub fn number(&self) -> anyhow::Result<usize> {
        match self {
            Self::Count(usize::MAX) => {
                anyhow::bail!("any number of these rays can be generated: give a number instead of `all`")
            }
            Self::Count(count) => Ok(*count),
            Self::File(_) => Ok(0),
        }
    }
}

/// Reads a ray file and loads the scene of the rays. If `named` is empty, the scene name in the ray file is used.
///
/// Returns `None` if `source` is not a file.
pub fn recorded(
    registry: &Registry,
    source: &RaySource,
    named: &[OsString],
) -> anyhow::Result<Option<((OsString, Scene), RayFile)>> {
    let RaySource::File(path) = source else { return Ok(None) };
    let file = RayFile::read(path)?;
    let name = match named {
        [] if file.scene.is_empty() => {
            anyhow::bail!("{} names no scene: name one on the command line", path.escaped())
        }
        // The scene name in a ray file must not be used as a path.
        [] if Builtin::find(&file.scene).is_err() => anyhow::bail!(
            "{} has rays of {:?}, which is not a built-in scene: name the mesh or scene file that they were recorded for",
            path.escaped(),
            file.scene
        ),
        [] => OsStr::new(&file.scene),
        [one] => one,
        _ => anyhow::bail!("{} has rays of one scene: name one scene, not {}", path.escaped(), named.len()),
    };
    let scene = scene(registry, name)?;
    file.check_scene(&scene).map_err(|problem| anyhow::anyhow!("{}: {problem}", path.escaped()))?;
    Ok(Some(((name.into(), scene), file)))
}

/// Like [`recorded`], but returns a [`WorkloadRequest`] instead of a [`RayFile`].
pub fn replayed<K>(
    registry: &Registry,
    source: &RaySource,
    named: &[OsString],
    workloads: &[K],
    rays: Option<usize>,
) -> anyhow::Result<Option<((OsString, Scene), WorkloadRequest)>> {
    let (Some((scene, file)), Some(path)) = (recorded(registry, source, named)?, source.file()) else {
        return Ok(None);
    };
    anyhow::ensure!(workloads.is_empty(), "the file defines the rays: omit --workload");
    Ok(Some((scene, WorkloadRequest::File { path: path.into(), hash: file.workload.hash(), rays })))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_counts_and_the_rest_are_files() {
        let of = |text: &str| RaySource::of(text.as_ref());
        assert_eq!(of("100"), Ok(RaySource::Count(100)));
        assert_eq!(of("a.rays"), Ok(RaySource::File("a.rays".into())));
        assert_eq!(of("./100"), Ok(RaySource::File("./100".into())));
        assert_eq!(of("all"), Ok(RaySource::Count(usize::MAX)));
        assert!(rays_or_all("a.rays").is_err());
        for wrong in ["0", "-5", "99999999999", ""] {
            assert!(of(wrong).is_err(), "{wrong}");
        }
    }
}
