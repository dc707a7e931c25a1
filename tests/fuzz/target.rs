//! A fuzz case has a mesh and rays of arbitrary floats.
//!
//! `tests/properties.rs` and the fuzz target of this folder share this file.

use std::cmp::Reverse;
use std::collections::{BTreeMap, BTreeSet};
use std::sync::{Arc, Mutex, PoisonError};

use glam::Vec3;
use sahara::accel::DynAccel;
use sahara::exact::rational;
use sahara::geometry::{Hit, Mesh, Ray};
use sahara::oracle;
use sahara::registry::Registry;
use sahara::request::known_defect;
use sahara::simd::Level;
use sahara::validate::adversarial::{near_the_largest_t, rounded_ends};
use sahara::validate::{Reference, validate};

/// Every eight-wide tree must occur with and without `batch=packets`. Small leaves give deep trees on small meshes.
pub const VARIANTS: [(&str, &str); 17] = [
    ("brute-force", ""),
    ("median-kd", ""),
    ("median-kd", "leaf=1,threshold=1"),
    ("median-kd", "leaf=2,threshold=1,traversal=plane-intervals,mailbox=true"),
    ("sah-kd", ""),
    ("sah-kd", "mailbox=true,empty_bonus=0"),
    ("sah-kd", "intersection_cost=50,traversal=child-boxes"),
    ("sah-kd", "intersection_cost=50,plane=vertex-median"),
    ("sah-kd-wide", "block_cost=0.01"),
    ("sah-kd-wide", "block_cost=50,batch=packets"),
    ("sah-kd-tight", "block_cost=50"),
    ("sah-kd-tight", "block_cost=0.01,batch=packets"),
    ("sah-hybrid", "block_cost=50"),
    ("sah-hybrid", "block_cost=50,batch=packets"),
    ("sah-hybrid", "block_cost=0.01,batch=packets"),
    ("sah-bvh", "block_cost=50"),
    ("sah-bvh", "block_cost=50,batch=packets"),
];

/// The triangle tests that support `batch=packets`.
const BATCHED: [&str; 3] = ["moller-trumbore", "watertight", "exact"];

/// Guards the SIMD level, which is a setting of the whole process.
static LEVEL: Mutex<()> = Mutex::new(());

/// Floats may be NaN or infinite. Indices may be out of range.
#[derive(Clone, Debug)]
pub struct Case {
    pub positions: Vec<Vec3>,
    pub triangles: Vec<[u32; 3]>,
    pub rays: Vec<Ray>,
}

impl Case {
    /// Checks the hits of all structures.
    ///
    /// Every structure must return the hits of brute force. In a tie, the hit must be the primitive with the lowest
    /// index. The hits must be equal on all SIMD levels. The triangle test `exact` must return the hits of the oracle.
    ///
    /// # Errors
    /// The violated property, with the case.
    pub fn check(&self) -> Result<(), String> {
        let mesh = match Mesh::new(self.positions.clone(), self.triangles.clone()) {
            Ok(mesh) => Arc::new(mesh),
            Err(refusal) if refusal.to_string().contains(' ') => return Ok(()),
            Err(refusal) => return Err(format!("{refusal:?} is not a sentence: {self:?}")),
        };
        let registry = Registry::builtin();
        let blame = |what: String| format!("{what}\n{self:?}");

        let rays = self.with_rounded_ends(&mesh);
        let company = with_packets(&rays);
        let tests = registry.entries().iter().filter(|e| e.name == "sah-kd").map(|e| e.triangle_test);
        for test in tests {
            let reference = Reference::of_test(test, &mesh).map_err(|e| blame(e.to_string()))?;
            let offered = |name, keys: &str| {
                registry.find(name, test).is_some() && (!keys.contains("batch") || BATCHED.contains(&test))
            };
            for (name, keys) in VARIANTS.iter().filter(|(name, keys)| offered(name, keys)) {
                let spec = format!("{name}:test={test},{keys}");
                let choice = registry.choose(&spec).map_err(|e| blame(e.to_string()))?;
                let accel = choice.build(&mesh).map_err(|e| blame(format!("{spec}: {e}")))?;
                let rays = if keys.contains("batch") { &company } else { &rays };
                let found = validate(&*accel, &reference, &mesh, rays);
                if found.errors() + found.higher_ids > 0 {
                    return Err(blame(format!("{spec}: {}", found.worst[0])));
                }
                same_on_all_levels(&*accel, rays).map_err(|e| blame(format!("{spec}: {e}")))?;
            }
        }

        let exact = Reference::of_test("exact", &mesh).map_err(|e| blame(e.to_string()))?;
        for (i, (ray, hit)) in rays.iter().zip(exact.accel.closest(&rays)).enumerate() {
            let truth = oracle::nearest(ray, &mesh).map(|truth| truth.first());
            let found = hit.map(|h| (h.t, h.prim.index()));
            if found != truth {
                return Err(blame(format!("exact: ray \"{ray}\": {found:?} in place of {truth:?}")));
            }
            let rational = || rational::nearest(ray, mesh.solid().map(|id| (id, mesh.corners(id))));
            // Unlike the oracle, rational arithmetic shares no code with `exact`. Rational arithmetic is slow, so only
            // every 20th ray is tested.
            if i % 20 == 0 && rational() != truth {
                return Err(blame(format!("exact sums: ray \"{ray}\": {truth:?} in place of {:?}", rational())));
            }
        }
        Ok(())
    }

