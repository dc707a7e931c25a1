//! The eight expectations. Pure functions of what was measured.

use super::counted::{CROWDED, TREES};
use super::rank::{kendall, mean};
use super::{Finding, Inputs, Prediction, Verdict};
use crate::measure::Interval;
use crate::report::Record;
use crate::report::number::{count, figures};
use crate::scene::WorkloadKind;
use crate::study::attribution::{Attribution, CellResult};
use crate::study::baselines::{REPORT_TREE, SAH_TREE};
use crate::study::replicate::original::MAIN;
use crate::study::scaling::{Family, Growth, Point};
use crate::study::{BRUTE_FORCE, interval_text};

/// All of them, in order.
pub fn result(inputs: &Inputs) -> Vec<Prediction> {
    vec![
        rays(inputs),
        brute_force(inputs),
        crowded(inputs),
        growth(inputs),
        speedup(inputs),
        architecture(inputs),
        ranking(inputs),
        depth(inputs),
    ]
}

/// `complete`: whether all that the claim speaks of is measured; a part of it can refute the claim, but not confirm it.
fn prediction(
    number: u8,
    claim: &str,
    findings: Vec<Finding>,
    complete: bool,
    why: String,
    command: &str,
) -> Prediction {
    let verdict = if findings.iter().any(|finding| !finding.holds) {
        Verdict::Refuted
    } else if complete && !findings.is_empty() {
        Verdict::Confirmed
    } else {
        Verdict::NotMeasured
    };
    Prediction {
        number,
        claim: claim.into(),
        verdict,
        why: if findings.is_empty() { String::new() } else { why },
        command: (!complete || findings.is_empty()).then(|| command.into()),
        findings,
    }
}

/// `a, b and c`.
fn listed(items: &[String]) -> String {
    match items {
        [] => String::new(),
        [only] => only.clone(),
        [first @ .., last] => format!("{} and {last}", first.join(", ")),
    }
}

fn rays(inputs: &Inputs) -> Prediction {
    // Scenes with creatures of our own have rays of their own.
    let of = inputs.counted.iter().filter(|case| case.scene != "Starters");
    let findings: Vec<Finding> = of
        .map(|case| {
            let difference = case.rays as f64 - case.report_rays as f64;
            Finding::exact(format!("{}: rays more than the report's", case.scene), difference, -2.0, 2.0)
        })
        .collect();
    let off: Vec<String> = findings
        .iter()
        .filter(|f| !f.holds)
        .map(|f| format!("{} is {} rays off", f.what.split(':').next().unwrap_or(""), f.value.estimate))
        .collect();
    let why: String = if off.is_empty() {
        "Scenes, meshes and the rules by which rays are cast are the report's.".into()
    } else {
        let total: u64 =
            inputs.counted.iter().filter(|case| case.scene == "Cornellbox").map(|case| case.report_rays).sum();
        let cornell = if off.iter().any(|text| text.starts_with("Cornellbox")) {
            format!(
                " The report does not tell that the back wall of Cornellbox is a mirror; with a mirror there, so few of {} rays are \
                 unexplained.",
                count(total)
            )
        } else {
            String::new()
        };
        format!("{}.{cornell}", listed(&off))
    };
    let moved = |case: &&super::Case| case.default_rays != case.rays;
    let moved: Vec<String> = inputs
        .counted
        .iter()
        .filter(moved)
        .map(|case| format!("{} ({:+})", case.scene, case.default_rays as f64 - case.rays as f64))
        .collect();
    let exact = if moved.is_empty() {
        String::new()
    } else {
        format!(
            " Counted with a triangle test in single precision, as renderers like the report's have one; the default test, which decides \
             edges exactly, changes {}.",
            listed(&moved)
        )
    };
    let why: String = why + &exact;
    let complete = inputs.counted.len() == MAIN.len();
    prediction(
        1,
        "Ray counts are the report's, within 2 rays (Starters aside: its creatures are our own).",
        findings,
        complete,
        why,
        "sahara study predictions",
    )
}

