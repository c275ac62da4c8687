//! The page as a person uses it: what stands where, what fits on a phone, a screen and paper, what can be copied, saved and sorted.

use crate::chromium::Browser;
use crate::report_fixture::{MANY, contradictory_identified, many_identified};
use serde_json::Value;
use std::fs;
use std::path::Path;

const LAYOUT: &str = include_str!("layout.js");
/// Width of a phone, of a screen, and of the text on A4 with margins of 15 mm, px.
const PHONE: u32 = 390;
const SCREEN: u32 = 1200;
const PAPER: u32 = 680;

#[test]
fn sixty_recordings_and_one_without_a_rotor_can_be_read_on_phone_screen_and_paper() {
    let Some(mut browser) = Browser::start() else { return };
    let folder = tempfile::tempdir().unwrap();
    let results = many_identified(folder.path());
    assert_eq!(results["inputs"].as_array().unwrap().len(), MANY);
    browser.allow_clipboard();
    browser.open(&folder.path().join("out/report.html"));

    sections_are_in_their_order(&mut browser);
    contents_stay_in_view(&mut browser);
    warnings_are_lines_with_links(&mut browser, &results);
    recordings_have_decision_runner_up_and_cuts(&mut browser, &results);
    titles_have_names_without_folders(&mut browser);
    constants_can_be_copied(&mut browser, &results);
    tables_are_sorted_and_saved(&mut browser, &folder.path().join("out"));
    fits_phone_screen_and_paper(&mut browser, "details.fold, details.trial:nth-of-type(-n+3), #recording-24");
    recordings_are_a_short_table_on_a_phone(&mut browser);
    figures_scroll_by_keyboard_on_a_phone(&mut browser);
    assert_eq!(browser.complaints(), [""; 0]);
}

/// Loads and recordings with names of 80 letters, whose masses and speeds contradict each other in every way.
#[test]
fn the_longest_warnings_take_one_line_each_on_a_screen() {
    let Some(mut browser) = Browser::start() else { return };
    let folder = tempfile::tempdir().unwrap();
    contradictory_identified(folder.path());
    browser.open(&folder.path().join("out/report.html"));
    browser.screen(SCREEN);
    browser.draw();
    let lines = browser.value(
        "[...document.querySelectorAll('#answer .warnings li')].map(line => [line.offsetHeight / parseFloat(getComputedStyle(line).lineHeight),
          line.scrollWidth - line.clientWidth, line.textContent, document.querySelector(line.firstElementChild.getAttribute('href')).textContent])",
    );
    let lines = lines.as_array().unwrap();
    let is_cut = |line: &&Value| line[2].as_str().is_some_and(|head| head.contains('…'));
    assert!(lines.len() >= 4 && lines.iter().filter(is_cut).count() >= 4, "{lines:?}");
    for line in lines {
        assert!(line[0].as_f64().unwrap() < 1.5, "{} lines: {}", line[0], line[2]);
        assert_eq!(line[1], 0, "px are cut of {}", line[2]);
        // the whole warning stands where its line leads to
        let (head, place) = (line[2].as_str().unwrap(), line[3].as_str().unwrap());
        let said = head.split(['…', ':', '"']).map(str::trim).rfind(|part| part.len() > 12).unwrap();
        assert!(place.contains(said), "{said} in {place}");
    }
    // letters are as wide as a name can make them
    let wide = browser.value(
        "(() => { const line = document.querySelector('#answer .warnings li'); line.firstElementChild.textContent = 'W'.repeat(100);
          return line.offsetHeight / parseFloat(getComputedStyle(line).lineHeight); })()",
    );
    assert!(wide.as_f64().unwrap() < 1.5, "{wide} lines");
}

