//! Reads and writes ray files.

use std::path::Path;

use glam::Vec3;

use super::bytes::{HEADER_BYTES, RaysId, body, header, number, rays_hash};
use super::{FileError, read};
use crate::geometry::Ray;
use crate::output::OutputFile;
use crate::scene::hash::hexadecimal;
use crate::scene::{Scene, Workload};

/// A workload, with the name and the hash of its scene.
#[derive(Clone, Debug, PartialEq)]
pub struct RayFile {
    /// The name of the scene, or an empty string.
    pub scene: String,
    /// [`Scene::hash`], in hexadecimal. `None` for rays without a scene.
    pub scene_hash: Option<String>,
    pub workload: Workload,
}

const MAGIC: &[u8; 8] = b"SAHARAYS";

const NAMES: usize = 72;

impl RayFile {
    pub fn new(scene: &Scene, workload: Workload) -> Self {
        Self { scene: scene.name.clone(), scene_hash: Some(scene.hash()), workload }
    }

    /// # Errors
    /// If the file cannot be read or is not a valid ray file.
    pub fn read(path: &Path) -> Result<Self, FileError> {
        read(path, MAGIC, Self::from_bytes)
    }

    /// # Errors
    /// If the file cannot be written.
    pub fn write(&self, file: &OutputFile) -> Result<(), FileError> {
        Ok(file.write(&self.to_bytes())?)
    }

    /// # Errors
    /// If there are no rays, if an origin or direction is not finite, or if `t_min` or `t_max` is NaN.
    pub fn check(rays: &[Ray]) -> Result<(), String> {
        let bad = |ray: &Ray| {
            let finite = ray.origin.is_finite() && ray.direction.is_finite();
            !finite || ray.t_min.is_nan() || ray.t_max.is_nan()
        };
        match rays.iter().position(bad) {
            _ if rays.is_empty() => Err("it has no rays".into()),
            Some(at) => Err(format!("ray {} of {} has a number that is not finite: {}", at + 1, rays.len(), rays[at])),
            None => Ok(()),
        }
    }

    /// # Errors
    /// If a name contains a control character, which would garble tables.
    pub fn check_names(scene: &str, kind: &str) -> Result<(), String> {
        match [scene, kind].into_iter().find(|name| name.chars().any(char::is_control)) {
            Some(name) => Err(format!("the name {name:?} contains a control character: choose another")),
            None => Ok(()),
        }
    }

    /// # Errors
    /// If `self.scene_hash` is not `None` and differs from the hash of `scene`.
    pub fn check_scene(&self, scene: &Scene) -> Result<(), String> {
        match &self.scene_hash {
            Some(hash) if *hash != scene.hash() => Err(format!(
                "the rays were recorded for the scene {:?} with the hash {}, but {:?} here has {}: record them again, \
                 or use the original meshes",
                self.scene,
                &hash[..16],
                scene.name,
                &scene.hash()[..16]
            )),
            _ => Ok(()),
        }
    }

    pub fn to_bytes(&self) -> Vec<u8> {
        let Workload { name, query, rays } = &self.workload;
        let body = self.workload.bytes();
        let id = RaysId { query: *query, count: rays.len() as u64, hash: rays_hash(&body) };
        let mut bytes = id.header(MAGIC);
        bytes.extend(self.scene_hash.as_deref().map_or([0; 32], unhex));
        let names = [self.scene.as_str(), name];
        names.iter().for_each(|name| bytes.extend((name.len() as u32).to_le_bytes()));
        names.iter().for_each(|name| bytes.extend(name.as_bytes()));
        bytes.resize(bytes.len().next_multiple_of(HEADER_BYTES), 0);
        bytes.extend(body);
        bytes
    }

    pub(super) fn from_bytes(bytes: &[u8]) -> Result<Self, String> {
        let RaysId { query, count, hash } = header(bytes, MAGIC, "rays")?;
        let short = || "the file is truncated in its header".to_owned();
        let mut names = bytes.get(NAMES..).ok_or_else(short)?;
        let mut name = |length: usize| {
            let name = names.split_off(..number(bytes, length) as usize).ok_or_else(short)?;
            let unreadable = |_| "a name in the header is not UTF-8: the file was changed".to_owned();
            String::from_utf8(name.to_vec()).map_err(unreadable)
        };
        let (scene, name) = (name(NAMES - 8)?, name(NAMES - 4)?);
        Self::check_names(&scene, &name)?;

        let start = (NAMES + scene.len() + name.len()).next_multiple_of(HEADER_BYTES);
        let body = body(bytes, start, count, 32)?;
        if rays_hash(body) != hash {
            return Err("the rays do not match the hash in the header: the file was changed".into());
        }
        let rays: Vec<Ray> = body.chunks_exact(32).map(ray).collect();
        Self::check(&rays)?;
        let known = bytes[HEADER_BYTES..HEADER_BYTES + 32].iter().any(|&byte| byte != 0);
        let scene_hash = known.then(|| hexadecimal(&bytes[HEADER_BYTES..HEADER_BYTES + 32]));
        Ok(Self { scene, scene_hash, workload: Workload { name, query, rays } })
    }
}

fn ray(bytes: &[u8]) -> Ray {
    let float = |i: usize| f32::from_bits(number(bytes, 4 * i));
    let vector = |i: usize| Vec3::new(float(i), float(i + 1), float(i + 2));
    Ray { origin: vector(0), t_min: float(3), direction: vector(4), t_max: float(7) }
}

fn unhex(text: &str) -> [u8; 32] {
    std::array::from_fn(|i| text.get(2 * i..2 * i + 2).and_then(|two| u8::from_str_radix(two, 16).ok()).unwrap_or(0))
}
