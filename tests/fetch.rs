//! Tests downloads from a local server. The path of a request selects the response.
#![cfg(feature = "fetch")]

use std::fs;
use std::io::{BufRead, BufReader, Write};
use std::net::TcpListener;
use std::sync::{Arc, Mutex};
use std::thread;
use std::time::{Duration, Instant};

use sahara::fetch::{Client, DataFile, FetchOutcome};
use sha2::{Digest, Sha256};

use crate::cli::command::{Folder, RIGHT, USAGE, ends};

fn mesh() -> Vec<u8> {
    (0..100_000_u32).flat_map(|i| format!("v {i} {} 0\n", i * 7 % 13).into_bytes()).collect()
}

struct Server {
    address: String,
    requests: Arc<Mutex<Vec<String>>>,
    folder: Folder,
}

impl Server {
    fn start() -> Self {
        let listener = TcpListener::bind("127.0.0.1:0").unwrap();
        let address = format!("http://{}", listener.local_addr().unwrap());
        let (requests, own): (Arc<Mutex<Vec<String>>>, _) = (Arc::default(), address.clone());
        let log = Arc::clone(&requests);
        thread::spawn(move || {
            for stream in listener.incoming() {
                let mut stream = stream.unwrap();
                let mut lines = BufReader::new(stream.try_clone().unwrap()).lines().map_while(Result::ok);
                let Some(first) = lines.next() else { continue };
                let path = first.split(' ').nth(1).unwrap_or("/").to_owned();
                lines.take_while(|line| !line.is_empty()).for_each(drop);
                log.lock().unwrap().push(path.clone());
                // The client may have disconnected.
                let _ = stream.write_all(&answer(&own, &path));
                if STALLS.contains(&&*path) {
                    let _ = stream.write_all(b"v");
                    thread::sleep(Duration::from_secs(3600));
                }
            }
        });
        Self { address, requests, folder: Folder::new() }
    }

    fn file(&self, path: &str) -> DataFile {
        let (folder, bytes) = (self.folder.path(&path[1..]), mesh());
        let url = format!("{}{path}", self.address);
        DataFile { url, path: folder.join("mesh.obj"), sha256: hex(&bytes), bytes: Some(bytes.len() as u64) }
    }

    /// The requests since the previous call of this function.
    fn requests(&self) -> Vec<String> {
        std::mem::take(&mut self.requests.lock().unwrap())
    }
}

/// Paths at which the server stalls before the end of the response.
const STALLS: [&str; 2] = ["/silent", "/headless"];

fn hex(bytes: &[u8]) -> String {
    Sha256::digest(bytes).iter().map(|byte| format!("{byte:02x}")).collect()
}

fn response(status: &str, head: &str, body: &[u8]) -> Vec<u8> {
    let length = body.len();
    let head = format!("HTTP/1.1 {status}\r\nContent-Length: {length}\r\nConnection: close\r\n{head}\r\n");
    [head.as_bytes(), body].concat()
}

/// `own` is the address of the server.
fn answer(own: &str, path: &str) -> Vec<u8> {
    let whole = mesh();
    match path {
        "/mesh.obj" => response("200 OK", "", &whole),
        // The response ends after half of its announced length.
        "/cut" => response("200 OK", "", &whole)[..whole.len() / 2].to_vec(),
        "/wrong" => response("200 OK", "", &vec![b'#'; whole.len()]),
        "/long" => response("200 OK", "", &[&whole[..], b"more"].concat()),
        "/moved" => response("302 Found", &format!("Location: {own}/mesh.obj\r\n"), b""),
        "/circle" => response("302 Found", &format!("Location: {own}/circle\r\n"), b""),
        "/broken" => response("503 Service Unavailable", "", b""),
        "/endless" => format!("HTTP/1.1 200 OK\r\nContent-Length: {}\r\n\r\nv 0", u64::MAX).into_bytes(),
        "/silent" => format!("HTTP/1.1 200 OK\r\nContent-Length: {}\r\n\r\n", whole.len()).into_bytes(),
        "/headless" => b"HTTP/1.1 200 OK\r\nServer: ".to_vec(),
        "/nonsense" => b"220 this is no web server\r\n\r\n".to_vec(),
        _ => response("404 Not Found", "", b"<html>not here</html>"),
    }
}

#[track_caller]
fn refused(file: &DataFile, client: &Client, parts: &[&str]) {
    let error = client.fetch(file, &mut |_| ()).unwrap_err().to_string();
    assert!(error.lines().count() == 1 && parts.iter().all(|part| error.contains(part)), "{}: {error}", file.url);
}

#[test]
fn a_file_is_fetched_once_and_whole() {
    let server = Server::start();
    let file = server.file("/moved");
    let (bytes, mut last) = (mesh().len() as u64, 0);
    let fetched = Client::default().fetch(&file, &mut |got| last = got).unwrap();
    assert_eq!((fetched, last), (FetchOutcome::Downloaded { bytes }, bytes));
    assert_eq!(fs::read(&file.path).unwrap(), mesh());
    assert_eq!(fs::read_dir(server.folder.path("moved")).unwrap().count(), 1, "nothing else is left behind");
    assert_eq!(Client::default().fetch(&file, &mut |_| ()).unwrap(), FetchOutcome::AlreadyThere);
    assert_eq!(server.requests().len(), 2, "a redirect and the file, and then nothing");
}

