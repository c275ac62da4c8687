//! `hovertone serve` and its page in a real browser: from dropped files to the constant of the command, broken files, cancel, a phone.

mod choices;
mod decoded;
mod microphone;
mod offline;
mod picture;

use crate::chromium::Browser;
use crate::lighthouse::Lighthouse;
use crate::testkit::{hovertone, steady_hover, text, write_hover, write_noise};
use hovertone_sim::paper::{GRAVITY_M_S2, LOADS};
use hovertone_sim::scenario::ScenarioFile;
use hovertone_vehicle::RotorSpeed;
use serde_json::Value;
use std::fs;
use std::io::{BufRead, BufReader, Read, Write};
use std::net::TcpStream;
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Stdio};
use std::thread;
use std::time::{Duration, Instant};

const TRIALS: u32 = 2;
const SEED: u64 = 1;
const HOVER_S: f64 = 4.0;
/// The browser calculates on one core that it may share.
const PATIENCE: Duration = Duration::from_secs(180);
/// Transforms of a browser and of the processor's widest units round differently: numbers agree to this share.
const ROUNDING_SHARE: f64 = 1e-5;
/// … and constants to this one.
const ROUNDING_SHARE_OF_CONSTANT: f64 = 1e-8;
const INPUT: &str = "input[type=file]";
const IS_DONE: &str = "document.querySelector('.constant') && document.querySelector('.result').ariaBusy === 'false'";

/// A running `hovertone serve`.
struct Served {
    child: Child,
    url: String,
}

impl Served {
    fn start() -> Self {
        let mut child = Command::new(env!("CARGO_BIN_EXE_hovertone"))
            .args(["serve", "--no-open", "--port", "0"])
            .stdout(Stdio::piped())
            .stderr(Stdio::null())
            .spawn()
            .unwrap();
        let mut url = String::new();
        BufReader::new(child.stdout.take().unwrap()).read_line(&mut url).unwrap();
        Self { child, url: url.trim().to_owned() }
    }

    /// The head of the answer to a request that is written as it is.
    fn answer_to(&self, request: &str) -> String {
        let address = self.url.strip_prefix("http://").unwrap().trim_end_matches('/');
        let mut stream = TcpStream::connect(address).unwrap();
        stream.write_all(request.replace("HOST", address).as_bytes()).unwrap();
        let mut answer = Vec::new();
        stream.read_to_end(&mut answer).unwrap();
        let answer = String::from_utf8_lossy(&answer).into_owned();
        answer.split("\r\n\r\n").next().unwrap_or_default().to_owned()
    }
}

impl Drop for Served {
    fn drop(&mut self) {
        let _ = self.child.kill();
        let _ = self.child.wait();
    }
}

/// The paper's experiment with fewer trials, flown in simulation, and the paths of its files: the experiment file first.
fn experiment(folder: &Path) -> Vec<PathBuf> {
    let mut toml = format!("[vehicle]\npreset = \"ardrone\"\nmass_kg = 0.413\ngravity_m_s2 = {GRAVITY_M_S2}\n");
    let mut files = vec![folder.join("experiment.toml")];
    for (index, load) in LOADS.iter().enumerate() {
        let names: Vec<String> = (1..=TRIALS).map(|trial| format!("load{index}_{trial}.wav")).collect();
        let added_kg = load.mass_kg - LOADS[0].mass_kg;
        toml += &format!("[[load]]\nname = \"{}\"\nadded_mass_kg = {added_kg:.3}\nrecordings = {names:?}\n", load.name);
        for (trial, name) in (0..).zip(&names) {
            let scenario = folder.join("scenario.toml");
            fs::write(&scenario, toml::to_string(&ScenarioFile::paper_trial(load, trial, SEED)).unwrap()).unwrap();
            let flown = folder.join("flown");
            hovertone(&["simulate", text(&scenario), "-o", text(&flown), "--force"]).ends_with(0);
            fs::copy(flown.join("sound.wav"), folder.join(name)).unwrap();
            files.push(folder.join(name));
        }
    }
    fs::write(&files[0], toml).unwrap();
    files
}

