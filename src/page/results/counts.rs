//! What structures count for primary rays of small scenes: no machine changes it.

use std::collections::BTreeMap;

use crate::scene::{Builtin, WorkloadKind};
use crate::study::measurement::Measurement;

/// Triangles of the scenes whose counts are kept, at most: they are counted again in seconds.
const RECOUNTED: usize = 1 << 16;

/// By scene and label, of small scenes that need no mesh of others.
pub fn of(measurements: &[Measurement]) -> BTreeMap<String, BTreeMap<String, String>> {
    let is_own = |own: &Measurement| {
        let scene = Builtin::find(&own.scene).ok().and_then(|builtin| builtin.scene(None).ok());
        scene.is_some_and(|scene| scene.hash() == own.scene_hash)
    };
    let counted = |own: &Measurement| {
        let rays = own.counted_rays as f64;
        let [tests, steps] = [own.tests_per_ray, own.steps_per_ray]
            .map(|per_ray| per_ray.map(|per_ray| libm::round(per_ray * rays) as u64));
        (own.label.clone(), text(own.counted_rays, own.hits, tests, steps))
    };
    let scenes = measurements.chunk_by(|a, b| a.scene == b.scene);
    let scenes = scenes.filter(|scene| scene[0].triangles <= RECOUNTED && is_own(&scene[0]));
    let of = |scene: &[Measurement]| {
        let primary = scene.iter().filter(|m| m.workload == WorkloadKind::Primary.name() && m.counted_rays > 0);
        (scene[0].scene.clone(), primary.map(counted).collect())
    };
    scenes.map(of).collect()
}

pub fn text(rays: usize, hits: usize, tests: Option<u64>, steps: Option<u64>) -> String {
    let number = |n: Option<u64>, what: &str| n.map_or(String::new(), |n| format!(", {n} {what}"));
    format!("{rays} rays: {hits} hits{}{}", number(tests, "tests"), number(steps, "steps"))
}
