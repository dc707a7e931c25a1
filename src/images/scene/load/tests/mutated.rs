//! Tests that damaged files load or fail with a one-line error.

use std::time::{Duration, Instant};

use proptest::prelude::*;
use proptest::sample::Index;
use proptest::test_runner::{RngSeed, TestRunner};

use super::{assert_error, gltf, load_files, ply};
use crate::geometry::Mesh;
use crate::scene::Model;

const OBJ: &str = "mtllib a.mtl\no a\nv 0 0 0\nv 1 0 0\nv 1 1 0 1\nv 0 1 -0.5e0\nvt 0 0\nvn 0 0 1\nusemtl red\n\
    f 1/1/1 2/1/1 3/1/1 4/1/1\ng b\nusemtl blue\nf -1 -2 \\\n -3\nf 1//1 2//1 3//1\nl 1 2\n";
const MTL: &str =
    "newmtl red\nKa 0.1 0 0\nKd 1 0 0\nKs 0.5 0.5 0.5\nNs 20\nmap_Kd red.png\nillum 2\nnewmtl blue\nKd 0 0 1\n";

fn patch() -> impl Strategy<Value = Vec<u8>> {
    const NUMBERS: &[&str] = &["0", "-1", "9", "1e999", "4294967295", "-9223372036854775808", "99999999999999999999"];
    const SIGNS: &[&str] = &["", "/", "\n", " ", "\\\n", "\"", "[", "}", "\0", "\u{ff}\u{ff}", "null", "nan"];
    const LINES: &[&str] = &["element face 9\n", "f 1 2 3\n", "Kd 1\n"];
    let words = prop::sample::select([NUMBERS, SIGNS, LINES].concat());
    prop_oneof![
        prop::collection::vec(any::<u8>(), 0..9),
        words.prop_map(|word| word.as_bytes().to_vec()),
        Just(vec![0xff; 4]),
    ]
}

#[derive(Clone, Debug)]
enum Damage {
    Cut(Index),
    Insert(Index, Vec<u8>),
    Overwrite(Index, Vec<u8>),
    Drop([Index; 2]),
    Repeat([Index; 2], usize),
    Swap([Index; 2]),
}

fn damage() -> impl Strategy<Value = Damage> {
    let [one, two, three] = [any::<[Index; 2]>; 3];
    prop_oneof![
        1 => any::<Index>().prop_map(Damage::Cut),
        3 => (any::<Index>(), patch()).prop_map(|(place, patch)| Damage::Insert(place, patch)),
        3 => (any::<Index>(), patch()).prop_map(|(place, patch)| Damage::Overwrite(place, patch)),
        2 => one().prop_map(Damage::Drop),
        2 => (two(), 2_usize..30).prop_map(|(ends, times)| Damage::Repeat(ends, times)),
        2 => three().prop_map(Damage::Swap),
    ]
}

fn damaged(file: &[u8], damages: &[Damage]) -> Vec<u8> {
    let mut file = file.to_vec();
    for damage in damages {
        let pieces: Vec<&[u8]> = file.split_inclusive(|byte| b" \n,:/{}[]".contains(byte)).collect();
        let range = |[start, length]: &[Index; 2]| {
            let start = start.index(pieces.len() + 1);
            start..(start + 1 + length.index(8)).min(pieces.len()).max(start)
        };
        file = match damage {
            Damage::Cut(end) => file[..end.index(file.len() + 1)].to_vec(),
            Damage::Insert(place, patch) => {
                let (before, after) = file.split_at(place.index(file.len() + 1));
                [before, patch, after].concat()
            }
            Damage::Overwrite(place, patch) => {
                let (before, after) = file.split_at(place.index(file.len() + 1));
                [before, patch, &after[patch.len().min(after.len())..]].concat()
            }
            Damage::Drop(ends) => [&pieces[..range(ends).start], &pieces[range(ends).end..]].concat().concat(),
            Damage::Repeat(ends, times) => {
                let repeated = pieces[range(ends)].repeat(*times);
                [&pieces[..range(ends).start], &repeated, &pieces[range(ends).end..]].concat().concat()
            }
            Damage::Swap(places) if !pieces.is_empty() => {
                let mut pieces = pieces.clone();
                let [a, b] = places.each_ref().map(|place| place.index(pieces.len()));
                pieces.swap(a, b);
                pieces.concat()
            }
            Damage::Swap(_) => continue,
        };
    }
    file
}

fn assert_whole(files: &[(&str, &[u8])]) {
    match load_files(files) {
        Err(error) => assert_error(Err(error), files[0].0, &[]),
        Ok(model) => {
            let Model { positions, triangles, normals, normal_indices, materials, material_of, notes } = model;
            assert!(normal_indices.is_empty() || normal_indices.len() == triangles.len());
            assert!(material_of.is_empty() || material_of.len() == triangles.len());
            let normal = |&n: &u32| n == Model::FLAT || normals[n as usize].is_finite();
            assert!(normal_indices.as_flattened().iter().all(normal));
            assert!(!materials.is_empty() && material_of.iter().all(|&m| (m as usize) < materials.len()));
            assert!(notes.iter().all(|note| !note.contains('\n')), "{notes:?}");
            Mesh::new(positions, triangles).unwrap();
        }
    }
}

/// The first file is the file to load.
type Files = Vec<(&'static str, Vec<u8>)>;

fn assert_damaged_files_are_safe(cases: u32) {
    let [gltf, skin, instances] = gltf::texts();
    let formats: [Files; 8] = [
        vec![("a.obj", OBJ.into()), ("a.mtl", MTL.into())],
        vec![("a.ply", ply::ASCII.into())],
        vec![("a.ply", ply::binary(true, "short", "uchar"))],
        vec![("a.ply", ply::binary(false, "uint", "int"))],
        vec![("a.gltf", gltf)],
        vec![("a.gltf", skin)],
        vec![("a.gltf", instances)],
        vec![("a.glb", gltf::binary())],
    ];
    for files in formats {
        let damages = prop::collection::vec(prop::collection::vec(damage(), 0..5), files.len());
        let config =
            ProptestConfig { cases, failure_persistence: None, rng_seed: RngSeed::Fixed(1), ..Default::default() };
        let whole = TestRunner::new(config).run(&damages, |damages| {
            let start = Instant::now();
            let damaged: Vec<_> = files.iter().zip(&damages).map(|((_, file), own)| damaged(file, own)).collect();
            let files: Vec<_> = files.iter().zip(&damaged).map(|((name, _), file)| (*name, &file[..])).collect();
            assert_whole(&files);
            prop_assert!(start.elapsed() < Duration::from_secs(10), "it takes too long");
            Ok(())
        });
        whole.unwrap();
    }
}

#[test]
fn damaged_files_are_safe() {
    assert_damaged_files_are_safe(100);
}

#[test]
#[ignore = "it takes a minute"]
fn many_damaged_files_are_safe() {
    assert_damaged_files_are_safe(3000);
}
