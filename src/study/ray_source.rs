//! Where the rays of a run come from: made anew, or replayed from a file.

use std::ffi::{OsStr, OsString};
use std::path::{Path, PathBuf};

use clap::builder::{OsStringValueParser, TryMapValueParser, TypedValueParser, ValueParserFactory};

use super::sources;
use crate::escaped::Escaped as _;
use crate::scene::files::RayFile;
use crate::scene::{Builtin, Scene};

/// What `--rays` takes: how many rays, or a file of rays. A file whose name is a number or `all` is written `./NAME`.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum RaySource {
    /// At most so many; all of them where the number is the largest there is.
    Count(usize),
    File(PathBuf),
}

/// More rays than anybody wants in memory.
const MOST: usize = 1 << 26;

/// Reads a number of rays, or `all`: the largest number.
///
/// # Errors
/// A sentence, if it is neither.
pub fn rays_or_all(text: &str) -> Result<usize, String> {
    match text.parse() {
        _ if text == "all" => Ok(usize::MAX),
        Ok(count @ 1..=MOST) => Ok(count),
        _ => Err(format!("give a number of rays from 1 to {MOST}, or all")),
    }
}

/// Reads what a command line names.
impl ValueParserFactory for RaySource {
    type Parser = TryMapValueParser<OsStringValueParser, fn(OsString) -> Result<Self, String>>;

    fn value_parser() -> Self::Parser {
        OsStringValueParser::new().try_map(|named| Self::of(&named))
    }
}

impl RaySource {
    /// What `named` names.
    ///
    /// # Errors
    /// A sentence, if it is a number that is no number of rays.
    pub fn of(named: &OsStr) -> Result<Self, String> {
        let Some(text) = named.to_str() else { return Ok(Self::File(named.into())) };
        // A number that is wrong is not taken for a file.
        let is_number = text.trim_start_matches(['-', '+']).bytes().all(|byte| byte.is_ascii_digit());
        match rays_or_all(text) {
            Ok(count) => Ok(Self::Count(count)),
            Err(sentence) if is_number => Err(format!("{sentence}, or a file of rays")),
            Err(_) => Ok(Self::File(text.into())),
        }
    }

    /// The file that they are replayed from, if they are.
    pub fn file(&self) -> Option<&Path> {
        match self {
            Self::Count(_) => None,
            Self::File(path) => Some(path),
        }
    }

    /// How many rays at most; all where they are replayed.
    pub fn count(&self) -> usize {
        match self {
            Self::Count(count) => *count,
            Self::File(_) => usize::MAX,
        }
    }

    /// As [`count`](Self::count), of rays of which there is no end.
    ///
    /// # Errors
    /// If all are asked for.
    pub fn number(&self) -> anyhow::Result<usize> {
        match self {
            Self::Count(usize::MAX) => anyhow::bail!("there is no end of such rays: give a number of them, not all"),
            Self::Count(count) => Ok(*count),
            Self::File(_) => Ok(0),
        }
    }
}

/// The scene and the rays of the file that `source` names; nothing where rays are to be made. The scene is the one named,
/// which must be the file's, or the file's own if none is.
///
/// # Errors
/// If the file cannot be used, or its rays are not for that scene.
pub fn replayed(source: &RaySource, named: &[OsString]) -> anyhow::Result<Option<(Scene, RayFile)>> {
    let RaySource::File(path) = source else { return Ok(None) };
    let file = RayFile::read(path)?;
    let name = match named {
        [] if file.scene.is_empty() => {
            anyhow::bail!("{} holds rays of no scene in particular: name a scene", path.escaped())
        }
        // Names of built-in scenes are names; what else a file says is no path to follow.
        [] if Builtin::find(&file.scene).is_err() => anyhow::bail!(
            "{} holds rays of {:?}, which is no built-in scene: name the mesh or scene file that they were recorded for",
            path.escaped(),
            file.scene
        ),
        [] => OsStr::new(&file.scene),
        [one] => one,
        _ => anyhow::bail!("{} holds rays of one scene: name one scene, not {}", path.escaped(), named.len()),
    };
    let scene = sources::scene(name)?;
    file.check_scene(&scene).map_err(|problem| anyhow::anyhow!("{}: {problem}", path.escaped()))?;
    Ok(Some((scene, file)))
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