/// Asserts that two results say the same, number by number.
fn assert_same(page: &Value, command: &Value, place: &str) {
    match (page, command) {
        (Value::Number(page), Value::Number(command)) => {
            let (page, command) = (page.as_f64().unwrap(), command.as_f64().unwrap());
            let scale = page.abs().max(command.abs());
            assert!((page - command).abs() <= ROUNDING_SHARE * scale + 1e-12, "{place}: {page} and {command}");
        }
        (Value::Array(page), Value::Array(command)) => {
            assert_eq!(page.len(), command.len(), "{place}");
            page.iter().zip(command).enumerate().for_each(|(n, (a, b))| assert_same(a, b, &format!("{place}[{n}]")));
        }
        (Value::Object(page), Value::Object(command)) => {
            let keys = |map: &serde_json::Map<String, Value>| map.keys().cloned().collect::<Vec<_>>();
            assert_eq!(keys(page), keys(command), "{place}");
            page.iter().for_each(|(key, value)| assert_same(value, &command[key], &format!("{place}.{key}")));
        }
        _ => assert_eq!(page, command, "{place}"),
    }
}

fn click(browser: &mut Browser, words: &str) {
    let found = browser.value(&format!(
        "(() => {{ const button = [...document.querySelectorAll('button')].find((each) => each.textContent.startsWith({words:?}) || each.ariaLabel === {words:?}); button?.click(); return Boolean(button); }})()"
    ));
    assert_eq!(found, true, "there is no button {words}");
}

/// The content of a file that the page saves, as soon as it is whole.
fn saved(folder: &Path, name: &str) -> String {
    let start = Instant::now();
    loop {
        match fs::read_to_string(folder.join(name)) {
            Ok(content) if !content.is_empty() => return content,
            _ => assert!(start.elapsed() < PATIENCE, "{name} was not saved"),
        }
        thread::sleep(Duration::from_millis(50));
    }
}

/// Asserts that the page asked nobody but its own server, and said nothing on the console.
fn stayed_at_home(browser: &Browser, served: &Served) {
    let is_own = |url: &String| url.starts_with(&served.url) || url.starts_with("blob:") || url.starts_with("data:");
    let foreign: Vec<String> = browser.requests().into_iter().filter(|url| !is_own(url)).collect();
    assert_eq!(foreign, [""; 0]);
    assert_eq!(browser.complaints(), [""; 0]);
}

#[test]
fn dropped_files_give_the_constant_of_the_command() {
    let Some(mut browser) = Browser::start() else { return };
    let folder = tempfile::tempdir().unwrap();
    let files = experiment(folder.path());
    let results = hovertone(&["identify", text(&files[0]), "--json"]).ends_with(0).stdout;
    let command: Value = serde_json::from_str(&results).unwrap();
    let printed = hovertone(&["identify", text(&files[0])]).ends_with(0).stdout;

    let served = Served::start();
    let downloads = folder.path().join("saved");
    fs::create_dir_all(&downloads).unwrap();
    browser.open_url(&served.url);
    browser.download_to(&downloads);
    browser.wait_for("document.querySelector('.drop')", PATIENCE);
    browser.choose(INPUT, &files.iter().map(PathBuf::as_path).collect::<Vec<_>>());
    browser.wait_for(IS_DONE, PATIENCE);

    let quote = browser.text("document.querySelector('.constant').dataset.quote");
    assert!(quote.starts_with("C_f = (") && printed.contains(&quote), "{quote}\n{printed}");
    click(&mut browser, "results.json");
    let mut page: Value = serde_json::from_str(&saved(&downloads, "results.json")).unwrap();
    // the page writes the experiment file itself, so that its hash is another
    page["settings"]["sha256"] = command["settings"]["sha256"].clone();
    assert_same(&page, &command, "results");
    let constant = |results: &Value| results["thrust_constant_total_n_s2"]["value"].as_f64().unwrap();
    let share = constant(&page) / constant(&command) - 1.0;
    assert!(share.abs() < ROUNDING_SHARE_OF_CONSTANT, "{share}");

    // what the page saves, the command takes
    click(&mut browser, "experiment.toml");
    let own = saved(&downloads, "experiment.toml");
    let own_file = folder.path().join("of_the_page.toml");
    fs::write(&own_file, own).unwrap();
    let again = hovertone(&["identify", text(&own_file)]).ends_with(0).stdout;
    assert!(again.contains(&quote), "{quote}\n{again}");
    click(&mut browser, "report.html");
    let report = saved(&downloads, "report.html");
    assert!(report.trim_end().ends_with("</html>") && report.contains("C_f"), "{} bytes", report.len());
    stayed_at_home(&browser, &served);
}