    /// Returns the rays and copies of some rays. The interval of a copy begins or ends at the nearest hit, with
    /// `t` rounded to a float. A short direction moves `t` of some copies close to the largest float.
    fn with_rounded_ends(&self, mesh: &Mesh) -> Vec<Ray> {
        let nearest = |ray: &Ray| oracle::nearest(ray, mesh).map(|truth| truth.t);
        let mut rays = self.rays.clone();
        for (ray, t) in self.rays.iter().filter_map(|ray| Some((ray, nearest(ray)?))).take(COPIED_RAYS) {
            let far = near_the_largest_t(&Ray::new(ray.origin, ray.direction), t.approximate());
            rays.extend(rounded_ends(ray, &t));
            rays.extend(nearest(&far).iter().flat_map(|t| rounded_ends(&far, t)));
        }
        rays
    }

    /// Reads a case from any bytes. Missing bytes are 0. A case uses only some kinds of floats.
    pub fn read(bytes: &[u8]) -> Self {
        let mut bytes = Bytes { left: bytes, kinds: (0..KINDS).collect() };
        let points = 3 + bytes.byte() as usize % 29;
        // A wild mesh may have invalid coordinates or indices. An invalid mesh ends the check, so few meshes are wild.
        let wild = bytes.byte() > 0xf8;
        let mixture = 1 + bytes.byte() % ((1 << (KINDS - 1)) - 1);
        bytes.kinds.retain(|kind| mixture >> kind & 1 == 1);
        let positions = (0..points).map(|_| bytes.point(wild)).collect::<Vec<Vec3>>();
        let limit = if wild { points + 1 } else { points } as u32;
        let triangles = (0..bytes.byte() % 48).map(|_| [0; 3].map(|_: u32| u32::from(bytes.byte()) % limit)).collect();
        let mut rays = vec![];
        // In some cases, rays use more kinds of floats than the mesh.
        let more = bytes.byte();
        if more < 64 {
            bytes.kinds.extend((0..KINDS).filter(|kind| more >> kind & 1 == 1).chain([KINDS - 1]));
        }
        while !bytes.left.is_empty() && rays.len() < 48 {
            let kind = bytes.byte();
            let from = if kind & 1 == 0 { bytes.point(true) } else { bytes.pick(&positions) };
            let to = match kind >> 1 & 3 {
                0 => bytes.point(true),
                1 => bytes.pick(&positions) - from,
                2 => (bytes.pick(&positions) + bytes.pick(&positions)) * 0.5 - from,
                _ => Vec3::AXES[bytes.byte() as usize % 3] * if kind & 8 == 0 { 1.0 } else { -1.0 },
            };
            let whole = Ray::new(from, to);
            let has_ends = kind >> 4 & 3 == 0;
            rays.push(if has_ends { Ray { t_min: bytes.float(), t_max: bytes.float(), ..whole } } else { whole });
        }
        Self { positions, triangles, rays }
    }
}

/// The maximum number of rays that are copied per case.
const COPIED_RAYS: usize = 6;

