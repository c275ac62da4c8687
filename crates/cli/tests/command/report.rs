//! The folder that `identify` writes: the page as a browser shows it, beside the results that it is made of.

use crate::chromium::Browser;
use crate::page::fits_phone_screen_and_paper;
use crate::report_fixture::{DURATION_S, HOSTILE_FILE, HOSTILE_LOAD, identified};
use serde_json::Value;
use std::fs;

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
    pointing_reads_values(&mut browser, &results);
    dragging_enlarges(&mut browser);
    methods_are_shown_on_request(&mut browser, &results);
    labels_follow_a_zoom(&mut browser);
    sound_follows_the_picture(&mut browser);
    fits_phone_screen_and_paper(&mut browser, "details");

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
    let counted = browser.text("document.querySelector('#answer .status').textContent");
    let lines = browser.value("document.querySelectorAll('#answer .warnings li').length");
    assert_eq!(counted, format!("⚠ {lines} warnings"));
    let words = browser.text("document.querySelector('#answer .warnings').textContent");
    let notices = browser.text("[...document.querySelectorAll('.notice')].map(notice => notice.textContent).join('')");
    for warning in results["warnings"].as_array().unwrap() {
        let (text, hint) = warning.as_str().unwrap().split_once(" (hint: ").unwrap();
        // the answer has its head, the place where that leads to all of it
        let head: String = text.chars().take(40).collect();
        assert!(words.contains(&head), "{head} in {words}");
        assert!(notices.contains(text) && notices.contains(hint.trim_end_matches(')')), "{warning}");
    }
    let rejected = browser.text("document.querySelector('table.recordings tbody tr:last-child').textContent");
    assert!(rejected.contains("noise.wav") && rejected.contains("no speed"), "{rejected}");
    // a gear mesh has odds and a runner-up as well
    let heard = browser.value(r"[...document.querySelectorAll('.trial dl')].map(facts => facts.textContent).filter(facts => /odds (above )?[0-9.]+ : 1/.test(facts) && / rev\/s \([^)]+ %\)/.test(facts))");
    assert_eq!(heard.as_array().unwrap().len(), 3, "{heard}");
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
    let hostile_name = HOSTILE_FILE.rsplit('/').next().unwrap();
    assert!(drawn.contains(HOSTILE_LOAD) && drawn.contains(hostile_name), "{drawn}");
    assert_eq!(browser.value("document.querySelectorAll('script').length"), 3, "a script of somebody else's");
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

fn pointing_reads_values(browser: &mut Browser, results: &Value) {
    // the nearest load, wherever the pointer is
    for (across, load) in [(0.1, 0), (0.9, 1)] {
        let at = place_in(browser, "[data-figure=fit]", across, 0.5);
        browser.mouse("mouseMoved", at);
        let reading = browser.text("document.querySelector('.readout').textContent");
        let load = &results["loads"][load];
        let value = |field: &str| load[field].as_f64().unwrap();
        let mass = format!("mass {:.1} g", 1e3 * value("mass_kg"));
        let speed = format!("speed {:.0}", value("speed_rpm").floor());
        let lines: Vec<&str> = reading.lines().collect();
        assert_eq!((lines[0], lines[1]), (load["name"].as_str().unwrap(), mass.as_str()));
        assert!(lines[2].starts_with(&speed[..8]) && lines[2].contains(" rpm = "), "{reading}, {speed}");
        let constant = format!("C_f ({:.2}", 1e5 * load["thrust_constant_total_n_s2"]["value"].as_f64().unwrap());
        assert!(lines[3].starts_with(&constant[..7]) && lines[3].ends_with("N s²"), "{reading}, {constant}");
    }
    assert_eq!(browser.value("!!document.querySelector('[data-figure=fit] .ring:not(.hidden)')"), true);
    browser.value("document.querySelector('#paper-fold').open = true");
    browser.draw();
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

fn methods_are_shown_on_request(browser: &mut Browser, results: &Value) {
    let shown = |browser: &mut Browser, class: &str| {
        let layers = format!("[...document.querySelectorAll('[data-figure=fit] .{class}')]");
        browser.value(&format!("{layers}.filter(layer => getComputedStyle(layer).display !== 'none').length")).as_u64()
    };
    // law, points, residuals, key, and twice the points for a pointer
    let reported = format!("method-{}", results["method"].as_str().unwrap());
    assert_eq!((shown(browser, &reported), shown(browser, "method-gaussian")), (Some(6), Some(0)));
    browser.value("document.querySelector('[data-method=gaussian]').click()");
    assert_eq!(shown(browser, "method-gaussian"), Some(6));
    browser.value("document.querySelector('[data-method=gaussian]').click()");
    assert_eq!(shown(browser, "method-gaussian"), Some(0));
    // bars and interval of the shown method fill the plot of the residuals, whatever the hidden ones need
    let seen = browser.value(
        "(() => { const svg = document.querySelector('[data-figure=fit]'), panel = svg.panels[1], { a: scale, f: shift } = svg.getScreenCTM();
          const boxes = [...svg.querySelectorAll('.residuals.method-harmonic .zoomable > *, .residuals.method-separated .zoomable > *')].filter(part => part.getClientRects().length > 0).map(part => part.getBoundingClientRect());
          const height = (panel.bottom - panel.top) * scale, top = panel.top * scale + shift;
          return [(Math.min(...boxes.map(box => box.top)) - top) / height, (Math.max(...boxes.map(box => box.bottom)) - top) / height,
            panel.view.xTo, panel.view.yTo - panel.view.yFrom]; })()",
    );
    let [top, bottom, x_to, range_mn] = [0, 1, 2, 3].map(|index: usize| seen[index].as_f64().unwrap());
    let share = results["uncertainty_budget"]["expanded_share"].as_f64().unwrap();
    let force_n = results["thrust_constant_total_n_s2"]["value"].as_f64().unwrap() * 1e3 * x_to;
    let interval = 2.0 * share * force_n * 1e3 / range_mn;
    assert!(top > 0.0 && bottom < 1.0, "bars reach from {top} to {bottom} of the plot");
    assert!((bottom - top).max(interval) > 0.6, "bars: {top} to {bottom}, interval: {interval}");
    // the law with an intercept lies over the others, and the key names it
    let intercept = browser.value(
        "(() => { const svg = document.querySelector('[data-figure=fit]'); const [line, key] = ['g.with-intercept[data-panel]', '.key.with-intercept text'].map(part => svg.querySelector(part));
          const laws = [...svg.querySelectorAll('.law')]; return [line.querySelectorAll('[stroke-dasharray]').length, key.textContent.trim(), laws.every(law => law.compareDocumentPosition(line) & 4)]; })()",
    );
    assert_eq!(intercept, serde_json::json!([1, "with an intercept", true]));
}

