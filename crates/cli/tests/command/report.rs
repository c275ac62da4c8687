//! The folder that `identify` writes: the page as a browser shows it, beside the results that it is made of.

use crate::chromium::Browser;
use crate::testkit::{hovertone, steady_hover, text, write_hover, write_noise};
use hovertone_sim::HoverSettings;
use hovertone_vehicle::RotorSpeed;
use serde_json::Value;
use std::fs;
use std::path::Path;

const GRAVITY_M_S2: f64 = 9.80;
const TRUTH_TOTAL_N_S2: f64 = 2.83e-5;
const ADDED_KG: [f64; 2] = [0.0, 0.05];
const DURATION_S: f64 = 4.0;
/// Names that would be markup if they were not escaped. A slash parts folders: this one is in a folder of its own.
const HOSTILE_FILE: &str = "<script>alert(1)</script>.wav";
const HOSTILE_LOAD: &str = "<img src=x onerror=alert(1)>";

/// Two loads, the first with a hostile name and a hostile recording, the second with a recording of noise; identified.
fn identified(folder: &Path) -> Value {
    let mut experiment = format!(
        "[vehicle]\npreset = \"ardrone\"\nmass_kg = 0.413\ngravity_m_s2 = {GRAVITY_M_S2}\n[tone]\norder = 69\n[samples]\nlength_s = 2.0\n"
    );
    let files = [[HOSTILE_FILE, "a.wav"], ["b.wav", "noise.wav"]];
    for (added_kg, files) in ADDED_KG.into_iter().zip(files) {
        let name = if added_kg == 0.0 { HOSTILE_LOAD } else { "loaded" };
        experiment += &format!(
            "[[load]]\nname = \"{name}\"\nadded_mass_kg = {added_kg}\nrecordings = [\"{}\", \"{}\"]\n",
            files[0], files[1]
        );
        for (seed, file) in (0..).zip(files) {
            let path = folder.join(file);
            fs::create_dir_all(path.parent().unwrap()).unwrap();
            if file == "noise.wav" {
                write_noise(&path, DURATION_S);
                continue;
            }
            let speed = RotorSpeed::from_rad_s(((0.413 + added_kg) * GRAVITY_M_S2 / TRUTH_TOTAL_N_S2).sqrt());
            let settings = steady_hover("ardrone", speed, DURATION_S);
            write_hover(&path, HoverSettings { seed, ..settings });
        }
    }
    fs::write(folder.join("experiment.toml"), experiment).unwrap();
    let out = folder.join("out");
    hovertone(&["identify", text(&folder.join("experiment.toml")), "-o", text(&out)]).ends_with(3);
    serde_json::from_str(&fs::read_to_string(out.join("results.json")).unwrap()).unwrap()
}

/// "2.830 ± 0.011" and the power of ten behind it.
fn shown_number(shown: &str, power: &str) -> f64 {
    let digits = shown.split(' ').next().unwrap();
    format!("{digits}e{}", power.replace('−', "-")).parse().unwrap()
}

#[test]
fn the_page_shows_the_results_asks_for_nothing_and_complains_of_nothing() {
    let Some(mut browser) = Browser::start() else { return };
    let folder = tempfile::tempdir().unwrap();
    let results = identified(folder.path());
    browser.open(&folder.path().join("out/report.html"));

    numbers_are_those_of_the_results(&mut browser, &results);
    hostile_names_are_text(&mut browser);
    pointing_reads_values(&mut browser);
    dragging_enlarges(&mut browser);
    methods_can_be_hidden(&mut browser);
    sound_follows_the_picture(&mut browser);

    let requests = browser.requests();
    let foreign: Vec<&String> = requests.iter().filter(|url| !url.starts_with("data:")).collect();
    assert!(foreign.len() == 1 && foreign[0].ends_with("/out/report.html"), "{foreign:?}");
    assert!(requests.len() > 1, "pictures were not loaded: the events are not seen");
    assert_eq!(browser.complaints(), [""; 0]);
}