/// Returns `rays`, followed by packets of sixteen rays. The directions in a packet are in one octant.
fn with_packets(rays: &[Ray]) -> Vec<Ray> {
    let mut octants: BTreeMap<[bool; 3], Vec<Ray>> = BTreeMap::new();
    for ray in rays {
        octants.entry(ray.direction.to_array().map(f32::is_sign_negative)).or_default().push(*ray);
    }
    let mut crowds: Vec<Vec<Ray>> = octants.into_values().collect();
    crowds.sort_by_key(|alike| Reverse(alike.len()));
    let mut rays = rays.to_vec();
    for alike in crowds.iter().take(2) {
        // A packet begins at an index divisible by sixteen.
        rays.resize(rays.len().next_multiple_of(16), alike[0]);
        rays.extend(alike.iter().cycle().take(alike.len().next_multiple_of(16)));
    }
    rays
}

/// The names of our structures that are missing in `VARIANTS`.
#[allow(dead_code, reason = "a test of `tests/properties.rs`, not of the fuzzer")]
pub fn left_out() -> Vec<String> {
    let registry = Registry::builtin();
    let names: BTreeSet<&str> = registry.entries().iter().map(|entry| entry.name.as_str()).collect();
    let ours = names.into_iter().filter(|name| known_defect(name).is_none());
    ours.filter(|name| VARIANTS.iter().all(|(known, _)| known != name)).map(String::from).collect()
}

fn same_on_all_levels(accel: &dyn DynAccel, rays: &[Ray]) -> Result<(), String> {
    let _alone = LEVEL.lock().unwrap_or_else(PoisonError::into_inner);
    let before = Level::current();
    let mut results = vec![];
    for level in Level::available() {
        level.choose();
        let bits = |hit: Option<Hit>| hit.map(|h| (h.t.to_bits(), h.prim.index()));
        results.push((level, accel.closest(rays).into_iter().map(bits).collect::<Vec<_>>(), accel.any(rays)));
    }
    before.choose();
    let (first, expected, _) = &results[0];
    for (level, hits, any) in &results {
        if let Some(i) = (0..rays.len()).find(|&i| hits[i] != expected[i] || any[i] != hits[i].is_some()) {
            let (here, there, any, ray) = (hits[i], expected[i], any[i], rays[i]);
            return Err(format!("ray {i}, \"{ray}\": {here:?} on {level}, any hit {any}; {there:?} on {first}"));
        }
    }
    Ok(())
}

const KINDS: u8 = 7;

/// Kinds 0 to 6: multiple of 1/8, zero, denormal, power of two, magnitude below 4, arbitrary bits, not finite.
/// Kind 2 may return zero. Kind 3 may return zero or infinity.
fn float_of(kind: u8, bits: u32) -> f32 {
    let signed = |x: f32| if bits >> 31 == 1 { -x } else { x };
    match kind {
        0 => (bits as u8 as i8 % 33) as f32 / 8.0,
        1 => signed(0.0),
        2 => f32::from_bits(bits & 0x807f_ffff),
        3 => f32::from_bits(bits & 0xff80_0000),
        4 => signed((bits >> 7 & 0xff_ffff) as f32 / (1 << 22) as f32),
        5 => f32::from_bits(bits),
        _ => [f32::NAN, f32::INFINITY, f32::NEG_INFINITY][bits as usize % 3],
    }
}

struct Bytes<'a> {
    left: &'a [u8],
    kinds: Vec<u8>,
}

impl Bytes<'_> {
    fn byte(&mut self) -> u8 {
        let Some((&first, rest)) = self.left.split_first() else { return 0 };
        self.left = rest;
        first
    }

    fn float(&mut self) -> f32 {
        let kind = usize::from(self.byte()) % self.kinds.len();
        let kind = self.kinds[kind];
        let bits = match kind {
            0 | 6 => self.byte().into(),
            1 => u32::from(self.byte()) << 24,
            _ => u32::from_le_bytes([0; 4].map(|_: u8| self.byte())),
        };
        float_of(kind, bits)
    }

    /// If `wild` is false, all coordinates are finite.
    fn point(&mut self, wild: bool) -> Vec3 {
        Vec3::from_array([0; 3].map(|_: u8| {
            let x = self.float();
            if wild || x.is_finite() { x } else { 0.0 }
        }))
    }

    fn pick(&mut self, points: &[Vec3]) -> Vec3 {
        points[self.byte() as usize % points.len()]
    }
}