/// Asserts that nothing is cut, too small or too pale, with these folds open.
pub(crate) fn fits_phone_screen_and_paper(browser: &mut Browser, opened: &str) {
    browser.value(&format!("document.querySelectorAll('{opened}').forEach(fold => {{ fold.open = true; }})"));
    for (width, medium, scheme) in [
        (PHONE, "screen", "light"),
        (PHONE, "screen", "dark"),
        (SCREEN, "screen", "light"),
        (SCREEN, "screen", "dark"),
        (PAPER, "print", "light"),
        (PAPER, "print", "dark"),
    ] {
        let is_print = medium == "print";
        browser.screen(width);
        browser.medium(medium, scheme);
        let event = if is_print { "beforeprint" } else { "resize" };
        browser.value(&format!("dispatchEvent(new Event('{event}'))"));
        browser.draw();
        let faults = browser.value(&format!("({LAYOUT})({{ width: {width}, isPrint: {is_print} }})"));
        assert_eq!(faults, Value::Array(Vec::new()), "{width} px, {medium}, {scheme}");
        let broken = browser.text("getComputedStyle(document.querySelector('#bibtex')).breakInside");
        assert_eq!(broken == "avoid", is_print, "the lines to cite are on one page: {broken}");
        // Chromium repeats the head of a table on each page if it is never broken and holds no button
        let may_repeat = browser.value("[...document.querySelectorAll('thead')].every(head => getComputedStyle(head).breakInside === 'avoid' && !head.querySelector('button'))");
        assert_eq!(may_repeat, is_print, "heads of tables, {medium}");
    }
    browser.value("dispatchEvent(new Event('afterprint'))");
    let is_sortable = browser.value("!!document.querySelector('thead button.sort')");
    assert_eq!(is_sortable, true);
    browser.screen(SCREEN);
    browser.medium("", "light");
    let pdf = browser.pdf_text();
    let boxes: Vec<&str> = pdf.split("/MediaBox [").skip(1).filter_map(|rest| rest.split(']').next()).collect();
    // 210 x 297 mm in points
    let is_a4 = |sides: &&str| sides.starts_with("0 0 594.") && sides.contains(" 841.") || sides.starts_with("0 0 595");
    assert!(boxes.len() > 2 && boxes.iter().all(is_a4), "{boxes:?}");
}

fn sections_are_in_their_order(browser: &mut Browser) {
    let ids = browser.value("[...document.querySelectorAll('main > section')].map(section => section.id)");
    let expected = ["answer", "fit", "budget", "loads", "recordings", "paper", "settings", "reproduce"];
    assert_eq!(ids, Value::from(expected.to_vec()));
    let folded = browser.value("[document.querySelector('#paper-fold').open, !!document.querySelector('#paper-fold #figure-9-gaussian'), !!document.querySelector('#paper-fold #table-gaussian')]");
    assert_eq!(folded, Value::from(vec![false, true, true]));
    let shown = browser.value("['#fit figure', '#budget figure', '#table-harmonic'].map(part => document.querySelector(part).checkVisibility())");
    assert_eq!(shown, Value::from(vec![true; 3]));
    let of_numbers = browser.text("document.querySelector('#answer').textContent");
    assert!(of_numbers.contains("every load agrees") && of_numbers.contains("1 warning"), "{of_numbers}");
}

fn contents_stay_in_view(browser: &mut Browser) {
    let tops = browser.value(
        "['#settings', '#answer'].map(part => { document.querySelector(part).scrollIntoView(); return document.querySelector('nav').getBoundingClientRect().top; })",
    );
    assert_eq!(tops[0], 0);
    let links = browser.value(
        "[...document.querySelectorAll('nav a')].every(link => document.querySelector(link.getAttribute('href')))",
    );
    assert_eq!(links, true);
}

fn warnings_are_lines_with_links(browser: &mut Browser, results: &Value) {
    let lines = browser.value(
        "[...document.querySelectorAll('#answer .warnings li')].map(line => [line.getClientRects()[0].height / parseFloat(getComputedStyle(line).lineHeight), line.textContent, line.firstElementChild.getAttribute('href')])",
    );
    let lines = lines.as_array().unwrap();
    let silent: Vec<&Value> =
        results["inputs"].as_array().unwrap().iter().filter(|input| input["status"] != "ok").collect();
    assert_eq!((lines.len(), silent.len()), (1, 1), "{lines:?}");
    assert!(lines[0][0].as_f64().unwrap() < 1.5, "{lines:?}");
    assert_eq!(lines[0][2], "#recording-24");
    // a line holds what happened; what to do stands with the recording
    let what = silent[0]["reason"].as_str().and_then(|reason| reason.split(';').next()).unwrap();
    assert!(lines[0][1].as_str().unwrap().contains(what), "{lines:?}");
    // the link opens the fold that it leads to
    let opened = browser.value(
        "new Promise(done => { document.querySelector('#answer .warnings a').click(); setTimeout(() => done(document.querySelector('#recording-24').open), 100); })",
    );
    assert_eq!(opened, true);
}

