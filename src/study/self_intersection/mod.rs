//! `study self-intersection`: which way to start a secondary ray neither meets its own surface again nor passes another one.
//!
//! A closed convex sphere gives the truth for nothing: a ray that leaves it outwards meets nothing, one that goes in meets the
//! far side. An outward ray with a hit is *acne*, an inward ray without one a *leak*. Where the exact test, over all triangles,
//! gives the right answer to the same ray, the start was good and the triangle test is to blame.

mod sphere;
mod table;
#[cfg(test)]
mod tests;

use serde::{Deserialize, Serialize};
use serde_json::json;

use super::plan::Measure;
use super::{BRUTE_FORCE, Context, Data, Plan, SAH_TREE, Stage, Study, StudyError, sources};
use crate::accel::DynAccel;
use crate::geometry::{Hit, Ray};
use crate::measure::Threads;
use crate::registry::{Choice, Registry};
use crate::report::{Statement, Table};
use crate::scene::offset::{Offset, SurfacePoint, barycentrics};
use crate::triangle::{Exact, TriangleTest};
use crate::validate::{Reference, Sampler};
pub use sphere::Sphere;
pub use table::table;

/// The ways that are compared; the lengths are those one meets most often.
pub const OFFSETS: [Offset; 5] =
    [Offset::None, Offset::Normal(1e-4), Offset::TMin(1e-4), Offset::WachterBinder, Offset::ErrorBounded];

/// How a point on the surface is made from a hit.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum PointFrom {
    /// `origin + t * direction`.
    Ray,
    /// The mean of the corners, weighted.
    Corners,
}

/// One sphere, structure, kind of point and way to start.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Row {
    pub sphere: Sphere,
    /// The structure with the keys that differ from their defaults.
    pub structure: String,
    pub triangle_test: String,
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

/// Traces the rays of one sphere. The same result on every machine.
fn trace(sphere: Sphere, structures: &[Choice], rays: usize, seed: u64) -> Result<Vec<Row>, StudyError> {
    let (mesh, scene) = (sphere.mesh(), sphere.to_string());
    let judge = Reference::of_test(Exact::NAME, &mesh).map_err(StudyError::of_build(BRUTE_FORCE, &scene))?;
    let mut rows = vec![];
    for choice in structures {
        let accel = choice.build(&mesh).map_err(StudyError::of_build(&choice.label, &scene))?;
        // Rays with the wrong answer: exactly so, and by the test's own fault.
        let wrong = |rays: &[Ray], hit_is_wrong: bool| {
            let of = |accel: &dyn DynAccel, rays: &[Ray]| {
                let hits = accel.closest(rays);
                rays.iter().zip(hits).filter(|(_, hit)| hit.is_some() == hit_is_wrong).map(|(ray, _)| *ray).collect()
            };
            let found: Vec<Ray> = of(accel.as_ref(), rays);
            let exactly: Vec<Ray> = of(judge.accel.as_ref(), &found);
            (exactly.len(), found.len() - exactly.len())
        };

        // Land on the sphere from outside. At its silhouette a ray may miss: take more than are needed.
        let mut sampler = Sampler::new(seed);
        let views: Vec<Ray> = (0..rays * 2).map(|_| sphere.view(&mut sampler)).collect();
        let hits = accel.closest(&views);
        let landed: Vec<(Ray, Hit)> = views.into_iter().zip(hits).filter_map(|(ray, hit)| Some((ray, hit?))).collect();
        let directions: Vec<_> = (0..rays * 2).map(|_| sampler.direction()).collect();

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
                    starts.iter().zip(&directions).take(rays).map(turned).collect()
                };
                let (outward, inward) = (leaving(1.0), leaving(-1.0));
                let ((acne, acne_of_test), (leaks, leaks_of_test)) = (wrong(&outward, true), wrong(&inward, false));
                rows.push(Row {
                    sphere,
                    structure: choice.label.clone(),
                    triangle_test: choice.triangle_test().into(),
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
    Ok(rows)
}

pub struct SelfIntersectionStudy;

#[derive(Clone, Debug, clap::Args)]
pub struct SelfIntersectionArgs {
    /// A structure, with keys that differ from their defaults; may be repeated [default: sah-kd over every triangle test]
    #[arg(long, short, value_name = "NAME[:key=value,..]")]
    structure: Vec<String>,
    /// Rays outwards of each case; as many go in
    #[arg(long, value_name = "N", default_value_t = RAYS, value_parser = clap::value_parser!(u32).range(1..=1 << 24))]
    rays: u32,
    /// Seed of the rays
    #[arg(long, value_name = "N", default_value_t = 1)]
    seed: u64,
}

const RAYS: u32 = 6000;

impl Study for SelfIntersectionStudy {
    const NAME: &'static str = "self-intersection";
    const QUESTION: &'static str =
        "Which way to start a secondary ray neither meets its own surface again nor passes another one?";
    const KEPT: bool = false;
    const QUICK: &'static str = "--rays 100";

    type Args = SelfIntersectionArgs;
    type Case = Vec<Row>;
    type Answer = Vec<Row>;

    fn plan(args: &SelfIntersectionArgs, registry: &Registry) -> anyhow::Result<Plan<Vec<Row>>> {
        let structures = if args.structure.is_empty() {
            registry.all().into_iter().filter(|choice| choice.entry.name == SAH_TREE).collect::<Vec<Choice>>()
        } else {
            sources::structures(registry, &args.structure)?
        };
        anyhow::ensure!(!structures.is_empty(), "{SAH_TREE} is not registered: name a structure with --structure");
        let (rays, seed) = (args.rays, args.seed);
        let labels: Vec<&str> = structures.iter().map(|choice| choice.label.as_str()).collect();
        let kept = json!({ "structures": labels.join(" "), "rays": rays, "seed": seed });
        let threads = Threads::new(1).map_err(anyhow::Error::msg)?;
        let spheres = Sphere::ALL.map(|sphere| (sphere.to_string(), sphere.to_string()));
        let measure: Measure<Vec<Row>> = Box::new(move |case, _, progress| {
            let sphere = Sphere::ALL[case.scene];
            progress(Stage::Rays("secondary"));
            trace(sphere, &structures, rays as usize, seed)
        });
        Ok(Plan::of_scenes(&kept, threads, spheres, measure))
    }

    fn answer(cases: &[Vec<Row>], _: &Context<Self>) -> Vec<Row> {
        cases.concat()
    }

    fn tables(answer: &Vec<Row>) -> Vec<Table> {
        vec![table(answer)]
    }

    fn statements(answer: &Vec<Row>) -> Vec<Statement> {
        table::statements(answer)
    }

    fn data(answer: &Vec<Row>) -> Vec<Data> {
        vec![Data::new(Self::NAME, answer)]
    }
}
