//! Compares the hits of a structure on its timed rays with the hits of another tree.
//!
//! If the tree uses the structure's triangle test, equal checksums of the hits in epoch 0 end the check. The timed rays
//! of later epochs are then not compared. The function `join` compares the checksums of later epochs with epoch 0.
//!
//! If the structure and the tree disagree on rays, brute force judges some of these rays.

use std::borrow::Cow;

use rayon::prelude::*;

use super::built::Built;
use super::guarded::guarded;
use super::pair::Pair;
use crate::accel::{BuildError, DynAccel, Query};
use crate::geometry::{Hit, Ray};
use crate::measure::tiles::{TILE, level_of, tiles};
use crate::measure::{QueryResults, spread};
use crate::registry::Registry;
use crate::scene::{Scene, Workload};
use crate::study::epoch::Checked;
use crate::triangle::{Exact, TriangleTest};
use crate::validate::{ExpectedHits, Kind, Reference, differences, validate_any_hits, validate_hits};

/// Brute force judges all disputed rays if their number is at most `FEWEST`.
const FEWEST: usize = 64;

pub struct TimedCheck<'a> {
    pub scene: &'a Scene,
    pub workloads: &'a [Workload],
    /// The number of planned epochs. Each epoch times other rays.
    pub epochs: usize,
    /// Approximate limit for the triangle tests of brute force in one check.
    pub tests: usize,
    references: Vec<TreeHits>,
}

struct TreeHits {
    name: &'static str,
    triangle_test: &'static str,
    /// A structure with the tree's triangle test must return the same bits. All other structures must agree within
    /// rounding.
    tree: Reference,
    /// Brute force with the triangle test of the checked structure. `exact` replaces an unknown or slow test.
    judge: Reference,
    /// Hits of the tree, indexed by workload and ray. The outer `Option` is `None` if the ray is not traced yet.
    hits: Vec<Vec<Option<Option<Hit>>>>,
}

impl<'a> TimedCheck<'a> {
    pub fn new(scene: &'a Scene, workloads: &'a [Workload], epochs: usize, tests: usize) -> Self {
        Self { scene, workloads, epochs, tests, references: vec![] }
    }

    /// `rays` is the number of timed rays per epoch. `checksum` covers the hits on the timed rays of epoch 0.
    /// Returns `Ok(None)` if the structure panics.
    pub fn check(
        &mut self,
        built: &Built,
        pair: &Pair,
        rays: usize,
        checksum: u64,
    ) -> Result<Option<Checked>, BuildError> {
        let workload = &self.workloads[pair.workload];
        let place = self.reference(built)?;
        let known = &mut self.references[place];
        if known.tree.test.is_some() {
            let first = timed(workload.rays.len(), rays, 1);
            let expected = known.hits_of(pair.workload, workload, &first);
            let expected = match workload.query {
                Query::Closest => QueryResults::Closest(expected),
                Query::Any => QueryResults::Any(expected.iter().map(Option::is_some).collect()),
            };
            if expected.checksum(0..first.len()) == checksum {
                return Ok(Some(Checked { rays: first.len(), ..Checked::default() }));
            }
        }

        let all = timed(workload.rays.len(), rays, self.epochs);
        let chosen: Vec<Ray> = all.iter().map(|&index| workload.rays[index]).collect();
        let Some(found) = guarded(|| traced(built.accel.as_ref(), &chosen, workload.query)) else { return Ok(None) };
        let expected = self.references[place].hits_of(pair.workload, workload, &all);
        Ok(guarded(|| self.judged(built, &self.references[place], &chosen, &expected, &found)))
    }

    /// Returns the index of a tree in `references`. A structure is never compared with itself.
    fn reference(&mut self, built: &Built) -> Result<usize, BuildError> {
        let own_test = built.choice.triangle_test();
        let name = checking_tree(built);
        let is_it = |one: &TreeHits| one.name == name && one.triangle_test == own_test;
        if let Some(place) = self.references.iter().position(is_it) {
            return Ok(place);
        }
        let registry = Registry::builtin();
        let test = registry.find(name, own_test).map_or(Exact::NAME, |entry| entry.triangle_test);
        let choice = registry.choose(&format!("{name}:quality=fast,test={test}"));
        let accel = choice.map_err(|cause| BuildError::Config(cause.to_string()))?.build(&self.scene.mesh)?;
        let judge = Reference::of_test(own_test, &self.scene.mesh)?;
        let tree = Reference { test: judge.test.filter(|_| test == own_test), ..Reference::structure(accel, own_test) };
        let hits = self.workloads.iter().map(|workload| vec![None; workload.rays.len()]).collect();
        self.references.push(TreeHits { name, triangle_test: own_test, tree, judge, hits });
        Ok(self.references.len() - 1)
    }