fn recordings_have_decision_runner_up_and_cuts(browser: &mut Browser, results: &Value) {
    let rows = browser.value("[...document.querySelectorAll('table.recordings tbody tr')].map(row => row.innerText)");
    for (index, input) in results["inputs"].as_array().unwrap().iter().enumerate() {
        let fold = browser.text(&format!("document.querySelector('#recording-{} dl').textContent", index + 1));
        let row = rows[index].as_str().unwrap();
        if input["status"] != "ok" {
            assert!(row.contains('✗') && row.contains(input["reason"].as_str().unwrap()), "{row}");
            continue;
        }
        assert!(fold.contains("odds ") && fold.contains("runner-up") && fold.contains(" rev/s ("), "{fold}");
        assert!(row.contains('✓') && row.contains("odds ") && row.contains(" rev/s ("), "{row}");
        let cuts = input["hover"]["cuts"].as_array().unwrap();
        assert_eq!(cuts.iter().any(|cut| cut["reason"] == "silence"), index % 10 == 5, "{input}");
        let expected = if cuts.is_empty() { "nothing was cut" } else { "(silence, transition to or from the hover)" };
        assert!(fold.contains(expected), "{fold}");
    }
    // the track of the rotor lies over the picture, and the reason of the cut stands in it
    let drawn = browser.value(
        "['.tracks polyline', '.track polyline', '.reason-of-cut text'].map(part => document.querySelectorAll(`#recording-6 ${part}`).length)",
    );
    assert!(drawn[0].as_u64() >= Some(3) && drawn[1].as_u64() >= Some(2) && drawn[2] == 1, "{drawn}");
}

fn recordings_are_a_short_table_on_a_phone(browser: &mut Browser) {
    browser.screen(PHONE);
    browser.draw();
    let table = browser.value(
        "(() => { const table = document.querySelector('table.recordings'); const box = table.parentElement;
          return [Math.max(...[...table.tBodies[0].rows].map(row => row.offsetHeight)), box.scrollWidth - box.clientWidth]; })()",
    );
    // three lines of a long name
    assert!(table[0].as_f64().unwrap() < 80.0, "a row is {} px high", table[0]);
    assert_eq!(table[1], 0, "the table is wider than the phone");
    let files = browser
        .value("Math.max(...[...document.querySelector('table.files').tBodies[0].rows].map(row => row.offsetHeight))");
    assert!(files.as_f64().unwrap() < 80.0, "a row of the files is {files} px high");
    let row = browser.text("document.querySelector('table.recordings tbody tr').innerText");
    assert!(row.contains("payload number") && row.contains(".wav") && row.contains(" ± "), "{row}");
    browser.screen(SCREEN);
    browser.draw();
    // one long name does not take the width of the decisions of all others
    let heights = browser.value(
        "(() => { const [first, ...rows] = document.querySelector('table.recordings').tBodies[0].rows;
          const link = first.querySelector('a'), name = link.textContent, height = () => Math.max(...rows.map(row => row.offsetHeight));
          const before = height(); link.textContent = 'a_long_name_'.repeat(8); const after = height(); link.textContent = name;
          return [before, after]; })()",
    );
    assert_eq!(heights[0], heights[1], "px high");
}

fn figures_scroll_by_keyboard_on_a_phone(browser: &mut Browser) {
    const ARROW_RIGHT: u32 = 39;
    browser.screen(PHONE);
    browser.draw();
    for focus in ["#budget .drawing", "#figure-5-database .drawing", "#fit svg", "#figure-7-spectrum svg"] {
        let element = format!("document.querySelector('{focus}')");
        browser.value(&format!("{element}.scrollIntoView({{ block: 'center', behavior: 'instant' }})"));
        browser.value(&format!("{element}.focus()"));
        for _ in 0..3 {
            browser.press("ArrowRight", ARROW_RIGHT);
        }
        let scrolled = browser.value(&format!(
            "new Promise(done => setTimeout(() => done({element}.closest('.scroll').scrollLeft), 400))"
        ));
        assert!(scrolled.as_f64().unwrap() > 20.0, "{focus} is scrolled by {scrolled} px");
    }
    browser.screen(SCREEN);
}

fn titles_have_names_without_folders(browser: &mut Browser) {
    let titles = browser.value(
        "[...document.querySelectorAll('.trial summary, .trial figcaption, .trial .frame text, .recordings td a, [data-figure=figure-5-database] text')].map(title => title.textContent)",
    );
    let titles: Vec<&str> = titles.as_array().unwrap().iter().map(|title| title.as_str().unwrap()).collect();
    assert!(
        titles.iter().filter(|title| title.contains("recording_with_a_long_name_7.wav")).count() > 10,
        "{titles:?}"
    );
    assert!(titles.iter().all(|title| !title.contains("load_")), "{titles:?}");
}

