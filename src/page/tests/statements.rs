//! What a report says must be true of the runs that it is made from, and of the form that it has.

use super::*;
use crate::page::pictures::draw;
use crate::registry::Registry;
use crate::report::document::Block;
use crate::scene::Scene;

#[test]
fn a_quick_look_says_so_before_its_verdict() {
    let quick = |record: Record| Record { provenance: provenance("sahara study all --quick"), ..record };
    let records = |quick_one: bool| {
        let all = records_of("Dragon").into_iter().map(|record| if quick_one { quick(record) } else { record });
        compared(&all.collect::<Vec<_>>())
    };
    for text in forms(&document(&records(true), vec![])) {
        let text = text.replace("\\-", "-").replace("--", "-").replace("\\_", "_");
        let (banner, verdict) = (text.find("A quick look").unwrap(), text.find("Yes, on Dragon").unwrap());
        assert!(banner < verdict, "{}", &text[..verdict.min(2000)]);
    }
    for text in forms(&document(&records(false), vec![])) {
        assert!(!text.contains("A quick look") && text.contains("Yes, on Dragon"));
    }
}

#[test]
fn only_a_page_speaks_of_a_slider() {
    let [page, markdown, latex] = forms(&cube().0);
    assert!(page.contains("the slider moves"));
    assert!(!markdown.contains("slider") && !latex.contains("slider"));
    let heat = draw(&of_scene("Cube"), (&Registry::builtin(), &Studies::builtin()), &find, &mut |_| ());
    let said = format!("{heat:?}");
    assert!(said.contains("Where the work is") && !said.contains("slider"));
}

#[test]
fn a_rank_says_whom_it_may_favour() {
    let said = "tuned on the meshes kitchen, sponza-nave, dragon-scan, bunny, lucy-scan and engine";
    for text in forms(&cube().0) {
        let text = text.split_whitespace().collect::<Vec<_>>().join(" ").replace("\\-", "-");
        assert!(text.contains(said) && text.contains("Neither obvhs nor any other peer was tuned by us"), "{text}");
    }
    let alone = [records_of("Cube").remove(0)];
    let runs = compared(&alone);
    assert!(!page(&document(&runs, vec![])).contains("tuned on"), "there is no rank");
}

fn of_scene(scene: &str) -> Runs {
    compared(&records_of(scene))
}

/// `Cube`, by its own name or as somebody's mesh.
fn find(name: &str) -> Option<Scene> {
    let cube = || crate::scene::Builtin::find("cube").unwrap().scene(None).unwrap();
    match name {
        "Cube" => Some(cube()),
        "mine" => Some(Scene { name: "mine".into(), ..cube() }),
        _ => None,
    }
}

#[test]
fn only_built_in_scenes_have_the_cameras_of_the_source_report() {
    let caption = |scene: &str, command: &str| {
        let command = format!("/opt/somewhere/sahara compare {command}");
        let of_command = |record| Record { provenance: provenance(&command), ..record };
        let records: Vec<Record> = records_of(scene).into_iter().map(of_command).collect();
        let runs = compared(&records);
        let sections = draw(&runs, (&Registry::builtin(), &Studies::builtin()), &find, &mut |_| ());
        let mut blocks = sections.into_iter().find(|section| section.id == "scenes").unwrap().blocks;
        let Block::Figure(figure) = blocks.remove(0) else { panic!("{scene} is not drawn") };
        figure.caption
    };
    let cube = caption("Cube", "cube");
    assert!(cube.contains("rendered by sahara with the source report's cameras") && !cube.contains("--"), "{cube}");
    let mine = caption("mine", "mine");
    assert!(mine.contains("the built-in ones with the source report's") && mine.contains("whole in view"), "{mine}");
    assert!(!mine.contains("--"), "{mine}");

    // Views that a command has asked for are those of no file.
    let inside = caption("mine", "mine --inside");
    assert!(inside.contains("whole in view") && inside.ends_with("; mine is seen from within (--inside)."), "{inside}");
    let looked = caption("Cube", "cube --camera '0,0,9 0,0,0'");
    assert!(looked.ends_with("; Cube is seen from where its command says (--camera)."), "{looked}");
}
