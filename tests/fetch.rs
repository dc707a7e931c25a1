//! Downloads, against a server of our own on the loopback device that misbehaves on request.
#![cfg(feature = "fetch")]

use std::fs;
use std::io::{BufRead, BufReader, Write};
use std::net::TcpListener;
use std::path::Path;
use std::process::Command;
use std::sync::{Arc, Mutex};
use std::thread;
use std::time::{Duration, Instant};

use sahara::fetch::{Client, DataFile, FetchError, FetchOutcome};
use sha2::{Digest, Sha256};
use tempfile::TempDir;

/// The file that is fetched.
fn mesh() -> Vec<u8> {
    (0..100_000_u32).flat_map(|i| format!("v {i} {} 0\n", i * 7 % 13).into_bytes()).collect()
}

/// Path of a request, and from where on it wants the file.
type Request = (String, Option<usize>);

/// A server that answers each request for `path`, from byte `range` on, with the bytes that `answer` gives.
struct Server {
    address: String,
    asked: Arc<Mutex<Vec<Request>>>,
}

impl Server {
    fn start(answer: fn(&str, &str, Option<usize>) -> Vec<u8>) -> Self {
        let listener = TcpListener::bind("127.0.0.1:0").unwrap();
        let address = format!("http://{}", listener.local_addr().unwrap());
        let (asked, own): (Arc<Mutex<Vec<Request>>>, _) = (Arc::default(), address.clone());
        let log = Arc::clone(&asked);
        thread::spawn(move || {
            for stream in listener.incoming() {
                let mut stream = stream.unwrap();
                let mut lines = BufReader::new(stream.try_clone().unwrap()).lines().map_while(Result::ok);
                let Some(first) = lines.next() else { continue };
                let path = first.split(' ').nth(1).unwrap_or("/").to_owned();
                let head: Vec<String> = lines.take_while(|line| !line.is_empty()).collect();
                let range = head.iter().find_map(|line| {
                    let (name, value) = line.split_once(':')?;
                    let from = value.trim().strip_prefix("bytes=")?.strip_suffix('-')?;
                    name.eq_ignore_ascii_case("range").then(|| from.parse().ok())?
                });
                log.lock().unwrap().push((path.clone(), range));
                // The client may have gone.
                let _ = stream.write_all(&answer(&own, &path, range));
            }
        });
        Self { address, asked }
    }

    fn file(&self, folder: &TempDir, path: &str) -> DataFile {
        DataFile {
            url: format!("{}{path}", self.address),
            path: folder.path().join("data/mesh.obj"),
            sha256: hex(&mesh()),
            bytes: Some(mesh().len() as u64),
        }
    }

    fn asked(&self) -> Vec<Request> {
        self.asked.lock().unwrap().clone()
    }
}

fn hex(bytes: &[u8]) -> String {
    Sha256::digest(bytes).iter().map(|byte| format!("{byte:02x}")).collect()
}

fn response(status: &str, head: &str, body: &[u8]) -> Vec<u8> {
    let length = body.len();
    let head = format!("HTTP/1.1 {status}\r\nContent-Length: {length}\r\nConnection: close\r\n{head}\r\n");
    [head.as_bytes(), body].concat()
}

/// Every behaviour by its path.
fn answer(own: &str, path: &str, range: Option<usize>) -> Vec<u8> {
    let whole = mesh();
    let partial = |from: usize| {
        let head = format!("Content-Range: bytes {from}-{}/{}\r\n", whole.len() - 1, whole.len());
        response("206 Partial Content", &head, &whole[from..])
    };
    match (path, range) {
        ("/mesh.obj", Some(from)) if from >= whole.len() => response("416 Range Not Satisfiable", "", b""),
        ("/mesh.obj", Some(from)) => partial(from),
        ("/mesh.obj", None) | ("/no-parts", _) => response("200 OK", "", &whole),
        // Says the whole length, gives half, and at the second asking the rest.
        ("/cut", None) => response("200 OK", "", &whole)[..whole.len() / 2].to_vec(),
        ("/cut", Some(from)) => partial(from),
        ("/wrong", _) => response("200 OK", "", &vec![b'#'; whole.len()]),
        ("/long", _) => response("200 OK", "", &[&whole[..], b"more"].concat()),
        ("/other-part", Some(_)) => response("206 Partial Content", "Content-Range: bytes 5-9/10\r\n", b"12345"),
        ("/other-part", None) => response("200 OK", "", &whole),
        ("/moved", _) => response("302 Found", &format!("Location: {own}/mesh.obj\r\n"), b""),
        ("/circle", _) => response("302 Found", &format!("Location: {own}/circle\r\n"), b""),
        ("/broken", _) => response("503 Service Unavailable", "", b""),
        // More than any number counts.
        ("/endless", range) => {
            let status = range.map_or("200 OK".into(), |from| format!("206 P\r\nContent-Range: bytes {from}-{from}/*"));
            format!("HTTP/1.1 {status}\r\nContent-Length: {}\r\n\r\nv 0", u64::MAX).into_bytes()
        }
        ("/nonsense", _) => b"220 this is no web server\r\n\r\n".to_vec(),
        _ => response("404 Not Found", "", b"<html>not here</html>"),
    }
}