fn numbers_are_those_of_the_results(browser: &mut Browser, results: &Value) {
    let constants = [
        ("total", "/thrust_constant_total_n_s2/value", "/uncertainty_budget/expanded_uncertainty_n_s2"),
        ("total", "/thrust_constant_total_n_s2/value", "/expanded_uncertainty_total_n_s2"),
        ("per_rotor", "/thrust_constant_per_rotor_n_s2/value", "/expanded_uncertainty_per_rotor_n_s2"),
    ];
    for (id, value, uncertainty) in constants {
        let (value, uncertainty) = (results.pointer(value).unwrap(), results.pointer(uncertainty).unwrap());
        let element = format!("document.getElementById('{id}')");
        let exact: f64 = browser.text(&format!("{element}.value")).parse().unwrap();
        assert_eq!(exact, value.as_f64().unwrap(), "{id}");
        let exact: f64 = browser.text(&format!("{element}.dataset.uncertainty")).parse().unwrap();
        assert_eq!(exact, uncertainty.as_f64().unwrap(), "{id}");
        let shown = browser.text(&format!("{element}.textContent"));
        let power = browser.text(&format!("{element}.parentElement.querySelector('sup').textContent"));
        // rounded to the second digit of the uncertainty: off by at most a twentieth of it
        let off = (shown_number(&shown, &power) - value.as_f64().unwrap()).abs();
        assert!(off <= uncertainty.as_f64().unwrap() / 18.0, "{id}: {shown}");
    }
    let mean = "document.getElementById('plain_mean')";
    let exact: f64 = browser.text(&format!("{mean}.value")).parse().unwrap();
    assert_eq!(exact, results["plain_mean_total_n_s2"]["value"].as_f64().unwrap());
    for method in ["maximum_trace", "gaussian", "harmonic", "separated"] {
        let rows = browser.value(&format!(
            "[...document.querySelectorAll('#table-{method} tbody tr')].map(row => [...row.children].map(cell => cell.textContent))"
        ));
        let Some(loads) = results["methods"][method]["loads"].as_array() else {
            assert_eq!(rows.as_array().map(Vec::len), Some(0), "{method}");
            continue;
        };
        assert_eq!(rows.as_array().unwrap().len(), loads.len(), "{method}");
        for (row, load) in rows.as_array().unwrap().iter().zip(loads) {
            assert_eq!(row[0], load["name"]);
            let rpm: f64 = row[2].as_str().unwrap().parse().unwrap();
            let (value, std) = (load["speed_rpm"].as_f64().unwrap(), load["std_uncertainty_rad_s"].as_f64().unwrap());
            assert!((rpm - value).abs() <= std * 9.55 / 18.0, "{method}: {row}");
        }
    }
    let warnings = browser.value("[...document.querySelectorAll('#answer .warnings li')].length");
    assert_eq!(warnings.as_u64(), results["warnings"].as_array().map(|warnings| warnings.len() as u64));
    let rejected = browser.text("document.querySelector('#data tbody').textContent");
    assert!(rejected.contains("noise.wav") && rejected.contains("rejected"), "{rejected}");
    let hashes = browser.text("document.querySelector('#settings').textContent");
    for input in results["inputs"].as_array().unwrap() {
        assert!(hashes.contains(input["recording"]["sha256"].as_str().unwrap()));
    }
    let command = browser.text("document.querySelector('#command').textContent");
    assert!(command.starts_with("hovertone identify ") && command.contains(" -o "), "{command}");
}

fn hostile_names_are_text(browser: &mut Browser) {
    let words = browser.text("document.body.innerText");
    assert!(words.contains(HOSTILE_FILE) && words.contains(HOSTILE_LOAD), "{words}");
    let drawn = browser.text("document.querySelector('[data-figure=\"figure-5-database\"]').textContent");
    assert!(drawn.contains(HOSTILE_LOAD) && drawn.contains(HOSTILE_FILE), "{drawn}");
    assert_eq!(browser.value("document.querySelectorAll('script').length"), 2, "a script of somebody else's");
    assert_eq!(browser.value("document.querySelectorAll('img, iframe, object, link:not([rel=icon])').length"), 0);
}

/// A place in the window, as shares of the first panel of a figure from its left and its top.
fn place_in(browser: &mut Browser, figure: &str, across: f64, down: f64) -> (f64, f64) {
    let at = browser.value(&format!(
        "(async () => {{ const svg = document.querySelector('{figure}'); const {{ left, right, top, bottom }} = svg.panels[0];
          const place = (across, down) => new DOMPoint(left + across * (right - left), top + down * (bottom - top)).matrixTransform(svg.getScreenCTM());
          window.scrollBy({{ top: place(0.5, 0.5).y - innerHeight / 2, behavior: 'instant' }});
          await new Promise(done => setTimeout(done, 200)); // until the page has settled
          const at = place({across}, {down}); return [at.x, at.y]; }})()"
    ));
    (at[0].as_f64().unwrap(), at[1].as_f64().unwrap())
}

