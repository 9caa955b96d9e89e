//! A headless browser and the little of its protocol that the tests need.
//!
//! The protocol: <https://chromedevtools.github.io/devtools-protocol/>.

use std::io::{BufRead, BufReader};
use std::net::TcpStream;
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Stdio};
use std::thread::sleep;
use std::time::{Duration, Instant};

use serde_json::{Value, json};
use tempfile::TempDir;
use tungstenite::{Message, WebSocket};

/// Nothing takes longer, unless it hangs. Drawing goes without a graphics card, on busy machines.
const PATIENCE: Duration = Duration::from_secs(60);
const NAMES: [&str; 5] =
    ["chromium", "chromium-browser", "google-chrome", "google-chrome-stable", "chrome"];

/// A browser with one page.
pub struct Browser {
    child: Child,
    socket: WebSocket<TcpStream>,
    session: String,
    next: u64,
    events: Vec<Value>,
    _profile: TempDir,
}

impl Drop for Browser {
    fn drop(&mut self) {
        // It may have ended already.
        let _ = self.child.kill();
        let _ = self.child.wait();
    }
}

/// The browser of this machine; `None`, with a word about it, if there is none and none is required.
pub fn find() -> Option<PathBuf> {
    let given = std::env::var_os("PIOLA_BROWSER").map(PathBuf::from);
    let paths = std::env::var_os("PATH").unwrap_or_default();
    let known =
        std::env::split_paths(&paths).flat_map(|folder| NAMES.map(|name| folder.join(name)));
    let found = given.into_iter().chain(known).find(|path| path.is_file());
    if found.is_none() {
        let required = std::env::var("PIOLA_BROWSER_REQUIRED").is_ok_and(|value| value == "1");
        assert!(!required, "no browser is found: install chromium, or set PIOLA_BROWSER");
        eprintln!("no browser is found: install chromium, or set PIOLA_BROWSER");
    }
    found
}

impl Browser {
    /// Starts the browser `program` with an empty page.
    pub fn start(program: &Path, flags: &[&str]) -> Self {
        let profile = tempfile::tempdir().unwrap();
        let mut child = Command::new(program)
            .args(["--headless=new", "--no-sandbox", "--disable-dev-shm-usage", "--no-first-run"])
            .args(["--use-angle=swiftshader", "--enable-unsafe-swiftshader"])
            .args(["--disable-background-networking", "--disable-component-update"])
            .args(["--remote-debugging-port=0", "--window-size=1240,1000"])
            .args(flags)
            .arg(format!("--user-data-dir={}", profile.path().display()))
            .arg("about:blank")
            .stdout(Stdio::null())
            .stderr(Stdio::piped())
            .spawn()
            .unwrap();
        let stderr = child.stderr.take().unwrap();
        let (sender, receiver) = std::sync::mpsc::channel();
        // The pipe is read to its end, so that the browser never waits for it.
        std::thread::spawn(move || {
            for line in BufReader::new(stderr).lines().map_while(Result::ok) {
                if let Some(address) = line.strip_prefix("DevTools listening on ") {
                    let _ = sender.send(address.to_owned());
                }
            }
        });
        let address = receiver.recv_timeout(PATIENCE).expect("the browser does not start");
        let host = address.trim_start_matches("ws://").split('/').next().unwrap();
        let stream = TcpStream::connect(host).unwrap();
        stream.set_read_timeout(Some(PATIENCE)).unwrap();
        let (socket, _) = tungstenite::client(&address, stream).unwrap();
        let session = String::new();
        let mut browser =
            Self { child, socket, session, next: 0, events: Vec::new(), _profile: profile };
        let target = browser.call("Target.createTarget", json!({ "url": "about:blank" }));
        let attach = json!({ "targetId": target["targetId"], "flatten": true });
        let session = browser.call("Target.attachToTarget", attach);
        browser.session = session["sessionId"].as_str().unwrap().to_owned();
        for part in ["Page", "Runtime", "Log", "Network"] {
            browser.call(&format!("{part}.enable"), json!({}));
        }
        browser
    }

    /// Calls a method and waits for its answer; events that come in between are kept.
    fn call(&mut self, method: &str, parameters: Value) -> Value {
        self.next += 1;
        let mut message = json!({ "id": self.next, "method": method, "params": parameters });
        if !self.session.is_empty() {
            message["sessionId"] = json!(self.session);
        }
        self.socket.send(Message::text(message.to_string())).unwrap();
        loop {
            let message = self.receive();
            if message["id"] == self.next {
                assert!(message["error"].is_null(), "{method}: {}", message["error"]);
                return message["result"].clone();
            }
            self.events.push(message);
        }
    }

    fn receive(&mut self) -> Value {
        loop {
            let message = self.socket.read().expect("the browser does not answer");
            if let Message::Text(text) = message {
                return serde_json::from_str(&text).unwrap();
            }
        }
    }

