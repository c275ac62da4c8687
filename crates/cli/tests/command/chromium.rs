//! A headless Chromium, driven over its DevTools socket: opens a page, moves the mouse, reads what is there.

use base64::Engine as _;
use base64::engine::general_purpose::STANDARD;
use serde_json::{Value, json};
use std::io::{BufRead, BufReader};
use std::net::TcpStream;
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Stdio};
use std::thread;
use std::time::Duration;
use tungstenite::{Message, WebSocket};

const NAMES: [&str; 4] = ["chromium", "chromium-browser", "google-chrome", "google-chrome-stable"];
/// What keeps it from doing anything but what it is told.
const SWITCHES: [&str; 12] = [
    "--headless",
    "--no-sandbox",
    "--disable-gpu",
    "--disable-quic",
    "--disable-dev-shm-usage",
    "--no-first-run",
    "--mute-audio",
    "--disable-background-networking",
    "--disable-component-update",
    "--disable-sync",
    "--disable-extensions",
    "--remote-debugging-port=0",
];
const PATIENCE: Duration = Duration::from_secs(60);

/// The program, if there is one on the PATH.
pub(crate) fn chromium_path() -> Option<PathBuf> {
    let folders = std::env::var_os("PATH")?;
    let found =
        |name: &&str| std::env::split_paths(&folders).map(|folder| folder.join(name)).find(|path| path.is_file());
    NAMES.iter().find_map(found)
}

/// A browser with one open page.
pub(crate) struct Browser {
    child: Child,
    socket: WebSocket<TcpStream>,
    session: Option<String>,
    next_id: u64,
    events: Vec<Value>,
    _profile: Option<tempfile::TempDir>,
}

impl Browser {
    /// Starts one. Where there is none, says so on a line that the run's summary counts, unless `HOVERTONE_REQUIRE_BROWSER` is set.
    pub(crate) fn start() -> Option<Self> {
        let profile = tempfile::tempdir().unwrap();
        let mut browser = Self::start_in(profile.path(), &[])?;
        browser._profile = Some(profile);
        Some(browser)
    }

    /// Starts one with more switches, that keeps what pages keep in a folder.
    pub(crate) fn start_in(profile: &Path, switches: &[String]) -> Option<Self> {
        let spawn = |name: &&str| {
            Command::new(name)
                .args(SWITCHES)
                .args(switches)
                .arg(format!("--user-data-dir={}", profile.display()))
                .arg("about:blank")
                .stdin(Stdio::null())
                .stdout(Stdio::null())
                .stderr(Stdio::piped())
                .spawn()
                .ok()
        };
        let Some(mut child) = NAMES.iter().find_map(spawn) else {
            assert!(std::env::var_os("HOVERTONE_REQUIRE_BROWSER").is_none(), "a browser is required: install chromium");
            println!("skipped: no Chromium on the PATH to look at the page with");
            return None;
        };
        let mut lines = BufReader::new(child.stderr.take().unwrap()).lines();
        let address = lines
            .by_ref()
            .map_while(Result::ok)
            .find_map(|line| Some(line.strip_prefix("DevTools listening on ")?.to_owned()))
            .expect("the browser ended before it listened");
        // it must not block on a full pipe
        thread::spawn(move || lines.map_while(Result::ok).for_each(drop));
        let host = address.strip_prefix("ws://").and_then(|rest| rest.split('/').next()).unwrap().to_owned();
        let stream = TcpStream::connect(host).unwrap();
        stream.set_read_timeout(Some(PATIENCE)).unwrap();
        let (socket, _) = tungstenite::client(address.as_str(), stream).unwrap();
        let mut browser = Self { child, socket, session: None, next_id: 0, events: Vec::new(), _profile: None };
        let target = browser.call("Target.createTarget", json!({ "url": "about:blank" }))["targetId"].clone();
        let attached = browser.call("Target.attachToTarget", json!({ "targetId": target, "flatten": true }));
        browser.session = attached["sessionId"].as_str().map(str::to_owned);
        for domain in ["Page", "Runtime", "Log", "Network"] {
            browser.call(&format!("{domain}.enable"), json!({}));
        }
        browser.call("Page.bringToFront", json!({}));
        browser.screen(1200);
        Some(browser)
    }

