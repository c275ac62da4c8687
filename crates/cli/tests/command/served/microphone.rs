//! The microphone of the page, which a WAV file stands for: the speed now, a guided campaign, and what a browser does to the sound.

use super::{IS_DONE, PATIENCE, Served, click, experiment, saved, select, stayed_at_home};
use crate::chromium::Browser;
use crate::testkit::{hovertone, steady_hover, text, write_hover, write_noise};
use hovertone_sim::paper::LOADS;
use hovertone_vehicle::RotorSpeed;
use std::fs;
use std::path::{Path, PathBuf};
use std::thread;
use std::time::{Duration, Instant};

pub(super) const LISTEN: &str = "Listen with the microphone";
/// The list of known vehicles is there.
const VEHICLES: &str = "document.querySelector('option[value=ardrone]')";
const TRIALS_SHOWN: &str = "document.querySelectorAll('.recording.ok').length";

/// A browser whose microphone hears a file, over and over.
pub(super) fn hearing(profile: &Path, sound: &Path) -> Option<Browser> {
    let switches = ["--use-fake-device-for-media-stream", "--use-fake-ui-for-media-stream"].map(str::to_owned);
    let file = format!("--use-file-for-fake-audio-capture={}", sound.display());
    Browser::start_in(profile, &[&switches[..], &[file]].concat())
}

pub(super) fn open(browser: &mut Browser, served: &Served) {
    browser.open_url(&served.url);
    browser.wait_for("document.querySelector('.drop')", PATIENCE);
}

/// Types a number into the field with a label, among the fields of a CSS selector.
pub(super) fn fill(browser: &mut Browser, fields: &str, label: &str, number: &str) {
    let found = browser.value(&format!(
        "(() => {{ const field = [...document.querySelectorAll({fields:?})].find((each) => each.labels[0]?.innerText.startsWith({label:?})); field?.focus(); field?.select(); return Boolean(field); }})()"
    ));
    assert_eq!(found, true, "there is no field {label}");
    browser.type_text(number);
    browser.press("Tab", 9);
}

#[test]
fn the_speed_of_the_microphone_is_within_its_uncertainty() {
    const SPEED_REV_S: f64 = 60.0;
    let folder = tempfile::tempdir().unwrap();
    let sound = folder.path().join("hover.wav");
    write_hover(&sound, steady_hover("ardrone", RotorSpeed::from_rev_s(SPEED_REV_S), 60.0));
    let Some(mut browser) = hearing(&folder.path().join("profile"), &sound) else { return };
    let served = Served::start();
    open(&mut browser, &served);
    click(&mut browser, LISTEN);
    browser.wait_for(VEHICLES, PATIENCE);
    select(&mut browser, "Known vehicle", "ardrone");
    browser.wait_for("document.querySelector('.now.ok')", PATIENCE);
    let mut shown = Vec::new();
    while shown.len() < 30 {
        let words = browser.text("document.querySelector('.now').innerText");
        let numbers: Vec<f64> = words.split([' ', '\n', '±']).filter_map(|word| word.trim().parse().ok()).collect();
        let [speed, expanded] = numbers[..] else { panic!("{words}") };
        shown.push((speed - SPEED_REV_S).abs() / expanded);
        thread::sleep(Duration::from_millis(100));
    }
    // k = 2: nine of ten are within their ±, and none is far away
    shown.sort_by(f64::total_cmp);
    assert!(shown[26] < 1.0 && shown[29] < 2.0, "{shown:?}");
    let level = browser.text("document.querySelector('.listen meter').textContent");
    assert!(level.ends_with(" dB") && level != "0 dB", "{level}");
    let strip = browser.text("document.querySelector('.strip').ariaLabel");
    assert!(strip.contains("59.") || strip.contains("60."), "{strip}");

    click(&mut browser, "Freeze");
    let time = "document.querySelector('.now').dataset.time";
    let frozen = browser.text(time);
    thread::sleep(Duration::from_millis(500));
    assert_eq!(browser.text(time), frozen);
    click(&mut browser, "Freeze");
    browser.wait_for(&format!("{time} !== {frozen:?}"), PATIENCE);
    click(&mut browser, "Stop listening");
    browser.wait_for("!document.querySelector('[aria-label=Microphone]')", PATIENCE);
    stayed_at_home(&browser, &served);
}

