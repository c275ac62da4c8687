//! The picture of a recording: how often it is drawn, and fingers on it.

use super::{HOVER_S, INPUT, PATIENCE, Served, click, stayed_at_home};
use crate::chromium::Browser;
use crate::testkit::{steady_hover, write_hover};
use hovertone_vehicle::RotorSpeed;
use std::thread;
use std::time::Duration;

/// Opens the page with the picture of a hover that is heard.
fn open_picture(browser: &mut Browser, served: &Served) {
    let folder = tempfile::tempdir().unwrap();
    let sound = folder.path().join("hover.wav");
    write_hover(&sound, steady_hover("ardrone", RotorSpeed::from_rev_s(60.0), HOVER_S));
    browser.open_url(&served.url);
    browser.wait_for("document.querySelector('.drop')", PATIENCE);
    browser.choose(INPUT, &[&sound]);
    browser.wait_for("document.querySelector('.recording .answer') && document.querySelector('canvas')", PATIENCE);
}

#[test]
fn a_move_of_the_picture_draws_it_once() {
    const MOVES: f64 = 10.0;
    let Some(mut browser) = Browser::start() else { return };
    let served = Served::start();
    browser.run_first(
        "window.draws = 0; const clear = CanvasRenderingContext2D.prototype.clearRect; CanvasRenderingContext2D.prototype.clearRect = function (...place) { window.draws += 1; return clear.apply(this, place); };",
    );
    open_picture(&mut browser, &served);
    click(&mut browser, "Zoom in");
    thread::sleep(Duration::from_secs(2));
    let draws = browser.value(&format!(
        "(async () => {{ window.draws = 0; for (let move = 0; move < {MOVES}; move++) {{ document.querySelector('canvas').dispatchEvent(new KeyboardEvent('keydown', {{ key: move % 2 ? 'ArrowLeft' : 'ArrowRight', bubbles: true }})); await new Promise((go) => setTimeout(go, 80)); }} return window.draws; }})()"
    ));
    // the detailed picture, which comes later, is drawn too
    assert!((MOVES..=MOVES + 3.0).contains(&draws.as_f64().unwrap()), "{draws}");
    stayed_at_home(&browser, &served);
}

#[test]
fn two_fingers_zoom_the_picture_and_not_the_page() {
    let Some(mut browser) = Browser::start() else { return };
    let served = Served::start();
    browser.phone(390);
    // the axes say what the picture shows
    browser.run_first(
        "window.words = []; const { fillText, clearRect } = CanvasRenderingContext2D.prototype; CanvasRenderingContext2D.prototype.fillText = function (text, ...place) { window.words.push(text); return fillText.call(this, text, ...place); }; CanvasRenderingContext2D.prototype.clearRect = function (...place) { window.words = []; return clearRect.apply(this, place); };",
    );
    open_picture(&mut browser, &served);
    browser.value("document.querySelector('canvas').scrollIntoView({ block: 'center' })");
    thread::sleep(Duration::from_secs(1));
    let before = browser.text("window.words.join()");
    let place = browser.value(
        "(() => { const { left, top, width, height } = document.querySelector('canvas').getBoundingClientRect(); return [left + width / 2, top + height / 2]; })()",
    );
    browser.spread_fingers((place[0].as_f64().unwrap(), place[1].as_f64().unwrap()));
    browser
        .wait_for(&format!("window.words.length > 0 && window.words.join() !== {before:?}"), Duration::from_secs(20));
    assert_eq!(browser.value("visualViewport.scale"), 1);
    stayed_at_home(&browser, &served);
}
