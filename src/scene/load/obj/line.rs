//! The statements of an OBJ file.

use std::borrow::Cow;

use glam::Vec3;

use crate::scene::Model;
use crate::scene::load::error::quoted;
use crate::scene::load::text::{after_keyword, lines, number, words};

/// Statements for visible elements other than faces: points, lines, curves and surfaces.
const SHAPES: &str = "p l curv curv2 surf bsp bzp cdc cdp";

/// Other statements of the format that are skipped: texture coordinates, groups, parameters, display attributes.
const SKIPPED: &str = "vt vp g o s cstype deg bmat step parm trim hole scrv sp end con mg bevel c_interp d_interp lod \
    maplib usemap shadow_obj trace_obj ctech stech call csh res fo cg texid smooth";

/// Statements with the numbers of the lines that they begin on: a line whose last character is `\` goes on in the next,
/// unless it ends in a comment.
pub(super) fn statements(text: &[u8]) -> impl Iterator<Item = (usize, Cow<'_, [u8]>)> {
    let mut lines = lines(text);
    std::iter::from_fn(move || {
        let (number, mut line) = lines.next()?;
        if continued(line).is_none() {
            return Some((number, Cow::Borrowed(line)));
        }
        let mut whole = Vec::new();
        while let Some(head) = continued(line) {
            whole.extend_from_slice(head);
            whole.push(b' ');
            line = lines.next().map_or(&[], |(_, line)| line);
        }
        whole.extend_from_slice(line);
        Some((number, Cow::Owned(whole)))
    })
}

fn continued(line: &[u8]) -> Option<&[u8]> {
    let head = line.strip_suffix(b"\\")?;
    let has_comment = words(line).any(|word| word.starts_with(b"#"));
    (!has_comment).then_some(head)
}

/// A statement; the words are those after the keyword.
pub(super) enum Line<W> {
    Vertex(W),
    Normal(W),
    Face(W),
    Material(String),
    Library(String),
    /// An element that is left out: see [`SHAPES`].
    Shape,
    /// A statement that is not needed: see [`SKIPPED`].
    Skipped,
    /// Nothing, or a comment.
    Empty,
    /// An unknown statement, quoted.
    Unknown(String),
}

impl Line<()> {
    pub fn of(line: &[u8]) -> Line<impl Iterator<Item = &[u8]>> {
        let mut words = words(line);
        match words.next() {
            None => Line::Empty,
            Some(b"v") => Line::Vertex(words),
            Some(b"vn") => Line::Normal(words),
            Some(b"f") => Line::Face(words),
            Some(b"usemtl") => Line::Material(after_keyword(line)),
            Some(b"mtllib") => Line::Library(after_keyword(line)),
            Some(comment) if comment.starts_with(b"#") => Line::Empty,
            Some(keyword) if is_among(SHAPES, keyword) => Line::Shape,
            Some(keyword) if is_among(SKIPPED, keyword) => Line::Skipped,
            Some(_) => Line::Unknown(quoted(line)),
        }
    }
}

fn is_among(keywords: &str, keyword: &[u8]) -> bool {
    keywords.split(' ').any(|known| known.as_bytes() == keyword)
}

/// The first three numbers; a fourth coordinate and colours are ignored.
pub(super) fn vector<'a>(mut words: impl Iterator<Item = &'a [u8]>) -> Result<Vec3, String> {
    let mut next = || match words.next() {
        None => Err("three numbers are needed: the file may be truncated".to_owned()),
        Some(word) => number::<f32>(word).ok_or_else(|| format!("{} is not a number", quoted(word))),
    };
    Ok(Vec3::new(next()?, next()?, next()?))
}

/// The corners of a face that follows the given numbers of vertices and normals: vertex and normal index, or
/// [`Model::FLAT`], counted from 0. They may exceed those of the file.
pub(super) fn corners<'a>(
    words: impl Iterator<Item = &'a [u8]>,
    vertices: usize,
    normals: usize,
) -> impl Iterator<Item = Result<(u32, u32), String>> {
    words.take_while(|word| !word.starts_with(b"#")).map(move |word| {
        let mut parts = word.split(|&b| b == b'/');
        let vertex = index(parts.next().unwrap_or_default(), "vertex", vertices)?;
        let normal = match parts.nth(1) {
            None | Some(b"") => Model::FLAT,
            Some(normal) => index(normal, "normal", normals)?,
        };
        match parts.next() {
            None => Ok((vertex, normal)),
            Some(_) => Err(format!("the corner {} has more than three indices", quoted(word))),
        }
    })
}

/// Turns an index that counts from 1, or backwards from -1, into one that counts from 0.
fn index(word: &[u8], what: &str, count: usize) -> Result<u32, String> {
    let index: i64 = number(word).ok_or_else(|| format!("{} is not a {what} index", quoted(word)))?;
    match index {
        0 => Err(format!("{what} index 0: indices count from 1, or backwards from -1")),
        1.. => u32::try_from(index)
            .map(|index| index - 1)
            .map_err(|_| format!("{what} {index} is more than a mesh can hold")),
        _ => match usize::try_from(count as i64 + index) {
            Ok(index) => Ok(index as u32),
            Err(_) => Err(format!("{what} index {index} reaches before the first of the {count} so far")),
        },
    }
}