fn constants_can_be_copied(browser: &mut Browser, results: &Value) {
    let per_rotor = results["thrust_constant_per_rotor_n_s2"]["value"].as_f64().unwrap();
    let rpm = std::f64::consts::TAU / 60.0;
    let mut copied = |button: &str| {
        browser.text(&format!(
            "(async () => {{ document.querySelector(`{button}`).click(); await new Promise(done => setTimeout(done, 150)); return navigator.clipboard.readText(); }})()"
        ))
    };
    for (row, expected) in [
        (1, per_rotor),
        (2, per_rotor * rpm.powi(2)),
        (3, per_rotor * std::f64::consts::TAU.powi(2)),
        (4, per_rotor * rpm.powi(2) / 9.806_65e-3),
    ] {
        let value: f64 = copied(&format!(".units-of-constant tbody tr:nth-child({row}) button")).parse().unwrap();
        assert!((value / expected - 1.0).abs() < 1e-5, "{row}: {value}, {expected}");
    }
    let gazebo = copied("button[data-copy-from=lines-gazebo]");
    assert!(gazebo.contains("motorConstant"), "{gazebo}");
    assert!(copied("button[data-copy-from=lines-rotorpy]").contains("k_eta"));
    let bibtex = copied("button[data-copy-from=bibtex]");
    // both entries have what BibTeX asks for; the program's year is that of the run
    let entries: Vec<&str> = bibtex.split('@').skip(1).collect();
    assert!(
        entries.len() == 2 && entries[0].starts_with("article{pizetta2021") && entries[1].starts_with("software{"),
        "{bibtex}"
    );
    for field in ["author  = ", "title   = ", "year    = "] {
        assert!(entries.iter().all(|entry| entry.contains(field)), "{field} in {bibtex}");
    }
    let year = entries[1].split_once("year    = \"").unwrap().1.split('"').next().unwrap();
    assert!(entries[1].contains(&format!("run on {year}-")) && year.parse::<u32>().unwrap() >= 2026, "{bibtex}");
    assert!(
        entries[1].contains("author  = \"{The hovertone authors}\"") && entries[1].contains("version = \"0."),
        "{bibtex}"
    );
    let braces = |sign: char| bibtex.matches(sign).count();
    assert_eq!(braces('{'), braces('}'), "{bibtex}");
}

fn tables_are_sorted_and_saved(browser: &mut Browser, out: &Path) {
    let speeds =
        "[...document.querySelectorAll('table.recordings tbody tr')].map(row => parseFloat(row.cells[3].textContent))";
    let head = "document.querySelector('table.recordings thead th:nth-child(4)')";
    for (direction, sign) in [("ascending", 1.0), ("descending", -1.0)] {
        browser.value(&format!("{head}.querySelector('button').click()"));
        assert_eq!(browser.text(&format!("{head}.ariaSort")), direction);
        let sorted = browser.value(speeds);
        let sorted: Vec<Option<f64>> = sorted.as_array().unwrap().iter().map(Value::as_f64).collect();
        let known: Vec<f64> = sorted.iter().copied().flatten().collect();
        assert_eq!((known.len(), sorted.len(), sorted[MANY - 1]), (MANY - 1, MANY, None));
        assert!(known.windows(2).all(|pair| sign * (pair[1] - pair[0]) >= 0.0), "{known:?}");
    }
    // a sum stays last
    browser.value("document.querySelector('#budget thead button').click()");
    let last = browser.text("document.querySelector('#budget tbody tr:last-child').textContent");
    assert!(last.starts_with("combined"), "{last}");
    let csv = browser.text(
        "(() => { let saved; const click = HTMLAnchorElement.prototype.click;
          HTMLAnchorElement.prototype.click = function () { saved = `${this.download} ${decodeURIComponent(this.href)}`; };
          document.querySelector('#loads .under button').click(); HTMLAnchorElement.prototype.click = click; return saved; })()",
    );
    assert!(csv.starts_with("harmonic.csv data:text/csv;charset=utf-8,load,mass (g),speed (rpm)"), "{csv}");
    assert_eq!(csv.lines().count(), 7, "{csv}");
    for name in ["loads.csv", "samples.csv"] {
        let held = browser.text(&format!(
            "new TextDecoder().decode(Uint8Array.from(atob(document.querySelector('a[download=\"{name}\"]').href.split(',')[1]), letter => letter.charCodeAt(0)))"
        ));
        assert_eq!(held, fs::read_to_string(out.join(name)).unwrap());
    }
}
