//! Tests of the catalogue of hard cases.

use std::collections::BTreeSet;

use sha2::{Digest, Sha256};

use super::{Content, Expected, HardCase, Rank, Set, catalogue, find, find_all};
use crate::exact::rational;
use crate::geometry::Ray;
use crate::oracle::{Oracle, Truth};

const FEW: usize = 40;

fn sets(count: usize) -> impl Iterator<Item = (&'static HardCase, Expected, Set)> {
    catalogue().into_iter().filter_map(move |case| match case.content {
        Content::Rays { expected, .. } => Some((case, expected, case.set(count)?)),
        Content::Property(_) => None,
    })
}

#[test]
fn there_are_92_numbers_and_every_case_has_a_name_of_its_own() {
    let cases = catalogue();
    // Two cases have the number 23.
    let numbers = (1..=92).flat_map(|number| vec![number; if number == 23 { 2 } else { 1 }]);
    assert!(cases.iter().map(|case| case.number).eq(numbers));
    let ranked = |rank: Rank| cases.iter().filter(|case| case.rank == rank).count();
    assert_eq!((ranked(Rank::Moderate), ranked(Rank::Extreme)), (49, 10), "what totals are over");
    let names: BTreeSet<&str> = cases.iter().map(|case| case.name).collect();
    assert_eq!(names.len(), cases.len());
    for case in cases {
        assert!(case.reason.ends_with('.') && !case.source.is_empty(), "{}", case.name);
        assert!(case.name.chars().all(|c| c.is_ascii_alphanumeric() || "_-.".contains(c)), "{}", case.name);
    }
}

#[test]
fn fewer_rays_are_the_first_of_more() {
    for (case, _, set) in sets(FEW) {
        assert_eq!(set.rays.len(), FEW, "{}", case.name);
        assert_eq!(bits(&set_of(case.name, FEW / 2).rays), bits(&set.rays[..FEW / 2]), "{}", case.name);
    }
}

fn set_of(name: &str, count: usize) -> Set {
    find(name).unwrap().set(count).expect("the case has rays")
}

fn bits(rays: &[Ray]) -> Vec<u32> {
    let of_ray = |ray: &Ray| {
        let points = ray.origin.to_array().into_iter().chain(ray.direction.to_array());
        points.chain([ray.t_min, ray.t_max]).map(f32::to_bits).collect::<Vec<u32>>()
    };
    rays.iter().flat_map(of_ray).collect()
}

/// If the hash changes, new results are not comparable with published results.
#[test]
fn every_machine_makes_the_same_cases() {
    assert!(set_of("nonfinite_verts", FEW).mesh.positions().iter().any(|p| p.abs().max_element() == f32::MAX));
    let mut hasher = Sha256::new();
    for (case, _, set) in sets(FEW) {
        hasher.update(case.name);
        for point in set.mesh.positions() {
            point.to_array().iter().for_each(|x| hasher.update(x.to_bits().to_le_bytes()));
        }
        set.mesh.triangles().iter().flatten().for_each(|index| hasher.update(index.to_le_bytes()));
        // Replace every NaN by the same number.
        let number = |x: u32| if f32::from_bits(x).is_nan() { u32::MAX } else { x };
        bits(&set.rays).into_iter().for_each(|x| hasher.update(number(x).to_le_bytes()));
    }
    assert_eq!(&format!("{:x}", hasher.finalize())[..16], "c70c3e700e9cc34b");
}

#[test]
fn what_must_be_hit_is_and_what_must_be_missed_is_not() {
    let (mut hit, mut missed) = (0, 0);
    for (case, expected, set) in sets(FEW) {
        let oracle = Oracle::new(&set.mesh);
        let truths: Vec<_> = set.rays.iter().map(|ray| oracle.nearest(ray)).collect();
        let hits = truths.iter().flatten().count();
        match expected {
            Expected::Hit => {
                hit += 1;
                assert_eq!(hits, FEW, "{}", case.name);
            }
            Expected::Miss => {
                missed += 1;
                assert_eq!(hits, 0, "{}", case.name);
            }
            Expected::SameAs(twin) => {
                hit += 1;
                let twin = set_of(twin, FEW);
                assert_eq!(twin.mesh, set.mesh);
                assert_ne!(bits(&twin.rays), bits(&set.rays));
                let oracle = Oracle::new(&twin.mesh);
                for (ray, truth) in twin.rays.iter().zip(&truths) {
                    assert!(truth.is_some() && oracle.nearest(ray) == *truth, "{}: {ray}", case.name);
                }
            }
            Expected::Oracle => assert!(hits > 0, "{}: nothing at all is hit", case.name),
        }
    }
    assert_eq!((hit, missed), (49, 10));
}

/// The module `rational` shares no code with the oracle.
#[test]
fn rational_arithmetic_finds_the_same_truths() {
    let (mut whole, mut hits) = (0, 0);
    for (case, _, set) in sets(4) {
        let oracle = Oracle::new(&set.mesh);
        let all = || set.mesh.solid().map(|id| (id, set.mesh.corners(id)));
        for ray in set.rays.iter().filter(|ray| ray.is_valid()) {
            let truth = oracle.nearest(ray);
            hits += usize::from(truth.is_some());
            let first = truth.as_ref().map(Truth::first);
            if set.mesh.len() <= 100 {
                assert_eq!(rational::nearest(ray, all()), first, "{}: \"{ray}\"", case.name);
                whole += 1;
            } else if let Some((t, id)) = first {
                assert_eq!(rational::hit_within(ray, set.mesh.corners(id)), Some(t), "{}: \"{ray}\"", case.name);
            }
        }
    }
    assert!(whole > 20 && hits > 150, "{whole} {hits}");
}

#[test]
fn an_unknown_name_gets_the_nearest() {
    let error = find("flat_grazing").map(|case| case.name).unwrap_err().to_string();
    assert!(error.contains("\"flat_grazing\"") && error.contains("flat_grazing_1e-3, flat_grazing_1e-6"), "{error}");
    let error = find("fan_apxe").map(|case| case.name).unwrap_err().to_string();
    assert!(error.contains("fan_apex"), "{error}");
    assert_eq!(find("41").unwrap().name, "duplicates_20000");
    assert_eq!(find("Duplicates_20000").unwrap().number, 41);
    let both: Vec<&str> = find_all("23").unwrap().iter().map(|case| case.name).collect();
    assert_eq!(both, ["scale_1e5", "scale_1e10"]);
}
