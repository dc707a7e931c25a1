//! What somebody else writes to add a structure: a type of their own, the public interface, one macro.

use std::sync::Arc;

use glam::{DVec3, UVec3, Vec3};
use sahara::accel::{Accel, BuildError, Footprint, Observer, TreeShape};
use sahara::geometry::{Hit, Mesh, Ray};
use sahara::measure::{SystemClock, Threads};
use sahara::registry::Registry;
use sahara::scene::{Builtin, WorkloadKind};
use sahara::study::compare::{Settings, compare_scene};
use sahara::triangle::{MollerTrumbore, TriangleTest};
use sahara::validate::{Kind, Reference, Stratum, degenerate_meshes, validate};
use serde::{Deserialize, Serialize};

/// A uniform grid: cells of equal size, each with the triangles whose boxes meet it.
struct MyGrid {
    /// Corner of the grid, and the size of a cell.
    origin: DVec3,
    cell: DVec3,
    size: UVec3,
    /// Triangle numbers, cell by cell.
    cells: Vec<Vec<u32>>,
    blocks: Vec<<MollerTrumbore as TriangleTest>::Block<1>>,
}

#[derive(Clone, Debug, Serialize, Deserialize)]
struct MyConfig {
    /// Cells along every axis.
    resolution: u32,
}

impl Default for MyConfig {
    fn default() -> Self {
        Self { resolution: 8 }
    }
}

impl MyGrid {
    /// Numbers of the cells along `axis` that a coordinate range meets, with slack for the rounding of `f64`.
    fn range(&self, axis: usize, low: f64, high: f64) -> Option<(u32, u32)> {
        let slack = 1e-12 * (low.abs().max(high.abs()) + self.origin[axis].abs() + self.cell[axis]);
        let index = |x: f64| ((x - self.origin[axis]) / self.cell[axis]).floor();
        let (first, last) = (index(low - slack), index(high + slack));
        let end = f64::from(self.size[axis]);
        // The far face of the grid belongs to its last cell.
        (last >= 0.0 && first <= end).then(|| (first.clamp(0.0, end - 1.0) as u32, last.clamp(0.0, end - 1.0) as u32))
    }

    fn at(&self, x: u32, y: u32, z: u32) -> usize {
        ((z * self.size.y + y) * self.size.x + x) as usize
    }

    /// Walks the layers of cells across the main axis of the ray, nearest first; in each, the cells that the ray may touch.
    fn walk<const ANY: bool, O: Observer>(&self, ray: &Ray, observer: &mut O) -> Option<Hit> {
        if !ray.is_valid() || self.blocks.is_empty() {
            return None;
        }
        let prepared = MollerTrumbore::prepare(ray);
        let (origin, direction) = (ray.origin.as_dvec3(), ray.direction.as_dvec3());
        let (t_min, t_max) = ray.interval();
        let main = direction.abs().max_position();
        let mut nearest: Option<Hit> = None;
        for step in 0..self.size[main] {
            let layer = if direction[main] > 0.0 { step } else { self.size[main] - 1 - step };
            let plane = |i: u32| {
                let x = self.origin[main] + self.cell[main] * f64::from(i);
                let slack = 1e-12 * (x.abs() + origin[main].abs() + self.cell[main]) / direction[main].abs();
                let t = (x - origin[main]) / direction[main];
                (t - slack, t + slack)
            };
            let ((a, b), (c, d)) = (plane(layer), plane(layer + 1));
            let (enter, leave) = (a.min(c).max(t_min.into()), b.max(d).min(t_max.into()));
            if enter > leave {
                continue;
            }
            if nearest.is_some_and(|hit| f64::from(hit.t) < enter) {
                break;
            }
            let mut ranges = [(layer, layer); 3];
            let mut outside = false;
            for axis in (0..3).filter(|&axis| axis != main) {
                let (p, q) = (origin[axis] + direction[axis] * enter, origin[axis] + direction[axis] * leave);
                let slack = 1e-12 * (origin[axis].abs() + p.abs().max(q.abs()));
                match self.range(axis, p.min(q) - slack, p.max(q) + slack) {
                    Some(range) => ranges[axis] = range,
                    None => outside = true,
                }
            }
            if outside {
                continue;
            }
            for z in ranges[2].0..=ranges[2].1 {
                for y in ranges[1].0..=ranges[1].1 {
                    for x in ranges[0].0..=ranges[0].1 {
                        let cell = &self.cells[self.at(x, y, z)];
                        observer.leaf(cell.len() as u32);
                        observer.test(cell.len() as u32);
                        for &id in cell {
                            let triangle = &self.blocks[id as usize];
                            let t = MollerTrumbore::hit(&prepared, triangle, t_min, t_max.next_down());
                            let Some(t) = t else { continue };
                            let hit = Hit::new(t, id);
                            if nearest.is_none_or(|n| hit.beats(n)) {
                                nearest = Some(hit);
                            }
                        }
                        if ANY && nearest.is_some() {
                            return nearest;
                        }
                    }
                }
            }
        }
        nearest
    }
}

