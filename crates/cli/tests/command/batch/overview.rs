//! The page of a batch in a browser.

use crate::chromium::Browser;
use std::path::Path;
use std::time::Duration;

/// In a browser: a row for each recording, pictures that are drawn, and heads that sort in both directions.
pub(super) fn has_a_page_that_sorts(out: &Path, files: &[String]) {
    let Some(mut browser) = Browser::start() else { return };
    browser.screen(1280);
    browser.open(&out.join("overview.html"));
    let names = "[...document.querySelectorAll('.archive tbody th')].map(cell => cell.innerText).join('\\n')";
    let shown: Vec<String> = browser.text(names).lines().map(str::to_owned).collect();
    assert_eq!(shown.len(), files.len());
    assert!(shown.iter().zip(files).all(|(shown, file)| file.ends_with(shown.as_str())), "{shown:?}");
    let drawn =
        "[...document.images].every(image => { image.loading = 'eager'; return true; }) && document.images.length";
    assert_eq!(browser.value(drawn), 5);
    browser.wait_for(
        "[...document.images].every(image => image.complete && image.naturalWidth > 0)",
        Duration::from_secs(30),
    );
    let speeds = "[...document.querySelectorAll('.archive tbody tr')].map(row => parseFloat(row.cells[3].innerText)).filter(it => !isNaN(it))";
    let head = "document.querySelectorAll('.archive thead th')[3].querySelector('button').click()";
    for sign in ["", "-"] {
        browser.value(head);
        let is_sorted = format!("{speeds}.every((it, at, all) => at === 0 || {sign}(it - all[at - 1]) >= 0)");
        assert_eq!(browser.value(&is_sorted), true, "{sign}");
        assert_eq!(browser.value(&format!("{speeds}.length")), 4);
    }
    assert_eq!(browser.value("document.documentElement.scrollWidth <= innerWidth"), true);
}