fn brute_force(inputs: &Inputs) -> Prediction {
    let claim = "Without a tree t' is constant across scenes within a factor of 2, and the tree improves Torus and Sphere most, then Teapot, \
                 Metallic, Cornellbox, Starters, Billards, Infinitycandy, Cube.";
    let command = "sahara study all";
    let Some(replicated) = &inputs.replicated else {
        return prediction(2, claim, vec![], false, String::new(), command);
    };
    let main = |scene: &str| replicated.main.iter().find(|main| main.scene == scene);
    let t_primes = || replicated.main.iter().map(|main| (main.brute_force.t_prime, main));
    let (Some(most), Some(least)) =
        (t_primes().max_by(|a, b| a.0.total_cmp(&b.0)), t_primes().min_by(|a, b| a.0.total_cmp(&b.0)))
    else {
        return prediction(2, claim, vec![], false, String::new(), command);
    };
    let mut findings =
        vec![Finding::exact("largest t' without a tree over the smallest", most.0 / least.0, f64::NEG_INFINITY, 2.0)];
    const ORDER: [(&str, &str); 9] = [
        ("Torus", "Teapot"),
        ("Sphere", "Teapot"),
        ("Teapot", "Metallic"),
        ("Metallic", "Cornellbox"),
        ("Cornellbox", "Starters"),
        ("Starters", "Billards"),
        ("Billards", "Infinitycandy"),
        ("Infinitycandy", "Cube"),
        ("Torus", "Cube"),
    ];
    for (better, worse) in ORDER {
        if let (Some(a), Some(b)) = (main(better), main(worse)) {
            let ratio = quotient(a.improvement, b.improvement);
            findings.push(Finding::within(
                format!("improvement of {better} over that of {worse}"),
                ratio,
                1.0,
                f64::INFINITY,
            ));
        }
    }
    let mut why = format!(
        "t' is largest on {} ({} triangles) and smallest on {} ({}): eight triangles are tested at once, so that what a ray costs besides them \
         weighs most where they are few.",
        most.1.scene,
        count(most.1.triangles as u64),
        least.1.scene,
        count(least.1.triangles as u64)
    );
    let wrong: Vec<String> =
        findings[1..].iter().filter(|f| !f.holds).map(|f| f.what.replace("improvement of ", "")).collect();
    if !wrong.is_empty() {
        why += &format!(" Not in the order expected: {}.", listed(&wrong));
    }
    let complete = replicated.main.len() == MAIN.len();
    prediction(2, claim, findings, complete, why, command)
}

fn crowded(inputs: &Inputs) -> Prediction {
    let claim = "On Infinitycandy the report's tree does 0.9 to 1.3 tests per ray and triangle, and its setting 50 / 0.7 more than brute force.";
    let case = inputs.counted.iter().find(|case| case.scene == CROWDED && case.tests.len() == TREES.len());
    let Some(case) = case else {
        return prediction(3, claim, vec![], false, String::new(), "sahara study predictions");
    };
    let share = |tests: u64| tests as f64 / (case.rays as f64 * case.triangles as f64);
    let [report, other] = [share(case.tests[0]), share(case.tests[1])];
    let findings = vec![
        Finding::exact("100 / 0.7: tests per ray and triangle", report, 0.9, 1.3),
        Finding::exact("50 / 0.7: tests per ray and triangle", other, 1.0, f64::INFINITY),
    ];
    let why = if findings.iter().all(|f| f.holds) {
        "Most triangles are on both sides of the median plane: both children stay nearly as large as their parent."
            .into()
    } else {
        format!(
            "A hit ends the search as soon as nothing nearer can follow, so that the tree skips a share of {} of the tests with the default and \
             of {} with 50 / 0.7: what is on both sides of a plane is tested twice only by rays that pass both cells.",
            figures(1.0 - report),
            figures(1.0 - other)
        )
    };
    prediction(3, claim, findings, true, why, "sahara study predictions")
}

