//! Tests file names that are not UTF-8 or contain control characters.

use std::ffi::{OsStr, OsString};
use std::os::unix::ffi::OsStrExt;
use std::process::Command;

use super::command::{Folder, RIGHT, SQUARE, USAGE, assert_contains, command, ends};

/// Pairs of a file name and its printed form.
const NAMES: [(&[u8], &str); 2] = [(b"gr\xfcn", "gr\\xfcn"), (b"a\x1b[31m\nb", "a\\u{1b}[31m\\nb")];

#[test]
fn files_of_any_name_are_taken_and_shown_escaped() {
    for (name, shown) in NAMES {
        let folder = Folder::new();
        let with_ending = |ending: &str| [OsStr::from_bytes(name), ending.as_ref()].into_iter().collect::<OsString>();
        let path = |ending: &str| folder.path("").join(with_ending(ending));
        // An initial `@` of a word is replaced by `name`.
        let run = |line: &str, status: i32| {
            let words = line.split(' ').map(|word| word.strip_prefix('@').map_or(word.into(), with_ending));
            let text = ends(status, folder.command("--quiet").args(words)).concat();
            assert!(!text.contains('\u{1b}') && !text.contains('\u{fffd}'), "{text:?}");
            text
        };
        let scene =
            "camera = { eye = [0, 0, 5], target = [0, 0, 0], vertical_fov = 60 }\nobjects = [{ mesh = \"cube\" }]";
        for (ending, text) in [
            (".obj", SQUARE),
            (".txt", "0.5 0.5 1 0 0 -1\n"),
            (".toml", &format!("name = \"Scene\"\n{scene}")),
            ("-bad.toml", scene),
        ] {
            std::fs::write(path(ending), text).unwrap();
        }
        for (line, parts) in [
            ("compare @.obj -s sah-kd --rays 64 --epochs 1 --export-json @.json", [shown, ""]),
            ("validate @.obj -s sah-kd --rays 64", [shown, ""]),
            ("render @.obj -o @.png --size 4x4", [shown, "4 x 4"]),
            ("render @.toml -o @-2.png --size 4x4", [shown, "Scene"]),
            ("rays record @.obj -o @.rays --rays 16", [shown, "16 rays"]),
            ("rays show @.rays", [shown, "16 rays"]),
            ("rays import @.txt -o @-2.rays --scene @.obj", [shown, "1 ray"]),
            ("validate @.obj --rays @.rays -s sah-kd --export-hits @.hits", [shown, "16 results"]),
            ("validate @.obj --rays @.rays --hits @.hits", [shown, ""]),
            ("rays corpus @.obj -o @.corpus --rays 4", [shown, ""]),
            ("study compare @.obj -s sah-kd --rays 16 --epochs 1 --dir @.runs", [shown, ""]),
            ("diff @.json @.json", [shown, ""]),
            ("report @.runs -o @.page --no-pictures", [shown, ""]),
            ("fetch @.toml --list", ["nothing to fetch", ""]),
        ] {
            assert_contains(&run(line, RIGHT), &parts);
        }
        for made in [".json", ".png", "-2.png", ".rays", "-2.rays", ".hits", ".corpus/SHA256SUMS", ".page/index.html"] {
            assert!(path(made).is_file(), "{made}");
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
            let text = run(line, USAGE);
            assert!(text.lines().count() == 1 && text.contains(shown), "{line}: {text}");
        }

        // A plan quotes file names for a shell.
        let line = run("study plan compare --dir @.jobs --scenes @.obj --rays 16 --epochs 1 -s sah-kd", RIGHT);
        assert_eq!(line.lines().count(), 1, "{line}");
        let program = env!("CARGO_BIN_EXE_sahara");
        let script = line.trim_end().replacen("sahara", &format!("'{program}' --quiet"), 1);
        let mut bash = Command::new("bash");
        if bash.args(["-c", &script]).current_dir(folder.path("")).status().is_ok() {
            ends(RIGHT, &mut bash);
            run("study compare @.obj --rays 16 --epochs 1 -s sah-kd --dir @.jobs", RIGHT);
        }
    }
}

#[test]
fn what_must_be_text_is_named_where_it_is_none() {
    let [_, message] = ends(USAGE, command("compare cube -s").arg(OsStr::from_bytes(b"sah\xff")));
    assert!(message.lines().count() == 1 && message.contains("$'sah\\xff' is not UTF-8"), "{message}");
    for line in ["compare \u{1b}[31m", "\u{1b}[31m", "compare cube --\u{1b}[31m"] {
        let [_, message] = ends(USAGE, &mut command(line));
        assert!(message.contains("\\u{1b}[31m") && !message.contains('\u{1b}'), "{line:?}: {message}");
    }
}