fn fetch(file: &DataFile) -> Result<FetchOutcome, FetchError> {
    Client::default().fetch(file, &mut |_| ())
}

/// Nothing but what is named is in the data folder.
#[track_caller]
fn holds(file: &DataFile, names: &[&str]) {
    let folder = file.path.parent().unwrap();
    let mut found: Vec<String> = match fs::read_dir(folder) {
        Ok(entries) => entries.map(|entry| entry.unwrap().file_name().into_string().unwrap()).collect(),
        Err(_) => vec![],
    };
    found.sort();
    assert_eq!(found, names);
}

fn put(path: &Path, bytes: &[u8]) {
    fs::create_dir_all(path.parent().unwrap()).unwrap();
    fs::write(path, bytes).unwrap();
}

#[test]
fn a_file_is_fetched_once_and_whole() {
    let (folder, server) = (tempfile::tempdir().unwrap(), Server::start(answer));
    let file = server.file(&folder, "/moved");
    let mut last = 0;
    let fetched = Client::default().fetch(&file, &mut |got| last = got).unwrap();
    let bytes = mesh().len() as u64;
    assert_eq!((fetched, last), (FetchOutcome::Downloaded { bytes, resumed: 0 }, bytes));
    assert_eq!(fs::read(&file.path).unwrap(), mesh());
    holds(&file, &["mesh.obj"]);
    assert_eq!(fetch(&file).unwrap(), FetchOutcome::AlreadyThere);
    assert_eq!(server.asked().len(), 2, "a redirect and the file, and then nothing");
}

#[test]
fn what_is_cut_off_is_kept_and_gone_on_with() {
    let (folder, server) = (tempfile::tempdir().unwrap(), Server::start(answer));
    let file = server.file(&folder, "/cut");
    let error = fetch(&file).unwrap_err();
    assert!(matches!(error, FetchError::Cut { .. }) && error.to_string().contains("fetch again"), "{error}");
    holds(&file, &[".mesh.obj.part"]);
    let there = fs::metadata(file.part()).unwrap().len();
    assert!(there > 0 && there < mesh().len() as u64, "{there}");
    let bytes = mesh().len() as u64;
    assert_eq!(fetch(&file).unwrap(), FetchOutcome::Downloaded { bytes, resumed: there });
    assert_eq!(server.asked()[1], ("/cut".into(), Some(there as usize)));
    holds(&file, &["mesh.obj"]);
}

#[test]
fn a_part_that_is_of_no_use_is_begun_anew() {
    for (path, part) in
        [("/no-parts", &mesh()[..50]), ("/other-part", &mesh()[..50]), ("/mesh.obj", &vec![0; mesh().len() + 9][..])]
    {
        let (folder, server) = (tempfile::tempdir().unwrap(), Server::start(answer));
        let file = server.file(&folder, path);
        put(&file.part(), part);
        assert_eq!(fetch(&file).unwrap(), FetchOutcome::Downloaded { bytes: mesh().len() as u64, resumed: 0 }, "{path}");
        assert_eq!(fs::read(&file.path).unwrap(), mesh(), "{path}");
    }
    // Finished but not moved: nothing is asked for.
    let (folder, server) = (tempfile::tempdir().unwrap(), Server::start(answer));
    let file = server.file(&folder, "/mesh.obj");
    put(&file.part(), &mesh());
    fetch(&file).unwrap();
    assert!(server.asked().is_empty());
    // A part with other contents cannot be gone on with: that shows at the end, and the next fetch begins anew.
    let other = server.file(&tempfile::tempdir().unwrap(), "/mesh.obj");
    put(&other.part(), b"other");
    assert!(matches!(fetch(&other).unwrap_err(), FetchError::Hash { .. }));
    assert_eq!(fetch(&other).unwrap(), FetchOutcome::Downloaded { bytes: mesh().len() as u64, resumed: 0 });
}

