//! Who may open the page: programs of this computer, or, at another address, those who have the token.

use crate::failure::Failure;
use std::fmt::Write as _;
use std::net::{IpAddr, SocketAddr};

/// Bytes of a token.
const TOKEN_BYTES: usize = 16;
/// Name of the cookie that keeps it.
const COOKIE: &str = "hovertone";

/// The address that is served, and the token that it asks for.
pub(super) struct Guests {
    at: SocketAddr,
    token: Option<String>,
}

impl Guests {
    /// Loopback needs no token; every other address does.
    pub(super) fn of(at: SocketAddr) -> Result<Self, Failure> {
        let token = (!at.ip().is_loopback()).then(new_token).transpose()?;
        Ok(Self { at, token })
    }

    /// The address to open.
    pub(super) fn url(&self) -> String {
        let token = self.token.as_ref().map_or(String::new(), |token| format!("?token={token}"));
        format!("http://{}/{token}", self.at)
    }

    /// Whether a page was asked for by the address that is served. Another name that leads here may be that of a foreign page.
    pub(super) fn is_own_host(&self, host: &str) -> bool {
        let (name, port) = match host.rsplit_once(':') {
            Some((name, port)) if !port.ends_with(']') => (name, port.parse().unwrap_or(0)),
            _ => (host, 80),
        };
        let ip = name.trim_start_matches('[').trim_end_matches(']').parse::<IpAddr>();
        let is_name_right = match self.at.ip() {
            own if own.is_loopback() => name == "localhost" || ip.is_ok_and(|ip| ip.is_loopback()),
            own if own.is_unspecified() => ip.is_ok(),
            own => ip == Ok(own),
        };
        is_name_right && port == self.at.port()
    }

    /// The cookie to set for a query that brings the token.
    pub(super) fn cookie_for(&self, query: &str) -> Option<String> {
        let token = self.token.as_deref()?;
        let brought = query.split('&').find_map(|part| part.strip_prefix("token="))?;
        is_equal(brought, token).then(|| format!("{COOKIE}={token}; HttpOnly; SameSite=Strict; Path=/"))
    }

    /// Whether the sender of a cookie may see the page.
    pub(super) fn may_enter(&self, cookie: Option<&str>) -> bool {
        let Some(token) = self.token.as_deref() else { return true };
        let mut cookies = cookie.unwrap_or_default().split(';').map(str::trim);
        cookies.any(|part| part.split_once('=').is_some_and(|(name, value)| name == COOKIE && is_equal(value, token)))
    }
}

fn new_token() -> Result<String, Failure> {
    let mut bytes = [0; TOKEN_BYTES];
    getrandom::fill(&mut bytes).map_err(Failure::internal)?;
    Ok(bytes.iter().fold(String::new(), |mut text, byte| {
        // writing into a string does not fail
        let _ = write!(text, "{byte:02x}");
        text
    }))
}

/// Compares in a time that does not tell how much is right.
fn is_equal(brought: &str, token: &str) -> bool {
    let differ = brought.bytes().zip(token.bytes()).fold(0, |differ, (a, b)| differ | (a ^ b));
    brought.len() == token.len() && differ == 0
}

#[cfg(test)]
mod tests {
    use super::*;

    fn guests(at: &str) -> Guests {
        Guests::of(at.parse().unwrap()).unwrap()
    }

    #[test]
    fn only_the_own_address_is_a_host() {
        let own = guests("127.0.0.1:4000");
        for host in ["127.0.0.1:4000", "localhost:4000", "[::1]:4000"] {
            assert!(own.is_own_host(host), "{host}");
        }
        for host in
            ["evil.example:4000", "127.0.0.1", "127.0.0.1:80", "localhost.evil.example:4000", "192.168.1.2:4000", ""]
        {
            assert!(!own.is_own_host(host), "{host}");
        }
        assert!(guests("192.168.1.2:80").is_own_host("192.168.1.2"));
        assert!(guests("0.0.0.0:4000").is_own_host("10.0.0.7:4000"));
        assert!(!guests("0.0.0.0:4000").is_own_host("evil.example:4000"));
    }

    #[test]
    fn another_address_asks_for_its_token() {
        assert!(guests("127.0.0.1:4000").may_enter(None));
        let other = guests("192.168.1.2:4000");
        let query = other.url().split_once('?').unwrap().1.to_owned();
        assert_eq!(query.len(), "token=".len() + 2 * TOKEN_BYTES);
        assert!(
            !other.may_enter(None) && !other.may_enter(Some("hovertone=")) && other.cookie_for("token=0").is_none()
        );
        let cookie = other.cookie_for(&query).unwrap();
        let brought = format!("a=b; {}", cookie.split_once(';').unwrap().0);
        assert!(other.may_enter(Some(&brought)));
        assert!(!guests("192.168.1.2:4000").may_enter(Some(&brought)), "each run has a token of its own");
    }
}
