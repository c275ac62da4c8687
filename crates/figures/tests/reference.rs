//! Every figure of a small experiment against its committed drawing in `reference/`: the same panels with the same axes, the same words, the same
//! curves within half a millimetre. `HOVERTONE_BLESS=1` writes the drawings anew.

#![allow(clippy::unwrap_used, clippy::print_stdout)] // what tests share has no attribute by which the lints know it

use hovertone_analysis::{Meaning, Method, Outcome, Reading, RotorEstimate, Span, SpeedAnalysis};
use hovertone_figures::{ExperimentFigures, Figure, Trial, figure_png, figures_of_experiment, recording_figure};
use hovertone_figures::{PictureConfig, Pictures, pictures_from_source, views_of_recording};
use hovertone_rotor_speed::{Config, ToneConfig, speed_from_source};
use hovertone_signal::Signal;
use hovertone_thrust::{Force, LoadSpeeds, ThrustSettings, ThrustTable, TrialSpeeds, thrust_from_loads};
use hovertone_vehicle::{Order, RotorSpeed};
use roxmltree::{Document, Node};
use std::f64::consts::TAU;
use std::path::{Path, PathBuf};

const RATE_HZ: f64 = 16_000.0;
const LENGTH_S: f64 = 6.0;
/// Curves may be off by so much, in tenths of a millimetre: arithmetic differs between machines, and a frame at the edge of noise comes or goes.
const UNITS_MAX: f64 = 5.0;
/// Share of a curve's points that must be where they were.
const POINTS_SHARE_MIN: f64 = 0.98;

/// Two blades at a speed that sways by 1 %, three harmonics, in noise.
fn hover(speed_rev_s: f64, seed: u64) -> Signal {
    let (mut state, mut turn) = (seed, 0.0);
    let samples = (0..(LENGTH_S * RATE_HZ) as usize).map(|n| {
        state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        let noise = 0.02 * ((state >> 40) as f64 / (1_u64 << 23) as f64 - 1.0);
        turn += speed_rev_s * (1.0 + 0.01 * (TAU * 0.5 * n as f64 / RATE_HZ).sin()) / RATE_HZ;
        let line = |harmonic: f64| (TAU * 2.0 * harmonic * turn).sin() / harmonic;
        (0.1 * (line(1.0) + line(2.0) + line(3.0)) + noise) as f32
    });
    Signal::new(samples.collect(), RATE_HZ)
}

struct Heard {
    load: &'static str,
    name: String,
    analysis: SpeedAnalysis,
    pictures: Pictures,
}

fn heard(load: &'static str, number: u64, speed_rev_s: f64) -> Heard {
    let mut source = hover(speed_rev_s, number);
    let config = Config { all_methods: true, ..Config::for_tone(ToneConfig::of_order(Order::from_blades(2).unwrap())) };
    let analysis = speed_from_source(&mut source, &config, &mut |_| {}).unwrap();
    let Outcome::Ok(tone) = &analysis.outcome else { panic!("no tone in {load}: {:?}", analysis.outcome) };
    let config = PictureConfig { rows_max: 64, columns_max: 64, ..PictureConfig::default() };
    let views = views_of_recording(Some(tone), RATE_HZ, &config);
    let all = Span { from_s: 0.0, to_s: LENGTH_S };
    let pictures = pictures_from_source(&mut source, all, &views, &analysis.hover.segments, &config).unwrap();
    Heard { load, name: format!("{load}/{number}.wav"), analysis, pictures }
}

/// Two loads of two trials.
fn all_heard() -> Vec<Heard> {
    vec![heard("light", 1, 300.0), heard("light", 2, 301.0), heard("heavy", 3, 330.0), heard("heavy", 4, 329.0)]
}

fn trials(heard: &[Heard]) -> Vec<Trial<'_>> {
    heard
        .iter()
        .map(|Heard { load, name, analysis, pictures }| Trial {
            load,
            recording: name,
            analysis: Some(analysis),
            reason: None,
            readings: &[],
            method: Method::Harmonic,
            pictures: Some(pictures),
        })
        .collect()
}

