//! Tests of the pages and files that `sahara report` writes.

use std::collections::BTreeSet;
use std::fs;
use std::path::PathBuf;

use super::{Document, Runs, Section, files, page};
use crate::builtin::Builtin;
use crate::measure::Provenance;
use crate::registry::Registry;
use crate::report::plot::Chart;
use crate::report::{Art, Block, Overlay};
use crate::request::{SceneRequest, ViewArgs};
use crate::study::Dataset;
use example::{Files, STUDIES, cube, export, folder, journal, measured, provenance, read, refused, runs, whole};

pub mod example;

fn document(runs: &Runs) -> Document {
    super::document(runs, &STUDIES, vec![])
}

fn forms(document: &Document) -> [String; 2] {
    [page(document), super::files::markdown(document)]
}

const EVIL: &str = "<script>alert(\"&'1'\")</script>";

#[test]
fn what_users_name_is_text_in_every_form() {
    let (document, runs) = whole(EVIL);
    let page = page(&document);
    assert!(!page.contains("<script>alert"), "a name became markup");
    assert!(page.contains("&lt;script&gt;alert(&quot;&amp;&#x27;1&#x27;&quot;)"), "the name is there as text");
    let files = files(&document, &runs);
    let (_, markdown) = files.iter().find(|(path, _)| path == "report.md").unwrap();
    assert!(!String::from_utf8(markdown.clone()).unwrap().replace("\\<", "").contains("<script>"));
    assert!(files.iter().all(|(path, _)| !path.contains("..") && !path.contains(['<', '"', '&'])), "{files:?}");

    // The text `</script>` in inspector data must not end the script element.
    let json = page.split("<script type=\"application/json\">").nth(1).unwrap().split("</script>").next().unwrap();
    let data: serde_json::Value = serde_json::from_str(json).unwrap();
    assert_eq!(data["command"], format!("sahara validate {EVIL} --ray"));
}

#[test]
fn the_page_asks_for_nothing_from_elsewhere() {
    let page = page(&cube().0);
    for attribute in ["src=", "href=", "url(", "@import", "srcset=", "action="] {
        for (at, _) in page.match_indices(attribute) {
            let value = page[at + attribute.len()..].trim_start_matches(['"', '\'']);
            assert!(value.starts_with('#') || value.starts_with("data:"), "{}", &page[at..at + 60]);
        }
    }
    assert!(!page.replace("http://www.w3.org/2000/svg", "").contains("http"), "no address at all");
}

#[test]
fn every_figure_has_a_name_of_its_own_a_caption_and_words_for_those_who_do_not_see() {
    let (document, _) = cube();
    let figures = document.figures();
    let ids: BTreeSet<&str> = figures.iter().map(|figure| figure.id.as_str()).collect();
    assert!(ids.len() == figures.len() && ids.contains("overlay") && ids.contains("overlay-v2"), "{ids:?}");
    let [page, markdown] = forms(document);
    assert_eq!(page.matches("<figcaption>").count(), figures.len());
    assert_eq!(page.matches("<figure ").count(), figures.len());
    let pictures = page.matches("<img src").count();
    assert!(pictures > 0 && pictures == page.matches("<img src=\"data:image/png;base64,").count());
    let charts = figures.iter().filter(|figure| matches!(figure.art, Art::Chart(_)));
    assert_eq!(page.matches("aria-label=\"A picture\"").count(), charts.count());
    assert_eq!(page.matches("<code>sahara study compare --dir runs</code>").count(), 1);
    assert!(markdown.contains("```console\nsahara study compare --dir runs\n```"));
    assert!(page.contains("<summary>More</summary>") && markdown.contains("**More**"));
    assert!(page.contains("The slider moves") && !markdown.contains("slider"));
}

#[test]
fn numbers_stand_to_the_right_and_sort_by_their_value() {
    let page = page(&cube().0);
    for cell in [
        "<th scope=\"row\" class=\"word\">sah-kd</th>",
        "<td class=\"best\" data-key=\"8.0\">8.00 [7.00, 9.00]</td>",
        "<td class=\"wrong\" data-key=\"0.3333333333333333\">3&#x2f;9 wrong</td>",
        "<td class=\"word\">right</td>",
    ] {
        assert!(page.contains(cell), "{cell}");
    }
}

