//! Checks an OBJ file, and counts its elements.

use super::line::{Line, corners, statements, vector};
use crate::scene::Model;
use crate::scene::load::error::{Fault, quoted};
use crate::scene::load::notes::{Notes, SMALL_FACES};

#[derive(Default)]
pub(super) struct Check {
    pub vertices: usize,
    pub normals: usize,
    pub triangles: usize,
    /// Whether any face has normals.
    pub smooth: bool,
    small_faces: usize,
    shapes: usize,
    skipped: usize,
    unknown: usize,
    /// The first unknown statement, with its line.
    first_unknown: Option<(usize, String)>,
    /// The highest index of a face, counted from 1, and its line. Indices may refer to later vertices, so it is checked
    /// at the end of the file.
    highest_vertex: (u32, usize),
    highest_normal: (u32, usize),
}

impl Check {
    /// Reads the whole text and keeps counts only.
    pub fn over(text: &[u8]) -> Result<Self, Fault> {
        let mut check = Self::default();
        for (number, line) in statements(text) {
            check.line(number, &line).map_err(|problem| Fault::line(number, problem))?;
        }
        check.finish()
    }

    pub fn note(&self, notes: &mut Notes) {
        notes.count(self.small_faces, SMALL_FACES);
        notes.count(
            self.shapes,
            ["point, line, curve or surface is left out", "points, lines, curves or surfaces are left out"],
        );
        if let Some((number, line)) = &self.first_unknown {
            let count = self.unknown;
            notes.add(format!(
                "{count} lines without a keyword of OBJ are passed over, the first is line {number}: {line}"
            ));
        }
    }

    fn line(&mut self, number: usize, line: &[u8]) -> Result<(), String> {
        match Line::of(line) {
            Line::Vertex(words) => {
                self.vertices += 1;
                if !vector(words)?.is_finite() {
                    return Err(format!("vertex {} is not finite: {}", self.vertices, quoted(line)));
                }
            }
            Line::Normal(words) => {
                self.normals += 1;
                vector(words)?;
            }
            Line::Face(words) => {
                let (mut count, mut smooth) = (0_usize, true);
                for corner in corners(words, self.vertices, self.normals) {
                    let (vertex, normal) = corner?;
                    raise(&mut self.highest_vertex, vertex, number);
                    if normal != Model::FLAT {
                        raise(&mut self.highest_normal, normal, number);
                    }
                    smooth &= normal != Model::FLAT;
                    count += 1;
                }
                self.small_faces += usize::from(count < 3);
                self.triangles += count.saturating_sub(2);
                self.smooth |= smooth && count >= 3;
            }
            Line::Shape => self.shapes += 1,
            Line::Skipped => self.skipped += 1,
            Line::Unknown(line) => {
                self.unknown += 1;
                self.first_unknown.get_or_insert((number, line));
            }
            Line::Material(_) | Line::Library(_) | Line::Empty => {}
        }
        Ok(())
    }

    fn finish(self) -> Result<Self, Fault> {
        let highest = [(self.highest_vertex, self.vertices, "vertex"), (self.highest_normal, self.normals, "normal")];
        for ((index, line), count, what) in highest {
            if index as usize > count {
                let problem = format!(
                    "a face names {what} {index}, but the file has only {count}: it is truncated or wrongly numbered"
                );
                return Err(Fault::line(line, problem));
            }
        }
        match &self.first_unknown {
            _ if self.triangles > 0 => Ok(self),
            Some((number, line)) => {
                let problem =
                    format!("{line} begins with no keyword of OBJ, and no face follows: this is another format");
                Err(Fault::line(*number, problem))
            }
            None => Err(Fault::file(format!(
                "it holds no triangles: {} vertices, {} faces with fewer than three corners, {} points, lines, curves or \
                 surfaces, {} other statements",
                self.vertices, self.small_faces, self.shapes, self.skipped
            ))),
        }
    }
}

fn raise(highest: &mut (u32, usize), index: u32, line: usize) {
    let index = index.saturating_add(1);
    if index > highest.0 {
        *highest = (index, line);
    }
}