    /// Opens a file and waits until it is loaded.
    pub(crate) fn open(&mut self, path: &Path) {
        self.open_url(&format!("file://{}", path.display()));
    }

    /// Opens an address and waits until it is loaded.
    pub(crate) fn open_url(&mut self, url: &str) {
        self.events.clear();
        self.call("Page.navigate", json!({ "url": url }));
        while !self.events.iter().any(|event| event["method"] == "Page.loadEventFired") {
            let message = self.next_message();
            self.events.push(message);
        }
    }

    /// Sets the width of the screen, px.
    pub(crate) fn screen(&mut self, width: u32) {
        let screen = json!({ "width": width, "height": 900, "deviceScaleFactor": 1, "mobile": false });
        self.call("Emulation.setDeviceMetricsOverride", screen);
    }

    /// Shows the page on a screen or on paper, light or dark.
    pub(crate) fn medium(&mut self, medium: &str, scheme: &str) {
        let features = json!([{ "name": "prefers-color-scheme", "value": scheme }]);
        self.call("Emulation.setEmulatedMedia", json!({ "media": medium, "features": features }));
    }

    /// Allows pages to use the clipboard.
    pub(crate) fn allow_clipboard(&mut self) {
        let permissions = json!({ "permissions": ["clipboardReadWrite", "clipboardSanitizedWrite"] });
        self.call("Browser.grantPermissions", permissions);
    }

    /// The page as PDF; what is no text in it is replaced.
    pub(crate) fn pdf_text(&mut self) -> String {
        let printed = self.call("Page.printToPDF", json!({ "preferCSSPageSize": true, "printBackground": true }));
        let bytes = STANDARD.decode(printed["data"].as_str().unwrap_or_default()).unwrap();
        String::from_utf8_lossy(&bytes).into_owned()
    }

    /// The value of an expression in the page, as if a person had asked for it; promises are waited for.
    pub(crate) fn value(&mut self, expression: &str) -> Value {
        let parameters =
            json!({ "expression": expression, "returnByValue": true, "awaitPromise": true, "userGesture": true });
        let answer = self.call("Runtime.evaluate", parameters);
        assert!(answer.get("exceptionDetails").is_none(), "{expression}: {answer}");
        answer["result"]["value"].clone()
    }

    /// The text of an expression.
    pub(crate) fn text(&mut self, expression: &str) -> String {
        let value = self.value(expression);
        value.as_str().unwrap_or_else(|| panic!("{expression} is no text but {value}")).to_owned()
    }

    /// Waits until an expression, or what it promises, is true in the page.
    pub(crate) fn wait_for(&mut self, expression: &str, patience: Duration) {
        let start = std::time::Instant::now();
        while self.value(&format!("(async () => Boolean(await ({expression})))()")) != true {
            let words = self.text("document.body.innerText");
            assert!(start.elapsed() < patience, "{expression} did not come true:\n{words}");
            thread::sleep(Duration::from_millis(50));
        }
    }

    /// Chooses files in an input of the page.
    #[cfg(feature = "page")]
    pub(crate) fn choose(&mut self, selector: &str, files: &[&Path]) {
        let input =
            self.call("Runtime.evaluate", json!({ "expression": format!("document.querySelector({selector:?})") }));
        let files: Vec<String> = files.iter().map(|path| path.display().to_string()).collect();
        self.call("DOM.setFileInputFiles", json!({ "objectId": input["result"]["objectId"], "files": files }));
    }

    /// Types a text where the focus is.
    #[cfg(feature = "page")]
    pub(crate) fn type_text(&mut self, text: &str) {
        self.call("Input.insertText", json!({ "text": text }));
    }

    /// Shows the page on a phone of this width, and allows touches.
    #[cfg(feature = "page")]
    pub(crate) fn phone(&mut self, width: u32) {
        let screen = json!({ "width": width, "height": 844, "deviceScaleFactor": 2, "mobile": true });
        self.call("Emulation.setDeviceMetricsOverride", screen);
        self.call("Emulation.setTouchEmulationEnabled", json!({ "enabled": true, "maxTouchPoints": 2 }));
    }