#[test]
fn a_campaign_of_three_loads_gives_the_constant_of_the_command() {
    let folder = tempfile::tempdir().unwrap();
    let sounds = experiment(folder.path());
    let profile = folder.path().join("profile");
    let served = Served::start();
    let downloads = folder.path().join("saved");
    fs::create_dir_all(&downloads).unwrap();
    for (index, load) in LOADS.iter().enumerate() {
        // each load has a sound of its own, and the trials before it outlive the browser
        let Some(mut browser) = hearing(&profile, &sounds[1 + 2 * index]) else { return };
        open(&mut browser, &served);
        browser.download_to(&downloads);
        browser.wait_for(&format!("{TRIALS_SHOWN} === {index}"), PATIENCE);
        click(&mut browser, LISTEN);
        browser.wait_for(&format!("document.querySelector('.step.weigh') && {VEHICLES}"), PATIENCE);
        if index == 0 {
            select(&mut browser, "Known vehicle", "ardrone");
            fill(&mut browser, ".step input", "Vehicle ready to fly", "413");
        }
        let added_g = 1e3 * (load.mass_kg - LOADS[0].mass_kg);
        fill(&mut browser, ".step input", "Added mass", &format!("{added_g:.0}"));
        click(&mut browser, "I am ready to hover");
        browser.wait_for("document.querySelector('.step.recording')", PATIENCE);
        browser.wait_for("document.querySelector('.step.judged .order')", PATIENCE);
        let verdict = browser.text("document.querySelector('.step.judged .order').innerText");
        assert!(verdict.starts_with("Good: ± ") && verdict.ends_with(" %"), "{verdict}");
        open(&mut browser, &served);
        browser.wait_for(&format!("{TRIALS_SHOWN} === {}", index + 1), PATIENCE);
        if index + 1 == LOADS.len() {
            compare(&mut browser, &downloads, LOADS.len());
        }
        stayed_at_home(&browser, &served);
    }
}

/// Asserts that the page and the command say the same of the recorded trials.
fn compare(browser: &mut Browser, downloads: &Path, count: usize) {
    browser.wait_for(IS_DONE, PATIENCE);
    let quote = browser.text("document.querySelector('.constant').dataset.quote");
    click(browser, "experiment.toml");
    let toml = saved(downloads, "experiment.toml");
    for index in 0..count {
        let name = browser.text(&format!(
            "(() => {{ const card = document.querySelectorAll('.recording')[{index}]; [...card.querySelectorAll('button')].find((each) => each.textContent === 'Save the sound').click(); return card.ariaLabel; }})()"
        ));
        assert!(toml.contains(&name), "{name}: {toml}");
        let wav = whole(&downloads.join(&name));
        let reader = hound::WavReader::new(&wav[..]).unwrap();
        assert_eq!(reader.spec().sample_format, hound::SampleFormat::Float);
        let length_s = f64::from(reader.duration()) / f64::from(reader.spec().sample_rate);
        // however busy the machine is, a trial has its ten seconds and no more
        assert!((length_s - 10.0).abs() < 1e-3, "{length_s} s");
    }
    let file = downloads.join("experiment.toml");
    let printed = hovertone(&["identify", text(&file)]).ends_with(0).stdout;
    assert!(quote.starts_with("C_f = (") && printed.contains(&quote), "{quote}\n{printed}");
}

/// The content of a file that is being saved, as soon as it no longer grows.
fn whole(path: &PathBuf) -> Vec<u8> {
    let start = Instant::now();
    let mut last = Vec::new();
    loop {
        thread::sleep(Duration::from_millis(200));
        let now = fs::read(path).unwrap_or_default();
        if !now.is_empty() && now == last {
            return now;
        }
        assert!(start.elapsed() < PATIENCE, "{} was not saved", path.display());
        last = now;
    }
}

#[test]
fn what_a_browser_does_to_the_sound_is_said_and_noise_is_no_rotor() {
    let folder = tempfile::tempdir().unwrap();
    let noise = folder.path().join("noise.wav");
    write_noise(&noise, 20.0);
    let Some(mut browser) = hearing(&folder.path().join("profile"), &noise) else { return };
    let served = Served::start();
    browser.run_first(
        "MediaStreamTrack.prototype.getSettings = () => ({ echoCancellation: false, noiseSuppression: true, autoGainControl: true })",
    );
    open(&mut browser, &served);
    click(&mut browser, LISTEN);
    browser.wait_for("document.querySelector('.listen .fault')", PATIENCE);
    let warning = browser.text("document.querySelector('.listen .fault').innerText");
    assert!(warning.contains("noise suppression, automatic gain"), "{warning}");
    assert!(!warning.contains("echo"), "{warning}");
    browser.wait_for("document.querySelector('.now.no_rotor_tone')", PATIENCE);
    browser.wait_for(
        "document.querySelector('.live .others').innerText.includes('nothing sounds like a rotor')",
        PATIENCE,
    );
    stayed_at_home(&browser, &served);
}

#[test]
fn a_microphone_that_is_not_allowed_is_said() {
    let Some(mut browser) = Browser::start() else { return };
    let served = Served::start();
    open(&mut browser, &served);
    click(&mut browser, LISTEN);
    browser.wait_for("document.querySelector('div.fault')", PATIENCE);
    let fault = browser.text("document.querySelector('div.fault').innerText");
    assert!(fault.contains("microphone") && fault.contains("press Listen again"), "{fault}");
    stayed_at_home(&browser, &served);
}
