//! A person decides for one of the possible speeds: of the microphone, and of a recording.

use super::microphone::{LISTEN, fill, hearing, open};
use super::{INPUT, PATIENCE, Served, click, stayed_at_home};
use crate::chromium::Browser;
use crate::testkit::write_wav;
use hovertone_sim::prescribed::{Line, Noise, Recording, Rotor, Sampling, seeded};
use std::path::{Path, PathBuf};

/// The buttons of the possible speeds that the microphone has.
const CHOICES: &str = "[...document.querySelectorAll('[aria-label=\"Possible speeds\"] button')]";

/// Writes tones at the multiples of 180 Hz in noise: two blades at 90 rev/s sound so, and three at 60 rev/s.
fn write_tones_of_two_or_three_blades(path: &Path) {
    const RATE_HZ: u32 = 48_000;
    let lines = (1..=4).map(|order| Line::new(f64::from(order), 0.2 / f64::from(order))).collect();
    let mut tones = Recording::of_rotors(&[Rotor::steady(180.0, lines)], Sampling::new(f64::from(RATE_HZ), 12.0));
    tones.add_noise(&Noise::white(0.02), &mut seeded(1));
    write_wav(path, &tones.samples_f32(), RATE_HZ);
}

/// The page in a browser whose microphone hears a file.
struct OpenPage {
    browser: Browser,
    served: Served,
    sound: PathBuf,
}

fn page_that_hears_tones(folder: &Path) -> Option<OpenPage> {
    let sound = folder.join("tones.wav");
    write_tones_of_two_or_three_blades(&sound);
    let mut browser = hearing(&folder.join("profile"), &sound)?;
    let served = Served::start();
    open(&mut browser, &served);
    Some(OpenPage { browser, served, sound })
}

#[test]
fn a_person_decides_for_one_of_the_possible_speeds() {
    let large_speed = |browser: &mut Browser| -> f64 {
        let words = browser.text("document.querySelector('.now strong').innerText");
        words.parse().unwrap_or_else(|_| panic!("{words} is no speed"))
    };
    let folder = tempfile::tempdir().unwrap();
    let Some(OpenPage { mut browser, served, .. }) = page_that_hears_tones(folder.path()) else { return };
    click(&mut browser, LISTEN);
    let offered = |blades: u32| format!("{CHOICES}.find((each) => each.innerText.includes(', {blades} blades,'))");
    browser
        .wait_for(&format!("{} && {} && document.querySelector('.now.ambiguous')", offered(2), offered(3)), PATIENCE);
    let before_rev_s = large_speed(&mut browser);
    assert!((before_rev_s / 90.0 - 1.0).abs() < 0.01, "{before_rev_s} rev/s");
    let said = browser.text("document.querySelector('.now').parentElement.innerText");
    assert!(said.contains("one of several possible speeds") && !said.contains('±'), "{said}");

    browser.value(&format!("{}.click()", offered(3)));
    // the vehicle has three blades now, and the sound is heard again by that
    browser.wait_for(
        &format!("document.querySelector('.now.ok strong')?.innerText.match(/^(59|60)[.]/) && {CHOICES}.length === 0"),
        PATIENCE,
    );
    let after_rev_s = large_speed(&mut browser);
    assert!((after_rev_s / 60.0 - 1.0).abs() < 0.01, "{after_rev_s} rev/s");
    let blades = browser.text(
        "[...document.querySelectorAll('input')].find((each) => each.labels[0]?.innerText.startsWith('Blades each')).value",
    );
    assert_eq!(blades, "3");
    stayed_at_home(&browser, &served);
}

/// With two blades, 90 rev/s and twice as much differ by the speed alone.
#[test]
fn a_person_decides_for_one_of_two_octaves() {
    let folder = tempfile::tempdir().unwrap();
    let Some(OpenPage { mut browser, served, sound }) = page_that_hears_tones(folder.path()) else { return };
    browser.choose(INPUT, &[&sound]);
    browser.wait_for("document.querySelector('.recording .nospeed')", PATIENCE);
    fill(&mut browser, "input", "Blades each", "2");
    let readings = "[...document.querySelectorAll('.readings li')]";
    let faster = format!("{readings}.find((each) => each.innerText.match(/2 blades.* (179|180)[.]?[0-9]* rev/))");
    browser.wait_for(&format!("{readings}.every((each) => each.innerText.includes('2 blades')) && {faster}"), PATIENCE);
    browser.value(&format!("{faster}.querySelector('button').click()"));
    // a wide ± may leave no decimals
    browser.wait_for("document.querySelector('.recording .answer strong')?.innerText.match(/^(179|180)\\b/)", PATIENCE);

    // the same of the microphone, by the same blades
    click(&mut browser, LISTEN);
    let live = format!("{CHOICES}.find((each) => each.innerText.match(/(179|180)\\b/))");
    browser.wait_for(&live, PATIENCE);
    browser.value(&format!("{live}.click()"));
    browser.wait_for("document.querySelector('.now.ok strong')?.innerText.match(/^(179|180)\\b/)", PATIENCE);
    stayed_at_home(&browser, &served);
}
