use std::process::Command;

use super::*;
use crate::accel::{Accel, DynAccel};
use crate::kdtree::{KdConfig, KdTree};
use crate::oracle::DepthRule;
use crate::scene::files::HitFile;
use crate::triangle::MollerTrumbore;
use crate::validate::count_errors;

const DOCUMENT: &str = include_str!("../../../images/scene/files/FORMAT.md");

#[test]
fn the_document_states_the_hash_of_the_corpus() {
    let line = format!("`{CORPUS_SHA256}`");
    assert!(DOCUMENT.lines().any(|own| own == line), "FORMAT.md does not contain {line}");
    let defaults = Args { scenes: vec![], output: "d".into(), rays: RAYS, seed: SEED };
    let others = [
        Args { scenes: vec!["cube".into()], output: "d".into(), ..defaults },
        Args { scenes: vec![], output: "d".into(), rays: RAYS + 1, ..defaults },
        Args { scenes: vec![], output: "d".into(), seed: SEED + 1, ..defaults },
    ];
    assert!(defaults.is_default() && !others.iter().any(Args::is_default));
}

#[test]
fn the_python_of_the_document_counts_the_errors_that_we_count() {
    if Command::new("python3").arg("--version").output().is_err() {
        println!("skipped: there is no python3 here");
        return;
    }
    let code = DOCUMENT.split("```python\n").nth(2).and_then(|rest| rest.split("```").next()).unwrap();
    assert!(code.lines().count() <= 30, "the document's judge is short");
    let folder = tempfile::tempdir().unwrap();
    let write = |name: &str, bytes: &[u8]| {
        let path = folder.path().join(name);
        std::fs::write(&path, bytes).unwrap();
        path
    };
    let script = write("judge.py", code.as_bytes());
    let judge = |(file, truth): &(RayFile, Vec<ExactHit>), hits: &PathBuf| {
        let truth = write("f.truth", &exact_hits_bytes(&file.workload, truth));
        Command::new("python3").args([&script, &truth, hits]).output().unwrap()
    };

    let scene = Builtin::find("cornellbox").unwrap().scene(None).unwrap();
    let oracle = Oracle::new(&scene.mesh);
    let tree = KdTree::<MollerTrumbore>::build(&scene.mesh, &KdConfig::SAH).unwrap();
    let mut wrong = 0;
    for kind in [RayKind::Vertex, RayKind::Edge] {
        let answered = rays_with_exact_hits(&scene, kind, 2000, 3, &oracle).unwrap();
        let workload = &answered.0.workload;
        let found = tree.closest(&workload.rays);
        let truths: Vec<_> = workload.rays.iter().map(|ray| oracle.nearest(ray)).collect();
        let ours = count_errors(&truths, &found, DepthRule::STRICT);
        let hits = HitFile::new(workload, found);
        let hits_path = folder.path().join("f.hits");
        hits.write(&crate::output::OutputFile::check(&hits_path).unwrap()).unwrap();

        let judged = judge(&answered, &hits_path);
        assert!(judged.status.success(), "{}", String::from_utf8_lossy(&judged.stderr));
        let expected = format!(
            "missed {}\nfalse hits {}\nwrong depth {}\nwrong primitive {}\n",
            ours.missed, ours.false_hits, ours.wrong_depth, ours.wrong_primitive
        );
        assert_eq!(String::from_utf8_lossy(&judged.stdout).replace('\r', ""), expected, "{}", kind.name());
        wrong += ours.errors();
    }
    assert!(wrong > 0, "without wrong hits, a program that finds no errors would pass");

    let other = rays_with_exact_hits(&scene, RayKind::Uniform, 10, 3, &oracle).unwrap();
    let refused = judge(&other, &folder.path().join("f.hits"));
    assert!(String::from_utf8_lossy(&refused.stderr).contains("the hits belong to other rays"));
}
