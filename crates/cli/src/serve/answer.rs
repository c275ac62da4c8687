//! The answer to a request: a file of the page, or why not.

use super::embedded::{file_at, media_type};
use super::guests::Guests;

/// The page runs its own scripts and its own WebAssembly, and reaches nothing else.
const POLICY: &str = "default-src 'none'; script-src 'self' 'wasm-unsafe-eval'; style-src 'self'; img-src 'self' blob: data:; \
    media-src blob:; connect-src 'self'; worker-src 'self'; manifest-src 'self'; base-uri 'none'; form-action 'none'; frame-ancestors 'none'";
/// Headers of every answer.
const ALWAYS: [(&str, &str); 6] = [
    ("Content-Security-Policy", POLICY),
    ("X-Content-Type-Options", "nosniff"),
    ("Referrer-Policy", "no-referrer"),
    ("Cross-Origin-Opener-Policy", "same-origin"),
    ("Cross-Origin-Resource-Policy", "same-origin"),
    ("Cache-Control", "no-cache"),
];

/// What a request asks.
pub(super) struct Asked<'a> {
    pub(super) method: &'a str,
    pub(super) url: &'a str,
    pub(super) host: Option<&'a str>,
    pub(super) origin: Option<&'a str>,
    pub(super) cookie: Option<&'a str>,
}

/// What is answered.
pub(super) struct Answer {
    pub(super) status: u16,
    pub(super) headers: Vec<(&'static str, String)>,
    pub(super) body: Vec<u8>,
}

impl Answer {
    fn new(status: u16, media_type: &str, body: &[u8]) -> Self {
        let mut headers: Vec<(&'static str, String)> =
            ALWAYS.iter().map(|(name, value)| (*name, (*value).to_owned())).collect();
        headers.push(("Content-Type", media_type.to_owned()));
        Self { status, headers, body: body.to_vec() }
    }

    fn refused(status: u16, why: &str) -> Self {
        Self::new(status, "text/plain; charset=utf-8", format!("{why}\n").as_bytes())
    }

    fn with(mut self, name: &'static str, value: impl Into<String>) -> Self {
        self.headers.push((name, value.into()));
        self
    }
}

/// The answer to a request.
pub(super) fn answer_to(asked: &Asked<'_>, guests: &Guests) -> Answer {
    let Some(host) = asked.host.filter(|host| guests.is_own_host(host)) else {
        return Answer::refused(421, "hovertone has no page at this address");
    };
    if asked.origin.is_some_and(|origin| origin != format!("http://{host}")) {
        return Answer::refused(403, "other web pages may not use this address");
    }
    if !["GET", "HEAD"].contains(&asked.method) {
        return Answer::refused(405, "the page can only be read").with("Allow", "GET, HEAD");
    }
    let (path, query) = asked.url.split_once('?').unwrap_or((asked.url, ""));
    if let Some(cookie) = guests.cookie_for(query) {
        return Answer::refused(303, "come in").with("Set-Cookie", cookie).with("Location", "/");
    }
    if !guests.may_enter(asked.cookie) {
        return Answer::refused(
            403,
            "open the whole address that `hovertone serve` printed, with the token at its end",
        );
    }
    match file_at(path) {
        Some(file) => Answer::new(200, media_type(file.name), file.gzip).with("Content-Encoding", "gzip"),
        None => Answer::refused(404, "the page has no such file"),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn status(asked: &Asked<'_>) -> u16 {
        answer_to(asked, &Guests::of("127.0.0.1:4000".parse().unwrap()).unwrap()).status
    }

    const GOOD: Asked<'static> =
        Asked { method: "GET", url: "/", host: Some("127.0.0.1:4000"), origin: None, cookie: None };

    #[test]
    fn the_page_is_read_by_its_own_address_alone() {
        assert_eq!(status(&GOOD), 200);
        assert_eq!(status(&Asked { url: "/main.js?x=1", origin: Some("http://127.0.0.1:4000"), ..GOOD }), 200);
        assert_eq!(status(&Asked { host: None, ..GOOD }), 421);
        assert_eq!(status(&Asked { host: Some("evil.example:4000"), ..GOOD }), 421);
        assert_eq!(status(&Asked { origin: Some("http://evil.example"), ..GOOD }), 403);
        assert_eq!(status(&Asked { origin: Some("null"), ..GOOD }), 403);
        assert_eq!(status(&Asked { method: "POST", ..GOOD }), 405);
    }

    #[test]
    fn no_path_reaches_the_file_system() {
        let own = concat!("/", file!());
        for url in ["/../Cargo.toml", "/%2e%2e/Cargo.toml", "//etc/passwd", "/etc/passwd", "Cargo.toml", "/.", "", own]
        {
            assert_eq!(status(&Asked { url, ..GOOD }), 404, "{url}");
        }
    }

    #[test]
    fn every_answer_has_the_policy() {
        let guests = Guests::of("127.0.0.1:4000".parse().unwrap()).unwrap();
        for asked in [GOOD, Asked { host: None, ..GOOD }, Asked { url: "/none", ..GOOD }] {
            let answer = answer_to(&asked, &guests);
            let policy = answer.headers.iter().find(|(name, _)| *name == "Content-Security-Policy");
            assert!(
                policy.is_some_and(
                    |(_, policy)| policy.contains("'wasm-unsafe-eval'") && !policy.contains("unsafe-inline")
                )
            );
        }
    }
}
