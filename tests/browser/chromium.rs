//! Headless Chromium, controlled through its debugging pipe.

use std::env;
use std::io::{BufRead, BufReader, Write};
use std::path::{Path, PathBuf};
use std::process::{Child, ChildStdin, Command, Stdio};
use std::sync::mpsc::{Receiver, channel};
use std::thread;
use std::time::{Duration, Instant};

use serde_json::{Value, json};
use tempfile::TempDir;

/// A reply takes far less, even on a busy machine.
const TIMEOUT: Duration = Duration::from_secs(300);

pub struct Chromium {
    process: Child,
    requests: ChildStdin,
    messages: Receiver<Value>,
    last: u64,
    session: Option<String>,
    events: Vec<Value>,
    _profile: TempDir,
}

/// Name, code and typed text of each key.
const KEYS: [(&str, u32, &str); 12] = [
    ("Tab", 9, ""),
    ("Enter", 13, "\r"),
    ("PageUp", 33, ""),
    ("PageDown", 34, ""),
    ("ArrowLeft", 37, ""),
    ("ArrowUp", 38, ""),
    ("ArrowRight", 39, ""),
    ("ArrowDown", 40, ""),
    ("b", 66, "b"),
    ("n", 78, "n"),
    ("w", 87, "w"),
    ("z", 90, "z"),
];

impl Chromium {
    /// `None` if Chromium is not installed.
    pub fn launch() -> Option<Self> {
        let program = ["chromium", "chromium-browser", "google-chrome"].iter().find_map(|name| on_path(name));
        if program.is_none() {
            eprintln!("skipped: no chromium on the path");
        }
        let profile = TempDir::new().unwrap();
        // Chromium reads requests from descriptor 3. Chromium writes replies to descriptor 4.
        let mut process = Command::new("sh")
            .args(["-c", "exec \"$0\" \"$@\" 3<&0 4>&1 </dev/null >/dev/null 2>/dev/null"])
            .arg(program?)
            .args(["--headless", "--no-sandbox", "--disable-gpu", "--disable-quic", "--no-first-run"])
            .args(["--disable-background-networking", "--disable-component-update", "--disable-sync"])
            .args(["--remote-debugging-pipe", "--force-prefers-reduced-motion"])
            .arg(format!("--user-data-dir={}", profile.path().display()))
            .arg("about:blank")
            .stdin(Stdio::piped())
            .stdout(Stdio::piped())
            .spawn()
            .expect("a shell runs");
        let requests = process.stdin.take().unwrap();
        let output = BufReader::new(process.stdout.take().unwrap());
        let (sender, messages) = channel();
        thread::spawn(move || {
            for message in output.split(0).map_while(Result::ok) {
                let message = serde_json::from_slice(&message).expect("the pipe speaks JSON");
                if sender.send(message).is_err() {
                    break;
                }
            }
        });
        let mut browser =
            Self { process, requests, messages, last: 0, session: None, events: vec![], _profile: profile };
        let target = browser.call("Target.createTarget", json!({ "url": "about:blank" }));
        let attached = json!({ "targetId": target["targetId"], "flatten": true });
        let session = browser.call("Target.attachToTarget", attached);
        browser.session = session["sessionId"].as_str().map(String::from);
        for domain in ["Page", "Runtime", "Log", "Network"] {
            browser.call(&format!("{domain}.enable"), json!({}));
        }
        Some(browser)
    }

    fn call(&mut self, method: &str, parameters: Value) -> Value {
        self.last += 1;
        let mut request = json!({ "id": self.last, "method": method, "params": parameters });
        if let Some(session) = &self.session {
            request["sessionId"] = session.as_str().into();
        }
        self.requests.write_all(format!("{request}\0").as_bytes()).expect("the browser listens");
        loop {
            let message = self.messages.recv_timeout(TIMEOUT).unwrap_or_else(|_| panic!("no answer to {method}"));
            if message["id"] != self.last {
                self.events.push(message);
                continue;
            }
            assert!(message.get("error").is_none(), "{method}: {message}");
            return message["result"].clone();
        }
    }

