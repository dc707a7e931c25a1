use std::process::Command;

use super::*;
use crate::accel::{Accel, DynAccel, Query};
use crate::geometry::{Hit, Ray};
use crate::kdtree::{KdConfig, KdTree};
use crate::output::OutputFile;
use crate::scene::tests::of_the_report;
use crate::scene::{Sampling, Scene, Workload, WorkloadKind};
use crate::triangle::Exact;

fn scene() -> Scene {
    of_the_report("cornellbox")
}

fn tree(scene: &Scene) -> KdTree<Exact> {
    KdTree::build(&scene.mesh, &KdConfig::SAH).unwrap()
}

fn recorded(kind: WorkloadKind) -> (Scene, RayFile) {
    let scene = scene();
    let workload = Workload::new(&scene, kind, &Sampling::some(&scene, 400, 1), &tree(&scene));
    (scene.clone(), RayFile::new(&scene, workload))
}

#[test]
fn replayed_rays_are_the_recorded_ones_and_have_the_same_hits() {
    let directory = tempfile::tempdir().unwrap();
    for kind in WorkloadKind::ALL {
        let (scene, file) = recorded(kind);
        let path = directory.path().join(kind.name());
        file.write(&OutputFile::check(&path).unwrap()).unwrap();
        let back = RayFile::read(&path).unwrap();
        assert_eq!(back, file);
        assert_eq!(back.workload.hash(), file.workload.hash(), "{}", kind.name());
        back.check_scene(&scene).unwrap();
        if file.workload.rays.is_empty() {
            continue;
        }

        let hits = |workload: &Workload| HitFile::new(workload, tree(&scene).closest(&workload.rays));
        let (first, again) = (hits(&file.workload), hits(&back.workload));
        assert_eq!(first, again);
        assert_eq!(HitFile::from_bytes(&first.to_bytes()).unwrap(), first);
        assert_eq!(first.hits_of(&RaysId::of(&back.workload)).unwrap().len(), back.workload.rays.len());
    }
}

#[test]
fn damaged_files_are_refused_with_a_sentence() {
    let (_, file) = recorded(WorkloadKind::Diffuse);
    let whole = file.to_bytes();
    let refusal = |bytes: &[u8]| RayFile::from_bytes(bytes).unwrap_err();
    assert!(refusal(b"").contains("SAHARAYS") && refusal(b"PNG and so on, long enough").contains("SAHARAYS"));
    assert!(refusal(&whole[..whole.len() - 1]).contains("truncated"));
    let hits = HitFile::new(&file.workload, vec![None; file.workload.rays.len()]).to_bytes();
    for end in 0..whole.len().min(hits.len()) {
        assert!(RayFile::from_bytes(&whole[..end]).is_err() && HitFile::from_bytes(&hits[..end]).is_err(), "{end}");
    }
    assert!(refusal(&[&whole[..], &[0]].concat()).contains("1 bytes follow"));
    let changed = |at: usize, to: u8| {
        let mut bytes = whole.clone();
        bytes[at] = to;
        refusal(&bytes)
    };
    assert!(changed(8, 9).contains("version 9"));
    assert!(changed(12, 7).contains("query 7"));
    assert!(changed(23, 0xff).contains("truncated"));
    assert!(changed(67, 0xff).contains("truncated"));
    assert!(changed(72, 0xff).contains("UTF-8"));
    assert!(changed(72, 0x1b).contains("control character"));
    assert!(changed(whole.len() - 5, whole[whole.len() - 5] ^ 1).contains("changed"));

    let mut bad = file.clone();
    bad.workload.rays[3].direction.y = f32::NAN;
    assert!(refusal(&bad.to_bytes()).contains("ray 4 of "));
    bad.workload.rays.clear();
    assert!(refusal(&bad.to_bytes()).contains("no ray"));
}

#[cfg(target_os = "linux")]
#[test]
fn an_endless_file_is_refused_by_its_first_bytes() {
    for refusal in
        [RayFile::read(Path::new("/dev/zero")).unwrap_err(), HitFile::read(Path::new("/dev/zero")).unwrap_err()]
    {
        assert!(refusal.to_string().contains("it does not begin with"), "{refusal}");
    }
}

#[test]
fn rays_and_hits_of_another_scene_are_refused() {
    let (scene, file) = recorded(WorkloadKind::Primary);
    let other = of_the_report("cube");
    let refusal = file.check_scene(&other).unwrap_err();
    assert!(refusal.contains("Cornellbox") && refusal.contains("Cube"), "{refusal}");
    let free = RayFile { scene_hash: None, ..file.clone() };
    assert_eq!(RayFile::from_bytes(&free.to_bytes()).unwrap(), free);
    free.check_scene(&other).unwrap();

    let hits = HitFile::new(&file.workload, vec![Some(Hit::new(1.5, 7)); file.workload.rays.len()]);
    let mut turned = file.workload.clone();
    turned.rays[0] = Ray::new(turned.rays[0].origin, -turned.rays[0].direction);
    assert!(hits.hits_of(&RaysId::of(&turned)).unwrap_err().contains("hash"));
    let any = Workload { query: Query::Any, ..file.workload.clone() };
    assert!(hits.hits_of(&RaysId::of(&any)).unwrap_err().contains("\"any\""));
    let cut = HitFile::from_bytes(&hits.to_bytes()[..100]).unwrap_err();
    assert!(cut.contains("truncated"), "{cut}");
    assert!(HitFile::from_bytes(&file.to_bytes()).unwrap_err().contains("SAHAHITS"));
    drop(scene);
}

/// Runs the first Python program of FORMAT.md.
#[test]
fn the_python_of_the_document_reads_our_rays_and_writes_hits_that_we_read() {
    if Command::new("python3").arg("--version").output().is_err() {
        println!("skipped: there is no python3 here");
        return;
    }
    let text = include_str!("FORMAT.md");
    let code = text.split("```python\n").nth(1).and_then(|rest| rest.split("```").next()).unwrap();
    let functions = code.lines().filter(|line| !line.trim().is_empty() && !line.starts_with("import")).count();
    assert!(functions <= 20, "the document says twenty lines, not {functions}");

    let directory = tempfile::tempdir().unwrap();
    let (_, file) = recorded(WorkloadKind::Shadow);
    let (rays, hits) = (directory.path().join("f.rays"), directory.path().join("f.hits"));
    file.write(&OutputFile::check(&rays).unwrap()).unwrap();
    let call = "\nwrite_hits(sys.argv[2], query, digest, [(r[7], i) if i % 2 else (0.0, 0xFFFFFFFF) for i, r in enumerate(rays)])\n";
    let script = directory.path().join("read.py");
    std::fs::write(&script, code.to_owned() + call).unwrap();
    let output = Command::new("python3").arg(&script).args([&rays, &hits]).output().unwrap();
    let printed = String::from_utf8_lossy(&output.stdout);
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    let expected = format!("Cornellbox shadow 1 {} {} ", file.workload.hash(), file.workload.rays.len());
    assert!(printed.starts_with(&expected), "{printed}");

    let back = HitFile::read(&hits).unwrap();
    let hits = back.hits_of(&RaysId::of(&file.workload)).unwrap();
    for (i, (ray, hit)) in file.workload.rays.iter().zip(hits).enumerate() {
        assert_eq!(*hit, (i % 2 == 1).then(|| Hit::new(ray.t_max, i as u32)));
    }
}
