//! `study self-intersection`: which way to start a secondary ray neither meets its own surface again nor passes another one.
//!
//! A closed convex sphere gives the truth for nothing: a ray that leaves it outwards meets nothing, one that goes in meets the
//! far side. An outward ray with a hit is *acne*, an inward ray without one a *leak*. Where the exact test, over all triangles,
//! gives the right answer to the same ray, the start was good and the triangle test is to blame.

mod sphere;
mod table;
#[cfg(test)]
mod tests;

use serde::Serialize;

use crate::accel::DynAccel;
use crate::geometry::{Hit, Ray};
use crate::measure::Provenance;
use crate::registry::Choice;
use crate::scene::offset::{Offset, SurfacePoint, barycentrics};
use crate::triangle::{Exact, TriangleTest};
use crate::validate::{Reference, Sampler};
pub use sphere::Sphere;
pub use table::table;

/// The ways that are compared; the lengths are those one meets most often.
pub const OFFSETS: [Offset; 5] =
    [Offset::None, Offset::Normal(1e-4), Offset::TMin(1e-4), Offset::WachterBinder, Offset::ErrorBounded];

/// How a point on the surface is made from a hit.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum PointFrom {
    /// `origin + t * direction`.
    Ray,
    /// The mean of the corners, weighted.
    Corners,
}

/// How much is traced.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Settings {
    /// Rays outwards of each case; as many go in.
    pub rays: usize,
    pub seed: u64,
}

/// One sphere, structure, kind of point and way to start.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Row {
    pub sphere: Sphere,
    /// The structure with the keys that differ from their defaults.
    pub structure: String,
    pub triangle_test: &'static str,
    pub point: PointFrom,
    /// [`Offset::name`].
    pub offset: String,
    /// Rays outwards.
    pub outward: usize,
    /// Those of them that hit something, and exactly so.
    pub acne: usize,
    /// Those that hit something although exactly there is nothing: the triangle test's own.
    pub acne_of_test: usize,
    /// Rays inwards.
    pub inward: usize,
    /// Those of them that hit nothing, and exactly so.
    pub leaks: usize,
    /// Those that hit nothing although exactly there is something: the triangle test's own.
    pub leaks_of_test: usize,
}

/// The study, as `--export-json` writes it.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct SelfIntersection {
    /// Version of this form.
    pub schema: u32,
    pub rows: Vec<Row>,
    pub provenance: Provenance,
}

/// Traces everything. The same result on every machine.
///
/// # Errors
/// If a structure refuses a sphere: a sentence.
pub fn study(structures: &[Choice], settings: Settings) -> Result<SelfIntersection, String> {
    let mut rows = vec![];
    for sphere in Sphere::ALL {
        let mesh = sphere.mesh();
        let judge = Reference::of_test(Exact::NAME, &mesh).map_err(|error| error.to_string())?;
        for choice in structures {
            let accel = choice.build(&mesh).map_err(|error| format!("{} over {sphere}: {error}", choice.label))?;
            // Rays with the wrong answer: exactly so, and by the test's own fault.
            let wrong = |rays: &[Ray], hit_is_wrong: bool| {
                let of = |accel: &dyn DynAccel, rays: &[Ray]| {
                    let hits = closest(accel, rays);
                    rays.iter()
                        .zip(hits)
                        .filter(|(_, hit)| hit.is_some() == hit_is_wrong)
                        .map(|(ray, _)| *ray)
                        .collect()
                };
                let found: Vec<Ray> = of(accel.as_ref(), rays);
                let exactly: Vec<Ray> = of(judge.accel.as_ref(), &found);
                (exactly.len(), found.len() - exactly.len())
            };

            // Land on the sphere from outside. At its silhouette a ray may miss: take more than are needed.
            let mut sampler = Sampler::new(settings.seed);
            let views: Vec<Ray> = (0..settings.rays * 2).map(|_| sphere.view(&mut sampler)).collect();
            let hits = closest(accel.as_ref(), &views);
            let landed: Vec<(Ray, Hit)> =
                views.into_iter().zip(hits).filter_map(|(ray, hit)| Some((ray, hit?))).collect();
            let directions: Vec<_> = (0..settings.rays * 2).map(|_| sampler.direction()).collect();

            for point in [PointFrom::Ray, PointFrom::Corners] {
                let start = |(ray, hit): &(Ray, Hit)| {
                    let corners = mesh.corners(hit.prim.index());
                    let start = SurfacePoint::on_triangle(corners, barycentrics(ray, corners));
                    if point == PointFrom::Ray { SurfacePoint { position: ray.at(hit.t), ..start } } else { start }
                };
                // The sphere is convex: outwards is the side of the normal.
                let starts: Vec<SurfacePoint> = landed.iter().map(start).collect();
                for offset in OFFSETS {
                    let leaving = |way: f32| -> Vec<Ray> {
                        let turned = |(start, &direction): (&SurfacePoint, &glam::Vec3)| {
                            let along = start.normal.as_dvec3().dot(direction.as_dvec3()) as f32;
                            offset.leave(start, direction * (way * along).signum())
                        };
                        starts.iter().zip(&directions).take(settings.rays).map(turned).collect()
                    };
                    let (outward, inward) = (leaving(1.0), leaving(-1.0));
                    let ((acne, acne_of_test), (leaks, leaks_of_test)) = (wrong(&outward, true), wrong(&inward, false));
                    rows.push(Row {
                        sphere,
                        structure: choice.label.clone(),
                        triangle_test: choice.triangle_test(),
                        point,
                        offset: offset.name(),
                        outward: outward.len(),
                        acne,
                        acne_of_test,
                        inward: inward.len(),
                        leaks,
                        leaks_of_test,
                    });
                }
            }
        }
    }
    Ok(SelfIntersection { schema: 1, rows, provenance: Provenance::capture(1) })
}

fn closest(accel: &dyn DynAccel, rays: &[Ray]) -> Vec<Option<Hit>> {
    let mut hits = vec![None; rays.len()];
    accel.closest_hits(rays, &mut hits);
    hits
}
