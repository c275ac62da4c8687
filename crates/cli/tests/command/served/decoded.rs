//! Sound that hovertone cannot decode: where the browser can, it is heard; where not, the page says what to do.

use super::{INPUT, PATIENCE, Served, select, stayed_at_home};
use crate::chromium::Browser;
use crate::testkit::{hovertone_with, steady_hover, text, write_hover};
use hovertone_vehicle::RotorSpeed;
use std::path::{Path, PathBuf};
use std::process::Command;

const SPEED_REV_S: f64 = 60.0;
const HOVER_S: f64 = 10.0;

/// AAC of six channels, which a browser decodes, in containers with and without a table of packets, and in raw frames.
const DECODED: [(&str, &[&str]); 4] = [
    ("table.m4a", &["-ac", "6", "-c:a", "aac"]),
    ("clusters.mkv", &["-ac", "6", "-c:a", "aac"]),
    ("raw.aac", &["-ac", "6", "-c:a", "aac"]),
    ("pieces.mp4", &["-ac", "6", "-c:a", "aac", "-movflags", "frag_keyframe+empty_moov", "-frag_duration", "1000000"]),
];
/// Sound that neither hovertone nor Chromium decodes: another codec, and another kind of AAC.
const REFUSED: [(&str, &str, &[&str]); 2] = [
    ("ac3.mkv", "AC-3", &["-c:a", "ac3"]),
    ("main.m4a", "AAC", &["-c:a", "aac", "-profile:a", "aac_main", "-strict", "-2"]),
];

/// The sound of a WAV file in another codec; `None` where this ffmpeg has no such encoder.
fn squeezed(wav: &Path, name: &str, codec: &[&str]) -> Option<PathBuf> {
    let file = wav.with_file_name(name);
    let mut ffmpeg = Command::new("ffmpeg");
    ffmpeg.args(["-v", "error", "-i", text(wav), "-b:a", "256k"]).args(codec).arg(&file);
    let is_made = ffmpeg.output().is_ok_and(|run| run.status.success());
    if !is_made {
        println!("skipped: no ffmpeg on the search path, or it cannot make {name}");
    }
    is_made.then_some(file)
}

fn card_of(file: &Path) -> String {
    format!("document.querySelector('.recording[aria-label={:?}]')", file.file_name().unwrap().to_str().unwrap())
}

/// The speed of a recording on the page, and its ±.
fn shown(browser: &mut Browser, file: &Path) -> [f64; 2] {
    let card = card_of(file);
    browser.wait_for(&format!("{card}?.querySelector('.answer')"), PATIENCE);
    let words = browser.text(&format!("{card}.innerText"));
    assert_eq!(browser.value(&format!("{card}.classList.contains('ok')")), true, "{words}");
    [".answer strong", ".plusminus"].map(|part| {
        let number = browser.text(&format!("{card}.querySelector({part:?}).innerText"));
        number.trim_start_matches("± ").parse().unwrap_or_else(|_| panic!("{number} in {words}"))
    })
}

#[test]
fn what_only_the_browser_decodes_has_the_speed_of_the_wav() {
    let Some(mut browser) = Browser::start() else { return };
    let folder = tempfile::tempdir().unwrap();
    let wav = folder.path().join("hover.wav");
    write_hover(&wav, steady_hover("ardrone", RotorSpeed::from_rev_s(SPEED_REV_S), HOVER_S));
    let decoded: Vec<PathBuf> = DECODED.iter().filter_map(|(name, codec)| squeezed(&wav, name, codec)).collect();
    let refused: Vec<(PathBuf, &str)> =
        REFUSED.iter().filter_map(|(name, words, codec)| Some((squeezed(&wav, name, codec)?, *words))).collect();
    if decoded.len() < DECODED.len() {
        return;
    }
    let all: Vec<&Path> = decoded.iter().chain(refused.iter().map(|(file, _)| file)).map(PathBuf::as_path).collect();
    for file in &all {
        let run =
            hovertone_with(&["speed", "--json", "--vehicle", "ardrone", text(file)], |command| command.env("PATH", ""));
        assert!(
            run.stdout.contains("needs the program ffmpeg"),
            "hovertone decodes {}: {}",
            file.display(),
            run.stdout
        );
    }

    let served = Served::start();
    browser.open_url(&served.url);
    browser.wait_for("document.querySelector('.drop')", PATIENCE);
    browser.choose(INPUT, &[&[&*wav], &all[..]].concat());
    browser.wait_for("document.querySelector('option[value=ardrone]')", PATIENCE);
    select(&mut browser, "Known vehicle", "ardrone");
    browser.wait_for(&format!("document.querySelectorAll('.recording.ok').length === {}", 1 + decoded.len()), PATIENCE);
    let [of_wav, expanded_of_wav] = shown(&mut browser, &wav);
    assert!((of_wav - SPEED_REV_S).abs() < expanded_of_wav, "{of_wav} ± {expanded_of_wav}");
    for file in &decoded {
        let [speed, expanded] = shown(&mut browser, file);
        println!("{}: {speed} ± {expanded}, WAV: {of_wav} ± {expanded_of_wav}", file.display());
        assert!((speed - of_wav).abs() <= expanded.hypot(expanded_of_wav), "{}: {speed} and {of_wav}", file.display());
    }
    for (file, codec) in &refused {
        let card = card_of(file);
        browser.wait_for(&format!("{card}.querySelector('.nospeed')"), PATIENCE);
        let words = browser.text(&format!("{card}.innerText"));
        assert!(words.contains(&format!("{codec}, which the page cannot decode")), "{words}");
        assert!(words.contains("WAV or FLAC"), "{words}");
    }
    stayed_at_home(&browser, &served);
}