fn growth(inputs: &Inputs) -> Prediction {
    let claim = "Time per ray grows like n^b: with b near 1 by the report's rule on one mesh refined, with b at most 0.2 in a proper SAH tree.";
    let of = |structure: &str| {
        let spheres = inputs.scaling.iter().filter(|g| g.family == Family::Spheres && g.structure == structure);
        spheres.into_iter().find(|g| g.workload == WorkloadKind::Primary.name())
    };
    let (report, sah) = (of(REPORT_TREE), of(SAH_TREE));
    let mut findings = vec![];
    let mut why = String::new();
    if let Some(time) = report.and_then(|g| g.time) {
        findings.push(Finding::within("b of the report's tree", time, 0.8, 1.2));
    }
    if let Some(time) = sah.and_then(|g| g.time) {
        findings.push(Finding::within("b of the SAH tree", time, f64::NEG_INFINITY, 0.2));
    }
    if let (Some(report), Some(sah)) = (report, sah) {
        let power = |x: Option<Interval>| x.map_or("?".into(), |x| figures(x.estimate));
        why = format!(
            "Tests per ray grow like n^{} in the report's tree and n^{} in the SAH tree, steps like n^{} and n^{}.",
            power(report.tests),
            power(sah.tests),
            power(report.steps),
            power(sah.steps)
        );
        if findings.first().is_some_and(|f| !f.holds) {
            why += &refined(report);
        }
        if findings.get(1).is_some_and(|f| !f.holds) {
            why += " What grows beyond the counts is the time of a step: the tree no longer fits the caches.";
        }
    }
    let complete = findings.len() == 2;
    prediction(4, claim, findings, complete, why, "sahara study scaling")
}

/// What the finest mesh of a family asks of a tree, against the coarsest.
fn refined(growth: &Growth) -> String {
    let mut fitted = growth.points.iter().filter(|point| point.fitted);
    let (Some(first), Some(last)) = (fitted.next(), fitted.next_back()) else { return String::new() };
    let tests = |point: &Point| point.tests_per_ray.map_or("?".into(), figures);
    format!(
        " From {} to {} triangles the report's tree goes from {} to {} tests a ray, with {} and {} triangles a leaf: the finer the \
         mesh, the fewer of its triangles a median plane cuts, and a ray sees no more of the leaves.",
        count(first.triangles as u64),
        count(last.triangles as u64),
        tests(first),
        tests(last),
        figures(first.triangles as f64 / first.leaves.max(1) as f64),
        figures(last.triangles as f64 / last.leaves.max(1) as f64),
    )
}

const HARD: [&str; 3] = ["Dragon", "Lucy", "Sponza"];

/// The hard scenes, real or stood in for.
fn hard(inputs: &Inputs) -> impl Iterator<Item = &Attribution> {
    inputs
        .attribution
        .iter()
        .filter(|r| HARD.iter().any(|name| r.scene == *name || r.scene == format!("{name} (stand-in)")))
}

fn speedup(inputs: &Inputs) -> Prediction {
    let claim = "On Dragon, Lucy and Sponza the SAH tree is at least 20 times as fast as the report's; of that the plane alone, with the same leaves of at \
                 most 8 triangles, gives 1.2 to 5.";
    let mut findings = vec![];
    for r in hard(inputs) {
        findings.push(Finding::within(format!("{}: whole", r.scene), r.time.whole, 20.0, f64::INFINITY));
        findings.push(Finding::within(format!("{}: plane alone", r.scene), r.plane_alone, 1.2, 5.0));
    }
    let slow: Vec<String> = hard(inputs).filter(|r| r.time.whole.estimate < 20.0).map(whole_explained).collect();
    let large: Vec<String> =
        hard(inputs).filter(|r| r.plane_alone.estimate > 5.0).filter_map(plane_explained).collect();
    let mut why = vec![];
    if !slow.is_empty() {
        why.push(format!(
            "Fewer tests save less than in proportion, since eight triangles are tested at once: {}.",
            listed(&slow)
        ));
    }
    if !large.is_empty() {
        why.push(format!(
            "Small leaves do not help the median plane, which cuts triangles instead of parting them: with leaves of at most 8, {}.",
            listed(&large)
        ));
    }
    let complete = HARD.iter().all(|name| hard(inputs).any(|r| r.scene.starts_with(name)));
    prediction(5, claim, findings, complete, why.join(" "), "sahara study attribution dragon lucy sponza")
}

fn whole_explained(r: &Attribution) -> String {
    format!(
        "on {} the SAH tree does {} times fewer tests and {} times fewer steps",
        r.scene,
        figures(r.tests.whole.estimate),
        figures(r.steps.whole.estimate)
    )
}

