//! Damaged files: whatever they contain, the result is a model or an error of one line.

use proptest::prelude::*;
use proptest::sample::Index;
use proptest::test_runner::RngSeed;

use super::{gltf, load_files, ply};
use crate::geometry::Mesh;
use crate::scene::Model;

const OBJ: &str = "mtllib a.mtl\no a\nv 0 0 0\nv 1 0 0\nv 1 1 0 1\nv 0 1 -0.5e0\nvt 0 0\nvn 0 0 1\nusemtl red\n\
    f 1/1/1 2/1/1 3/1/1 4/1/1\ng b\nusemtl blue\nf -1 -2 \\\n -3\nf 1//1 2//1 3//1\nl 1 2\n";
const MTL: &str =
    "newmtl red\nKa 0.1 0 0\nKd 1 0 0\nKs 0.5 0.5 0.5\nNs 20\nmap_Kd red.png\nillum 2\nnewmtl blue\nKd 0 0 1\n";

/// What a file is damaged with: random bytes, and words that parsers are known to mishandle.
fn patch() -> impl Strategy<Value = Vec<u8>> {
    const WORDS: &[&str] = &[
        "",
        "0",
        "-1",
        "9",
        "99999999999999999999",
        "-9223372036854775808",
        "4294967295",
        "1e999",
        "nan",
        "/",
        "\n",
        " ",
        "\\\n",
        "\"",
        "[",
        "}",
        "\0",
        "\u{ff}\u{ff}\u{ff}\u{ff}",
        "element face 9\n",
        "f 1 2 3\n",
        "Kd 1\n",
        "null",
    ];
    prop_oneof![
        prop::collection::vec(any::<u8>(), 0..9),
        prop::sample::select(WORDS).prop_map(|word| word.as_bytes().to_vec()),
        Just(vec![0xff; 4]),
    ]
}

/// Truncates the file, then overwrites bytes (`true`) or inserts some.
type Damage = (Option<Index>, Vec<(Index, bool, Vec<u8>)>);

fn damage() -> impl Strategy<Value = Damage> {
    let places = prop::collection::vec((any::<Index>(), any::<bool>(), patch()), 0..5);
    (prop::option::weighted(0.2, any::<Index>()), places)
}

fn damaged(file: &[u8], (cut, places): &Damage) -> Vec<u8> {
    let mut file = file.to_vec();
    if let Some(cut) = cut {
        file.truncate(cut.index(file.len()));
    }
    for (place, overwrite, patch) in places {
        let start = place.index(file.len() + 1);
        let end = if *overwrite { (start + patch.len()).min(file.len()) } else { start };
        file.splice(start..end, patch.iter().copied());
    }
    file
}

fn assert_whole(name: &str, files: &[(&str, &[u8])]) {
    match load_files(files) {
        Err(error) => {
            let message = error.to_string();
            assert!(message.contains(name) && !message.contains('\n'), "{message:?}");
        }
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

proptest! {
    #![proptest_config(ProptestConfig { cases: 1000, failure_persistence: None, rng_seed: RngSeed::Fixed(1), ..ProptestConfig::default() })]

    #[test]
    fn obj(to_obj in damage(), to_mtl in damage()) {
        let files = [("a.obj", damaged(OBJ.as_bytes(), &to_obj)), ("a.mtl", damaged(MTL.as_bytes(), &to_mtl))];
        assert_whole("a.obj", &files.each_ref().map(|(name, bytes)| (*name, &bytes[..])));
    }

    #[test]
    fn ply_text(damage in damage()) {
        assert_whole("a.ply", &[("a.ply", &damaged(ply::ASCII.as_bytes(), &damage))]);
    }

    #[test]
    fn ply_binary(damage in damage(), big in any::<bool>(), short in any::<bool>()) {
        let file = if short { ply::binary(big, "short", "uchar") } else { ply::binary(big, "uint", "int") };
        assert_whole("a.ply", &[("a.ply", &damaged(&file, &damage))]);
    }

    #[test]
    fn gltf_text(damage in damage()) {
        assert_whole("a.gltf", &[("a.gltf", &damaged(&gltf::text(), &damage))]);
    }

    #[test]
    fn gltf_binary(damage in damage()) {
        assert_whole("a.glb", &[("a.glb", &damaged(&gltf::binary(), &damage))]);
    }
}
