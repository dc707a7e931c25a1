//! The hash of a scene.

use std::io::{BufWriter, Write};

use glam::Vec3;
use sha2::{Digest, Sha256};

use super::{Offset, Scene};

impl Scene {
    /// SHA-256, in hexadecimal, of everything that rays, hits or pictures depend on.
    pub fn hash(&self) -> String {
        // Add every new field of `Scene` to one of these patterns. Because of `..`, the compiler does not check this.
        let Self { mesh, normals, materials, material_of, lights, camera, background, .. } = self;
        let Self { recursion_limit, shadow_terminator_fix, offset, size, .. } = self;
        let Self { name: _, is_framed: _, stand_ins: _, notes: _, warnings: _, .. } = self;
        let mut hash = Hash(BufWriter::new(Sha256::new()));
        hash.vectors(mesh.positions());
        hash.triples(mesh.triangles());
        let (corner_normals, corners) = normals.as_ref().map_or((&[][..], &[][..]), |normals| normals.parts());
        hash.vectors(corner_normals);
        hash.triples(corners);

        hash.count(materials.len());
        for material in materials {
            hash.vectors(&[material.ambient, material.diffuse, material.specular]);
            hash.floats(&[material.shininess, material.mirror]);
        }
        hash.count(material_of.len());
        hash.words(material_of.iter().copied());
        hash.count(lights.len());
        for light in lights {
            hash.vectors(&[light.position, light.colour]);
            hash.floats(&[light.linear, light.quadratic]);
        }

        hash.vectors(&[camera.eye(), camera.target(), camera.up(), *background]);
        hash.floats(&[camera.vertical_fov()]);
        hash.words([*recursion_limit, u32::from(*shadow_terminator_fix), size[0], size[1]]);
        // Recorded hashes depend on these codes. Never change or reuse a code.
        let (code, length) = match *offset {
            Offset::Direction(distance) => (3, distance),
            Offset::ErrorBounded => (5, 0.0),
        };
        hash.words([code]);
        hash.floats(&[length]);
        hexadecimal(&hash.0.into_inner().expect(SUMMED).finalize())
    }
}

/// The buffer avoids one call of SHA-256 per word, which would take longer than the hashing.
struct Hash(BufWriter<Sha256>);

const SUMMED: &str = "a sum takes all bytes";

impl Hash {
    fn words(&mut self, words: impl IntoIterator<Item = u32>) {
        words.into_iter().for_each(|word| self.0.write_all(&word.to_le_bytes()).expect(SUMMED));
    }

    fn floats(&mut self, floats: &[f32]) {
        self.words(floats.iter().map(|float| float.to_bits()));
    }

    /// Adds the length of a list to the hash, to separate the list from the next list.
    fn count(&mut self, n: usize) {
        self.0.write_all(&(n as u64).to_le_bytes()).expect(SUMMED);
    }

    fn vectors(&mut self, vectors: &[Vec3]) {
        self.count(vectors.len());
        self.words(vectors.iter().flat_map(|vector| vector.to_array()).map(f32::to_bits));
    }

    fn triples(&mut self, triples: &[[u32; 3]]) {
        self.count(triples.len());
        self.words(triples.as_flattened().iter().copied());
    }
}

pub fn hexadecimal(bytes: &[u8]) -> String {
    bytes.iter().map(|byte| format!("{byte:02x}")).collect()
}