impl Accel for MyGrid {
    type Config = MyConfig;

    const TRIANGLE_TEST: &'static str = MollerTrumbore::NAME;

    fn build(mesh: &Arc<Mesh>, config: &MyConfig) -> Result<Self, BuildError> {
        if config.resolution == 0 || config.resolution > 256 {
            return Err(BuildError::Config("resolution must be from 1 to 256".into()));
        }
        let bounds = if mesh.is_empty() { [Vec3::ZERO, Vec3::ONE] } else { [mesh.bounds().min, mesh.bounds().max] };
        let [low, high] = bounds.map(Vec3::as_dvec3);
        let size = UVec3::splat(config.resolution);
        // A flat box still has cells.
        let cell = ((high - low) / size.as_dvec3()).max(DVec3::splat((high - low).max_element().max(1e-300) * 1e-6));
        let blocks = (0..mesh.len() as u32).map(|id| MollerTrumbore::block(&[mesh.corners(id)])).collect();
        let mut grid = Self { origin: low, cell, size, cells: vec![vec![]; size.element_product() as usize], blocks };
        for id in mesh.solid() {
            let bounds = mesh.triangle_bounds(id);
            let range = |axis| {
                let ends = (bounds.min[axis].into(), bounds.max[axis].into());
                grid.range(axis, ends.0, ends.1).expect("a triangle lies in the grid")
            };
            let (xs, ys, zs) = (range(0), range(1), range(2));
            for z in zs.0..=zs.1 {
                for y in ys.0..=ys.1 {
                    for x in xs.0..=xs.1 {
                        let at = grid.at(x, y, z);
                        grid.cells[at].push(id);
                    }
                }
            }
        }
        Ok(grid)
    }

    fn closest_hit<O: Observer>(&self, ray: &Ray, observer: &mut O) -> Option<Hit> {
        self.walk::<false, O>(ray, observer)
    }

    fn any_hit<O: Observer>(&self, ray: &Ray, observer: &mut O) -> bool {
        self.walk::<true, O>(ray, observer).is_some()
    }

    fn footprint(&self) -> Footprint {
        let references: usize = self.cells.iter().map(Vec::len).sum();
        Footprint {
            nodes: size_of_val(&self.cells[..]),
            references: references * size_of::<u32>(),
            triangles: size_of_val(&self.blocks[..]),
            other: 0,
        }
    }

    fn shape(&self) -> TreeShape {
        TreeShape {
            leaves: self.cells.len(),
            empty: self.cells.iter().filter(|cell| cell.is_empty()).count(),
            references: self.cells.iter().map(Vec::len).sum(),
            largest_leaf: self.cells.iter().map(Vec::len).max().unwrap_or(0),
            ..TreeShape::default()
        }
    }
}

sahara::conformance!(my_grid, MyGrid, MyConfig::default(), lowest_id);
sahara::conformance!(my_grid_of_one_cell, MyGrid, MyConfig { resolution: 1 });

#[test]
fn a_registered_structure_is_chosen_like_the_others() {
    let registry = Registry::builtin().with::<MyGrid>("my-grid", MyConfig::default());
    let choice = registry.choose("my-grid:resolution=3").unwrap();
    assert_eq!((choice.label.as_str(), choice.triangle_test()), ("my-grid:resolution=3", "moller-trumbore"));
    let refusal = registry.choose("my-grid:resolution=0").map(|_| ()).unwrap_err().to_string();
    assert!(refusal.contains("resolution must be from 1 to 256"), "{refusal}");

    for (name, mesh) in degenerate_meshes() {
        let (accel, reference) = (choice.build(&mesh).unwrap(), Reference::of_test("moller-trumbore", &mesh).unwrap());
        let validation = validate(&*accel, &reference, &mesh, &Stratum::Random.rays(&mesh, 100, 9));
        assert_eq!(validation.errors(), 0, "{name}: {:?}", validation.worst);
    }
}