/// Asserts that the name of a load stays beside its point, and goes with it out of view.
fn labels_follow_a_zoom(browser: &mut Browser) {
    let apart = |browser: &mut Browser| {
        let apart = browser.value(
            "(() => { const svg = document.querySelector('[data-figure=fit]'); const [panel] = svg.panels;
              return panel.labels.map(label => { if (label.getClientRects().length === 0) return null; const box = label.getBoundingClientRect();
                const point = new DOMPoint(panel.px(Number(label.dataset.x)), panel.py(Number(label.dataset.y))).matrixTransform(svg.getScreenCTM());
                return [Math.round(box.right - point.x), Math.round(box.bottom - point.y)]; }); })()",
        );
        apart.as_array().unwrap().clone()
    };
    let before = apart(browser);
    assert_eq!(before.len(), 2);
    let dot = browser.value("(() => { const svg = document.querySelector('[data-figure=fit]'); const { left, right, top, bottom, data, ...panel } = svg.panels[0]; const at = [svg.panels[0].px(Number(data[0].dataset.x)), svg.panels[0].py(Number(data[0].dataset.y))]; return [(at[0] - left) / (right - left), (at[1] - top) / (bottom - top)]; })()");
    let (x, y) = (dot[0].as_f64().unwrap(), dot[1].as_f64().unwrap());
    let figure = "[data-figure=fit]";
    let (from, to) = (place_in(browser, figure, x - 0.1, y - 0.1), place_in(browser, figure, x + 0.1, y + 0.1));
    browser.drag(from, to);
    let after = apart(browser);
    assert!(after.contains(&Value::Null), "{after:?}");
    let kept = after.iter().zip(&before).filter(|(after, before)| after == before).count();
    assert_eq!(kept, 1, "{before:?}, {after:?}");
    // a drag out of the figure, over its caption, selects no text
    let caption = browser.value("(() => { const box = document.querySelector('#fit figcaption').getBoundingClientRect(); return [box.left + 200, box.bottom - 4]; })()");
    let middle = place_in(browser, figure, 0.5, 0.9);
    let below = (caption[0].as_f64().unwrap(), caption[1].as_f64().unwrap().min(890.0));
    browser.drag(middle, below);
    let key = place_in(browser, figure, 0.05, -0.06);
    browser.drag(key, below);
    assert_eq!(browser.text("getSelection().toString()"), "");
    browser.value(&format!(
        "document.querySelector('{figure}').dispatchEvent(new KeyboardEvent('keydown', {{ key: 'Escape' }}))"
    ));
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
pub(crate) fn holds_to_its_schema(results: &Value, schema: &str) {
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