#[test]
fn what_is_wrong_is_refused_in_a_sentence_and_not_kept() {
    let server = Server::start();
    for (path, bytes, parts) in [
        ("/wrong", Some(mesh().len()), ["SHA-256", "nothing is kept"]),
        ("/long", Some(mesh().len()), ["more than", "the download was discarded"]),
        ("/missing", None, ["404", "the file is gone"]),
        ("/broken", None, ["503", "try again later"]),
        ("/circle", None, ["redirects", "circle"]),
        ("/nonsense", None, ["/nonsense", "check the connection"]),
        ("/cut", Some(mesh().len()), ["the connection ended after", "fetch again"]),
        // A file of unknown size may have at most 8 GiB.
        ("/endless", None, ["8589934592", "/endless"]),
    ] {
        let file = DataFile { bytes: bytes.map(|bytes| bytes as u64), ..server.file(path) };
        refused(&file, &Client::default(), &parts);
        let kept = fs::read_dir(file.path.parent().unwrap()).map_or(0, Iterator::count);
        assert_eq!(kept, 0, "{path} is kept");
        assert!(server.requests().len() < 20, "{path}");
    }
    for path in STALLS {
        let (begun, server) = (Instant::now(), Server::start());
        let file = server.file(path);
        refused(&file, &Client::with_timeout(Duration::from_secs(2)), &["timeout", &file.url]);
        assert!(begun.elapsed() < Duration::from_secs(20), "{:?}", begun.elapsed());
    }
}

#[test]
fn what_is_there_with_other_contents_is_not_touched() {
    let (server, client) = (Server::start(), Client::default());
    let file = server.file("/mesh.obj");
    fs::create_dir_all(file.path.parent().unwrap()).unwrap();
    fs::write(&file.path, b"mine").unwrap();
    refused(&file, &client, &["other contents", "mesh.obj"]);
    assert_eq!(fs::read(&file.path).unwrap(), b"mine");
    // A regular file cannot contain a file.
    refused(&DataFile { path: file.path.join("x"), ..file.clone() }, &client, &["cannot write"]);
    fs::remove_file(&file.path).unwrap();
    fs::create_dir(&file.path).unwrap();
    refused(&file, &client, &["cannot read"]);
    assert!(server.requests().is_empty());
    fs::remove_dir(&file.path).unwrap();
    let nobody = DataFile { url: "http://127.0.0.1:9/mesh.obj".into(), ..file };
    refused(&nobody, &client, &["check the connection"]);
}

#[test]
fn the_command_shows_the_licence_before_it_fetches() {
    let server = Server::start();
    let folder = &server.folder;
    let hash = format!("sha256 = \"{}\"\nbytes = {}\n", hex(&mesh()), mesh().len());
    let describe = |file: &str, url: &str, hash: &str| {
        let text = format!(
            "name = \"Mine\"\n[camera]\neye = [0, 0, 5]\ntarget = [0, 0, 0]\nvertical_fov = 40\n[[objects]]\nmesh = \"cube\"\n\
             [objects.real]\nfile = \"{file}\"\nurl = \"{url}\"\nlicence = \"free for tests\"\norigin = \"made up\"\n\
             reported_triangles = 1\n{hash}"
        );
        folder.write("scene.toml", text);
    };
    let run = |line: &str, status: i32| ends(status, folder.command(line).env("SAHARA_DATA", "data"));
    let url = format!("{}/mesh.obj", server.address);
    describe("mesh.obj", &url, &hash);

    let [printed, _] = run("fetch scene.toml --list scene.toml", RIGHT);
    assert!(server.requests().is_empty());
    assert_eq!(printed.matches("licence: free for tests").count(), 1, "{printed}");
    let [printed, _] = run("fetch scene.toml", RIGHT);
    assert!(printed.find("free for tests").unwrap() < printed.find("SHA-256 verified").unwrap(), "{printed}");
    assert_eq!(fs::read(folder.path("data/mesh.obj")).unwrap(), mesh());
    let [printed, _] = run("fetch scene.toml", RIGHT);
    assert!(printed.contains("present, SHA-256 verified"), "{printed}");

    fs::remove_file(folder.path("data/mesh.obj")).unwrap();
    let missing = format!("{}/missing", server.address);
    for (file, url, hash, parts) in [
        ("mesh.obj", &*missing, &*hash, ["404", "1 of 1 files"]),
        ("mesh.obj", &url, "sha256 = \"12ab\"\n", ["sha256", "64 hexadecimal"]),
        ("mesh.obj", &url, "unpack = \"unpack mesh.obj\"\n", ["then unpack", "mesh.obj"]),
        ("mesh.obj", "file:///etc/hosts", &hash, ["https://", "url"]),
        ("..", &url, &hash, ["without folders", "file"]),
    ] {
        describe(file, url, hash);
        let [_, errors] = run("fetch scene.toml", USAGE);
        assert!(parts.iter().all(|part| errors.contains(part)), "{parts:?}: {errors}");
    }
}
