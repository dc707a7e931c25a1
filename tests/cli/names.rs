//! Files of any name that the system supports: accepted unchanged, printed escaped.

use std::ffi::{OsStr, OsString};
use std::fs;
use std::os::unix::ffi::OsStrExt;
use std::path::Path;
use std::process::Command;

use super::command::{RIGHT, SQUARE, USAGE, command, ends, stderr};

/// Bytes that are not text, an escape sequence with a line break, and their printed forms.
const NAMES: [(&[u8], &str); 2] = [(b"gr\xfcn", "gr\\xfcn"), (b"a\x1b[31m\nb", "a\\u{1b}[31m\\nb")];

fn with_ending(name: &OsStr, ending: &str) -> OsString {
    let mut name = name.to_owned();
    name.push(ending);
    name
}

/// The output and messages of a line of words, which contain no terminal controls from the name; `@.obj` is the file
/// with that name and extension.
#[track_caller]
fn run(folder: &Path, name: &OsStr, line: &str, status: i32) -> String {
    let word = |word: &str| match word.strip_prefix('@') {
        Some(ending) => with_ending(name, ending),
        None => word.into(),
    };
    let mut command = command(&["--quiet"]);
    let (text, messages) = ends(status, command.args(line.split(' ').map(word)).current_dir(folder));
    let said = text + &messages;
    assert!(!said.contains('\u{1b}') && !said.contains('\u{fffd}'), "{said:?}");
    said
}

#[test]
fn files_of_any_name_are_taken_and_shown_escaped() {
    for (name, shown) in NAMES {
        let (folder, name) = (tempfile::tempdir().unwrap(), OsStr::from_bytes(name));
        let put = |ending: &str, text: &str| fs::write(folder.path().join(with_ending(name, ending)), text).unwrap();
        put(".obj", SQUARE);
        put(".txt", "0.5 0.5 1 0 0 -1\n");
        let scene =
            "camera = { eye = [0, 0, 5], target = [0, 0, 0], vertical_fov = 60 }\nobjects = [{ mesh = \"cube\" }]";
        put(".toml", &format!("name = \"Scene\"\n{scene}"));
        put("-bad.toml", scene);
        for (line, parts) in [
            ("compare @.obj -s sah-kd --rays 64 --epochs 1 --export-json @.json", &[shown, "4 triangles"][..1]),
            ("validate @.obj -s sah-kd --rays 64", &[shown]),
            ("render @.obj -o @.png --size 4x4", &[shown, "4 x 4"]),
            ("render @.toml -o @-2.png --size 4x4", &[shown, "Scene"]),
            ("rays record @.obj -o @.rays --rays 16", &[shown, "16 rays"]),
            ("rays show @.rays", &[shown, "16 rays"]),
            ("rays import @.txt -o @-2.rays --scene @.obj", &[shown, "1 ray"]),
            ("validate @.obj --rays @.rays -s sah-kd --export-hits @.hits", &[shown, "16 results"]),
            ("validate @.obj --rays @.rays --hits @.hits", &[shown]),
            ("rays corpus @.obj -o @.corpus --rays 4", &[shown]),
            ("study compare @.obj -s sah-kd --rays 16 --epochs 1 --dir @.runs", &[shown]),
            ("diff @.json @.json", &[shown]),
            ("report @.runs -o @.page --no-pictures", &[shown]),
            ("fetch @.toml --list", &["nothing to fetch"]),
        ] {
            let said = run(folder.path(), name, line, RIGHT);
            assert!(parts.iter().all(|part| said.contains(part)), "{line}: {said}");
        }
        for made in [".json", ".png", "-2.png", ".rays", "-2.rays", ".hits", ".corpus/SHA256SUMS", ".page/index.html"] {
            assert!(folder.path().join(with_ending(name, made)).is_file(), "{made}");
        }
        for line in [
            "compare @-none.obj",
            "compare @.xyz",
            "validate @-bad.toml",
            "render cube -o @/x.png",
            "rays show @-none.rays",
            "rays import @-none.txt -o x.rays",
            "diff @-none.json @.json",
            "report @-none -o x",
            "fetch @-bad.toml",
        ] {
            let said = run(folder.path(), name, line, USAGE);
            assert!(said.lines().count() == 1 && said.contains(shown), "{line}: {said}");
        }

        // A plan names files for a shell; the second time the case exists.
        let plan = "study plan compare --dir @.jobs --scenes @.obj --rays 16 --epochs 1 -s sah-kd";
        let line = run(folder.path(), name, plan, RIGHT);
        assert_eq!(line.lines().count(), 1, "{line}");
        let program = env!("CARGO_BIN_EXE_sahara");
        let script = line.trim_end().replacen("sahara", &format!("'{program}' --quiet"), 1);
        let Ok(done) = Command::new("bash").args(["-c", &script]).current_dir(folder.path()).output() else { continue };
        assert_eq!(done.status.code(), Some(RIGHT), "{script}: {}", stderr(&done));
        run(folder.path(), name, "study compare @.obj --rays 16 --epochs 1 -s sah-kd --dir @.jobs", RIGHT);
    }
}

#[test]
fn what_must_be_text_is_named_where_it_is_none() {
    let mut compare = command(&["compare", "cube", "-s"]);
    let (_, said) = ends(USAGE, compare.arg(OsStr::from_bytes(b"sah\xff")));
    assert!(said.lines().count() == 1 && said.contains("$'sah\\xff' is not UTF-8"), "{said}");
    for args in [&["compare", "\u{1b}[31m"][..], &["\u{1b}[31m"], &["compare", "cube", "--\u{1b}[31m"]] {
        let (_, said) = ends(USAGE, &mut command(args));
        assert!(said.contains("\\u{1b}[31m") && !said.contains('\u{1b}'), "{args:?}: {said}");
    }
}
