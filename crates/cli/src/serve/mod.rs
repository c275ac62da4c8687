//! `hovertone serve`: hands out the page that is in this program. The browser computes; nothing of the page reaches this computer's files.

mod answer;
mod embedded;
mod guests;

use crate::args::ServeArguments;
use crate::failure::{Ending, Failure};
use crate::terminal::Terminal;
use answer::{Answer, Asked, answer_to};
use guests::Guests;
use std::net::{IpAddr, SocketAddr};
use std::sync::Arc;
use std::thread;
use tiny_http::{Header, Request, Response, Server};

/// Requests that are answered at the same time: a browser asks for the few files of the page at once.
const THREADS: usize = 4;

/// Serves until it is interrupted.
pub(crate) fn run(arguments: &ServeArguments, terminal: &mut Terminal) -> Result<Ending, Failure> {
    let asked = SocketAddr::new(arguments.address, arguments.port);
    let server = Server::http(asked).map_err(|error| {
        let hint = "give another --port, or --port 0 for any free port; --address must be an address of this computer";
        Failure::Failed {
            what: format!("the page cannot be served at {asked}: {error}"),
            hint: hint.to_owned(),
            path: None,
        }
    })?;
    let at = server.server_addr().to_ip().unwrap_or(asked);
    let guests = Guests::of(at)?;
    let url = guests.url();
    terminal.text(&format!("{url}\n"))?;
    terminal.flush()?;
    if let Some(words) = others_in_words(at.ip()) {
        terminal.say(&words);
    }
    if !arguments.no_open && open::that_detached(&url).is_err() {
        terminal.say("no browser could be opened: open this address in a browser yourself");
    }
    serve(&Arc::new(server), &Arc::new(guests));
    Ok(Ending::Done)
}

/// How other computers open the page; `None` where they cannot. An unspecified address such as 0.0.0.0 stands for all addresses of this
/// computer, and no other computer can open it.
fn others_in_words(at: IpAddr) -> Option<String> {
    let how = match at {
        at if at.is_loopback() => return None,
        at if at.is_unspecified() => format!(
            "other computers can open this address with its token, if you write the IP address of this computer in place \
             of {at}"
        ),
        _ => "other computers can open this address with its token".to_owned(),
    };
    Some(format!("{how}; Ctrl-C stops hovertone"))
}

fn serve(server: &Arc<Server>, guests: &Arc<Guests>) {
    let work = |server: Arc<Server>, guests: Arc<Guests>| {
        for request in server.incoming_requests() {
            respond(request, &guests);
        }
    };
    let more = (1..THREADS).map(|_| {
        let (server, guests) = (Arc::clone(server), Arc::clone(guests));
        thread::spawn(move || work(server, guests))
    });
    let more: Vec<_> = more.collect();
    work(Arc::clone(server), Arc::clone(guests));
    for thread in more {
        // a thread that broke has nothing to hand over
        let _ = thread.join();
    }
}

fn respond(request: Request, guests: &Guests) {
    let header = |name: &'static str| {
        let found = request.headers().iter().find(|header| header.field.equiv(name));
        found.map(|header| header.value.as_str())
    };
    let asked = Asked {
        method: request.method().as_str(),
        url: request.url(),
        host: header("Host"),
        origin: header("Origin"),
        cookie: header("Cookie"),
    };
    let Answer { status, headers, body } = answer_to(&asked, guests);
    let headers = headers.iter().filter_map(|(name, value)| Header::from_bytes(name.as_bytes(), value.as_bytes()).ok());
    let mut response = Response::from_data(body).with_status_code(status);
    headers.for_each(|header| response.add_header(header));
    // a browser that went away needs no answer
    let _ = request.respond(response);
}

#[cfg(test)]
mod tests {
    use super::others_in_words;

    #[test]
    fn an_unspecified_address_is_replaced_on_other_computers() {
        let words = |at: &str| others_in_words(at.parse().unwrap());
        assert_eq!(words("127.0.0.1"), None);
        assert_eq!(
            words("192.168.1.20").unwrap(),
            "other computers can open this address with its token; Ctrl-C stops hovertone"
        );
        for at in ["0.0.0.0", "::"] {
            let said = words(at).unwrap();
            assert!(said.contains(&format!("the IP address of this computer in place of {at};")), "{said}");
        }
    }
}