fn pointing_reads_values(browser: &mut Browser) {
    let middle = place_in(browser, "[data-figure=fit]", 0.5, 0.5);
    browser.mouse("mouseMoved", middle);
    let reading = browser.text("document.querySelector('.readout').textContent");
    let home = browser.value("document.querySelector('[data-figure=fit]').panels[0].home");
    let force: f64 = reading.split("force of all rotors ").nth(1).unwrap().split(' ').next().unwrap().parse().unwrap();
    let (from, to) = (home["yFrom"].as_f64().unwrap(), home["yTo"].as_f64().unwrap());
    // a pixel of the window, and the rounding of what is written
    assert!((force - (from + to) / 2.0).abs() < 0.006 * (to - from), "{reading}, {home}");
    let spectrogram = "[data-figure=figure-6-spectrograms]";
    let at = place_in(browser, spectrogram, 0.3, 0.4);
    browser.mouse("mouseMoved", at);
    // the picture is decoded when somebody first points at it
    browser.value("new Promise(done => setTimeout(done, 300))");
    browser.mouse("mouseMoved", (at.0 + 1.0, at.1));
    let reading = browser.text("document.querySelector('.readout').textContent");
    assert!(reading.contains("kHz") && reading.contains("rev/s") && reading.contains("dB re full scale"), "{reading}");
    assert_eq!(browser.value("document.querySelector('.readout').hidden"), false);
}

fn dragging_enlarges(browser: &mut Browser) {
    let figure = "[data-figure=figure-8-maximum-trace]";
    let (from, to) = (place_in(browser, figure, 0.25, 0.25), place_in(browser, figure, 0.75, 0.75));
    browser.drag(from, to);
    let panel = format!("document.querySelector('{figure}').panels[0]");
    let view = |browser: &mut Browser| {
        browser.value(&format!("(({{ view, home }}) => [view.xFrom, view.xTo, home.xFrom, home.xTo])({panel})"))
    };
    let enlarged = view(browser);
    let [from, to, home_from, home_to] = [0, 1, 2, 3].map(|index: usize| enlarged[index].as_f64().unwrap());
    let length = home_to - home_from;
    assert!(
        (from - home_from - 0.25 * length).abs() < 0.01 * length
            && (to - home_to + 0.25 * length).abs() < 0.01 * length,
        "{enlarged}"
    );
    let across = browser.value(&format!("{panel}.layers[0].transform.baseVal[0].matrix.a")).as_f64().unwrap();
    assert!((across - 2.0).abs() < 0.02, "{across}");
    browser.value(&format!(
        "document.querySelector('{figure}').dispatchEvent(new KeyboardEvent('keydown', {{ key: 'Escape' }}))"
    ));
    let whole = view(browser);
    assert_eq!((&whole[0], &whole[1]), (&whole[2], &whole[3]));
}

fn methods_can_be_hidden(browser: &mut Browser) {
    let shown = "[...document.querySelectorAll('[data-figure=fit] .method-gaussian')].filter(layer => getComputedStyle(layer).display !== 'none').length";
    let before = browser.value(shown).as_u64().unwrap();
    assert!(before >= 3, "{before} layers of the Gaussian method");
    browser.value("document.querySelector('[data-method=gaussian]').click()");
    assert_eq!(browser.value(shown), 0);
    browser.value("document.querySelector('[data-method=gaussian]').click()");
    assert_eq!(browser.value(shown), before);
}

