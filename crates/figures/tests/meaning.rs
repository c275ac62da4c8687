//! What a person needs to read a figure: keys of its lines, labels that are whole, axes of what is shown.

#![allow(clippy::unwrap_used, clippy::print_stdout)] // what tests share has no attribute by which the lints know it

mod drawn;
mod small_experiment;

use drawn::structure;
use hovertone_analysis::{Meaning, Method, Outcome, Reading, RotorEstimate};
use hovertone_figures::{ExperimentFigures, Trial, figures_of_experiment, recording_figure};
use hovertone_vehicle::{Order, RotorSpeed};
use roxmltree::{Document, Node};
use small_experiment::{all_heard, heard, tables, trials};

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

/// The loads of a method whose speeds are 3 % too high are not seen in the range of another method.
#[test]
fn each_method_says_which_part_of_the_axes_it_needs() {
    let heard = all_heard();
    let mut tables = tables(&heard);
    for load in &mut tables[1].loads {
        load.thrust_constant_total_n_s2 = load.thrust_constant_total_n_s2.map(|constant| constant.scaled(1.1));
    }
    let experiment = ExperimentFigures { trials: &[], tables: &tables, method: Method::Harmonic };
    let figures = figures_of_experiment(&experiment).unwrap();
    let svg = &figures.iter().find(|figure| figure.name == "fit").unwrap().svg;
    let drawn = Document::parse(svg).unwrap();
    let number = |node: Node<'_, '_>, name: &str| node.attribute(name).unwrap().parse::<f64>().unwrap();
    let of_residuals = |class: &str| {
        let is_wanted =
            |node: &Node<'_, '_>| node.attribute("class") == Some(class) && node.attribute("data-panel") == Some("2");
        drawn.descendants().find(is_wanted).unwrap()
    };
    let height = |node: Node<'_, '_>| number(node, "data-y-to") - number(node, "data-y-from");
    let [all, own, other] = ["panel", "data method-harmonic", "data method-maximum_trace"].map(of_residuals);
    assert!(height(own) < 0.5 * height(all), "{} of {} mN", height(own), height(all));
    assert!(height(other) > 0.9 * height(all), "{} of {} mN", height(other), height(all));
    for layer in [own, other] {
        let points: Vec<Node<'_, '_>> = layer.children().filter(Node::is_element).collect();
        assert_eq!(points.len(), 2);
        for point in points {
            let range = number(layer, "data-y-from")..=number(layer, "data-y-to");
            assert!(range.contains(&number(point, "data-y")), "{range:?}");
        }
    }
}

/// However uncertain the constant is, each bar and its words are on the sheet, and have three digits.
#[test]
fn the_labels_of_the_budget_are_whole() {
    const LETTER_UNITS: f64 = 15.4;
    let heard = all_heard();
    let mut tables = tables(&heard);
    for times in [1.0, 700.0, 30_000.0] {
        let budget = tables[0].budget.as_mut().unwrap();
        budget.lines.iter_mut().for_each(|line| line.contribution_n_s2 *= times);
        budget.combined_std_uncertainty_n_s2 *= times;
        let experiment = ExperimentFigures { trials: &[], tables: &tables, method: Method::Harmonic };
        let figures = figures_of_experiment(&experiment).unwrap();
        let svg = &figures.iter().find(|figure| figure.name == "budget").unwrap().svg;
        let drawn = Document::parse(svg).unwrap();
        let of_bars = drawn
            .descendants()
            .filter(|node| node.parent().is_some_and(|layer| layer.attribute("class") == Some("bars")));
        let mut labels = Vec::new();
        for text in of_bars.filter(|node| node.attribute("text-anchor") == Some("start")) {
            let words = text.text().unwrap().trim();
            let right =
                text.attribute("x").unwrap().parse::<f64>().unwrap() + LETTER_UNITS * words.chars().count() as f64;
            assert!(right <= 1741.0, "{words} ends at {right}");
            let digits = words.split(' ').next().unwrap().trim_start_matches(['0', '.']);
            assert!(digits.len() <= 4 || !digits.contains('.'), "{words}");
            labels.push(words.to_owned());
        }
        assert!(labels.len() > 2, "{labels:?}");
    }
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