fn tables(heard: &[Heard]) -> Vec<ThrustTable> {
    let speeds = |method: Method| -> Vec<LoadSpeeds> {
        [("light", 0.0), ("heavy", 0.1)]
            .map(|(load, added_mass_kg)| LoadSpeeds {
                name: load.to_owned(),
                force: Force::Weight {
                    vehicle_mass_kg: 0.5,
                    added_mass_kg,
                    mass_std_kg: 0.0005,
                    gravity_m_s2: 9.8,
                    gravity_std_m_s2: 0.0005,
                },
                rotors_running: 4,
                power_w: None,
                trials: heard
                    .iter()
                    .filter(|one| one.load == load)
                    .map(|one| match TrialSpeeds::from_analysis(&one.name, &one.analysis, method) {
                        Some(trial) => trial,
                        None => panic!("no tone"),
                    })
                    .collect(),
            })
            .to_vec()
    };
    [Method::Harmonic, Method::MaximumTrace, Method::Gaussian]
        .map(|method| thrust_from_loads(&speeds(method), method, &ThrustSettings::for_rotors(4)))
        .to_vec()
}

/// What a drawing shows.
#[derive(Debug, Default)]
struct Structure {
    /// Axes of every panel: place and range.
    panels: Vec<Vec<f64>>,
    words: Vec<String>,
    /// Classes of the layers, and for each the points of all that is drawn in it.
    layers: Vec<(String, Vec<(f64, f64)>)>,
}

fn structure(svg: &str) -> Structure {
    const AXES: [&str; 8] =
        ["data-left", "data-top", "data-right", "data-bottom", "data-x-from", "data-x-to", "data-y-from", "data-y-to"];
    let drawn = Document::parse(svg).unwrap();
    let number = |node: Node<'_, '_>, name: &str| node.attribute(name).unwrap().parse::<f64>().unwrap();
    let mut structure = Structure::default();
    for group in drawn.root_element().children().filter(|node| node.has_tag_name(("http://www.w3.org/2000/svg", "g"))) {
        let class = group.attribute("class").unwrap().to_owned();
        if class == "panel" {
            structure.panels.push(AXES.map(|name| number(group, name)).to_vec());
        }
        let inside = || group.descendants();
        structure
            .words
            .extend(inside().filter_map(|node| Some(node.text()?.trim().to_owned())).filter(|text| !text.is_empty()));
        let points = inside().flat_map(|node| match node.tag_name().name() {
            "polyline" | "polygon" => node.attribute("points").unwrap().split_whitespace().map(pair).collect(),
            "circle" => vec![(number(node, "cx"), number(node, "cy"))],
            "rect" | "image" => vec![(number(node, "x"), number(node, "y"))],
            _ => Vec::new(),
        });
        structure.layers.push((class, points.collect()));
    }
    structure
}

fn pair(text: &str) -> (f64, f64) {
    let (x, y) = text.split_once(',').unwrap();
    (x.parse().unwrap(), y.parse().unwrap())
}

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

/// Class and colour of everything that is drawn in the layers of a class, with the words beside it.
fn strokes(svg: &str, class: &str) -> Vec<(String, Vec<String>, Vec<String>)> {
    let drawn = Document::parse(svg).unwrap();
    let layers = drawn.descendants().filter(|node| node.attribute("class").is_some_and(|all| all.starts_with(class)));
    layers
        .map(|layer| {
            let lines =
                layer.descendants().filter(|node| node.has_tag_name(("http://www.w3.org/2000/svg", "polyline")));
            let colours = lines.map(|line| line.attribute("stroke").unwrap().to_owned()).collect();
            let texts = layer.descendants().filter(|node| node.has_tag_name(("http://www.w3.org/2000/svg", "text")));
            let words = texts.filter_map(|node| Some(node.text()?.trim().to_owned()));
            let words = words.filter(|word| !word.is_empty()).collect();
            (layer.attribute("class").unwrap().to_owned(), colours, words)
        })
        .collect()
}

