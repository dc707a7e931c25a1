// An example of a study in another crate, with generated scenes.
use sahara::anyhow;
use sahara::clap::{ArgMatches, Args, Command, FromArgMatches};
use sahara::glam::Vec3;
use sahara::registry::Registry;
use sahara::report::{Block, Report, Table};
use sahara::request::{Rays, Structures, scene};
use sahara::scene::{Model, Scene, WorkloadKind};
use sahara::study::measurement::{Measurement, measurements};
use sahara::study::{Dataset, Plan, PlannedScene, Presets, Settings, Study};

/// The scene `staircase:N` has N steps. Each step is one triangle. Every second step is wide.
pub fn staircase(parameters: &str) -> anyhow::Result<Scene> {
    let steps: u32 = parameters.parse()?;
    let corner = |i: u32, wide: f32, z: f32| Vec3::new(i as f32 * 0.1 + wide, i as f32 * 0.1, z);
    let step = |i: u32| [corner(i, 0.0, 0.0), corner(i, (i % 2) as f32, 0.0) + Vec3::X * 0.1, corner(i, 0.0, 1.0)];
    let positions = (0..steps).flat_map(step).collect();
    let triangles = (0..steps).map(|i| [3 * i, 3 * i + 1, 3 * i + 2]).collect();
    Ok(Scene::framed(&format!("staircase {steps}"), Model { positions, triangles, ..Model::default() })?)
}

pub const DUPLICATION: Study = Study {
    name: "duplication",
    question: "How often does a structure refer to a triangle?",
    presets: Presets { full: "-s grid -s sah-bvh", quick: "-s grid --rays 512" },
    options: || Rays::augment_args(Structures::augment_args(Command::new("duplication"))),
    plan,
    report,
};

fn plan(matches: &ArgMatches, registry: &Registry) -> anyhow::Result<Plan> {
    let structures = Structures::from_arg_matches(matches)?.chosen(registry, &["grid", "sah-kd"])?;
    let workloads = Rays::from_arg_matches(matches)?.request(&[WorkloadKind::Primary]);
    let settings = Settings::one_sample("sah-kd");
    let planned = |steps: u32| {
        let word = format!("staircase:{steps}");
        let own = (word.clone(), scene(registry, &word)?);
        Ok(PlannedScene::new(&own, &structures, &workloads, &settings, 1).labelled("steps", steps.to_string()))
    };
    let scenes = [4, 64].into_iter().map(planned).collect::<anyhow::Result<Vec<_>>>()?;
    Ok(Plan::by_epoch("duplication", &scenes))
}

fn report(dataset: &Dataset, _: &ArgMatches) -> Report {
    let all = measurements(dataset);
    let data = Table::of(
        "References for each triangle",
        all,
        &[
            ("scene", &|own: &Measurement| (&own.scene).into()),
            ("structure", &|own| (&own.label).into()),
            ("references_per_triangle", &|own| (own.shape.references as f64 / own.triangles as f64).into()),
        ],
    );
    Report { blocks: vec![Block::Table(data.clone())], data, failures: dataset.failures(), ..Report::default() }
}
