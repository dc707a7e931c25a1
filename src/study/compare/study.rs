//! `compare` as a study.

use std::collections::BTreeSet;

use serde_json::Value;

use super::{
    Compared, Reference, brief_table, compared, details_legend, legend, mean_table, refusals, scene_table, section,
    winner,
};
use crate::measure::Provenance;
use crate::registry::{Choice, Registry};
use crate::report::document::Block;
use crate::report::words::distinct;
use crate::report::{Record, Statement, Table, to_csv, to_json};
use crate::runner::Program;
use crate::scene::{Scene, WorkloadKind};
use crate::study::args::{Measuring, SLOWEST, Scenes, Structures, WORKLOADS, kinds, with_twin};
use crate::study::epoch::{self, Asked, Epoch, Settings, troubles};
use crate::study::grouped::grouped;
use crate::study::{
    BRUTE_FORCE, Context, Data, Plan, Printed, RaySource, Refused, SceneId, Seconds, Study, Trouble, ViewArgs,
    left_out, replayed, sources,
};

pub struct CompareStudy;

#[derive(Clone, Debug, clap::Args)]
pub struct CompareArgs {
    #[command(flatten)]
    pub scenes: Scenes,
    #[command(flatten)]
    pub from: ViewArgs,
    #[command(flatten)]
    pub structures: Structures,
    /// A program that takes part as a structure and times itself, with its arguments; may be repeated. FORMAT.md of the ray files
    /// says what it reads and writes
    #[arg(long, value_name = "COMMAND")]
    pub runner: Vec<String>,
    /// Seconds that such a program may take for an answer, a build among them
    #[arg(long, value_name = "SECONDS", requires = "runner", default_value_t = RUNNER_LIMIT, allow_negative_numbers = true)]
    pub runner_limit: Seconds,
    /// The structure that speeds are related to; takes part even if it is not among those named [default: median-kd and the better
    /// BVH of obvhs; without them the first one]
    #[arg(long, value_name = "NAME[:key=value,..]")]
    pub reference: Option<String>,
    /// A kind of rays; may be repeated [default: primary, shadow, diffuse, random]
    #[arg(long, short, value_name = "KIND")]
    pub workload: Vec<WorkloadKind>,
    /// Rays of a workload that are timed, at most, in whole tiles of the scene's picture; or a file of rays to replay
    #[arg(long, value_name = "N|all|F.rays", default_value = "all")]
    pub rays: RaySource,
    #[command(flatten)]
    pub measuring: Measuring<4, 1, 2>,
    /// A coarse answer within seconds: up to three epochs of few rays, without brute-force unless it is named, and no further epoch
    /// that would take a scene beyond 4 s
    #[arg(long, conflicts_with_all = ["epochs", "runs", "budget"])]
    pub quick: bool,
    /// Print all columns: of builds, memory, tests, steps, checks, and ratios to both references
    #[arg(long)]
    pub wide: bool,
}

/// What a program may take for an answer.
const RUNNER_LIMIT: Seconds = Seconds::whole(120);

/// Of a quick run: its epochs and rays, what all epochs of a scene may take, the samples of one of them, and the triangle tests of all
/// checks together. These are totals, however many structures take part.
const QUICK_EPOCHS: u16 = 3;
const QUICK_RAYS: usize = 1 << 14;
const QUICK_NS: u64 = 4_000_000_000;
const QUICK_SAMPLES_NS: u64 = 250_000_000;
const QUICK_CHECKS: usize = 1 << 28;

/// The options of `study all`: all names, and each again over a triangle test of the other precision.
const FIELD: &str = "-s all -s median-kd:test=moller-trumbore -s sah-kd:test=moller-trumbore -s sah-kd-wide:test=moller-trumbore \
    -s sah-kd-tight:test=moller-trumbore -s sah-hybrid:test=moller-trumbore -s sah-bvh:test=moller-trumbore \
    -s obvhs-bvh2:test=exact -s obvhs-cwbvh:test=exact --epochs 4 --runs 1 --budget 4";