    /// Opens the file `path` and waits until it is loaded.
    pub fn open(&mut self, path: &Path) {
        let address = format!("file://{}", path.canonicalize().unwrap().display());
        let result = self.call("Page.navigate", json!({ "url": address }));
        assert!(result["errorText"].is_null(), "{result}");
        self.wait_for("document.readyState === 'complete' && location.protocol === 'file:'");
    }

    /// The value of a JavaScript expression.
    #[track_caller]
    pub fn evaluate(&mut self, expression: &str) -> Value {
        let parameters =
            json!({ "expression": expression, "returnByValue": true, "awaitPromise": true });
        let answer = self.call("Runtime.evaluate", parameters);
        assert!(answer["exceptionDetails"].is_null(), "{expression}: {answer}");
        answer["result"]["value"].clone()
    }

    /// Waits until an expression is true.
    #[track_caller]
    pub fn wait_for(&mut self, expression: &str) {
        let start = Instant::now();
        while self.evaluate(expression) != true {
            assert!(start.elapsed() < PATIENCE, "never true: {expression}");
            sleep(Duration::from_millis(20));
        }
    }

    /// Middle and size of an element in the window, which is scrolled to show it.
    fn area(&mut self, selector: &str) -> [f64; 4] {
        let area = self.evaluate(&format!(
            "(() => {{ const e = document.querySelector('{selector}'); \
             e.scrollIntoView({{ block: 'center', behavior: 'instant' }}); \
             const r = e.getBoundingClientRect(); \
             return [r.x + r.width / 2, r.y + r.height / 2, r.width, r.height]; }})()"
        ));
        [0, 1, 2, 3].map(|i| area[i].as_f64().unwrap())
    }

    fn mouse(&mut self, kind: &str, [x, y]: [f64; 2], buttons: u32) {
        let button = if kind == "mouseMoved" && buttons == 0 { "none" } else { "left" };
        let parameters = json!({
            "type": kind, "x": x, "y": y, "button": button, "buttons": buttons, "clickCount": 1
        });
        self.call("Input.dispatchMouseEvent", parameters);
    }

    /// Clicks on an element at `share` of its width.
    pub fn click(&mut self, selector: &str, share: f64) {
        let [x, y, width, _] = self.area(selector);
        let at = [x + (share - 0.5) * width, y];
        self.mouse("mouseMoved", at, 0);
        self.mouse("mousePressed", at, 1);
        self.mouse("mouseReleased", at, 0);
    }

    /// Moves the pointer to a place in an element, in shares of its size from the middle.
    pub fn hover(&mut self, selector: &str, [right, down]: [f64; 2]) {
        let [x, y, width, height] = self.area(selector);
        self.mouse("mouseMoved", [x + right * width, y + down * height], 0);
    }

    /// Drags from the middle of an element by some pixels.
    pub fn drag(&mut self, selector: &str, [right, down]: [f64; 2]) {
        let [x, y, ..] = self.area(selector);
        self.mouse("mouseMoved", [x, y], 0);
        self.mouse("mousePressed", [x, y], 1);
        for part in [0.25, 0.5, 0.75, 1.0] {
            self.mouse("mouseMoved", [x + part * right, y + part * down], 1);
        }
        self.mouse("mouseReleased", [x + right, y + down], 0);
    }

    /// Everything that the page did wrong: exceptions, and errors and warnings of the console.
    pub fn complaints(&mut self) -> Vec<String> {
        // An answer means that all events before it have come.
        self.evaluate("1");
        let wrong = self.events.iter().filter(|event| match event["method"].as_str() {
            Some("Runtime.exceptionThrown") => true,
            Some("Runtime.consoleAPICalled") => {
                ["error", "warning", "assert"].iter().any(|kind| event["params"]["type"] == *kind)
            }
            Some("Log.entryAdded") => event["params"]["entry"]["level"] == "error",
            _ => false,
        });
        wrong.map(|event| event["params"].to_string()).collect()
    }

    /// The addresses that the page asked for, without those inside itself.
    pub fn requests(&mut self) -> Vec<String> {
        self.evaluate("1");
        let asked = self.events.iter().filter(|event| {
            ["Network.requestWillBeSent", "Network.webSocketCreated"]
                .iter()
                .any(|kind| event["method"] == *kind)
        });
        let address = |event: &Value| {
            let params = &event["params"];
            let address = params["request"]["url"].as_str().or(params["url"].as_str());
            address.unwrap_or_default().to_owned()
        };
        let outside =
            |address: &String| !["data:", "blob:"].iter().any(|start| address.starts_with(start));
        asked.map(address).filter(outside).collect()
    }

    /// Saves what the window shows, where `PIOLA_BROWSER_SHOTS` names a folder for it.
    pub fn shot(&mut self, name: &str) {
        use base64::Engine;
        let Some(folder) = std::env::var_os("PIOLA_BROWSER_SHOTS") else { return };
        let answer = self.call("Page.captureScreenshot", json!({ "format": "png" }));
        let data = answer["data"].as_str().unwrap();
        let bytes = base64::engine::general_purpose::STANDARD.decode(data).unwrap();
        std::fs::write(Path::new(&folder).join(format!("{name}.png")), bytes).unwrap();
    }
}
