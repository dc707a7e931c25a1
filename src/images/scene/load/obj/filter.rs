//! The statements of an OBJ file for tobj, and the data that tobj does not return.
//!
//! tobj is given one clean statement at a time: the place of its errors is then known. The text is read twice: first
//! vertices and normals, then faces, which may refer to later vertices. Comments that begin with "tobj" explain a
//! guard; each has a test that fails without it.

use std::borrow::Cow;
use std::collections::VecDeque;
use std::io::{self, Read, Write as _};

use indexmap::IndexSet;

use super::vectors::Vectors;
use crate::scene::load::error::{Fault, quoted};
use crate::scene::load::notes::{Notes, SMALL};
use crate::scene::load::text::{is_among, name, number, statements, words};

/// Statements for visible elements other than faces: points, lines, curves and surfaces.
const SHAPES: &str = "p l curv curv2 surf bsp bzp cdc cdp";

/// Other statements of the format that are skipped: texture coordinates, groups, parameters, display attributes.
const SKIPPED: &str = "vt vp g o s cstype deg bmat step parm trim hole scrv sp end con mg bevel c_interp d_interp lod \
    maplib usemap shadow_obj trace_obj ctech stech call csh res fo cg texid smooth";

/// A face with more corners is taken for a mistake.
const MOST_CORNERS: usize = 1 << 20;

/// tobj holds 104 bytes for a face, and up to 48 more for a corner of a polygon, until its model ends: up to thirty times
/// the text. So a model ends after so many corners. A vertex that several models use stays one: see [`Vectors`].
const CORNERS_IN_MODEL: usize = 1 << 16;

#[derive(Clone, Copy)]
enum Reading {
    Vectors,
    Faces,
}

/// Consecutive faces.
pub(super) struct Section {
    pub faces: usize,
    pub material: u32,
    /// Whether all corners have normals.
    pub is_smooth: bool,
}

/// The filter's findings in the statements.
#[derive(Default)]
pub(super) struct Contents {
    pub vertices: Vectors,
    pub normals: Vectors,
    pub triangles: usize,
    pub sections: Vec<Section>,
    /// The words after each `mtllib`.
    pub libraries: IndexSet<Vec<u8>>,
    /// Names in the order of their first use. tobj forgets those that no library defines.
    pub materials: IndexSet<Vec<u8>>,
    material: u32,
    /// The name of the next face's material, if it may be another one.
    next_material: Option<Vec<u8>>,
    /// Corners of the face being read: vertex and normal counted from 1, or normal 0 for none.
    corners: Vec<[u32; 2]>,
    models: u32,
    corners_in_model: usize,
    weighted: usize,
    small_faces: usize,
    shapes: usize,
    unknown: usize,
    /// The first unknown statement, with its line.
    first_unknown: Option<(usize, String)>,
    /// The bytes of a statement that tobj has not yet read.
    to_tobj: VecDeque<u8>,
}

pub(super) struct Filter<'a> {
    statements: Box<dyn Iterator<Item = (Reading, usize, Cow<'a, [u8]>)> + 'a>,
    pub contents: Contents,
    /// The fault of a statement. tobj itself finds no fault in the statements that it is given.
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

/// Gives one statement at a time.
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
    /// Notes what is left out. An error if there are no triangles: it may be another format, in which tobj finds nothing
    /// wrong.
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

    /// Reads a statement, and writes what tobj needs of it.
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
            // tobj makes a face of a line with three or more vertices.
            _ if is_among(SHAPES, keyword) => self.shapes += 1,
            _ if is_among(SKIPPED, keyword) => {}
            _ => {
                self.unknown += 1;
                self.first_unknown.get_or_insert_with(|| (line, quoted(statement)));
            }
        }
        Ok(())
    }

    /// Writes a vertex or a normal with its three numbers; none if it has not as many. tobj also splits words at white
    /// space outside of ASCII, and takes nan, inf and 1e999 for coordinates.
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
        // tobj divides by a fourth number. More are colours, which tobj wants for every vertex or none.
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
            // tobj gives a corner without a normal the normal of another corner: here it is the first of the file.
            let normal = normal.max(1);
            self.vertices.add_use(vertex, self.models);
            self.normals.add_use(normal, self.models);
            write!(self.to_tobj, " {vertex}//{normal}").expect("a list takes all bytes");
        }
        self.to_tobj.push_back(b'\n');
        Ok(())
    }

    /// The vertex and the normal of a corner. tobj resolves an index that is relative, or forward, in what it has read; it
    /// panics on normals such as -4 of three and 6148914691236517206, and takes 0 for none.
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
