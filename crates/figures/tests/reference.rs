//! Every figure of a small experiment against its committed drawing in `reference/`: the same panels with the same axes, the same words, the same
//! curves within half a millimetre. `HOVERTONE_BLESS=1` writes the drawings anew.

#![allow(clippy::unwrap_used, clippy::print_stdout)] // what tests share has no attribute by which the lints know it

mod drawn;
mod small_experiment;

use drawn::{Structure, pair, structure};
use hovertone_analysis::Method;
use hovertone_figures::{ExperimentFigures, Figure, figure_png, figures_of_experiment, recording_figure};
use small_experiment::{all_heard, heard, tables, trials};
use std::f64::consts::TAU;
use std::path::{Path, PathBuf};

/// Curves may be off by so much, in tenths of a millimetre: arithmetic differs between machines, and a frame at the edge of noise comes or goes.
const UNITS_MAX: f64 = 5.0;
/// Share of a curve's points that must be where they were.
const POINTS_SHARE_MIN: f64 = 0.98;

/// What differs between two drawings, in words.
fn differences(reference: &Structure, drawn: &Structure) -> Vec<String> {
    let mut differences = Vec::new();
    let mut differs = |what: String| differences.push(what);
    if reference.panels.len() != drawn.panels.len() {
        differs(format!("{} panels, {} before", drawn.panels.len(), reference.panels.len()));
    }
    for (before, now) in reference.panels.iter().zip(&drawn.panels) {
        let range = |axes: &[f64], from: usize| (axes[from + 1] - axes[from]).abs();
        let is_near = |index: usize, unit: f64| (before[index] - now[index]).abs() <= unit;
        let is_same = (0..4).all(|index| is_near(index, 0.5))
            && (4..6).all(|index| is_near(index, 0.01 * range(before, 4)))
            && (6..8).all(|index| is_near(index, 0.01 * range(before, 6)));
        if !is_same {
            differs(format!("axes {now:?}, {before:?} before"));
        }
    }
    let is_word = |word: &&String| !word.chars().any(|letter| letter.is_ascii_digit());
    let words = |structure: &Structure| structure.words.iter().filter(is_word).cloned().collect::<Vec<_>>();
    if words(reference) != words(drawn) {
        differs(format!("words {:?}, {:?} before", words(drawn), words(reference)));
    }
    let classes = |structure: &Structure| structure.layers.iter().map(|(class, _)| class.clone()).collect::<Vec<_>>();
    if classes(reference) != classes(drawn) {
        differs(format!("layers {:?}, {:?} before", classes(drawn), classes(reference)));
    }
    for ((class, before), (_, now)) in reference.layers.iter().zip(&drawn.layers) {
        let is_kept =
            |point: &&(f64, f64)| now.iter().any(|other| (point.0 - other.0).hypot(point.1 - other.1) <= UNITS_MAX);
        let kept = before.iter().filter(is_kept).count();
        if (kept as f64) < POINTS_SHARE_MIN * before.len() as f64
            || now.len().abs_diff(before.len()) * 20 > before.len().max(20)
        {
            differs(format!("layer {class}: {kept} of {} points are kept, there are {}", before.len(), now.len()));
        }
    }
    differences
}

fn reference_path(figure: &Figure) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join(format!("tests/reference/{}.svg", figure.name))
}

#[test]
fn figures_are_what_they_were() {
    let heard = all_heard();
    let (trials, tables) = (trials(&heard), tables(&heard));
    let experiment = ExperimentFigures { trials: &trials, tables: &tables, method: Method::Harmonic };
    let mut figures = figures_of_experiment(&experiment).unwrap();
    figures.push(recording_figure(&trials[0], "recording").unwrap().unwrap());
    assert_eq!(figures.len(), 8, "{:?}", figures.iter().map(|figure| &figure.name).collect::<Vec<_>>());
    let blesses = std::env::var_os("HOVERTONE_BLESS").is_some();
    for figure in &figures {
        let path = reference_path(figure);
        if blesses {
            std::fs::write(&path, &figure.svg).unwrap();
        }
        let reference = std::fs::read_to_string(&path).unwrap_or_else(|error| panic!("{}: {error}", path.display()));
        let (before, now) = (structure(&reference), structure(&figure.svg));
        assert!(!now.panels.is_empty() && now.words.len() > 3, "{}: nothing is drawn", figure.name);
        let differences = differences(&before, &now);
        assert!(differences.is_empty(), "{}:\n{}", figure.name, differences.join("\n"));
    }
}