fn plane_explained(r: &Attribution) -> Option<String> {
    let cell = |plane: &str| -> Option<&CellResult> {
        r.cells.iter().find(|c| c.plane == plane && c.stop == "leaf 8" && c.traversal == "plane intervals")
    };
    let (median, sah) = (cell("vertex median cyclic")?, cell("SAH exact")?);
    Some(format!(
        "{} has {} references for each triangle and does {} tests and {} steps a ray against {}, {} and {}",
        r.scene,
        figures(median.duplication),
        figures(median.tests_per_ray),
        figures(median.steps_per_ray),
        figures(sah.duplication),
        figures(sah.tests_per_ray),
        figures(sah.steps_per_ray)
    ))
}

fn architecture(inputs: &Inputs) -> Prediction {
    let claim = "An architectural scene (Sponza) gains more from SAH than evenly tessellated scans (Dragon, Lucy).";
    let mut findings = vec![];
    let mut why = vec![];
    for stand_in in [false, true] {
        let of = |name: &str| hard(inputs).find(|r| r.stand_in == stand_in && r.scene.starts_with(name));
        let Some(sponza) = of("Sponza") else { continue };
        for scan in [of("Dragon"), of("Lucy")].into_iter().flatten() {
            let ratio = quotient(sponza.time.whole, scan.time.whole);
            let finding = Finding::within(
                format!("gain on {} over that on {}", sponza.scene, scan.scene),
                ratio,
                1.0,
                f64::INFINITY,
            );
            if !finding.holds {
                let report = |r: &Attribution| figures(r.cells[0].tests_per_ray);
                let sah = |r: &Attribution| r.cells.last().map_or(String::new(), |cell| figures(cell.tests_per_ray));
                why.push(format!(
                    "on {} the report's tree does {} tests a ray and the SAH tree {}, on {} {} and {}",
                    sponza.scene,
                    report(sponza),
                    sah(sponza),
                    scan.scene,
                    report(scan),
                    sah(scan)
                ));
            }
            findings.push(finding);
        }
    }
    let why = if why.is_empty() { String::new() } else { format!("Where the scan gains more: {}.", listed(&why)) };
    let complete = findings.len() >= 2;
    prediction(6, claim, findings, complete, why, "sahara study attribution dragon lucy sponza")
}

/// A family well ranked, and one badly ranked, begin here.
const WELL: f64 = 0.7;
const BADLY: f64 = 0.5;

fn ranking(inputs: &Inputs) -> Prediction {
    let claim = "SAH cost ranks trees of one family well (Kendall's tau of cost and time at least 0.7) and trees of different families badly (below 0.5).";
    // One family: the trees of the factorial that are walked alike.
    let mut within: Vec<(f64, &str)> = vec![];
    for r in &inputs.attribution {
        for traversal in ["child boxes", "plane intervals"] {
            let trees = r.cells.iter().filter(|cell| cell.traversal == traversal);
            let pairs: Vec<(f64, f64)> = trees.filter_map(|cell| Some((cell.sah_cost?, cell.ns_per_ray))).collect();
            within.extend(kendall(&pairs, |_, _| true).map(|tau| (tau, r.scene.as_str())));
        }
    }
    let least = within.iter().min_by(|a, b| a.0.total_cmp(&b.0)).copied();
    let within: Vec<f64> = within.into_iter().map(|(tau, _)| tau).collect();
    let across: Vec<f64> = groups(&inputs.compare).iter().filter_map(|group| across(group)).collect();
    let mut findings = vec![];
    if let Some(tau) = mean(&within) {
        findings.push(Finding::within(
            format!("tau within a family, mean of {}", within.len()),
            tau,
            WELL,
            f64::INFINITY,
        ));
    }
    if let Some(tau) = mean(&across) {
        findings.push(Finding::within(
            format!("tau across families, mean of {}", across.len()),
            tau,
            f64::NEG_INFINITY,
            BADLY,
        ));
    }
    let mut why = String::new();
    if let (Some((tau, scene)), true) = (least, findings.iter().any(|f| f.what.contains("within") && !f.holds)) {
        why += &format!(
            "Within the family it is least on {scene}, {}: the cost counts triangles one by one where eight are tested at once, and random \
             lines where rays come from an eye. ",
            figures(tau)
        );
    }
    if findings.iter().any(|f| f.what.contains("across") && !f.holds) {
        why += "Across families the report's tree is so much dearer than the others that cost finds it, whatever else it confuses. ";
    }
    if findings.len() == 1 {
        let missing = if within.is_empty() {
            "the factorial (sahara study attribution)"
        } else {
            "other families (sahara study all)"
        };
        why += &format!("Half of it is not measured: {missing}.");
    }
    let complete = findings.len() == 2;
    prediction(7, claim, findings, complete, why.trim().into(), "sahara study all")
}

