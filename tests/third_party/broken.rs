//! A grid with one of nine faults. The command `validate` must detect each fault.

use std::sync::Arc;
use std::sync::atomic::{AtomicU32, Ordering};

use sahara::accel::{Accel, BuildError, Capabilities, Footprint, Observed, Observer, TreeShape};
use sahara::geometry::{Hit, Mesh, Ray};
use sahara::serde::{Deserialize, Serialize};
use sahara::triangle::MollerTrumbore;

use crate::grid::{Grid, GridConfig};

pub struct Broken {
    grid: Grid<MollerTrumbore>,
    fault: Fault,
    hits: AtomicU32,
}

#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(crate = "sahara::serde", rename_all = "kebab-case")]
pub enum Fault {
    #[default]
    None,
    /// Returns a miss for one ray in 10,000.
    Drops,
    WrongId,
    /// Returns `t` 3 ulps too large.
    Late,
    AnyHitDisagrees,
    Panics,
    Hangs,
    /// Loses every 500th hit.
    Moody,
    BuilderPanics,
    BuilderHangs,
}

#[derive(Clone, Debug, Default, Serialize, Deserialize)]
#[serde(crate = "sahara::serde")]
pub struct BrokenConfig {
    pub fault: Fault,
}

/// A hash of origin and direction selects about one ray in `n`.
pub fn picks(ray: &Ray, n: u32) -> bool {
    let bits = ray.origin.to_array().into_iter().chain(ray.direction.to_array()).map(f32::to_bits);
    let mixed = bits.fold(0x811c_9dc5_u32, |h, b| (h ^ b).wrapping_mul(0x9e37_79b1).rotate_left(13));
    (mixed ^ mixed >> 15).wrapping_mul(0x85eb_ca6b).is_multiple_of(n)
}

fn forever() -> ! {
    loop {
        std::thread::park();
    }
}

impl Accel for Broken {
    type Config = BrokenConfig;

    const TRIANGLE_TEST: &'static str = Grid::<MollerTrumbore>::TRIANGLE_TEST;

    fn build(mesh: &Arc<Mesh>, config: &BrokenConfig) -> Result<Self, BuildError> {
        match config.fault {
            Fault::BuilderPanics if !mesh.is_empty() => panic!("no triangle is good enough"),
            Fault::BuilderHangs if !mesh.is_empty() => forever(),
            _ => {}
        }
        Ok(Self { grid: Grid::build(mesh, &GridConfig::default())?, fault: config.fault, hits: AtomicU32::new(0) })
    }

    fn closest_hit<O: Observer>(&self, ray: &Ray, observer: &mut O) -> Option<Hit> {
        let hit = self.grid.closest_hit(ray, observer);
        match self.fault {
            Fault::Drops => hit.filter(|_| !picks(ray, 10_000)),
            Fault::WrongId => hit.map(|hit| Hit::new(hit.t, hit.prim.index() + 1)),
            Fault::Late => hit.map(|hit| Hit { t: hit.t.next_up().next_up().next_up(), ..hit }),
            Fault::Panics if picks(ray, 500) => panic!("an index out of bounds, say"),
            Fault::Hangs if picks(ray, 500) => forever(),
            Fault::Moody => hit.filter(|_| !self.hits.fetch_add(1, Ordering::Relaxed).is_multiple_of(500)),
            _ => hit,
        }
    }

    fn any_hit<O: Observer>(&self, ray: &Ray, observer: &mut O) -> bool {
        self.closest_hit(ray, observer).is_some() != (self.fault == Fault::AnyHitDisagrees && picks(ray, 500))
    }

    fn footprint(&self) -> Footprint {
        Accel::footprint(&self.grid)
    }

    fn shape(&self) -> TreeShape {
        Accel::shape(&self.grid)
    }
}

/// A structure that declares few capabilities.
pub struct Modest(Grid<MollerTrumbore>);

impl Accel for Modest {
    type Config = GridConfig;

    const OBSERVED: Observed = Observed::NONE;
    const CAPABILITIES: Capabilities = Capabilities { any_hit: false, t_min: false, closed_start: true, t_max: false };

    fn build(mesh: &Arc<Mesh>, config: &GridConfig) -> Result<Self, BuildError> {
        Grid::build(mesh, config).map(Self)
    }

    fn closest_hit<O: Observer>(&self, ray: &Ray, _: &mut O) -> Option<Hit> {
        self.0.closest_hit(&Ray::new(ray.origin, ray.direction), &mut ())
    }

    fn footprint(&self) -> Footprint {
        Accel::footprint(&self.0)
    }

    fn shape(&self) -> TreeShape {
        Accel::shape(&self.0)
    }
}