fn sound_follows_the_picture(browser: &mut Browser) {
    browser.value("document.querySelector('details.trial').open = true");
    browser.draw();
    let at = place_in(browser, "details.trial svg", 0.5, 0.3);
    browser.mouse("mouseMoved", at);
    browser.mouse("mousePressed", at);
    browser.mouse("mouseReleased", at);
    let heard = browser.value(
        "new Promise(done => { const audio = document.querySelector('details.trial audio'); let looks = 0;
         const look = () => (audio.currentTime > 0 && audio.readyState >= 2) || ++looks > 200
         ? done([audio.currentTime, audio.duration, document.querySelectorAll('details.trial svg .cursor:not(.hidden)').length,
             audio.readyState, audio.networkState, audio.error && audio.error.message, audio.paused])
         : setTimeout(look, 50); look(); })",
    );
    assert!(heard[1].is_number(), "the sound was not loaded: {heard}, {:?}", browser.complaints());
    let (time_s, length_s) = (heard[0].as_f64().unwrap(), heard[1].as_f64().unwrap());
    assert!((length_s - DURATION_S).abs() < 0.05, "{heard}");
    assert!((DURATION_S / 2.0 - 0.1..DURATION_S / 2.0 + 1.5).contains(&time_s), "{heard}");
    assert!(heard[2].as_u64().unwrap() >= 2, "no line shows where it plays: {heard}");
    browser.value("document.querySelector('details.trial audio').pause()");
}

/// Asserts that the results are what their schema says, and that it says something: without a field they are refused.
fn holds_to_its_schema(results: &Value, schema: &str) {
    let schema: Value = serde_json::from_str(schema).unwrap();
    let validator = jsonschema::draft202012::new(&schema).unwrap();
    let faults: Vec<String> =
        validator.iter_errors(results).map(|error| format!("{}: {error}", error.instance_path())).collect();
    assert_eq!(faults, [""; 0]);
    let mut lacking = results.clone();
    lacking["loads"][0].as_object_mut().unwrap().remove("force_n");
    assert!(!validator.is_valid(&lacking));
    let mut renamed = results.clone();
    renamed["thrust_constant"] = Value::Null;
    assert!(!validator.is_valid(&renamed));
}

#[test]
fn everything_is_written_and_escaped() {
    let folder = tempfile::tempdir().unwrap();
    let results = identified(folder.path());
    let out = folder.path().join("out");
    holds_to_its_schema(&results, &fs::read_to_string(out.join("results.schema.json")).unwrap());
    let read = |name: &str| fs::read_to_string(out.join(name)).unwrap_or_else(|error| panic!("{name}: {error}"));
    for name in [
        "figure-5-database",
        "figure-6-spectrograms",
        "figure-7-spectrum",
        "figure-8-maximum-trace",
        "figure-9-gaussian",
        "fit",
        "budget",
    ] {
        let svg = read(&format!("figures/{name}.svg"));
        let drawn = roxmltree::Document::parse(&svg).unwrap_or_else(|error| panic!("{name}: {error}"));
        let has = |tag: &str| drawn.descendants().any(|node| node.has_tag_name(("http://www.w3.org/2000/svg", tag)));
        assert!(has("title") && has("desc") && has("text") && !has("script") && !has("img"), "{name}");
        let png = fs::read(out.join(format!("figures/{name}.png"))).unwrap();
        assert!(png.starts_with(b"\x89PNG") && png.len() > 5000, "{name}");
    }
    let loads: Vec<csv::StringRecord> =
        csv::Reader::from_path(out.join("loads.csv")).unwrap().records().map(Result::unwrap).collect();
    let methods = results["methods"].as_object().unwrap();
    assert_eq!(loads.len(), methods.values().map(|method| method["loads"].as_array().unwrap().len()).sum::<usize>());
    for load in loads.iter().filter(|load| load[0] == *results["method"].as_str().unwrap()) {
        let of_results = results["loads"].as_array().unwrap().iter().find(|known| known["name"] == load[1]).unwrap();
        assert_eq!(load[7].parse::<f64>().unwrap(), of_results["speed_rad_s"].as_f64().unwrap());
    }
    for name in ["samples.parquet", "loads.parquet"] {
        let bytes = fs::read(out.join(name)).unwrap();
        assert!(bytes.starts_with(b"PAR1") && bytes.ends_with(b"PAR1"), "{name}");
    }
    let page = read("report.html");
    assert!(!page.contains("<script>alert") && !page.contains("<img "), "a name became markup");
    assert!(page.contains("default-src &#39;none&#39;") || page.contains("default-src 'none'"));
    let (markdown, latex) = (read("tables.md"), read("tables.tex"));
    for load in results["loads"].as_array().unwrap() {
        let rpm = format!("{:.0}", load["speed_rpm"].as_f64().unwrap());
        assert!(markdown.contains(&rpm[..3]) && latex.contains(&rpm[..3]), "{rpm}");
    }
    assert!(!markdown.contains("<img") && latex.contains("$<$img"), "{markdown}");
}
