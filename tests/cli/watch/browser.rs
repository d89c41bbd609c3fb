//! A headless Chromium, driven over WebDriver (W3C).

use crate::watch::program::{PATIENCE, client};
use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use serde_json::{Value, json};
use std::io::{BufRead, BufReader, Read};
use std::process::{Child, Command, Stdio};
use std::thread;
use std::time::{Duration, Instant};

/// A browser with one page, which is closed when it is dropped.
pub struct Browser {
    driver: Child,
    session: String,
}

impl Browser {
    /// Opens this page, if there is a browser.
    pub fn open(url: &str) -> Option<Self> {
        let there = |program: &str| {
            let ran =
                Command::new(program).arg("--version").stdout(Stdio::null()).stderr(Stdio::null()).status();
            ran.is_ok_and(|status| status.success())
        };
        if !there("chromium") || !there("chromedriver") {
            eprintln!(
                "SKIPPED: there is no `chromium` or no `chromedriver` (Debian: chromium chromium-driver)"
            );
            return None;
        }
        // Of several that start at the same time, one may find its port taken.
        let started = (0..10).find_map(|_| start_driver());
        let (driver, port) = started.expect("chromedriver tells its port");
        let mut browser = Self { driver, session: format!("http://127.0.0.1:{port}/session") };
        let args = ["--headless=new", "--no-sandbox", "--disable-dev-shm-usage", "--window-size=1360,850"];
        let options = json!({ "args": args, "binary": "/usr/bin/chromium" });
        let wanted = json!({ "browserName": "chrome", "goog:chromeOptions": options });
        let session = browser.post("", json!({ "capabilities": { "alwaysMatch": wanted } }));
        browser.session += "/";
        browser.session += session["sessionId"].as_str().expect("a session");
        browser.go(url);
        Some(browser)
    }

    /// Opens another page.
    pub fn go(&self, url: &str) {
        self.post("/url", json!({ "url": url }));
    }

    fn post(&self, path: &str, body: Value) -> Value {
        value(client().post(format!("{}{path}", self.session)).send_json(body))
    }

    /// Runs JavaScript and returns its value.
    pub fn run(&self, script: &str) -> Value {
        self.post("/execute/sync", json!({ "script": script, "args": [] }))
    }

    /// Runs JavaScript that passes a value to the function `done`, and returns this value.
    pub fn run_until_done(&self, script: &str) -> Value {
        let script = format!("const done = arguments[arguments.length - 1]; {script}");
        self.post("/execute/async", json!({ "script": script, "args": [] }))
    }

    /// Runs a command of the protocol of the browser's developer tools.
    fn command(&self, name: &str, params: Value) {
        self.post("/goog/cdp/execute", json!({ "cmd": name, "params": params }));
    }

    /// Shows the page as on a screen of this size in pixels, touched by fingers if so, in light or dark colours, and
    /// waits until the image fits in its width: what a touch aims at lies elsewhere before.
    pub fn emulate(&self, [width, height]: [u32; 2], has_fingers: bool, scheme: &str) {
        let screen =
            json!({ "width": width, "height": height, "deviceScaleFactor": 1, "mobile": has_fingers });
        self.command("Emulation.setDeviceMetricsOverride", screen);
        self.command("Emulation.setTouchEmulationEnabled", json!({ "enabled": has_fingers }));
        let feature = json!({ "name": "prefers-color-scheme", "value": scheme });
        self.command("Emulation.setEmulatedMedia", json!({ "features": [feature] }));
        self.wait(&format!(
            "innerWidth === {width} && document.querySelector('canvas').getBoundingClientRect().right < {width}"
        ));
    }

    /// Puts fingers on the screen, each at the first of its places, moves them to the others and lifts them.
    pub fn touch(&self, fingers: &[&[[i64; 2]]]) {
        let finger = |(index, places): (usize, &&[[i64; 2]])| {
            let to = |[x, y]: &[i64; 2]| json!({ "type": "pointerMove", "x": x, "y": y, "duration": 30 });
            let mut actions: Vec<_> = places.iter().map(to).collect();
            actions.insert(1, json!({ "type": "pointerDown", "button": 0 }));
            actions.push(json!({ "type": "pointerUp", "button": 0 }));
            let kind = json!({ "pointerType": "touch" });
            json!({ "type": "pointer", "id": format!("finger{index}"), "parameters": kind, "actions": actions })
        };
        let actions: Vec<_> = fingers.iter().enumerate().map(finger).collect();
        self.post("/actions", json!({ "actions": actions }));
    }

