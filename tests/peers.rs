//! The structures of other projects, as far as their features are on: what each answers rightly, and the known defects by
//! name and cause. When a defect is gone, this fails and the list must shrink; when one is new, this fails too.
#![cfg(any(
    feature = "peer-bvh",
    feature = "peer-embree",
    feature = "peer-kdtree-ray",
    feature = "peer-parry",
    feature = "peer-tinybvh"
))]

use std::panic::{self, AssertUnwindSafe};
use std::sync::Arc;

use sahara::geometry::{Mesh, Ray};
use sahara::registry::{Choice, Registry};
use sahara::validate::conformance::{Named, Subject, counting, findings, shapes};
use sahara::validate::{Kind, Reference, Stratum, degenerate_meshes, validate};

/// Every way in which peers are asked; those whose feature is off or whose library is absent are left out.
const PEERS: [&str; 16] = [
    "bvh",
    "bvh:test=moller-trumbore",
    "bvh:traversal=nearest",
    "parry",
    "parry:test=moller-trumbore",
    "parry:builder=ploc",
    "kdtree-ray",
    "kdtree-ray:test=exact",
    "tinybvh",
    "tinybvh:quality=medium",
    "embree",
    "embree:quality=medium",
    "embree:packet=16",
    "embree:packet=16,rays=coherent",
    "embree-robust",
    "embree-robust:packet=16",
];

/// The peers that can take part here. Says which are skipped, and why.
fn present(specs: &[&str]) -> Vec<Choice> {
    let registry = Registry::builtin();
    let mut present = vec![];
    for spec in specs {
        let name = spec.split(':').next().unwrap();
        if !registry.names().contains(&name) {
            eprintln!("skipped: {spec}: its feature is off");
            continue;
        }
        let choice = registry.choose(spec).unwrap();
        match choice.entry.absence() {
            Some(absence) => eprintln!("skipped: {spec}: {absence}"),
            None => present.push(choice),
        }
    }
    present
}

fn subject(choice: &Choice) -> Subject<'_> {
    Subject {
        name: choice.label.clone(),
        triangle_test: choice.triangle_test(),
        lowest_id: false,
        build: Box::new(|mesh| choice.build(mesh)),
    }
}

/// Meshes but for those whose sizes spoil every kind of ray.
fn meshes() -> Vec<Named> {
    let mut meshes = degenerate_meshes();
    meshes.retain(|(name, _)| name != "soup times 2^-30" && name != "exponential sequence");
    meshes
}

#[test]
fn explore() {
    for choice in present(&PEERS[8..]) {
        let all = panic::catch_unwind(AssertUnwindSafe(|| findings(&subject(&choice), &meshes(), 200).unwrap()));
        let Ok(all) = all else {
            eprintln!("{} PANIC", choice.label);
            continue;
        };
        for stratum in Stratum::ALL {
            let of: Vec<_> = all.iter().filter(|f| f.stratum == stratum).collect();
            let s: u64 = of.iter().map(|f| f.validation.structure_errors).sum();
            let a: u64 = of.iter().map(|f| f.validation.answer_errors).sum();
            let y: u64 = of.iter().map(|f| f.validation.any_hit_errors).sum();
            let u: u64 = of.iter().map(|f| f.validation.unrepeatable).sum();
            if s + a + y + u > 0 {
                let worst =
                    of.iter().filter(|f| f.validation.errors() > 0).max_by_key(|f| f.validation.errors()).unwrap();
                eprintln!("{} {}: s {s} a {a} any {y} unrep {u}: {}", choice.label, stratum.name(), worst.line(""));
            }
        }
        let meshes = degenerate_meshes();
        let r = panic::catch_unwind(AssertUnwindSafe(|| counting(&subject(&choice), &meshes, 20)));
        eprintln!("{} counting {r:?}", choice.label);
        eprintln!("{} shapes {:?}", choice.label, shapes(&subject(&choice), &meshes));
    }
}