impl CompareArgs {
    /// The structures, the reference among them, and its label.
    fn chosen(&self, registry: &Registry) -> anyhow::Result<(Vec<Choice>, Option<String>)> {
        let mut structures = self.structures.chosen(registry, &[])?;
        structures.extend(self.runners()?);
        let Some(spec) = &self.reference else { return Ok((structures, None)) };
        if let Some(runner) = structures.iter().find(|choice| choice.label == *spec) {
            let label = runner.label.clone();
            return Ok((structures, Some(label)));
        }
        let quality = self.structures.quality.as_deref();
        let choice = sources::structures_at(registry, std::slice::from_ref(spec), quality)?.remove(0);
        if structures.iter().all(|other| other.label != choice.label) {
            structures.push(choice.clone());
        }
        Ok((structures, Some(choice.label)))
    }

    /// What is named, the reference among it.
    pub fn named(&self) -> Structures {
        let mut named = self.structures.clone();
        named.structure.extend(self.reference.clone());
        named
    }

    /// Rays of a workload that are timed, at most.
    fn most_rays(&self) -> usize {
        if self.quick { self.rays.count().min(QUICK_RAYS) } else { self.rays.count() }
    }

    /// The programs that take part, each once.
    fn runners(&self) -> anyhow::Result<Vec<Choice>> {
        let mut programs: Vec<Program> = vec![];
        for command in &self.runner {
            let program = Program::new(command, self.runner_limit.duration());
            let program = program.map_err(|problem| anyhow::anyhow!("--runner {command:?}: {problem}"))?;
            if let Some(other) = programs.iter().find(|other| other.name() == program.name()) {
                anyhow::ensure!(
                    other == &program,
                    "--runner {command:?} and --runner {:?} have one name, {}: call a file otherwise",
                    other.command(),
                    program.name()
                );
                continue;
            }
            programs.push(program);
        }
        Ok(programs.into_iter().map(Choice::of_program).collect())
    }

    /// Scenes, and the settings for them.
    ///
    /// # Errors
    /// If the options name what is not there.
    pub fn settings(&self, registry: &Registry) -> anyhow::Result<(Vec<Scene>, Settings)> {
        let (structures, _) = self.chosen(registry)?;
        let (scenes, asked) = match replayed(&self.rays, &self.scenes.scenes)? {
            Some((scene, file)) => {
                self.from.is_unasked()?;
                anyhow::ensure!(self.workload.is_empty(), "the rays are those of the file: leave --workload out");
                (vec![scene], Asked::Replayed(file.workload, self.most_rays()))
            }
            None => {
                let kinds = kinds(&self.workload, &WORKLOADS);
                let scenes = self.scenes.read(&[])?.into_iter().map(|scene| self.from.of(scene));
                (scenes.collect::<anyhow::Result<_>>()?, Asked::Kinds(kinds, self.most_rays()))
            }
        };
        let settings = self.measuring.settings(registry, with_twin(structures), asked)?;
        let mut settings = Settings { slowest: SLOWEST, detailed: true, ..settings };
        if self.quick {
            if !self.named().names_brute_force() {
                settings.structures.retain(|choice| choice.entry.name != BRUTE_FORCE);
            }
            let tests: BTreeSet<&str> = settings.structures.iter().map(Choice::triangle_test).collect();
            let kinds = match &settings.asked {
                Asked::Replayed(..) => 1,
                _ => kinds(&self.workload, &WORKLOADS).len(),
            };
            settings.check_tests = QUICK_CHECKS / (tests.len() * kinds).max(1);
            settings.budget_ns = QUICK_SAMPLES_NS;
        }
        Ok((scenes, settings))
    }
}

impl Study for CompareStudy {
    const NAME: &'static str = "compare";
    const QUESTION: &'static str = "How fast is every structure, and is it right?";
    const SCENE_BY_SCENE: bool = true;
    const KEPT: bool = false;
    const FULL: &'static str = FIELD;
    const QUICK: &'static str = "cube torus --rays 16384 --epochs 2 --runs 2 --budget 1";

    type Args = CompareArgs;
    type Case = Epoch;
    type Answer = Compared;

    fn command() -> String {
        "sahara compare --dir runs".into()
    }

