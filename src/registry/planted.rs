//! A slowdown for tests of what looks for slowdowns.

use std::hint::black_box;
use std::sync::Arc;

use crate::accel::{Accel, BuildError, Footprint, Observer, Outline, TreeShape};
use crate::geometry::{Hit, Mesh, Ray};

/// Of 256 rays so many are asked twice: 9 %, and choosing them takes time as well. The second time finds its nodes in the nearest cache.
const TWICE: u32 = 24;

/// The structure `A`, about a tenth slower.
pub(super) struct Planted<A>(A);

/// Whether the ray is asked twice: every kind of rays is hit alike.
fn is_chosen(ray: &Ray) -> bool {
    let hash = (ray.origin.x.to_bits() ^ ray.direction.y.to_bits().rotate_left(9) ^ ray.direction.z.to_bits())
        .wrapping_mul(0x9e37_79b1);
    (hash ^ hash >> 15).wrapping_mul(0x85eb_ca6b) >> 24 < TWICE
}

impl<A: Accel> Accel for Planted<A> {
    type Config = A::Config;

    const TRIANGLE_TEST: &'static str = A::TRIANGLE_TEST;

    fn build(mesh: &Arc<Mesh>, config: &A::Config) -> Result<Self, BuildError> {
        A::build(mesh, config).map(Self)
    }

    #[inline]
    fn closest_hit<O: Observer>(&self, ray: &Ray, observer: &mut O) -> Option<Hit> {
        if is_chosen(ray) {
            black_box(self.0.closest_hit(black_box(ray), &mut ()));
        }
        self.0.closest_hit(ray, observer)
    }

    #[inline]
    fn any_hit<O: Observer>(&self, ray: &Ray, observer: &mut O) -> bool {
        if is_chosen(ray) {
            black_box(self.0.any_hit(black_box(ray), &mut ()));
        }
        self.0.any_hit(ray, observer)
    }

    fn footprint(&self) -> Footprint {
        self.0.footprint()
    }

    fn shape(&self) -> TreeShape {
        self.0.shape()
    }

    fn outline(&self) -> Option<Outline> {
        self.0.outline()
    }
}
