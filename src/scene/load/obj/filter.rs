//! The statements of an OBJ file for tobj, and the data that tobj does not return.
//!
//! tobj is given one clean statement at a time: the place of its errors is then known. The text is read twice: first
//! vertices and normals, then faces, which may refer to later vertices. Comments that begin with "tobj" explain a
//! guard; each has a test that fails without it.

use std::borrow::Cow;
use std::collections::HashMap;
use std::io::{self, Cursor, Read, Write as _};

use super::vectors::Vectors;
use crate::scene::load::error::{Fault, quoted};
use crate::scene::load::mtl::MOST_LIBRARIES;
use crate::scene::load::notes::{Notes, SMALL_FACES};
use crate::scene::load::text::{name, number, statements, words};

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

/// The faces from `first` on, up to the next section.
#[derive(Clone, Copy)]
pub(super) struct Section {
    pub first: usize,
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
    pub libraries: Vec<Vec<u8>>,
    /// Material names with their numbers, in the order of their first use.
    pub materials: HashMap<Vec<u8>, u32>,
    /// The current material name, none if a face has used it.
    material: Option<Vec<u8>>,
    faces: usize,
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
}

pub(super) struct Filter<'a> {
    statements: Box<dyn Iterator<Item = (Reading, usize, Cow<'a, [u8]>)> + 'a>,
    /// The statement for tobj, its line in the file, and why there is none.
    statement: Cursor<Vec<u8>>,
    line: usize,
    problem: Option<String>,
    contents: Contents,
}

impl<'a> Filter<'a> {
    pub fn new(text: &'a [u8]) -> Self {
        let read = move |reading| statements(text).map(move |(line, statement)| (reading, line, statement));
        Self {
            statements: Box::new([Reading::Vectors, Reading::Faces].into_iter().flat_map(read)),
            statement: Cursor::default(),
            line: 0,
            problem: None,
            contents: Contents { material: Some(b"default".to_vec()), models: 1, ..Contents::default() },
        }
    }

    /// Why tobj ended with this error: by itself it finds nothing wrong in what it is given.
    pub fn fault(self, error: tobj::LoadError) -> Fault {
        Fault::line(self.line, self.problem.unwrap_or_else(|| error.to_string()))
    }

    /// The content of the text once tobj has read it: triangles, or another format, in which tobj finds nothing wrong.
    pub fn finish(self, notes: &mut Notes) -> Result<Contents, Fault> {
        let Contents { triangles, small_faces, shapes, weighted, unknown, .. } = self.contents;
        notes.count(small_faces, SMALL_FACES);
        notes.count(shapes, ["point, line, curve or surface: ignored", "points, lines, curves or surfaces: ignored"]);
        notes.count(
            weighted,
            ["vertex has a weight w other than 1: ignored", "vertices have weights w other than 1: ignored"],
        );
        match &self.contents.first_unknown {
            None if triangles == 0 => return Err(Fault::file("it has no triangles: no face has three corners")),
            Some((line, statement)) if triangles == 0 => {
                let problem = format!(
                    "{statement} does not begin with an OBJ keyword, and no face follows: this is another \
                             format"
                );
                return Err(Fault::line(*line, problem));
            }
            Some((line, statement)) => notes.add(format!(
                "{unknown} lines without an OBJ keyword are ignored; the first is line {line}: {statement}"
            )),
            None => {}
        }
        Ok(self.contents)
    }

    /// Writes the next statement for tobj, none at the end of the text.
    fn advance(&mut self) -> Result<(), String> {
        let Self { statement, contents, .. } = self;
        statement.set_position(0);
        let to_tobj = statement.get_mut();
        to_tobj.clear();
        while to_tobj.is_empty()
            && let Some((reading, line, statement)) = self.statements.next()
        {
            self.line = line;
            let mut words = words(&statement);
            let Some(keyword) = words.next() else { continue };
            match (reading, keyword) {
                (Reading::Vectors, b"v" | b"vn") => contents.vector(keyword, words, to_tobj).ok_or_else(|| {
                    let what = if keyword == b"v" { "finite numbers" } else { "numbers" };
                    format!("three {what} are needed: {}", quoted(&statement))
                })?,
                (Reading::Faces, b"v") => contents.vertices.so_far += 1,
                (Reading::Faces, b"vn") => contents.normals.so_far += 1,
                (Reading::Faces, b"f") => contents.face(words, to_tobj)?,
                (Reading::Faces, b"usemtl") => contents.material = Some(name(&statement).to_vec()),
                (Reading::Faces, b"mtllib") => contents.add_library(name(&statement)),
                (Reading::Faces, _) | (_, b"f" | b"usemtl" | b"mtllib") => {}
                // tobj makes a face of a line with three or more vertices.
                (_, keyword) if is_among(SHAPES, keyword) => contents.shapes += 1,
                (_, keyword) if is_among(SKIPPED, keyword) => {}
                _ => {
                    contents.unknown += 1;
                    contents.first_unknown.get_or_insert_with(|| (line, quoted(&statement)));
                }
            }
        }
        Ok(())
    }
}

