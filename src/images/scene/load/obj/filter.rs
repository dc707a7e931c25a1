//! Passes the statements of an OBJ file to tobj.
//!
//! tobj receives one checked statement at a time, to know the line of each error. Each guard that a comment about tobj
//! explains has a test that fails without the guard.
//!
//! The filter keeps data that tobj drops. The text is read twice, because faces may refer to later vertices.

use std::borrow::Cow;
use std::collections::VecDeque;
use std::io::{self, Read, Write as _};

use indexmap::IndexSet;

use super::vectors::Vectors;
use crate::scene::load::error::{Fault, quoted};
use crate::scene::load::notes::{Notes, SMALL};
use crate::scene::load::text::{is_among, name, number, statements, words};

const SHAPES: &str = "p l curv curv2 surf bsp bzp cdc cdp";

const SKIPPED: &str = "vt vp g o s cstype deg bmat step parm trim hole scrv sp end con mg bevel c_interp d_interp lod \
    maplib usemap shadow_obj trace_obj ctech stech call csh res fo cg texid smooth";

/// A face with more corners is probably a mistake.
const MOST_CORNERS: usize = 1 << 20;

/// The filter begins a new tobj model after this number of corners. Until a model ends, tobj holds up to thirty
/// times the text of the model.
const CORNERS_IN_MODEL: usize = 1 << 16;

#[derive(Clone, Copy)]
enum Reading {
    Vectors,
    Faces,
}

/// Consecutive faces with equal material and smoothness.
pub(super) struct Section {
    pub faces: usize,
    pub material: u32,
    pub is_smooth: bool,
}

#[derive(Default)]
pub(super) struct Contents {
    pub vertices: Vectors,
    pub normals: Vectors,
    pub triangles: usize,
    pub sections: Vec<Section>,
    /// The words after each `mtllib`.
    pub libraries: IndexSet<Vec<u8>>,
    /// Names in the order of first use. tobj drops names that no library defines.
    pub materials: IndexSet<Vec<u8>>,
    material: u32,
    /// The material name for the next face. `None` if the material does not change.
    next_material: Option<Vec<u8>>,
    /// The vertex index and normal index of each corner of a face. Indices count from 1. A missing normal is 0.
    corners: Vec<[u32; 2]>,
    models: u32,
    corners_in_model: usize,
    weighted: usize,
    small_faces: usize,
    shapes: usize,
    unknown: usize,
    first_unknown: Option<(usize, String)>,
    /// Bytes that tobj has not yet read.
    to_tobj: VecDeque<u8>,
}

pub(super) struct Filter<'a> {
    statements: Box<dyn Iterator<Item = (Reading, usize, Cow<'a, [u8]>)> + 'a>,
    pub contents: Contents,
    /// The fault of the rejected statement.
    pub fault: Option<Fault>,
}

impl<'a> Filter<'a> {
    pub fn new(text: &'a [u8]) -> Self {
        let read = move |reading| statements(text).map(move |(line, statement)| (reading, line, statement));
        let statements = Box::new(read(Reading::Vectors).chain(read(Reading::Faces)));
        let contents = Contents { next_material: Some(b"default".to_vec()), models: 1, ..Contents::default() };
        Self { statements, contents, fault: None }
    }
}

impl Read for Filter<'_> {
    fn read(&mut self, buffer: &mut [u8]) -> io::Result<usize> {
        while self.contents.to_tobj.is_empty()
            && let Some((reading, line, statement)) = self.statements.next()
        {
            if let Err(problem) = self.contents.read(reading, line, &statement) {
                self.fault = Some(Fault::line(line, problem));
                return Err(io::ErrorKind::InvalidData.into());
            }
        }
        self.contents.to_tobj.read(buffer)
    }
}

impl Contents {
    /// Returns an error if there are no triangles.
    pub fn check(&self, notes: &mut Notes) -> Result<(), Fault> {
        notes.count(self.small_faces, "face", SMALL);
        notes.count(self.shapes, "statement", "of points, lines, curves or surfaces: ignored");
        notes.count(self.weighted, "weight", "w other than 1 in statements `v`: ignored");
        if let Some((line, statement)) = &self.first_unknown {
            if self.triangles == 0 {
                let problem = "does not begin with an OBJ keyword, and no face follows: this is another format";
                return Err(Fault::line(*line, format!("{statement} {problem}")));
            }
            let ignored = format!("{} lines without an OBJ keyword are ignored", self.unknown);
            notes.add(format!("{ignored}; the first is line {line}: {statement}"));
        }
        let none = || Fault::file("it has no triangles: no face has three corners");
        (self.triangles > 0).then_some(()).ok_or_else(none)
    }