/// Chooses an entry of a list of the page.
fn select(browser: &mut Browser, label: &str, value: &str) {
    let found = browser.value(&format!(
        "(() => {{ const list = [...document.querySelectorAll('select')].find((each) => (each.ariaLabel ?? each.labels[0]?.innerText) === {label:?}); list.value = {value:?}; list.dispatchEvent(new Event('change', {{ bubbles: true }})); return list.value; }})()"
    ));
    assert_eq!(found, value, "{label}");
}

#[test]
fn loads_are_made_by_hand_while_the_page_computes() {
    let Some(mut browser) = Browser::start() else { return };
    let folder = tempfile::tempdir().unwrap();
    let files = experiment(folder.path());
    let [light, heavy] = [&files[1], &files[5]];
    let served = Served::start();
    browser.open_url(&served.url);
    browser.wait_for("document.querySelector('.drop')", PATIENCE);
    browser.choose(INPUT, &[light, heavy]);
    browser.wait_for("document.querySelectorAll('.recording .answer').length === 2", PATIENCE);
    select(&mut browser, "Known vehicle", "ardrone");
    click(&mut browser, "Add a load");
    click(&mut browser, "Add a load");
    for (path, load) in [(light, "0"), (heavy, "1")] {
        select(&mut browser, &format!("Load of {}", path.file_name().unwrap().to_str().unwrap()), load);
    }
    browser.value("document.querySelectorAll('.load')[1].querySelector('input[type=number]').select()");
    for digit in ["4", "9"] {
        browser.type_text(digit);
        // the fit is running, and shows its progress
        thread::sleep(Duration::from_millis(500));
    }
    browser.press("Tab", 9);
    browser.wait_for(
        &format!("{IS_DONE} && document.querySelector('.result table').innerText.includes('462.0')"),
        PATIENCE,
    );
    let quote = browser.text("document.querySelector('.constant').dataset.quote");
    assert!(quote.starts_with("C_f = (7.0") || quote.starts_with("C_f = (7.1"), "{quote}");
    stayed_at_home(&browser, &served);
}

#[test]
fn what_cannot_be_heard_says_why() {
    let Some(mut browser) = Browser::start() else { return };
    let folder = tempfile::tempdir().unwrap();
    let [broken, noise, empty] = ["broken.mp4", "noise.wav", "empty.wav"].map(|name| folder.path().join(name));
    fs::write(&broken, "this is no film").unwrap();
    fs::write(&empty, "").unwrap();
    write_noise(&noise, HOVER_S);
    let toml = folder.path().join("wrong.toml");
    fs::write(&toml, "[vehicle]\nmas_kg = 1\n").unwrap();
    let served = Served::start();
    browser.open_url(&served.url);
    browser.wait_for("document.querySelector('.drop')", PATIENCE);
    browser.choose(INPUT, &[&broken, &noise, &empty, &toml]);
    browser.wait_for("document.querySelectorAll('.recording .nospeed').length === 3", PATIENCE);
    browser.wait_for("document.querySelector('div.fault')", PATIENCE);
    let cards = browser.text("document.querySelector('[aria-label=Recordings]').innerText");
    for words in ["could not be read", "not an audio or video file", "no rotor tone", "there is nothing in it"] {
        assert!(cards.contains(words), "{words}: {cards}");
    }
    let fault = browser.text("document.querySelector('div.fault').innerText");
    assert!(fault.contains("wrong.toml") && fault.contains("mas_kg"), "{fault}");
    stayed_at_home(&browser, &served);
}