#[test]
fn the_track_of_each_rotor_has_a_key_above_the_spectrogram() {
    let mut heard = vec![heard("light", 1, 300.0)];
    let Outcome::Ok(tone) = &mut heard[0].analysis.outcome else { panic!("no tone") };
    tone.rotors = [1.01, 1.0, 0.99]
        .map(|ratio| {
            let mut track = tone.track.clone();
            track.iter_mut().for_each(|point| point.speed_rev_s *= ratio);
            RotorEstimate { speed: tone.speeds[0].clone(), merged: Vec::new(), track, condition: None }
        })
        .to_vec();
    let svg = recording_figure(&trials(&heard)[0], "recording").unwrap().unwrap().svg;
    let tracks = strokes(&svg, "tracks rotor-");
    assert_eq!(tracks.len(), 3);
    let keys = strokes(&svg, "key rotors");
    // one key for each of the two pictures
    assert_eq!(keys.len(), 2, "{keys:?}");
    for (_, colours, words) in keys {
        assert_eq!(words, ["rotor 1", "rotor 2", "rotor 3"]);
        for ((class, of_track, _), of_key) in tracks.iter().zip(&colours) {
            assert!(!of_track.is_empty() && of_track.iter().all(|colour| colour == of_key), "{class}: {of_track:?}");
        }
        assert!(colours[0] != colours[1] && colours[1] != colours[2], "{colours:?}");
    }
}

#[test]
fn an_ambiguous_tone_shows_its_track_and_its_other_readings() {
    let heard = vec![heard("light", 1, 300.0)];
    let order = Order::from_blades(2).unwrap();
    let reading = |speed_rev_s: f64, plausibility: f64| {
        let speed = RotorSpeed::from_rev_s(speed_rev_s);
        Reading {
            order,
            tone_hz: speed.tone_hz(order),
            meaning: Meaning::BladePass { blades: 2 },
            speed,
            motor_speed: speed,
            tip_mach: None,
            thrust_coefficient: None,
            plausibility,
            why: String::new(),
        }
    };
    let readings = [reading(300.0, 0.6), reading(600.0, 0.3), reading(150.0, 0.1)];
    let reason = Some("several rotor speeds explain this sound; count the blades");
    let trial = Trial { reason, readings: &readings, ..trials(&heard)[0] };
    let figure = recording_figure(&trial, "recording").unwrap().unwrap();
    let drawn = structure(&figure.svg);
    let (_, track) = drawn.layers.iter().find(|(class, _)| class == "tracks reading-1").unwrap();
    assert!(track.len() > 50, "{} points", track.len());
    let axes = &drawn.panels[0];
    let hz = |y: f64| axes[6] + (axes[3] - y) / (axes[3] - axes[1]) * (axes[7] - axes[6]);
    for (class, tone_hz) in [("reading reading-2", 1200.0), ("reading reading-3", 300.0)] {
        let (_, line) = drawn.layers.iter().find(|(other, _)| other == class).unwrap();
        // one unit of the drawing is about 4 Hz
        assert!(line.len() == 4 && line.iter().all(|(_, y)| (hz(*y) - tone_hz).abs() < 5.0), "{class}: {line:?}");
    }
    let keys = strokes(&figure.svg, "key readings");
    assert_eq!(keys[0].2, ["300.0 rev/s (60 %)", "600.0 rev/s (30 %)", "150.0 rev/s (10 %)"]);
    assert!(figure.description.contains("300.0 rev/s (60 %); dashed"), "{}", figure.description);
    // below: the harmonic with the same track
    assert!(drawn.layers.iter().any(|(class, points)| class == "track" && points.len() > 50));
    assert!(drawn.words.iter().any(|words| words.contains("most plausible speed")), "{:?}", drawn.words);
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
