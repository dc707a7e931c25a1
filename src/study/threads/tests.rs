use super::speedup::serial_share;
use super::*;
use crate::study::epoch::tests::example;

/// Three epochs with 1, 2 and 4 threads, of which a share `f` of the rays' time and all of the build's is serial.
fn cases(f: f64, numbers: &[usize]) -> Vec<ThreadsEpoch> {
    let mut cases = vec![];
    for epoch in 0..3 {
        for &threads in numbers {
            let n = threads as f64;
            let off = if epoch == 1 { 1.01 } else { 1.0 };
            let ns = (1e8 * off * (f + (1.0 - f) / n)) as u64;
            let epoch = example("a", 1000, epoch, &[("sah-kd", 1_000_000, &[ns; 3])]);
            cases.push(ThreadsEpoch { threads, epoch });
        }
    }
    cases
}

#[test]
fn the_serial_share_is_found_where_there_is_one() {
    assert!((serial_share(&[(2, 0.6), (4, 0.4)]) - 0.2).abs() < 1e-12);
    assert!(serial_share(&[(2, 0.5), (8, 0.125)]).abs() < 1e-12 && serial_share(&[(2, 0.4)]) < 0.0);
    for f in [0.0, 0.1, 0.5] {
        let speedups = speedups(&cases(f, &[1, 2, 4]));
        assert_eq!(speedups.iter().map(|one| one.what.as_str()).collect::<Vec<_>>(), ["build", "primary"]);
        let [build, rays] = &speedups[..] else { panic!("{speedups:?}") };
        assert!((build.serial.estimate - 1.0).abs() < 1e-6 && (rays.serial.estimate - f).abs() < 1e-5, "{rays:?}");
        let threads: Vec<usize> = rays.points.iter().map(|point| point.threads).collect();
        assert_eq!(threads, [1, 2, 4]);
        assert!((rays.points[2].speedup.estimate - 1.0 / (f + (1.0 - f) / 4.0)).abs() < 1e-3, "{rays:?}");
        assert!(rays.points[2].speedup.interval.is_some() && rays.serial.interval.is_some());
    }
}

#[test]
fn without_one_thread_or_another_nothing_is_said() {
    assert!(speedups(&cases(0.5, &[2, 4])).is_empty() && speedups(&cases(0.5, &[1])).is_empty());
    assert!(speedups(&[]).is_empty() && ThreadsStudy::tables(&vec![]).is_empty());
}

#[test]
fn every_number_of_threads_is_a_column_and_a_point() {
    assert_eq!([2, 3, 8, 24].map(numbers), [vec![1, 2], vec![1, 2, 3], vec![1, 2, 4, 8], vec![1, 2, 4, 8, 16, 24]]);
    let speedups = speedups(&cases(0.25, &[1, 2, 3]));
    let [builds, rays] = &ThreadsStudy::tables(&speedups)[..] else { panic!("a table each") };
    assert_eq!(rays.columns, ["structure", "1 thread", "x with 2", "x with 3", "serial share"]);
    let data = &ThreadsStudy::data(&speedups)[0].rows;
    let names: Vec<&String> = data[0].as_object().unwrap().keys().collect();
    assert_eq!(
        (data.len(), names),
        (6, ["scene", "structure", "what", "threads", "ns", "speedup"].map(String::from).iter().collect())
    );
    assert!(builds.title.contains("builds") && rays.rows[0][4].text.starts_with("0.25"), "{rays:?}");
    assert_eq!(section::blocks(&speedups, "").len(), 4);
    assert!(rays.notes.iter().all(|note| !note.starts_with("Two points")));
    let told = &section::statements(&speedups)[0].sentence;
    assert!(told.starts_with("On a, 3 threads build sah-kd 1.00"), "{told}");
}

#[test]
fn two_points_are_told_in_table_and_figure() {
    let two = super::speedups(&cases(0.25, &[1, 2]));
    let tables = ThreadsStudy::tables(&two);
    assert!(tables.iter().all(|table| table.notes.iter().any(|note| note.starts_with("Two points"))), "{tables:?}");
    let figures = section::blocks(&two, "").into_iter().filter_map(|block| match block {
        Block::Figure(figure) => Some(figure.caption),
        _ => None,
    });
    assert!(figures.into_iter().all(|caption| caption.contains("Two points")));
}

#[test]
fn a_plan_starts_no_threads_and_a_case_those_of_its_own_alone() {
    use clap::{Args as _, FromArgMatches as _};
    let command = ThreadsArgs::augment_args(clap::Command::new("threads"));
    let matches =
        command.get_matches_from(["threads", "cube", "--most", "2", "--epochs", "2", "-s", "sah-kd", "--rays", "64"]);
    let args = ThreadsArgs::from_arg_matches(&matches).unwrap();
    let plan = ThreadsStudy::plan(&args, &Registry::builtin()).unwrap();
    assert_eq!((plan.cases.len(), plan.threads.count()), (4, 2));
    for case in &plan.cases[..2] {
        let threads = (plan.measure)(case, &crate::measure::SystemClock::start(), &mut |_| {}).unwrap().threads;
        assert!(case.title.ends_with(&format!(", {threads} threads")), "{}", case.title);
        assert!(!plan.threads.are_started());
    }
}