    pub fn text(&self, script: &str) -> String {
        self.run(script).as_str().unwrap_or_default().to_owned()
    }

    /// Waits until a JavaScript expression is true.
    pub fn wait(&self, condition: &str) {
        let start = Instant::now();
        while self.run(&format!("return !!({condition})")) != true {
            assert!(
                start.elapsed() < PATIENCE,
                "waited for {condition}: {}",
                self.run("return document.body.innerText")
            );
            thread::sleep(Duration::from_millis(20));
        }
    }

    /// Clicks at a position in the window.
    pub fn click(&self, [x, y]: [i64; 2]) {
        let actions = json!([
            { "type": "pointerMove", "x": x, "y": y },
            { "type": "pointerDown", "button": 0 },
            { "type": "pointerUp", "button": 0 },
        ]);
        self.post(
            "/actions",
            json!({ "actions": [{ "type": "pointer", "id": "mouse", "actions": actions }] }),
        );
    }

    /// Presses a button of the mouse (0 left, 2 right) at a position in the window, moves to others and lets go, while a key
    /// is held.
    pub fn drag(&self, button: u8, key: Option<char>, places: &[[i64; 2]]) {
        let [first, rest @ ..] = places else { return };
        let move_to = |[x, y]: &[i64; 2]| json!({ "type": "pointerMove", "x": x, "y": y, "duration": 20 });
        let down = json!({ "type": "pointerDown", "button": button });
        let mut mouse = vec![move_to(first), down];
        mouse.extend(rest.iter().map(move_to));
        mouse.push(json!({ "type": "pointerUp", "button": button }));
        let mut keys = vec![json!({ "type": "pause" })];
        if let Some(key) = key {
            keys = vec![json!({ "type": "keyDown", "value": key })];
            keys.resize(mouse.len(), json!({ "type": "pause" }));
            keys.push(json!({ "type": "keyUp", "value": key }));
        }
        let actions = json!([
            { "type": "key", "id": "keys", "actions": keys },
            { "type": "pointer", "id": "mouse", "actions": mouse },
        ]);
        self.post("/actions", json!({ "actions": actions }));
    }

    /// Turns the wheel at a position in the window, by this many pixels down.
    pub fn wheel(&self, [x, y]: [i64; 2], down: i64) {
        let turn = json!({ "type": "scroll", "x": x, "y": y, "deltaX": 0, "deltaY": down });
        self.post("/actions", json!({ "actions": [{ "type": "wheel", "id": "wheel", "actions": [turn] }] }));
    }

    pub fn press(&self, key: char) {
        let actions = json!([{ "type": "keyDown", "value": key }, { "type": "keyUp", "value": key }]);
        self.post("/actions", json!({ "actions": [{ "type": "key", "id": "keys", "actions": actions }] }));
    }

    /// Returns a screenshot of the window, as a PNG.
    pub fn screenshot(&self) -> Vec<u8> {
        let answer = value(client().get(format!("{}/screenshot", self.session)).call());
        STANDARD.decode(answer.as_str().expect("text")).expect("base64")
    }
}

/// Starts a driver, and returns it with its port, unless it ends before it has one.
fn start_driver() -> Option<(Child, String)> {
    let mut driver = Command::new("chromedriver")
        .arg("--port=0")
        .stdout(Stdio::piped())
        .stderr(Stdio::null())
        .spawn()
        .expect("chromedriver runs");
    let mut stdout = BufReader::new(driver.stdout.take().expect("its messages"));
    let started = |line: String| Some(line.split_once("started successfully on port ")?.1.to_owned());
    let port = stdout.by_ref().lines().map_while(Result::ok).find_map(started);
    let Some(port) = port else {
        driver.wait().expect("it has ended");
        return None;
    };
    thread::spawn(move || stdout.read_to_end(&mut Vec::new()));
    Some((driver, port.trim_end_matches(|c: char| !c.is_ascii_digit()).to_owned()))
}

impl Drop for Browser {
    fn drop(&mut self) {
        let _ = client().delete(&self.session).call();
        let _ = self.driver.kill();
        let _ = self.driver.wait();
    }
}

fn value(answer: Result<ureq::http::Response<ureq::Body>, ureq::Error>) -> Value {
    let mut answer = answer.expect("chromedriver answers");
    let body: Value = answer.body_mut().with_config().limit(1 << 26).read_json().expect("JSON");
    assert!(answer.status().is_success(), "{body}");
    body["value"].clone()
}