/// The grid, but it answers "nothing" to one ray in a thousand.
struct Forgetful(MyGrid);

impl Forgetful {
    fn forgets(ray: &Ray) -> bool {
        let bits = ray.direction.to_array().map(f32::to_bits);
        bits.into_iter().fold(0_u32, |h, b| (h ^ b).wrapping_mul(0x9e37_79b1).rotate_left(13)) % 1000 == 0
    }
}

impl Accel for Forgetful {
    type Config = MyConfig;

    const TRIANGLE_TEST: &'static str = MollerTrumbore::NAME;

    fn build(mesh: &Arc<Mesh>, config: &MyConfig) -> Result<Self, BuildError> {
        MyGrid::build(mesh, config).map(Self)
    }

    fn closest_hit<O: Observer>(&self, ray: &Ray, observer: &mut O) -> Option<Hit> {
        if Self::forgets(ray) { None } else { self.0.closest_hit(ray, observer) }
    }

    fn any_hit<O: Observer>(&self, ray: &Ray, observer: &mut O) -> bool {
        !Self::forgets(ray) && self.0.any_hit(ray, observer)
    }

    fn footprint(&self) -> Footprint {
        Accel::footprint(&self.0)
    }

    fn shape(&self) -> TreeShape {
        Accel::shape(&self.0)
    }
}

#[test]
fn a_structure_that_loses_one_ray_in_a_thousand_is_rejected_with_the_ray() {
    let (_, mesh) = degenerate_meshes().into_iter().find(|(name, _)| name == "closed sphere").unwrap();
    let (broken, reference) =
        (Forgetful::build(&mesh, &MyConfig::default()).unwrap(), Reference::of_test("moller-trumbore", &mesh).unwrap());
    let rays = Stratum::Random.rays(&mesh, 20_000, 1);
    let validation = validate(&broken, &reference, &mesh, &rays);
    let rate = validation.structure_errors as f64 / validation.hits as f64;
    assert!(rate > 0.0003 && rate < 0.003, "{rate}");
    assert_eq!(validation.errors(), validation.structure_errors, "the rest is right");

    let worst = validation.worst_error().unwrap();
    assert_eq!((worst.kind, worst.found), (Kind::Lost, None));
    let again: Ray = worst.ray.to_string().parse().unwrap();
    assert!(Forgetful::forgets(&again) && broken.0.closest_hit(&again, &mut ()).is_some());

    let subject = sahara::validate::conformance::Subject::of::<Forgetful>("forgetful", MyConfig::default());
    let report = sahara::validate::conformance::answers(&subject, &degenerate_meshes(), 200).unwrap_err();
    assert!(report.contains("forgetful on ") && report.contains("worst: lost: ray \""), "{report}");
}

#[test]
fn it_is_compared_like_our_own() {
    let registry = Registry::builtin().with::<MyGrid>("my-grid", MyConfig::default());
    let settings = Settings {
        structures: ["my-grid", "sah-kd"].map(|name| registry.choose(name).unwrap()).into(),
        guide: registry.choose("sah-kd").unwrap(),
        workloads: vec![WorkloadKind::Primary, WorkloadKind::Shadow],
        rays: 1024,
        runs: 3,
        budget_ns: 1_000_000_000,
        seed: 1,
        threads: Threads::new(1).unwrap(),
    };
    let scene = Builtin::find("sphere").unwrap().scene(None).unwrap();
    let records = compare_scene(&scene, &settings, &SystemClock::start(), &mut |_| {}).unwrap().records;
    assert_eq!(records.len(), 4);
    assert!(records.iter().all(|r| r.structure_errors == Some(0) && r.mrays_per_s > Some(0.0)));
    assert_eq!(records[0].label, "my-grid");
    assert_eq!(records[0].hits, records[2].hits);
}