#[test]
fn what_is_wrong_is_refused_in_a_sentence_and_not_kept() {
    for (path, parts) in [
        ("/wrong", ["SHA-256", "nothing of it is kept"]),
        ("/long", ["more than the", "nothing of it is kept"]),
        ("/missing", ["404", "no such file"]),
        ("/broken", ["503", "try again later"]),
        ("/circle", ["redirects", "circle"]),
        ("/nonsense", ["/nonsense", "check the connection"]),
    ] {
        let (folder, server) = (tempfile::tempdir().unwrap(), Server::start(answer));
        let file = server.file(&folder, path);
        let error = fetch(&file).unwrap_err().to_string();
        assert!(parts.iter().all(|part| error.contains(part)) && error.lines().count() == 1, "{path}: {error}");
        holds(&file, &[]);
        if path == "/circle" {
            assert!(server.asked().len() < 20, "{:?}", server.asked().len());
        }
    }
}

#[test]
fn what_is_there_with_other_contents_is_not_touched() {
    let (folder, server) = (tempfile::tempdir().unwrap(), Server::start(answer));
    let file = server.file(&folder, "/mesh.obj");
    put(&file.path, b"mine");
    let error = fetch(&file).unwrap_err().to_string();
    assert!(error.contains("other contents") && error.contains("mesh.obj"), "{error}");
    assert_eq!(fs::read(&file.path).unwrap(), b"mine");
    assert!(server.asked().is_empty());
    let nobody = DataFile { url: "http://127.0.0.1:9/mesh.obj".into(), ..server.file(&folder, "/mesh.obj") };
    fs::remove_file(&nobody.path).unwrap();
    assert!(fetch(&nobody).unwrap_err().to_string().contains("check the connection"));
}

/// A server that sends the head, then a byte a time with pauses in between: none, if they are longer than anyone waits.
fn slow_server(head: &'static str, pause: Duration) -> String {
    let listener = TcpListener::bind("127.0.0.1:0").unwrap();
    let address = format!("http://{}/mesh.obj", listener.local_addr().unwrap());
    thread::spawn(move || {
        for stream in listener.incoming() {
            let mut stream = stream.unwrap();
            // The request is read until its end, so that the connection is not reset.
            let lines = BufReader::new(stream.try_clone().unwrap()).lines().map_while(Result::ok);
            lines.take_while(|line| !line.is_empty()).for_each(drop);
            let _ = stream.write_all(head.as_bytes());
            while stream.write_all(b"v").is_ok() {
                thread::sleep(pause);
            }
        }
    });
    address
}

#[test]
fn a_server_that_stalls_is_left() {
    let folder = tempfile::tempdir().unwrap();
    let head = "HTTP/1.1 200 OK\r\nContent-Length: 100000\r\n\r\n";
    for (head, pause, word) in [
        (head, Duration::from_secs(3600), "next to nothing"),
        (head, Duration::from_millis(20), "next to nothing"),
        ("HTTP/1.1 200 OK\r\nServer: ", Duration::from_secs(3600), "timeout"),
    ] {
        let begun = Instant::now();
        let file = DataFile {
            url: slow_server(head, pause),
            path: folder.path().join("mesh.obj"),
            sha256: hex(&mesh()),
            bytes: Some(100_000),
        };
        let error = Client::with_patience(Duration::from_secs(2)).fetch(&file, &mut |_| ()).unwrap_err().to_string();
        assert!(error.contains(word) && error.contains(&file.url), "{error}");
        assert!(begun.elapsed() < Duration::from_secs(20), "{:?}", begun.elapsed());
    }
}

#[test]
fn what_cannot_be_read_is_not_said_to_be_unwritable() {
    let (folder, server) = (tempfile::tempdir().unwrap(), Server::start(answer));
    let file = server.file(&folder, "/mesh.obj");
    // A folder in place of the file opens, and does not read.
    fs::create_dir_all(&file.path).unwrap();
    let error = fetch(&file).unwrap_err();
    assert!(matches!(error, FetchError::Read { .. }) && error.to_string().starts_with("cannot read"), "{error}");
    // The same in place of the part cannot be written.
    fs::remove_dir(&file.path).unwrap();
    fs::create_dir_all(file.part()).unwrap();
    let error = fetch(&file).unwrap_err();
    assert!(matches!(error, FetchError::Write { .. }) && error.to_string().starts_with("cannot write"), "{error}");
}

