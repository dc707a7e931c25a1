//! Compares the fast oracle (`Oracle`) with the slow oracle (`nearest`).

use std::sync::Arc;

use sahara::builtin::Builtin;
use sahara::geometry::{Mesh, Ray};
use sahara::oracle::{Oracle, nearest};
use sahara::validate::{Stratum, degenerate_meshes};

/// Returns the number of rays with a hit.
fn agree(mesh: &Arc<Mesh>, rays: impl IntoIterator<Item = Ray>, name: &str) -> usize {
    let oracle = Oracle::new(mesh);
    let mut hits = 0;
    for ray in rays {
        let slow = nearest(&ray, mesh);
        hits += usize::from(slow.is_some());
        assert_eq!(oracle.nearest(&ray), slow, "{name}, ray \"{ray}\"");
    }
    hits
}

#[test]
fn fast_and_slow_agree_on_degenerate_meshes_and_scenes() {
    let scenes =
        ["cornellbox", "teapot"].map(|name| (name.into(), Builtin::find(name).unwrap().scene(None).unwrap().mesh));
    let mut hits = [0; Stratum::ALL.len()];
    for (name, mesh) in degenerate_meshes().into_iter().chain(scenes) {
        // The slow oracle takes some microseconds per ray and triangle.
        let count = (4000 / (mesh.len() + 1)).clamp(4, 60);
        for (sum, stratum) in hits.iter_mut().zip(Stratum::ALL) {
            *sum += agree(&mesh, stratum.rays(&mesh, count, 7), &format!("{name}, {}", stratum.name()));
        }
    }
    for (stratum, hits) in Stratum::ALL.into_iter().zip(hits) {
        assert_eq!(hits == 0, stratum == Stratum::Invalid, "{} rays hit {hits} times", stratum.name());
    }
}
