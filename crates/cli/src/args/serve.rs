//! Arguments of `serve`.

use super::groups::whole_number;
use clap::Args;
use std::net::{IpAddr, Ipv4Addr};

const SERVE_EXAMPLES: &str = "\
Other computers see the page only with --address. It then asks for the token that is part of the printed address. To open it on a phone, \
put the folder of `cargo xtask page` on any static host.

Examples:
  hovertone serve
  hovertone serve --port 0 --no-open
  hovertone serve --address 0.0.0.0";

/// The page in your browser: drop recordings, see the rotors, weigh loads, get the constant
///
/// The page computes in the browser: recordings are not sent anywhere, and the page reads no files but those that you give it.
#[derive(Args, Debug)]
#[command(after_help = SERVE_EXAMPLES)]
#[cfg_attr(not(feature = "page"), allow(dead_code))]
pub(crate) struct ServeArguments {
    /// Port of this computer; 0 is any that is free
    #[arg(long, value_name = "N", default_value_t = 4680, value_parser = whole_number(0..=u16::MAX))]
    pub(crate) port: u16,
    /// IP address to serve at; other computers can reach all but the loopback address
    #[arg(long, value_name = "IP", default_value_t = IpAddr::V4(Ipv4Addr::LOCALHOST), value_parser = address)]
    pub(crate) address: IpAddr,
    /// Print the address, and open no browser
    #[arg(long)]
    pub(crate) no_open: bool,
}

fn address(text: &str) -> Result<IpAddr, String> {
    let hint = "write an IP address of this computer, such as 192.168.1.20, or 0.0.0.0 for all of them";
    text.parse().map_err(|_| hint.to_owned())
}
