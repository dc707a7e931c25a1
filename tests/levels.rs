//! All levels of instructions give the same answers, bit for bit, and count the same steps.
//!
//! In a process of its own, because the level is that of the process.

use std::io::Write;
use std::sync::Arc;

use sahara::accel::{Counts, DynAccel};
use sahara::geometry::{Hit, Mesh, Ray};
use sahara::registry::Registry;
use sahara::scene::Builtin;
use sahara::simd::Level;
use sahara::validate::{Stratum, degenerate_meshes};

use crate::alone::alone;

/// Everything that a structure says of some rays.
#[derive(PartialEq, Debug)]
struct Said {
    closest: Vec<Option<(u32, u32)>>,
    any: Vec<bool>,
    counts: [Counts; 2],
}

fn bits(hits: &[Option<Hit>]) -> Vec<Option<(u32, u32)>> {
    hits.iter().map(|hit| hit.map(|hit| (hit.t.to_bits(), hit.prim.index()))).collect()
}

fn ask(accel: &dyn DynAccel, rays: &[Ray]) -> Said {
    let (mut closest, mut any) = (vec![None; rays.len()], vec![false; rays.len()]);
    let mut counts = [Counts::default(); 2];
    accel.closest_hits_counted(rays, &mut closest, &mut counts[0]);
    accel.any_hits_counted(rays, &mut any, &mut counts[1]);
    assert_eq!(
        (bits(&accel.closest(rays)), accel.any(rays)),
        (bits(&closest), any.clone()),
        "counting changes an answer"
    );
    Said { closest: bits(&closest), any, counts }
}

#[test]
fn all_levels_say_the_same() {
    if !alone("levels::all_levels_say_the_same") {
        return;
    }
    let mut meshes: Vec<(String, Arc<Mesh>)> = degenerate_meshes();
    for name in ["teapot", "cornellbox"] {
        meshes.push((name.into(), Builtin::find(name).unwrap().scene(None).unwrap().mesh));
    }
    let registry = Registry::builtin();
    let levels = Level::available();
    if levels.len() == 1 {
        // A pass would prove nothing: say so where it is read, for the output of a test that passes is not shown.
        let note =
            format!("\nwarning: this machine or build has only the level {}: levels are not compared\n", levels[0]);
        std::io::stderr().write_all(note.as_bytes()).expect("a sentence is written");
    }
    let mut hits = 0;
    for choice in registry.all().iter().filter(|choice| !choice.entry.name.starts_with("obvhs")) {
        for (name, mesh) in &meshes {
            let rays: Vec<Ray> = Stratum::ALL.into_iter().flat_map(|stratum| stratum.rays(mesh, 8, 7)).collect();
            let accel = choice.build(mesh).unwrap();
            let said = levels.iter().map(|level| {
                level.choose();
                ask(&*accel, &rays)
            });
            let said: Vec<Said> = said.collect();
            for (level, other) in levels.iter().zip(&said) {
                assert_eq!(&said[0], other, "{} on {name}: {} and {level} differ", choice.label, levels[0]);
            }
            hits += said[0].any.iter().filter(|&&hit| hit).count();
        }
    }
    assert!(hits > 20_000, "too few hits to prove anything: {hits}");
}