#[test]
fn another_drawing_is_noticed() {
    let heard = vec![heard("light", 1, 300.0)];
    let trials = trials(&heard);
    let svg = recording_figure(&trials[0], "recording").unwrap().unwrap().svg;
    let before = structure(&svg);
    let axis = svg.replacen("data-y-to=\"", "data-y-to=\"1", 1);
    assert!(!differences(&before, &structure(&axis)).is_empty(), "an axis");
    let word = svg.replace("time (s)", "hours");
    assert!(!differences(&before, &structure(&word)).is_empty(), "a word");
    let layer = svg.replacen("class=\"track\"", "class=\"path\"", 1);
    assert!(!differences(&before, &structure(&layer)).is_empty(), "a layer");
    let (head, track) = svg.split_once("class=\"track\"").unwrap();
    let lowered = |line: &str| {
        let Some((points, rest)) = line.split_once('"') else { return line.to_owned() };
        let lower = points.split_whitespace().map(|at| format!("{},{}", pair(at).0, pair(at).1 + 40.0));
        format!("{}\"{rest}", lower.collect::<Vec<_>>().join(" "))
    };
    let mut lines = track.split("points=\"");
    let first = lines.next().unwrap_or_default().to_owned();
    let curve = lines.fold(format!("{head}class=\"track\"{first}"), |text, line| text + "points=\"" + &lowered(line));
    assert!(!differences(&before, &structure(&curve)).is_empty(), "a curve");
}

#[test]
fn the_track_lies_where_the_tone_is() {
    let heard = vec![heard("light", 1, 300.0)];
    let trials = trials(&heard);
    let drawn = structure(&recording_figure(&trials[0], "recording").unwrap().unwrap().svg);
    let axes = &drawn.panels[1];
    let (_, track) = drawn.layers.iter().find(|(class, _)| class == "track").unwrap();
    assert!(track.len() > 50, "{} points", track.len());
    for (x, y) in track {
        let time_s = axes[4] + (x - axes[0]) / (axes[2] - axes[0]) * (axes[5] - axes[4]);
        let hz = axes[6] + (axes[3] - y) / (axes[3] - axes[1]) * (axes[7] - axes[6]);
        let truth_hz = 600.0 * (1.0 + 0.01 * (TAU * 0.5 * time_s).sin());
        // a twentieth of the band, and half a unit of the drawing
        assert!((hz - truth_hz).abs() < 3.0, "{hz} Hz for {truth_hz} Hz at {time_s} s");
    }
}

#[test]
fn a_figure_becomes_the_same_pixels_every_time() {
    let heard = vec![heard("light", 1, 300.0)];
    let figure = recording_figure(&trials(&heard)[0], "recording").unwrap().unwrap();
    let pixels = |bytes: &[u8]| {
        let mut reader = png::Decoder::new(std::io::Cursor::new(bytes)).read_info().unwrap();
        let mut pixels = vec![0; reader.output_buffer_size().unwrap()];
        reader.next_frame(&mut pixels).unwrap();
        (reader.info().width, reader.info().height, pixels)
    };
    let (first, second) = (figure_png(&figure, 100.0).unwrap(), figure_png(&figure, 100.0).unwrap());
    assert_eq!(first, second);
    let (width, height, pixels) = pixels(&first);
    // 180 mm
    assert!(width.abs_diff(709) <= 2, "{width} x {height}");
    let is_ink = |pixel: &&[u8]| pixel.iter().all(|&value| value < 0x90);
    let ink = pixels.chunks(3).filter(is_ink).count();
    assert!(ink > 2000, "letters and axes are missing: {ink} dark pixels");
    // letters of a font that is carried: the title's words leave their mark above the first panel
    let row = |y: u32| &pixels[(y * width * 3) as usize..((y + 1) * width * 3) as usize];
    let marked = (30..50).flat_map(|y| row(y).chunks(3)).filter(is_ink).count();
    assert!(marked > 50, "no letters above the panel: {marked}");
}