    /// Brute force decides about disputed rays, because the tree may be wrong.
    fn judged(
        &self,
        built: &Built,
        known: &TreeHits,
        rays: &[Ray],
        expected: &[Option<Hit>],
        found: &QueryResults,
    ) -> Checked {
        let TreeHits { tree, judge, .. } = known;
        let mesh = &self.scene.mesh;
        let mut checked = Checked { rays: rays.len(), ..Checked::default() };
        let accused: Vec<usize> = match found {
            QueryResults::Any(found) => (0..rays.len()).filter(|&i| found[i] != expected[i].is_some()).collect(),
            QueryResults::Closest(found) => {
                let differing = differences(&ExpectedHits { reference: tree, mesh, rays, hits: expected }, found);
                let rounds = |kind: Kind| matches!(kind, Kind::Depth | Kind::TriangleTest);
                checked.rounded = differing.iter().filter(|(_, kind)| rounds(*kind)).count();
                differing.into_iter().filter(|(_, kind)| kind.is_error()).map(|(index, _)| index).collect()
            }
        };
        if accused.is_empty() {
            return checked;
        }

        let some = spread(&accused, (self.tests / mesh.len().max(1)).max(FEWEST));
        let disputed: Vec<Ray> = some.iter().map(|&index| rays[index]).collect();
        let truth = judge.closest_hits(&disputed);
        let expected = ExpectedHits { reference: judge, mesh, rays: &disputed, hits: &truth };
        let judged = Checked::from(&match found {
            QueryResults::Closest(found) => {
                let found: Vec<Option<Hit>> = some.iter().map(|&index| found[index]).collect();
                validate_hits(&expected, &found)
            }
            QueryResults::Any(found) => {
                let found: Vec<bool> = some.iter().map(|&index| found[index]).collect();
                validate_any_hits(&expected, &found, Some(built.accel.as_ref()))
            }
        });
        Checked { rays: rays.len(), rounded: checked.rounded + judged.rounded, ..judged }
    }
}

/// The name of the tree that checks the hits of a structure. It is never the structure itself.
pub fn checking_tree(built: &Built) -> &'static str {
    if built.choice.entry.name == "sah-bvh" { "sah-hybrid" } else { "sah-bvh" }
}

/// Indices of all rays in the samples of the first `epochs` epochs. Each sample has `rays` rays.
fn timed(all: usize, rays: usize, epochs: usize) -> Vec<usize> {
    let level = level_of(all, rays).unwrap_or(0);
    let mut timed: Vec<usize> = (0..epochs.max(1)).flat_map(|epoch| tiles(all, level, epoch)).flatten().collect();
    timed.sort_unstable();
    timed.dedup();
    timed
}

impl TreeHits {
    fn hits_of(&mut self, place: usize, workload: &Workload, wanted: &[usize]) -> Vec<Option<Hit>> {
        let hits = &mut self.hits[place];
        let missing: Vec<usize> = wanted.iter().copied().filter(|&index| hits[index].is_none()).collect();
        let rays: Vec<Ray> = missing.iter().map(|&index| workload.rays[index]).collect();
        let traced = self.tree.accel.closest_by_chunks(&rays, TILE);
        missing.into_iter().zip(traced).for_each(|(index, hit)| hits[index] = Some(hit));
        wanted.iter().map(|&index| hits[index].flatten()).collect()
    }
}

fn traced(accel: &dyn DynAccel, rays: &[Ray], query: Query) -> QueryResults {
    let chunk = if accel.remote().is_some() { rays.len().max(1) } else { TILE };
    let mut results = QueryResults::misses(query, rays.len());
    match &mut results {
        QueryResults::Closest(hits) => {
            let batches = rays.par_chunks(chunk).zip(hits.par_chunks_mut(chunk));
            batches.for_each(|(rays, hits)| accel.load(Cow::Borrowed(rays)).closest_hits(hits));
        }
        QueryResults::Any(hits) => {
            let batches = rays.par_chunks(chunk).zip(hits.par_chunks_mut(chunk));
            batches.for_each(|(rays, hits)| accel.load(Cow::Borrowed(rays)).any_hits(hits));
        }
    }
    results
}