#[test]
fn a_recording_is_cancelled_and_heard_again() {
    let Some(mut browser) = Browser::start() else { return };
    let folder = tempfile::tempdir().unwrap();
    let long = folder.path().join("long.wav");
    write_hover(&long, steady_hover("ardrone", RotorSpeed::from_rev_s(60.0), 30.0));
    let served = Served::start();
    browser.open_url(&served.url);
    browser.wait_for("document.querySelector('.drop')", PATIENCE);
    browser.choose(INPUT, &[&long]);
    browser.wait_for("document.querySelector('.working progress')?.value > 0", PATIENCE);
    click(&mut browser, "Cancel");
    browser.wait_for("document.querySelector('.working')?.innerText.includes('cancelled')", PATIENCE);
    click(&mut browser, "Hear it again");
    browser.wait_for("document.querySelector('.recording .answer')", PATIENCE);
    stayed_at_home(&browser, &served);
}

#[test]
fn the_example_fits_a_phone_and_a_wide_screen_in_both_colours() {
    let Some(mut browser) = Browser::start() else { return };
    let served = Served::start();
    browser.screen(390);
    browser.open_url(&served.url);
    browser.wait_for("document.querySelector('.steps')", PATIENCE);
    click(&mut browser, "Try an example");
    browser.wait_for(IS_DONE, PATIENCE);
    browser.wait_for("document.querySelector('canvas')", PATIENCE);
    let verdict = browser.text("document.querySelector('.verdict').innerText");
    assert!(verdict.contains("every load agrees"), "{verdict}");
    for width in [390, 1200, 3840] {
        for scheme in ["light", "dark"] {
            browser.screen(width);
            browser.medium("screen", scheme);
            browser.draw();
            let wide = browser.value("document.documentElement.scrollWidth");
            assert!(wide.as_f64().unwrap() <= f64::from(width), "{width} px, {scheme}: the page is {wide} px wide");
            let small = browser.value(
                "[...document.querySelectorAll('button, select, input:not([type=checkbox], [hidden])')].filter((each) => each.checkVisibility() && each.getBoundingClientRect().height < 24).map((each) => each.outerHTML)",
            );
            assert_eq!(small, Value::Array(Vec::new()), "{width} px, {scheme}: too small for a finger");
        }
    }
    stayed_at_home(&browser, &served);
}

#[test]
fn lighthouse_is_content_with_the_served_page() {
    let Some(lighthouse) = Lighthouse::found() else { return };
    let served = Served::start();
    let found = lighthouse.look_at(&served.url, "accessibility,best-practices");
    for category in ["accessibility", "best-practices"] {
        let score = found["categories"][category]["score"].as_f64().unwrap();
        let faults: Vec<&Value> =
            found["audits"].as_object().unwrap().values().filter(|audit| audit["score"] == 0.0).collect();
        assert!(score >= 0.95, "{category}: {score}\n{faults:#?}");
    }
}

#[test]
fn only_the_own_address_is_served() {
    let served = Served::start();
    let status = |request: &str| served.answer_to(request).lines().next().unwrap_or_default().to_owned();
    let good = served.answer_to("GET / HTTP/1.1\r\nHost: HOST\r\nConnection: close\r\n\r\n");
    assert!(
        good.starts_with("HTTP/1.1 200") && good.contains("'wasm-unsafe-eval'") && !good.contains("unsafe-inline"),
        "{good}"
    );
    assert!(status("GET / HTTP/1.1\r\nHost: evil.example\r\nConnection: close\r\n\r\n").contains("421"));
    assert!(
        status("GET / HTTP/1.1\r\nHost: HOST\r\nOrigin: http://evil.example\r\nConnection: close\r\n\r\n")
            .contains("403")
    );
    assert!(status("GET /../../etc/passwd HTTP/1.1\r\nHost: HOST\r\nConnection: close\r\n\r\n").contains("404"));
    assert!(status("DELETE / HTTP/1.1\r\nHost: HOST\r\nConnection: close\r\n\r\n").contains("405"));
}
