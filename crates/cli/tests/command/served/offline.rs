//! The page without a network: kept by the browser from a served page and from a folder of a static host, and as new as its host.

use super::{INPUT, PATIENCE, Served};
use crate::chromium::Browser;
use crate::testkit::{steady_hover, write_hover};
use hovertone_vehicle::RotorSpeed;
use serde_json::Value;
use std::fs;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::thread;
use std::time::{Duration, Instant};
use tiny_http::{Header, Response, Server};

/// The page in a folder below the root of a static host.
struct StaticHost {
    server: Arc<Server>,
    url: String,
}

impl StaticHost {
    fn of(folder: &Path) -> Self {
        let server = Arc::new(Server::http("127.0.0.1:0").unwrap());
        let url = format!("http://{}/sub/folder/", server.server_addr().to_ip().unwrap());
        let (requests, folder) = (Arc::clone(&server), folder.to_owned());
        thread::spawn(move || {
            for request in requests.incoming_requests() {
                let name = request.url().strip_prefix("/sub/folder/").map(str::to_owned);
                let name = name.map(|name| if name.is_empty() { "index.html".to_owned() } else { name });
                let _ = match name.and_then(|name| Some((fs::read(folder.join(&name)).ok()?, name))) {
                    Some((bytes, name)) => request.respond(Response::from_data(bytes).with_header(media_type(&name))),
                    None => request.respond(Response::empty(404)),
                };
            }
        });
        Self { server, url }
    }
}

impl Drop for StaticHost {
    fn drop(&mut self) {
        self.server.unblock();
    }
}

fn media_type(name: &str) -> Header {
    let words = match name.rsplit_once('.').map(|(_, ending)| ending) {
        Some("html") => "text/html",
        Some("js") => "text/javascript",
        Some("css") => "text/css",
        Some("wasm") => "application/wasm",
        Some("svg") => "image/svg+xml",
        _ => "application/octet-stream",
    };
    format!("Content-Type: {words}").parse().unwrap()
}

/// The folder that `cargo xtask page` wrote, beside the program with the page.
fn page_folder() -> PathBuf {
    let program = Path::new(env!("CARGO_BIN_EXE_hovertone"));
    program.ancestors().map(|folder| folder.join("page")).find(|folder| folder.join("index.html").is_file()).unwrap()
}

/// Opens the page, takes its host away, opens it again and lets it hear a file.
fn outlives<H>(browser: &mut Browser, url: &str, host: H) {
    let folder = tempfile::tempdir().unwrap();
    let sound = folder.path().join("hover.wav");
    write_hover(&sound, steady_hover("ardrone", RotorSpeed::from_rev_s(60.0), 4.0));
    browser.open_url(url);
    let scope = browser.text("navigator.serviceWorker.ready.then((registration) => registration.scope)");
    assert_eq!(scope, url);
    drop(host);
    browser.open_url(url);
    browser.wait_for("document.querySelector('.drop')", PATIENCE);
    browser.choose(INPUT, &[&sound]);
    browser.wait_for("document.querySelector('.recording .answer')", PATIENCE);
    let icons = browser.value(
        "fetch('manifest.webmanifest').then((answer) => answer.json()).then(({ icons }) => Promise.all(icons.map(async ({ src, sizes }) => { const picture = new Image(); picture.src = src; await picture.decode(); return sizes === 'any' || sizes === `${picture.naturalWidth}x${picture.naturalHeight}`; })))",
    );
    assert_eq!(icons, Value::from(vec![true; 4]));
}

#[test]
fn a_served_page_opens_without_its_server() {
    let Some(mut browser) = Browser::start() else { return };
    let served = Served::start();
    let url = served.url.clone();
    let manifest = served.answer_to("GET /manifest.webmanifest HTTP/1.1\r\nHost: HOST\r\nConnection: close\r\n\r\n");
    assert!(manifest.contains("application/manifest+json"), "{manifest}");
    let worker = served.answer_to("GET /service_worker.js HTTP/1.1\r\nHost: HOST\r\nConnection: close\r\n\r\n");
    assert!(worker.contains("text/javascript") && worker.contains("no-cache"), "{worker}");
    outlives(&mut browser, &url, served);
}

#[test]
fn a_folder_of_a_static_host_opens_without_a_network() {
    let Some(mut browser) = Browser::start() else { return };
    let host = StaticHost::of(&page_folder());
    let url = host.url.clone();
    outlives(&mut browser, &url, host);
}

#[test]
fn a_new_version_replaces_the_kept_one() {
    let Some(mut browser) = Browser::start() else { return };
    let folder = tempfile::tempdir().unwrap();
    let page = folder.path().join("page");
    let names = copy(&page_folder(), &page);
    let assets = names.iter().find_map(|name| name.strip_suffix("/main.js")).unwrap().to_owned();
    let host = StaticHost::of(&page);
    let script = "document.querySelector('script').getAttribute('src')";
    browser.open_url(&host.url);
    browser.value("navigator.serviceWorker.ready.then(() => true)");
    assert_eq!(browser.text(script), format!("{assets}/main.js"));

    // the next version: other scripts, and a service worker that names them
    fs::rename(page.join(&assets), page.join("next")).unwrap();
    for name in ["index.html", "service_worker.js"] {
        let text = fs::read_to_string(page.join(name)).unwrap();
        fs::write(page.join(name), text.replace(&assets, "next") + "\n").unwrap();
    }
    let worker = fs::read_to_string(page.join("service_worker.js")).unwrap();
    let version = worker.split('"').find(|part| part.len() == 12 && part.bytes().all(|byte| byte.is_ascii_hexdigit()));
    fs::write(page.join("service_worker.js"), worker.replace(version.unwrap(), "newer")).unwrap();
    browser.open_url(&host.url);
    assert_eq!(browser.text(script), "next/main.js");
    browser.wait_for("document.querySelector('.drop')", PATIENCE);
    browser.wait_for("navigator.serviceWorker.getRegistration().then((each) => Boolean(each.waiting))", PATIENCE);

    // once no page of the old version is open, the new one takes over, and the old one is forgotten
    let url = host.url.clone();
    let is_newest = "caches.keys().then((names) => names.length === 1 && names[0].endsWith('newer'))";
    let start = Instant::now();
    loop {
        browser.open_url("about:blank");
        thread::sleep(Duration::from_millis(500));
        browser.open_url(&url);
        if browser.value(is_newest) == true {
            break;
        }
        assert!(start.elapsed() < PATIENCE, "{}", browser.value("caches.keys()"));
    }
    drop(host);
    browser.open_url(&url);
    assert_eq!(browser.text(script), "next/main.js");
    browser.wait_for("document.querySelector('.drop')", PATIENCE);
}

/// Copies a folder and returns the names of its files.
fn copy(from: &Path, to: &Path) -> Vec<String> {
    fs::create_dir_all(to).unwrap();
    let mut names = Vec::new();
    for entry in fs::read_dir(from).unwrap() {
        let entry = entry.unwrap();
        let name = entry.file_name().into_string().unwrap();
        if entry.file_type().unwrap().is_dir() {
            names.extend(copy(&entry.path(), &to.join(&name)).iter().map(|inner| format!("{name}/{inner}")));
        } else {
            fs::copy(entry.path(), to.join(&name)).unwrap();
            names.push(name);
        }
    }
    names
}
