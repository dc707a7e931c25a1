//! What becomes of a run in which scenes fail.

use super::epoch::tests::example;
use super::*;
use crate::measure::Threads;

/// Two epochs of the scenes a, b and c. With `FAILS` what measures the second of b dies, and that of c has other answers.
pub struct Tiny<const FAILS: bool>;

#[derive(clap::Args)]
pub struct TinyArgs {}

impl<const FAILS: bool> Study for Tiny<FAILS> {
    const NAME: &'static str = if FAILS { "failing" } else { "right" };
    const QUESTION: &'static str = "What becomes of a run in which scenes fail?";
    const SCENE_BY_SCENE: bool = true;

    type Args = TinyArgs;
    type Case = Epoch;
    type Answer = Vec<Epoch>;

    fn plan(_: &TinyArgs, _: &Registry) -> anyhow::Result<Plan<Epoch>> {
        let threads = Threads::new(1).map_err(anyhow::Error::msg)?;
        let measure: Measure<Epoch> = Box::new(|case, _, _| {
            let mut epoch = example(&case.title, 10, case.epoch, &[("x", 50, &[1000; 3])]);
            match case.key.as_str() {
                "b 1" if FAILS => return Err(StudyError::Process { key: case.key.clone(), cause: "it died".into() }),
                "c 1" if FAILS => epoch.structures[0].rays[0].checksum = 2,
                _ => {}
            }
            Ok(epoch)
        });
        let scenes = ["a", "b", "c"].map(|name| (name.to_owned(), format!("{name} 0")));
        let mut plan = Plan::of_scenes(&serde_json::Map::new(), threads, scenes, measure);
        let again = |case: &Planned| Planned { key: format!("{} 1", case.title), epoch: 1, ..case.clone() };
        let second: Vec<Planned> = plan.cases.iter().map(again).collect();
        plan.cases.extend(second);
        Ok(plan)
    }

    fn answer(cases: &[Epoch], _: &Context<Self>) -> Vec<Epoch> {
        cases.to_vec()
    }

    fn tables(answer: &Vec<Epoch>) -> Vec<Table> {
        epoch::scenes(answer).into_iter().map(|scene| titled(scene[0].scene.clone())).collect()
    }

    fn summary(answer: &Vec<Epoch>) -> Vec<Table> {
        let names: Vec<&str> = epoch::scenes(answer).into_iter().map(|scene| scene[0].scene.as_str()).collect();
        vec![titled(format!("mean of {}", names.join(" ")))]
    }

    fn data(_: &Vec<Epoch>) -> Vec<Data> {
        vec![]
    }
}

fn titled(title: String) -> Table {
    Table { title, ..Table::default() }
}

/// The titles of what is shown while a run goes on.
#[derive(Default)]
struct Shown(Vec<String>);

impl Screen for Shown {
    fn begin(&mut self, _: u64) {}
    fn case(&mut self, _: &str, _: u64) {}
    fn stage(&mut self, _: &Stage) {}
    fn done(&mut self) {}
    fn is_interrupted(&self) -> bool {
        false
    }
    fn is_watched(&self) -> bool {
        false
    }
    fn warn(&mut self, _: &[String]) {}
    fn table(&mut self, table: &Table) {
        self.0.push(table.title.clone());
    }
    fn end(&mut self) {}
}

#[test]
fn all_scenes_that_fail_are_told_and_cut_no_mean() {
    let (registry, folder, mut screen) = (Registry::empty(), tempfile::tempdir().unwrap(), Shown::default());
    let studies = Studies::empty().with::<Tiny<true>>();
    let mut run = Run {
        registry: &registry,
        others: &|| Ok(Answers::default()),
        folder: folder.path(),
        is_kept: false,
        fresh: false,
        processes: None,
        screen: &mut screen,
    };
    let study = studies.find("failing").unwrap();
    let measured = study.run(Chosen::Defaults, &mut run, &mut |_| Ok(())).unwrap();
    let told: Vec<String> = measured.failures.iter().map(ToString::to_string).collect();
    assert!(told.len() == 2 && told[0].contains("b 1: it died") && told[1].contains("rays of c: epoch 0"), "{told:?}");
    assert_eq!(measured.outcome, Status::Wrong, "wrong answers weigh more than a process that died");
    // What there is of b is shown, and is in no mean.
    assert_eq!(screen.0, ["a", "b (1 of 2 epochs)"]);
    let titles: Vec<&str> = measured.to_print.iter().map(|table| table.title.as_str()).collect();
    assert!(titles == ["mean of a"] && measured.answer.is_some(), "{titles:?}");
}
