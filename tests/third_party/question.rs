// A study of a crate of its own: how many triangles of a scene a structure refers to more than once.
use sahara::registry::Registry;
use sahara::report::Table;
use sahara::scene::Scene;
use sahara::serde::{Deserialize, Serialize};
use sahara::study::args::{Scenes, Structures};
use sahara::study::{Context, Data, Measure, Plan, Stage, Study, StudyError};
use sahara::{anyhow, clap};

/// The study.
pub struct DuplicationStudy;

/// Its options on the command line.
#[derive(Clone, Debug, clap::Args)]
pub struct DuplicationArgs {
    #[command(flatten)]
    scenes: Scenes,
    #[command(flatten)]
    structures: Structures,
}

/// One structure on one scene.
#[derive(Clone, Debug, Serialize, Deserialize)]
#[serde(crate = "sahara::serde")]
pub struct Duplication {
    pub scene: String,
    pub structure: String,
    pub references_per_triangle: f64,
}

impl Study for DuplicationStudy {
    const NAME: &'static str = "duplication";
    const QUESTION: &'static str = "How often does a structure refer to a triangle?";
    const FULL: &'static str = "cube torus";
    const QUICK: &'static str = "cube torus";

    type Args = DuplicationArgs;
    type Case = Vec<Duplication>;
    type Answer = Vec<Duplication>;

    fn plan(args: &DuplicationArgs, registry: &Registry) -> anyhow::Result<Plan<Self::Case>> {
        let scenes = args.scenes.read(&["cube"])?;
        let structures = args.structures.chosen(registry, &["grid", "sah-kd"])?;
        let labels: Vec<String> = structures.iter().map(|choice| choice.label.clone()).collect();
        let keys: Vec<(String, String)> = scenes.iter().map(|scene| (scene.name.clone(), scene.hash())).collect();
        let of = move |scene: &Scene, progress: &mut dyn FnMut(Stage)| {
            let mut found = vec![];
            for choice in &structures {
                progress(Stage::Build(&choice.label));
                let accel = choice.build(&scene.mesh).map_err(|cause| StudyError::Build {
                    structure: choice.label.clone(),
                    scene: scene.name.clone(),
                    cause,
                })?;
                let references_per_triangle = accel.shape().references as f64 / scene.mesh.len() as f64;
                let (scene, structure) = (scene.name.clone(), choice.label.clone());
                found.push(Duplication { scene, structure, references_per_triangle });
            }
            Ok(found)
        };
        let measure: Measure<Self::Case> = Box::new(move |case, _, progress| of(&scenes[case.scene], progress));
        let settings = std::collections::BTreeMap::from([("structures", labels.join(" "))]);
        let threads = sahara::measure::Threads::new(1).map_err(anyhow::Error::msg)?;
        Ok(Plan::of_scenes(&settings, threads, keys, measure))
    }

    fn answer(cases: &[Self::Case], _: &Context<Self>) -> Self::Answer {
        cases.concat()
    }

    fn tables(answer: &Self::Answer) -> Vec<Table> {
        let row = |d: &Duplication| [d.scene.clone(), d.structure.clone(), format!("{:.2}", d.references_per_triangle)];
        let rows = answer.iter().map(row).collect();
        vec![Table::of_texts("References for each triangle", ["scene", "structure", "references"], rows)]
    }

    fn data(answer: &Self::Answer) -> Vec<Data> {
        vec![Data::new(Self::NAME, answer)]
    }
}
