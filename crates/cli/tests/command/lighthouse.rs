//! Lighthouse's check of accessibility (`npm install --global lighthouse`) on a page with warnings and a recording without a rotor.

use crate::chromium::chromium_path;
use crate::report_fixture::identified;
use serde_json::Value;
use std::fs;
use std::io::{BufRead, BufReader, Write};
use std::net::{SocketAddr, TcpListener};
use std::path::PathBuf;
use std::process::{Command, Stdio};
use std::thread;

const CHROMIUM_SWITCHES: &str = "--chrome-flags=--headless --no-sandbox --disable-gpu";

/// The program Lighthouse, with the browser that it looks with.
pub(crate) struct Lighthouse {
    program: String,
    chromium: PathBuf,
}

impl Lighthouse {
    /// `None` where it or a browser is missing and need not be there.
    pub(crate) fn found() -> Option<Self> {
        let program = std::env::var("HOVERTONE_LIGHTHOUSE").unwrap_or_else(|_| "lighthouse".to_owned());
        let runs = Command::new(&program).arg("--version").stdout(Stdio::null()).stderr(Stdio::null()).status();
        let (Ok(_), Some(chromium)) = (runs, chromium_path()) else {
            let is_required = std::env::var_os("HOVERTONE_REQUIRE_BROWSER").is_some();
            assert!(
                !is_required,
                "Lighthouse and a browser are required: install chromium, and npm install --global lighthouse"
            );
            println!("skipped: no lighthouse on the PATH (HOVERTONE_LIGHTHOUSE names it), or no Chromium");
            return None;
        };
        Some(Self { program, chromium })
    }

    /// What it finds on the page at an address, in these categories.
    pub(crate) fn look_at(&self, url: &str, categories: &str) -> Value {
        let folder = tempfile::tempdir().unwrap();
        let found = folder.path().join("lighthouse.json");
        let run = Command::new(&self.program)
            .arg(url)
            .arg(format!("--only-categories={categories}"))
            .args(["--output=json", "--quiet", CHROMIUM_SWITCHES])
            .arg(format!("--output-path={}", found.display()))
            .env("CHROME_PATH", &self.chromium)
            .output()
            .unwrap();
        assert!(run.status.success(), "{}", String::from_utf8_lossy(&run.stderr));
        serde_json::from_str(&fs::read_to_string(found).unwrap()).unwrap()
    }
}

#[test]
fn lighthouse_finds_no_fault_of_accessibility() {
    let Some(lighthouse) = Lighthouse::found() else { return };
    let folder = tempfile::tempdir().unwrap();
    identified(folder.path());
    let address = served(fs::read(folder.path().join("out/report.html")).unwrap());
    let found = lighthouse.look_at(&format!("http://{address}/"), "accessibility");
    let audits = found["audits"].as_object().unwrap();
    let scored = audits.values().filter(|audit| audit["score"].is_number()).count();
    let faults: Vec<String> = audits
        .values()
        .filter(|audit| audit["score"].as_f64().is_some_and(|score| score < 1.0))
        .map(|audit| format!("{}: {}", audit["title"], audit["details"]["items"]))
        .collect();
    assert!(scored > 15, "only {scored} checks were made");
    assert_eq!(faults, [""; 0]);
}

/// Answers every request with a page, until the test ends.
fn served(page: Vec<u8>) -> SocketAddr {
    let listener = TcpListener::bind("127.0.0.1:0").unwrap();
    let address = listener.local_addr().unwrap();
    thread::spawn(move || {
        for stream in listener.incoming().map_while(Result::ok) {
            let page = page.clone();
            thread::spawn(move || {
                let head = BufReader::new(&stream).lines().map_while(Result::ok).take_while(|line| !line.is_empty());
                if head.count() > 0 {
                    let length = page.len();
                    let answer = format!(
                        "HTTP/1.1 200 OK\r\nContent-Type: text/html; charset=utf-8\r\nContent-Length: {length}\r\nConnection: close\r\n\r\n"
                    );
                    let _ = (&stream).write_all(answer.as_bytes()).and_then(|()| (&stream).write_all(&page));
                }
            });
        }
    });
    address
}