    /// Waits until the page is loaded. `width` is in pixels.
    pub fn open(&mut self, page: &Path, width: u32, dark: bool) {
        let size = json!({ "width": width, "height": 900, "deviceScaleFactor": 1, "mobile": false });
        self.call("Emulation.setDeviceMetricsOverride", size);
        let scheme = json!({ "name": "prefers-color-scheme", "value": if dark { "dark" } else { "light" } });
        self.call("Emulation.setEmulatedMedia", json!({ "features": [scheme] }));
        self.call("Page.navigate", json!({ "url": format!("file://{}", page.display()) }));
        while self.evaluate("document.readyState === 'complete' && location.protocol === 'file:'") != true {
            thread::sleep(Duration::from_millis(20));
        }
    }

    pub fn evaluate(&mut self, expression: &str) -> Value {
        let request = json!({ "expression": expression, "returnByValue": true, "awaitPromise": true });
        let result = self.call("Runtime.evaluate", request);
        assert!(result.get("exceptionDetails").is_none(), "{expression}: {result}");
        result["result"]["value"].clone()
    }

    pub fn text(&mut self, expression: &str) -> String {
        self.evaluate(expression).as_str().unwrap_or_else(|| panic!("{expression} is not a string")).to_owned()
    }

    /// Waits until `is_wanted` accepts the text of `expression`.
    pub fn text_once(&mut self, expression: &str, is_wanted: impl Fn(&str) -> bool) -> String {
        let begun = Instant::now();
        loop {
            let text = self.text(expression);
            if is_wanted(&text) {
                return text;
            }
            assert!(begun.elapsed() < TIMEOUT, "{expression} stays {text}");
            thread::sleep(Duration::from_millis(10));
        }
    }

    pub fn press(&mut self, key: &str) {
        let (_, code, text) = KEYS.iter().find(|(name, ..)| *name == key).expect("the key is known");
        for kind in ["keyDown", "keyUp"] {
            let typed = if kind == "keyDown" { *text } else { "" };
            let event = json!({ "type": kind, "key": key, "code": key, "windowsVirtualKeyCode": code, "text": typed });
            self.call("Input.dispatchKeyEvent", event);
        }
    }

    /// `across` and `down` are fractions of the element's width and height. `[0, 0]` is the top left corner.
    pub fn click(&mut self, selector: &str, [across, down]: [f64; 2]) {
        let place = self.evaluate(&format!(
            "(() => {{ const e = document.querySelector('{selector}'); e.scrollIntoView({{ block: 'center' }}); \
             const b = e.getBoundingClientRect(); return [b.x + {across} * b.width, b.y + {down} * b.height]; }})()"
        ));
        for kind in ["mousePressed", "mouseReleased"] {
            let event = json!({ "type": kind, "x": place[0], "y": place[1], "button": "left", "clickCount": 1 });
            self.call("Input.dispatchMouseEvent", event);
        }
    }

    /// The console messages, errors and network requests of the page.
    fn complaints(&self) -> Vec<String> {
        let is_network_request = |event: &Value| {
            let url = event["params"]["request"]["url"].as_str().unwrap_or_default();
            event["method"] == "Network.requestWillBeSent" && !url.starts_with("file:") && !url.starts_with("data:")
        };
        let complaints = ["Runtime.consoleAPICalled", "Runtime.exceptionThrown", "Log.entryAdded"];
        let is_complaint =
            |event: &&Value| complaints.iter().any(|method| event["method"] == *method) || is_network_request(event);
        self.events.iter().filter(is_complaint).map(Value::to_string).collect()
    }
}

/// Fails the test if the list of complaints is not empty.
impl Drop for Chromium {
    fn drop(&mut self) {
        let _ = self.process.kill();
        let _ = self.process.wait();
        let complaints = self.complaints();
        assert!(thread::panicking() || complaints.is_empty(), "{complaints:#?}");
    }
}

fn on_path(name: &str) -> Option<PathBuf> {
    env::split_paths(&env::var_os("PATH")?).map(|folder| folder.join(name)).find(|path| path.is_file())
}