    /// Moves two fingers apart, from left and right of a place.
    #[cfg(feature = "page")]
    pub(crate) fn spread_fingers(&mut self, (x, y): (f64, f64)) {
        const STEPS: u32 = 10;
        const STEP_PX: f64 = 10.0;
        for step in 0..=STEPS + 1 {
            let kind = if step == 0 { "touchStart" } else { "touchMove" };
            let away = STEP_PX * f64::from(step.min(STEPS) + 1);
            let points = json!([{ "x": x - away, "y": y, "id": 0 }, { "x": x + away, "y": y, "id": 1 }]);
            self.call("Input.dispatchTouchEvent", json!({ "type": kind, "touchPoints": points }));
        }
        self.call("Input.dispatchTouchEvent", json!({ "type": "touchEnd", "touchPoints": [] }));
    }

    /// Runs a script in each page before its own.
    #[cfg(feature = "page")]
    pub(crate) fn run_first(&mut self, script: &str) {
        self.call("Page.addScriptToEvaluateOnNewDocument", json!({ "source": script }));
    }

    /// Downloads go into a folder.
    #[cfg(feature = "page")]
    pub(crate) fn download_to(&mut self, folder: &Path) {
        let parameters = json!({ "behavior": "allow", "downloadPath": folder.display().to_string() });
        self.call("Browser.setDownloadBehavior", parameters);
    }

    /// Draws the page as it is now: what was opened is laid out only when it is seen.
    pub(crate) fn draw(&mut self) {
        self.call("Page.captureScreenshot", json!({ "format": "jpeg", "quality": 1 }));
    }

    /// Moves, presses or releases the mouse at a place of the window.
    pub(crate) fn mouse(&mut self, kind: &str, (x, y): (f64, f64)) {
        let (button, buttons) = if kind == "mouseMoved" { ("none", 0) } else { ("left", 1) };
        let parameters = json!({ "type": kind, "x": x, "y": y, "button": button, "buttons": buttons, "clickCount": 1 });
        self.call("Input.dispatchMouseEvent", parameters);
    }

    /// Drags from one place to another.
    pub(crate) fn drag(&mut self, from: (f64, f64), to: (f64, f64)) {
        self.mouse("mouseMoved", from);
        self.mouse("mousePressed", from);
        self.mouse("mouseMoved", to);
        self.mouse("mouseReleased", to);
    }

    /// Presses a key where the focus is.
    pub(crate) fn press(&mut self, key: &str, code: u32) {
        for kind in ["rawKeyDown", "keyUp"] {
            let parameters = json!({ "type": kind, "key": key, "code": key, "windowsVirtualKeyCode": code });
            self.call("Input.dispatchKeyEvent", parameters);
        }
    }

    /// Everything that the page asked for since it was opened.
    pub(crate) fn requests(&self) -> Vec<String> {
        self.events_of("Network.requestWillBeSent")
            .map(|event| event["params"]["request"]["url"].as_str().unwrap_or_default().to_owned())
            .collect()
    }

    /// Everything that was written to the console, thrown, or asked since the page was opened.
    pub(crate) fn complaints(&self) -> Vec<String> {
        const KINDS: [&str; 4] =
            ["Runtime.consoleAPICalled", "Runtime.exceptionThrown", "Log.entryAdded", "Page.javascriptDialogOpening"];
        KINDS.into_iter().flat_map(|kind| self.events_of(kind).map(Value::to_string)).collect()
    }

    fn events_of<'a>(&'a self, method: &'a str) -> impl Iterator<Item = &'a Value> {
        self.events.iter().filter(move |event| event["method"] == method)
    }

    fn call(&mut self, method: &str, parameters: Value) -> Value {
        self.next_id += 1;
        let mut command = json!({ "id": self.next_id, "method": method, "params": parameters });
        if let Some(session) = &self.session {
            command["sessionId"] = json!(session);
        }
        self.socket.send(Message::text(command.to_string())).unwrap();
        loop {
            let message = self.next_message();
            if message["id"] == self.next_id {
                assert!(message.get("error").is_none(), "{method}: {message}");
                return message["result"].clone();
            }
            self.events.push(message);
        }
    }

    fn next_message(&mut self) -> Value {
        loop {
            if let Message::Text(text) = self.socket.read().expect("the browser fell silent") {
                return serde_json::from_str(text.as_str()).unwrap();
            }
        }
    }
}

impl Drop for Browser {
    fn drop(&mut self) {
        // it has its own children, which go with it
        let _ = self.child.kill();
        let _ = self.child.wait();
    }
}