    fn plan(args: &CompareArgs, registry: &Registry) -> anyhow::Result<Plan<Epoch>> {
        let (mut scenes, settings) = args.settings(registry)?;
        scenes.sort_by_key(|scene| scene.mesh.len());
        let inputs = args.scenes.files().into_iter().chain(args.rays.file().map(Into::into)).collect();
        let epochs = if args.quick { QUICK_EPOCHS } else { args.measuring.epochs };
        let mut of_large = settings.clone();
        of_large.structures.retain(|choice| choice.entry.name != BRUTE_FORCE);
        let (all, named) = (settings.structures.clone(), args.named());
        let is_large = move |scene: &Scene| all.iter().any(|choice| named.leaves_out(choice, scene.mesh.len()));
        let notes: Vec<String> = scenes.iter().filter(|scene| is_large(scene)).map(left_out).collect();
        let settings = vec![settings, of_large];
        let which = move |scene: &Scene| usize::from(is_large(scene));
        let plan = epoch::plan(settings, which, scenes, epochs, |_, _, epoch| Ok(epoch));
        let mut plan = Plan { inputs, ..plan.scene_by_scene() };
        plan.notes.extend(notes);
        if args.quick {
            plan.limit_ns = Some(QUICK_NS);
            plan.notes
                .push("Coarse: few rays, few checks and up to three epochs. Without --quick it is measured.".into());
        }
        Ok(plan)
    }

    fn answer(cases: &[Epoch], context: &Context<Self>) -> Compared {
        // As the structure is called that the records know: its label, if it has one by that name.
        let compared = compared(cases, context.provenance);
        let reference = context.args.and_then(|args| args.reference.clone());
        let label = reference.map(|spec| {
            let known = compared.records.iter().find(|r| r.label.eq_ignore_ascii_case(&spec));
            known.map_or(spec, |record| record.label.clone())
        });
        let wide = context.args.is_some_and(|args| args.wide);
        Compared { reference: label, wide, ..compared }
    }

    fn tables(answer: &Compared) -> Vec<Table> {
        tables(answer, scene_table)
    }

    fn summary(answer: &Compared) -> Vec<Table> {
        summary(answer, &answer.references(&answer.records))
    }

    fn legend(answer: &Compared) -> Vec<String> {
        let records = &answer.records;
        let mut all = vec![];
        if let Some(first) = records.first() {
            all = details_legend(&first.workload);
            all.extend(legend(records, &answer.references(records)));
            if records.iter().all(|r| r.instructions_per_ray.is_none()) {
                all.push("Instructions are not counted: the system offers no counter of them here.".into());
            }
        }
        all.extend(refusals(&answer.refused));
        all
    }

    fn printed(answer: &Compared) -> Printed {
        if answer.wide {
            let (tables, summary) = (Self::tables(answer), Self::summary(answer));
            return Printed { tables, summary, legend: Self::legend(answer) };
        }
        let references = answer.references(&answer.records);
        let last = &references[references.len().saturating_sub(1)..];
        let mut legend = if answer.records.is_empty() { vec![] } else { legend(&answer.records, last) };
        legend.extend(refusals(&answer.refused));
        Printed { tables: tables(answer, brief_table), summary: summary(answer, last), legend }
    }

    fn remarks(answer: &Compared) -> Vec<String> {
        winner(&answer.records, answer.reference.as_deref()).into_iter().map(|winner| winner.sentence).collect()
    }

    fn troubles(cases: &[Epoch]) -> Vec<Trouble> {
        // The tables tell them.
        troubles(cases).into_iter().map(|trouble| Trouble { sentence: String::new(), ..trouble }).collect()
    }

    fn warnings(answer: &Compared) -> Vec<String> {
        let all = distinct(answer.records.iter().flat_map(|r| &r.provenance.warnings));
        // Those of several scenes that differ in their numbers alone are one.
        let words = |warning: &str| warning.replace(|c: char| c.is_ascii_digit() || c == '.', "");
        let warnings = grouped(all, |a, b| words(a) == words(b));
        let told = |alike: Vec<String>| match alike.len() {
            1 => alike[0].clone(),
            n => format!("{} (the first of {n} scenes of which that is so)", alike[0]),
        };
        warnings.into_iter().map(told).collect()
    }

    fn data(answer: &Compared) -> Vec<Data> {
        vec![Data::new("records", &answer.records)]
    }

    fn statements(answer: &Compared) -> Vec<Statement> {
        section::statements(&answer.records)
    }

    fn section(answer: &Compared, command: &str) -> Vec<Block> {
        section::blocks(&answer.records, command)
    }

    fn json(answer: &Compared, _: &Provenance) -> Vec<u8> {
        to_json(&answer.records)
    }

    fn csv(answer: &Compared, _: &Provenance) -> Vec<u8> {
        to_csv(&answer.records)
    }