/// The records of one scene and one kind of rays.
fn groups(records: &[Record]) -> Vec<Vec<&Record>> {
    let mut groups: Vec<Vec<&Record>> = vec![];
    for record in records.iter().filter(|r| r.structure != BRUTE_FORCE && r.trace_ns.is_some()) {
        let same = |group: &&mut Vec<&Record>| {
            group[0].scene_hash == record.scene_hash && group[0].workload == record.workload
        };
        match groups.iter_mut().find(same) {
            Some(group) => group.push(record),
            None => groups.push(vec![record]),
        }
    }
    groups
}

/// Kendall's tau over couples of different families.
fn across(group: &[&Record]) -> Option<f64> {
    let known: Vec<(&str, (f64, f64))> = group
        .iter()
        .filter_map(|r| Some((family(&r.structure), (r.counts.sah_cost?, r.trace_ns? / r.rays as f64))))
        .collect();
    let pairs: Vec<(f64, f64)> = known.iter().map(|(_, pair)| *pair).collect();
    kendall(&pairs, |i, j| known[i].0 != known[j].0)
}

/// Structures with the same kind of cells and the same width of nodes.
fn family(structure: &str) -> &str {
    match structure {
        REPORT_TREE | SAH_TREE => "binary kd-tree",
        "sah-kd-wide" | "sah-kd-tight" => "wide kd-tree",
        other => other,
    }
}

fn depth(inputs: &Inputs) -> Prediction {
    let claim = "On a CPU as on GPUs a KD-tree overtakes a BVH at high depth complexity (open in the literature).";
    let mut findings = vec![];
    let mut crossings = vec![];
    for race in &inputs.crossover {
        let Some(last) = race.members.last() else { continue };
        let pair = format!("{} / {}, {} rays", short(&race.kd), short(&race.bvh), race.workload);
        let what = format!("{pair}, {} surfaces: time", figures(last.complexity));
        findings.push(Finding::within(what, last.ratio, f64::NEG_INFINITY, 1.0));
        if let Some(crossing) = race.crossings.iter().rev().find(|c| c.kd_wins_beyond && c.found >= 0.95) {
            crossings.push(format!("{pair}, at {} surfaces", interval_text(crossing.complexity)));
        }
    }
    // Whether it gains at all: the sign of the trend, where that is sure.
    let trends = || inputs.crossover.iter().filter_map(|race| race.trend);
    let gains = trends().filter(|trend| trend.high < 0.0).count();
    let losses = trends().filter(|trend| trend.low > 0.0).count();
    let overtakes = match crossings.len() {
        0 => "It is not seen to overtake anywhere".into(),
        _ => format!("It overtakes for {}", crossings.join("; ")),
    };
    let why = format!(
        "At the most surfaces the KD-tree is the faster one for {} of {} pairs and kinds of rays. {overtakes}. With growing depth complexity it surely \
         gains in {gains} of them and surely loses in {losses}.",
        findings.iter().filter(|finding| finding.holds).count(),
        findings.len(),
    );
    prediction(8, claim, findings, true, why, "sahara study crossover")
}

/// A label without its keys.
fn short(label: &str) -> &str {
    label.split(':').next().unwrap_or(label)
}

/// The quotient of two estimates that err independently: relative errors add in squares.
fn quotient(a: Interval, b: Interval) -> Interval {
    let log = |x: f64, y: f64| libm::fabs(libm::log(x / y));
    let estimate = a.estimate / b.estimate;
    let down = libm::hypot(log(a.estimate, a.low), log(b.high, b.estimate));
    let up = libm::hypot(log(a.high, a.estimate), log(b.estimate, b.low));
    Interval { estimate, low: estimate * libm::exp(-down), high: estimate * libm::exp(up) }
}
