//! Where the rays of a run come from: made anew, or replayed from a file.

use std::path::{Path, PathBuf};
use std::str::FromStr;

use super::shown;
use crate::cli::sources;
use crate::scene::files::RayFile;
use crate::scene::{Builtin, Scene};

/// What `--rays` takes: how many rays to make, or a file of rays. A file whose name is a number is written `./NUMBER`.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum RaySource {
    Count(u32),
    File(PathBuf),
}

/// More rays than anybody wants in memory.
const MOST: u32 = 1 << 26;

impl FromStr for RaySource {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        // A number that is wrong is not taken for a file.
        let is_number = text.trim_start_matches(['-', '+']).bytes().all(|byte| byte.is_ascii_digit());
        match text.parse() {
            Ok(count @ 1..=MOST) => Ok(Self::Count(count)),
            _ if is_number => Err(format!("give a number of rays from 1 to {MOST}, or a file of rays")),
            _ => Ok(Self::File(text.into())),
        }
    }
}

impl RaySource {
    /// The file that they are replayed from, if they are.
    pub fn file(&self) -> Option<&Path> {
        match self {
            Self::Count(_) => None,
            Self::File(path) => Some(path),
        }
    }

    /// How many rays to make; `default` where they are replayed.
    pub fn count(&self, default: u32) -> u32 {
        match self {
            Self::Count(count) => *count,
            Self::File(_) => default,
        }
    }
}

/// The scene and the rays of the file that `source` names; nothing where rays are to be made. The scene is the one named,
/// which must be the file's, or the file's own if none is.
///
/// # Errors
/// If the file cannot be used, or its rays are not for that scene.
pub fn replayed(source: &RaySource, named: &[String]) -> anyhow::Result<Option<(Scene, RayFile)>> {
    let RaySource::File(path) = source else { return Ok(None) };
    let file = RayFile::read(path)?;
    let name = match named {
        [] if file.scene.is_empty() => {
            anyhow::bail!("{} holds rays of no scene in particular: name a scene", shown(path))
        }
        // Names of built-in scenes are names; what else a file says is no path to follow.
        [] if Builtin::find(&file.scene).is_err() => anyhow::bail!(
            "{} holds rays of {:?}, which is no built-in scene: name the mesh or scene file that they were recorded for",
            shown(path),
            file.scene
        ),
        [] => &file.scene,
        [one] => one,
        _ => anyhow::bail!("{} holds rays of one scene: name one scene, not {}", shown(path), named.len()),
    };
    let scene = sources::scene(name)?;
    file.check_scene(&scene).map_err(|problem| anyhow::anyhow!("{}: {problem}", shown(path)))?;
    Ok(Some((scene, file)))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_counts_and_the_rest_are_files() {
        assert_eq!("100".parse(), Ok(RaySource::Count(100)));
        assert_eq!("a.rays".parse(), Ok(RaySource::File("a.rays".into())));
        assert_eq!("./100".parse(), Ok(RaySource::File("./100".into())));
        for wrong in ["0", "-5", "99999999999", ""] {
            assert!(wrong.parse::<RaySource>().is_err(), "{wrong}");
        }
    }
}