impl Contents {
    /// Writes a vertex or a normal with its three numbers; none if it has not as many. tobj also splits words at white
    /// space outside of ASCII, and takes nan, inf and 1e999 for coordinates.
    fn vector<'w>(
        &mut self,
        keyword: &[u8],
        mut words: impl Iterator<Item = &'w [u8]>,
        to_tobj: &mut Vec<u8>,
    ) -> Option<()> {
        let is_vertex = keyword == b"v";
        let vectors = if is_vertex { &mut self.vertices } else { &mut self.normals };
        vectors.last_model.push(0);
        to_tobj.extend_from_slice(keyword);
        for _ in 0..3 {
            let word = words.next()?;
            number(word).filter(|number: &f32| number.is_finite() || !is_vertex)?;
            to_tobj.push(b' ');
            to_tobj.extend_from_slice(word);
        }
        to_tobj.push(b'\n');
        // tobj divides by a fourth number. More are colours, which tobj wants for every vertex or none.
        if is_vertex && let (Some(weight), None) = (words.next(), words.next()) {
            self.weighted += usize::from(number::<f32>(weight) != Some(1.0));
        }
        Some(())
    }

    fn face<'w>(&mut self, words: impl Iterator<Item = &'w [u8]>, to_tobj: &mut Vec<u8>) -> Result<(), String> {
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
        self.begin_section();
        self.faces += 1;
        if self.corners_in_model >= CORNERS_IN_MODEL {
            to_tobj.extend_from_slice(b"g\n");
            self.models += 1;
            self.corners_in_model = 0;
        }
        self.corners_in_model += self.corners.len();

        to_tobj.push(b'f');
        for &[vertex, normal] in &self.corners {
            // tobj gives a corner without a normal the normal of another corner: here it is the first of the file.
            let normal = normal.max(1);
            self.vertices.add_use(vertex, self.models);
            self.normals.add_use(normal, self.models);
            write!(to_tobj, " {vertex}//{normal}").expect("a list takes all bytes");
        }
        to_tobj.push(b'\n');
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

    /// Begins a section if the face being read differs from the last. tobj forgets the names of undefined materials.
    fn begin_section(&mut self) {
        let is_smooth = self.corners.iter().all(|&[_, normal]| normal > 0);
        let last = self.sections.last().copied();
        let next = self.materials.len() as u32;
        let material = match (self.material.take(), last) {
            (None, Some(last)) => last.material,
            (name, _) => *self.materials.entry(name.unwrap_or_default()).or_insert(next),
        };
        if last.is_none_or(|last| (last.material, last.is_smooth) != (material, is_smooth)) {
            self.sections.push(Section { first: self.faces, material, is_smooth });
        }
    }

    /// Keeps one library more than are read, for a note.
    fn add_library(&mut self, names: &[u8]) {
        if self.libraries.len() <= MOST_LIBRARIES && !self.libraries.iter().any(|known| known == names) {
            self.libraries.push(names.to_vec());
        }
    }
}

fn is_among(keywords: &str, keyword: &[u8]) -> bool {
    keywords.split(' ').any(|known| known.as_bytes() == keyword)
}

/// One statement at a time.
impl Read for Filter<'_> {
    fn read(&mut self, buffer: &mut [u8]) -> io::Result<usize> {
        if self.statement.position() == self.statement.get_ref().len() as u64
            && let Err(problem) = self.advance()
        {
            self.problem = Some(problem);
            return Err(io::ErrorKind::InvalidData.into());
        }
        self.statement.read(buffer)
    }
}