    fn read(&mut self, reading: Reading, line: usize, statement: &[u8]) -> Result<(), String> {
        let mut words = words(statement);
        let Some(keyword) = words.next() else { return Ok(()) };
        match (reading, keyword) {
            (Reading::Vectors, b"v" | b"vn") => self.vector(keyword, words).ok_or_else(|| {
                let what = if keyword == b"v" { "finite numbers" } else { "numbers" };
                format!("three {what} are needed: {}", quoted(statement))
            })?,
            (Reading::Vectors, _) => {}
            (_, b"v") => self.vertices.so_far += 1,
            (_, b"vn") => self.normals.so_far += 1,
            (_, b"f") => self.face(words)?,
            (_, b"usemtl") => self.next_material = Some(name(statement).to_vec()),
            (_, b"mtllib") => drop(self.libraries.insert(name(statement).to_vec())),
            // tobj would read a statement `l` with three or more vertices as a face.
            _ if is_among(SHAPES, keyword) => self.shapes += 1,
            _ if is_among(SKIPPED, keyword) => {}
            _ => {
                self.unknown += 1;
                self.first_unknown.get_or_insert_with(|| (line, quoted(statement)));
            }
        }
        Ok(())
    }

    /// Returns `None` unless there are three valid numbers. tobj would accept nan, inf and 1e999 as coordinates. tobj
    /// would also split words at white space outside ASCII.
    fn vector<'w>(&mut self, keyword: &[u8], mut words: impl Iterator<Item = &'w [u8]>) -> Option<()> {
        let is_vertex = keyword == b"v";
        let vectors = if is_vertex { &mut self.vertices } else { &mut self.normals };
        vectors.last_model.push(0);
        self.to_tobj.extend(keyword);
        for _ in 0..3 {
            let word = words.next()?;
            number(word).filter(|number: &f32| number.is_finite() || !is_vertex)?;
            self.to_tobj.push_back(b' ');
            self.to_tobj.extend(word);
        }
        self.to_tobj.push_back(b'\n');
        // The fourth of exactly four numbers is a weight. tobj would divide the coordinates by the weight.
        // More numbers are colours, which tobj requires for all vertices or none.
        if is_vertex && let (Some(weight), None) = (words.next(), words.next()) {
            self.weighted += usize::from(number::<f32>(weight) != Some(1.0));
        }
        Some(())
    }

    fn face<'w>(&mut self, words: impl Iterator<Item = &'w [u8]>) -> Result<(), String> {
        self.corners.clear();
        for word in words {
            if self.corners.len() == MOST_CORNERS {
                return Err(format!("the face has more than {MOST_CORNERS} corners: split it, or correct the line"));
            }
            self.corners.push(self.corner(word)?);
        }
        if self.corners.len() < 3 {
            self.small_faces += 1;
            return Ok(());
        }
        self.triangles += self.corners.len() - 2;
        if let Some(name) = self.next_material.take() {
            self.material = self.materials.insert_full(name).0 as u32;
        }
        let (material, is_smooth) = (self.material, self.corners.iter().all(|&[_, normal]| normal > 0));
        match self.sections.last_mut().filter(|last| (last.material, last.is_smooth) == (material, is_smooth)) {
            Some(section) => section.faces += 1,
            None => self.sections.push(Section { faces: 1, material, is_smooth }),
        }

        if self.corners_in_model >= CORNERS_IN_MODEL {
            self.to_tobj.extend(b"g\n");
            self.models += 1;
            self.corners_in_model = 0;
        }
        self.corners_in_model += self.corners.len();
        self.to_tobj.push_back(b'f');
        for &[vertex, normal] in &self.corners {
            // Replace a missing normal index. Without the index, tobj may use a normal that `add_use` has not recorded.
            let normal = normal.max(1);
            self.vertices.add_use(vertex, self.models);
            self.normals.add_use(normal, self.models);
            write!(self.to_tobj, " {vertex}//{normal}").expect("a list takes all bytes");
        }
        self.to_tobj.push_back(b'\n');
        Ok(())
    }

    /// Returns absolute indices, because tobj receives all vectors before the first face. The function rejects invalid
    /// indices, because tobj panics on some invalid indices of normals.
    fn corner(&self, word: &[u8]) -> Result<[u32; 2], String> {
        let mut parts = word.split(|&b| b == b'/');
        let vertex = self.vertices.index(parts.next().unwrap_or_default(), "vertex")?;
        let normal = match parts.nth(1) {
            None | Some(b"") => 0,
            Some(normal) => self.normals.index(normal, "normal")?,
        };
        match parts.next() {
            None => Ok([vertex, normal]),
            Some(_) => Err(format!("the corner {} has more than three indices", quoted(word))),
        }
    }
}