    fn read(value: &Value) -> Option<serde_json::Result<Compared>> {
        value.get(0)?.get("workload_hash")?;
        let records = serde_json::from_value::<Vec<Record>>(value.clone());
        Some(records.map(|records| Compared { records, ..Compared::default() }))
    }

    fn merge(old: &mut Compared, new: Compared) -> bool {
        let before = old.records.len();
        // Times of different runs are no pairs: a scene is of one run.
        old.records.retain(|old| new.records.iter().all(|new| new.scene != old.scene));
        old.refused.retain(|old| new.records.iter().all(|new| new.scene != old.scene));
        let is_replaced = old.records.len() < before;
        old.records.extend(new.records);
        old.refused.extend(new.refused);
        is_replaced
    }

    fn scenes(answer: &Compared) -> Vec<SceneId> {
        answer.records.iter().map(SceneId::of).collect()
    }
}

fn tables(answer: &Compared, table: impl Fn(&[Record], &[Reference], &[Refused]) -> Table) -> Vec<Table> {
    let scenes = distinct(answer.records.iter().map(|r| &r.scene).chain(answer.refused.iter().map(|r| &r.scene)));
    let of = |scene: &String| {
        let records: Vec<Record> = answer.records.iter().filter(|r| r.scene == *scene).cloned().collect();
        let refused: Vec<Refused> = answer.refused.iter().filter(|r| r.scene == *scene).cloned().collect();
        let mut table = table(&records, &answer.references(&records), &refused);
        if records.is_empty() {
            table.title = format!("{scene}: every structure is refused, or no ray is left");
        }
        table
    };
    scenes.iter().map(of).collect()
}

fn summary(answer: &Compared, references: &[Reference]) -> Vec<Table> {
    let several = answer.records.iter().any(|r| r.scene != answer.records[0].scene);
    let means = several.then(|| mean_table(&answer.records, references));
    means.into_iter().filter(Table::says_something).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::report::example;
    use crate::study::chosen::args;
    use crate::study::{Chosen, Effort};

    #[test]
    fn warnings_that_differ_in_their_numbers_alone_are_one() {
        let record = |warnings: &[&str]| {
            let mut record = example();
            record.provenance.warnings = warnings.iter().map(|&warning| warning.into()).collect();
            record
        };
        let records =
            vec![record(&["made way 3 times in 1.5 s", "hot"]), record(&["made way 40 times in 12 s", "hot"])];
        let warnings = CompareStudy::warnings(&Compared { records, ..Compared::default() });
        assert_eq!(warnings, ["made way 3 times in 1.5 s (the first of 2 scenes of which that is so)", "hot"]);
    }

    #[test]
    fn brute_force_takes_part_in_a_quick_run_where_it_is_named_alone() {
        use clap::{Args as _, FromArgMatches as _};
        let registry = Registry::builtin();
        let takes_part = |words: &[&str]| {
            let command = CompareArgs::augment_args(clap::Command::new("compare"));
            let matches = command.get_matches_from([&["compare", "cube", "--quick"], words].concat());
            let (_, settings) = CompareArgs::from_arg_matches(&matches).unwrap().settings(&registry).unwrap();
            settings.structures.iter().any(|choice| choice.entry.name == BRUTE_FORCE)
        };
        assert!(!takes_part(&[]) && !takes_part(&["-s", "all"]) && !takes_part(&["-s", "sah-kd"]));
        assert!(takes_part(&["-s", "all", "-s", BRUTE_FORCE]));
        assert!(takes_part(&["--reference", BRUTE_FORCE]) && takes_part(&["-s", "sah-kd", "--reference", BRUTE_FORCE]));
    }

    #[test]
    fn study_all_compares_every_structure_with_right_answers_and_in_single_precision() {
        let registry = Registry::builtin();
        let args = args::<CompareStudy>(Chosen::Preset(Effort::Full, vec![])).unwrap();
        let (chosen, _) = args.chosen(&registry).unwrap();
        let labels: Vec<&str> = chosen.iter().map(|choice| choice.label.as_str()).collect();
        for name in registry.names() {
            assert!(labels.contains(&name), "{name} is not among {labels:?}");
        }
        assert_eq!(labels.len(), registry.names().len() + FIELD.matches("-s ").count() - 1);
    }
}