#[test]
fn the_answer_goes_by_what_is_measured() {
    const HARD: [&str; 3] = ["Dragon", "Lucy", "Sponza"];
    const SAH: &str = "Would a SAH tree have been much faster on the hard scenes?";
    // Studies with scenes; expected title, verdict, count of numbers, parts of sentences, count of parts in a bar.
    type Case<'a> = (&'a [(&'a str, &'a [&'a str])], &'a str, &'a str, usize, &'a [&'a str], usize);
    let tally = "0 of 24 confirmed, 1 refuted, 0 undecided, 23 not measured";
    let own = "Of all structures sah-kd is the fastest.";
    let cases: [Case; 6] = [
        (&[("replicate", &HARD)], SAH, "Yes", 4, &["Primary rays are 8.00 times", tally], 1),
        (
            &[("replicate", &HARD), ("attribution", &HARD)],
            SAH,
            "Yes",
            4,
            &["Primary rays are 8.00 times", "On Dragon the plane", "On Lucy", "On Sponza", tally],
            2,
        ),
        (&[("replicate", &HARD), ("attribution", &["Lucy"])], SAH, "Yes", 4, &["Primary", "On Lucy", tally], 1),
        (
            &[("replicate", &["Lucy"]), ("attribution", &["Lucy"])],
            SAH,
            "Yes, on Lucy",
            1,
            &["Primary", "On Lucy", tally],
            2,
        ),
        (&[("compare", &["Cube"])], "Which structure is the fastest on Cube?", "sah-kd", 0, &[own, "replicate"], 0),
        (&[("attribution", &["Cube"])], SAH, "Not measured", 0, &["`sahara replicate` does"], 0),
    ];
    for (studies, title, verdict, numbers, sentences, parts) in cases {
        let document = document(&runs(studies));
        let answer = &document.answer;
        assert_eq!((document.title.as_str(), answer.verdict.as_str(), answer.numbers.len()), (title, verdict, numbers));
        assert_eq!(answer.sentences.len(), sentences.len(), "{:?}", answer.sentences);
        for (found, part) in answer.sentences.iter().zip(sentences) {
            assert!(found.contains(part), "{found}: {part}");
        }
        let found = answer.chart.as_ref().map_or(0, |chart| match chart {
            Chart::Bars(bars) => bars.parts.len(),
            _ => panic!("the answer has no bars"),
        });
        assert_eq!(found, parts, "{studies:?}");
        let missing: Vec<&str> = document.missing().iter().map(|missing| missing.command.as_str()).collect();
        assert_eq!(missing.len(), 3 - studies.len());
        for form in forms(&document) {
            assert!(form.contains("Not measured") && !form.contains("?."));
            assert!(missing.iter().all(|command| form.contains(*command)), "{missing:?}");
        }
    }
}

#[test]
fn a_section_says_what_is_found_judged_and_amiss_and_no_bare_name() {
    let (document, _) = cube();
    let blocks = |id: &str| &document.sections.iter().find(|section| section.id == id).unwrap().blocks;
    let texts: Vec<&str> = blocks("compare")
        .iter()
        .filter_map(|block| if let Block::Text(text) | Block::Note(text) = block { Some(text.as_str()) } else { None })
        .collect();
    assert_eq!(texts, ["Of all structures sah-kd is the fastest.", "None is wrong", "the clock was slow."]);
    let [Block::Text(_), Block::Table(verdicts)] = &blocks("replicate")[..] else { panic!("no verdicts") };
    assert_eq!(verdicts.rows[0][3].text(), "refuted");
}

#[test]
fn a_quick_look_says_so_before_its_verdict() {
    let of = |command: &str| {
        let files = journal("compare", &["Cube"], &provenance("x"));
        let text = String::from_utf8(files[0].1.clone()).unwrap().replace("study compare", command);
        forms(&document(&read(folder(&[("case.json", text.into_bytes())]).path())))
    };
    for form in of("study all --quick") {
        let (banner, verdict) = (form.find("A quick trial").unwrap(), form.find("sah-kd.").unwrap());
        assert!(banner < verdict, "{}", &form[..verdict.min(2000)]);
    }
    assert!(of("study all").iter().all(|form| !form.contains("A quick trial")));
}

#[test]
fn of_two_runs_the_newest_cases_count_and_what_is_not_shown_is_said() {
    let [old, new] = ["2026-01-01T00:00:00Z", "2026-01-02T00:00:00Z"].map(provenance);
    let other_cpu = Provenance { cpu: "another".into(), ..new.clone() };
    let other_commit = Provenance { commit: "decade".into(), ..new.clone() };
    let three = ["Cube", "Dragon", "Lucy"];
    let again: Files = journal("compare", &["Cube"], &new);
    let again = again.into_iter().map(|(name, text)| (name, String::from_utf8(text).unwrap().replace("8000", "8001")));
    let again: Files = again.map(|(name, text)| (name, text.into_bytes())).collect();
    // Files added to a journal of three scenes; expected shown scenes, hidden scenes, and part of the only note.
    type Case<'a> = (Files, &'a [&'a str], &'a [&'a str], &'a str);
    let cases: [Case; 6] = [
        (export("compare", &three, &old), &three, &[], ""),
        (again, &three, &[], "compare: 1 case was measured again"),
        (journal("compare", &["Torus"], &new), &["Cube", "Dragon", "Lucy", "Torus"], &[], ""),
        (journal("compare", &["Torus"], &other_cpu), &three, &["Torus"], ""),
        (export("compare", &["Torus"], &other_commit), &three, &["Torus"], ""),
        (export("compare", &["Cube"], &other_commit), &three, &["Cube"], ""),
    ];
    for (beside, shown, others, note) in cases {
        let [one, other] = [&journal("compare", &three, &old), &beside].map(|files| folder(files));
        for order in [[&one, &other], [&other, &one]] {
            let runs = Runs::read(&order.map(|folder| folder.path().to_path_buf()), &STUDIES).unwrap();
            let run = runs.of("compare").unwrap();
            let titles = |dataset: &Dataset| super::runs::scene_titles(dataset);
            assert_eq!(titles(&run.dataset), shown);
            assert_eq!(run.others.iter().flat_map(titles).collect::<Vec<String>>(), others);
            assert_eq!(runs.notes.len(), usize::from(!note.is_empty()), "{:?}", runs.notes);
            assert!(runs.notes.iter().all(|own| own.contains(note)), "{:?}", runs.notes);
            for form in forms(&document(&runs)) {
                let said = others.iter().all(|scene| form.contains(&format!("Measured but not shown: {scene} on ")));
                assert!(said && form.contains(note));
            }
        }
    }
}

#[test]
fn what_cannot_be_read_is_one_sentence() {
    let export = export("compare", &["Cube"], &provenance("x")).remove(0).1;
    let case = String::from_utf8(journal("compare", &["Cube"], &provenance("x")).remove(0).1).unwrap();
    let changed = |from: &str, to: &str| case.replacen(from, to, 1).into_bytes();
    let newer = String::from_utf8(export.clone()).unwrap().replacen("\"schema\":4", "\"schema\":5", 1);
    let cases: [(&str, Vec<u8>, &str); 7] = [
        ("torn.json", export[..export.len() / 2].to_vec(), "cannot be parsed"),
        ("other.json", b"{\"a\": 1}".to_vec(), "not a run of sahara"),
        ("half.json", case.as_bytes()[..case.len() / 2].to_vec(), "cannot be parsed"),
        ("astrology.json", changed("\"study\":\"compare\"", "\"study\":\"astrology\""), "astrology"),
        ("broken.json", changed("\"scene_hash\":", "\"scene_hush\":"), "missing field `scene_hash`"),
        ("old.json", changed("\"schema\":4", "\"schema\":3"), "has version 3"),
        ("newer.json", newer.into_bytes(), "has version 5"),
    ];
    for (name, bytes, part) in cases {
        let folder = folder(&[(name, bytes)]);
        let error = refused(folder.path().join(name)).to_string();
        assert!(error.contains(name) && error.contains(part) && error.lines().count() == 1, "{error}");
    }
    let missing = refused(PathBuf::from("no/such/file.json")).to_string();
    assert!(missing.contains("no/such/file.json"), "{missing}");
    let empty = tempfile::tempdir().unwrap();
    assert!(refused(empty.path().into()).to_string().contains("sahara study all"));
}

#[test]
fn what_is_no_run_is_left_out_of_a_folder_and_named() {
    let mut files = export("compare", &["Cube"], &provenance("x"));
    files.push(("notes.json".into(), b"[{\"claim\": \"x\"}]".to_vec()));
    let (folder, run) = (folder(&files), files[0].0.clone());
    let runs = read(folder.path());
    assert!(runs.of("compare").is_some() && runs.notes[0].ends_with("notes.json is not a run: ignored."));
    fs::remove_file(folder.path().join(run)).unwrap();
    assert!(refused(folder.path().into()).to_string().contains("there is no run"));
}

#[test]
fn the_folder_of_a_report_has_all_numbers_for_programs() {
    let (document, runs) = cube();
    let files = files(document, runs);
    let rows = |name: &str| -> Vec<Vec<String>> {
        let (_, bytes) = files.iter().find(|(path, _)| path == name).unwrap_or_else(|| panic!("no {name}"));
        let csv = csv::ReaderBuilder::new().has_headers(false).from_reader(&bytes[..]);
        csv.into_records().map(|row| row.unwrap().iter().map(String::from).collect()).collect()
    };
    let data = rows("data/compare.csv");
    assert_eq!(data[0], ["scene", "label", "mrays_per_s", "leaves"]);
    assert_eq!((data.len(), &data[2][..2], &*data[2][3]), (3, &["Cube".to_owned(), "sah-kd".into()][..], "8"));
    for figure in document.figures() {
        assert_eq!(rows(&format!("figures/{}.csv", figure.id)).len(), 1 + figure.data.rows.len());
    }
}

#[test]
fn scenes_are_drawn_as_they_were_measured_and_those_that_are_gone_are_named() {
    let scene = Builtin::find("cube").unwrap().scene(None).unwrap();
    let mut all = ["Cube", "gone"].map(|name| measured("compare", name));
    all[0].case.scene = SceneRequest::new("cube", &ViewArgs::default(), &scene);
    let dataset = Dataset::new(provenance("x"), all.into());
    let runs = read(folder(&[("compare.json", dataset.to_json())]).path());
    let sections = super::draw(&runs, &Registry::builtin(), &mut |_| ());
    let [scenes, heat, errors]: &[Section; 3] = sections.as_slice().try_into().unwrap();
    let [Block::Figure(pictures), Block::Missing(gone)] = &scenes.blocks[..] else { panic!("{:?}", scenes.blocks) };
    assert!(pictures.pictures()[0].note == "12 triangles" && gone.what.contains("gone"));
    let Block::Figure(figure) = &heat.blocks[1] else { panic!("no heat") };
    assert_eq!((figure.id.as_str(), figure.pictures().len()), ("heat-cube", 2));
    // The script of the page reads these fields.
    let Art::Overlay(Overlay { inspector: data, .. }) = &figure.art else { panic!("no overlay") };
    let names = |data: &serde_json::Value| data.as_object().unwrap().keys().cloned().collect::<Vec<_>>().join(" ");
    assert_eq!(names(data), "size which command pixels rays truths answers structures");
    assert_eq!(names(&data["structures"][1]), "label nodes leaves tests answers");
    assert!(heat.command.starts_with("sahara render cube --view heat --hottest "), "{}", heat.command);
    assert!(matches!(&errors.blocks[1], Block::Text(text) if text.contains("is correct with median-kd and sah-kd")));
}