#[test]
fn a_file_of_unknown_size_is_not_fetched_without_end() {
    let (folder, server) = (tempfile::tempdir().unwrap(), Server::start(answer));
    let file = DataFile { bytes: None, ..server.file(&folder, "/endless") };
    let error = fetch(&file).unwrap_err();
    assert!(matches!(error, FetchError::TooLarge { .. }) && error.to_string().contains("8589934592"), "{error}");
    holds(&file, &[]);
}

#[test]
fn a_length_beyond_all_numbers_is_a_body_cut_short() {
    let (folder, server) = (tempfile::tempdir().unwrap(), Server::start(answer));
    let file = server.file(&folder, "/endless");
    put(&file.part(), b"mine");
    for _ in 0..2 {
        let error = fetch(&file).unwrap_err().to_string();
        assert!(error.contains("the connection ended after"), "{error}");
    }
    assert!(!file.path.exists());
}

/// The command, over a scene file of one's own.
#[test]
fn the_command_shows_the_licence_before_it_fetches() {
    let (folder, server) = (tempfile::tempdir().unwrap(), Server::start(answer));
    let scene = |path: &str, hash: &str| {
        let text = format!(
            "name = \"Mine\"\n[camera]\neye = [0, 0, 5]\ntarget = [0, 0, 0]\nvertical_fov = 40\n[[objects]]\nmesh = \"cube\"\n\
             [objects.real]\nfile = \"mesh.obj\"\nurl = \"{}{path}\"\nlicence = \"free for tests\"\norigin = \"made up\"\n\
             reported_triangles = 1\n{hash}",
            server.address
        );
        let file = folder.path().join("scene.toml");
        fs::write(&file, text).unwrap();
        file
    };
    let data = folder.path().join("data");
    let run = |scene: &Path, more: &[&str]| {
        let mut command = Command::new(env!("CARGO_BIN_EXE_sahara"));
        command.arg("fetch").arg(scene).args(more).env("SAHARA_DATA", &data);
        let output = command.output().unwrap();
        let text = |bytes: &[u8]| String::from_utf8(bytes.to_vec()).unwrap();
        (output.status.code(), text(&output.stdout), text(&output.stderr))
    };
    let hash = format!("sha256 = \"{}\"\nbytes = {}\n", hex(&mesh()), mesh().len());

    let (code, printed, _) = run(&scene("/mesh.obj", &hash), &["--list"]);
    assert!(code == Some(0) && printed.contains("licence: free for tests") && server.asked().is_empty(), "{printed}");
    let file = scene("/mesh.obj", &hash);
    let (_, printed, _) = run(&file, &["--list", file.to_str().unwrap()]);
    assert_eq!(printed.matches("licence:").count(), 1, "{printed}");
    let (code, printed, errors) = run(&file, &[]);
    assert_eq!(code, Some(0), "{errors}");
    assert!(printed.find("free for tests").unwrap() < printed.find("SHA-256 verified").unwrap(), "{printed}");
    assert_eq!(fs::read(data.join("mesh.obj")).unwrap(), mesh());
    let (code, printed, _) = run(&scene("/mesh.obj", &hash), &[]);
    assert!(code == Some(0) && printed.contains("is there"), "{printed}");

    fs::remove_file(data.join("mesh.obj")).unwrap();
    let (code, _, errors) = run(&scene("/missing", &hash), &[]);
    assert!(code == Some(1) && errors.contains("404") && errors.contains("1 of 1 files"), "{errors}");
    let (code, _, errors) = run(&scene("/mesh.obj", "sha256 = \"12ab\"\n"), &[]);
    assert!(code == Some(1) && errors.contains("sha256") && errors.contains("64 hexadecimal"), "{errors}");
    for (wrong, part) in [("url = \"file:///etc/hosts\"", "https://"), ("file = \"..\"", "without folders")] {
        let text = fs::read_to_string(scene("/mesh.obj", &hash)).unwrap();
        let key = wrong.split(' ').next().unwrap();
        let other: Vec<&str> =
            text.lines().map(|l| if l.starts_with(&format!("{key} =")) { wrong } else { l }).collect();
        fs::write(folder.path().join("scene.toml"), other.join("\n")).unwrap();
        let (code, _, errors) = run(&folder.path().join("scene.toml"), &[]);
        assert!(code == Some(1) && errors.contains(part), "{wrong}: {errors}");
    }
    let (code, _, errors) = run(&scene("/mesh.obj", "unpack = \"unpack mesh.obj\"\n"), &[]);
    assert!(code == Some(1) && errors.contains("then unpack mesh.obj"), "{errors}");
}
