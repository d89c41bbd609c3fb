//! Who can reach a page: the address that its server listens on, and the names by which browsers may ask for it.

use std::net::{IpAddr, Ipv4Addr, SocketAddr};
use tabray_cli::options::number::whole;
use tabray_cli::process::failure::Failure;

/// Where a page is served.
#[derive(clap::Args)]
pub struct Reach {
    /// The port of the page; by default the first free one from 3000; 0 is any free one
    #[arg(long, value_name = "N", value_parser = whole::<u16>(0..=65535))]
    pub port: Option<u16>,
    /// The address to listen on. With any other than 127.0.0.1, other machines can reach the page, and can read what is
    /// sent on the way
    #[arg(long, value_name = "ADDR", default_value_t = IpAddr::V4(Ipv4Addr::LOCALHOST))]
    pub host: IpAddr,
    /// A host name in addresses under which browsers may ask for the page, at any port, for example through a tunnel or
    /// a proxy; may be repeated
    #[arg(long, value_name = "NAME", value_parser = name)]
    pub allow_host: Vec<String>,
}

impl Reach {
    /// On this machine, at a port.
    pub fn local(port: Option<u16>) -> Self {
        Self { port, host: Ipv4Addr::LOCALHOST.into(), allow_host: Vec::new() }
    }

    /// # Errors
    /// If no browser could ask for the page by a name that is let in.
    pub fn check(&self) -> Result<(), Failure> {
        if self.host.is_unspecified() && self.allow_host.is_empty() {
            return Err(Failure::usage(format!(
                "`--host {}` stands for all addresses of this machine, and no host name is allowed",
                self.host
            ))
            .help("add `--allow-host NAME`, with the name that browsers ask for"));
        }
        Ok(())
    }

    /// Returns the host of the page's address.
    pub fn authority(&self, port: u16) -> String {
        match self.allow_host.first() {
            Some(name) if self.host.is_unspecified() => format!("{name}:{port}"),
            _ => SocketAddr::new(self.host, port).to_string(),
        }
    }

    /// Tells whether a browser may ask for the page by this host and port, where the server listens on `port`.
    pub fn admits(&self, asked: &[u8], port: u16) -> bool {
        let own = [format!("127.0.0.1:{port}"), format!("localhost:{port}"), self.authority(port)];
        own.iter().any(|own| asked.eq_ignore_ascii_case(own.as_bytes())) || self.allows(asked)
    }

    /// Tells whether a host is allowed by name, at any port or none.
    pub fn allows(&self, asked: &[u8]) -> bool {
        let Ok(asked) = str::from_utf8(asked) else { return false };
        let name = match asked.rsplit_once(':') {
            Some((name, port)) if !port.is_empty() && port.bytes().all(|digit| digit.is_ascii_digit()) => {
                name
            }
            _ => asked,
        };
        self.allow_host.iter().any(|allowed| name.eq_ignore_ascii_case(allowed))
    }
}

/// Reads the name of a host, without a scheme, a port or a path.
fn name(text: &str) -> Result<String, String> {
    let is_name = |byte: u8| byte.is_ascii_alphanumeric() || b"-._".contains(&byte);
    if !text.is_empty() && text.bytes().all(is_name) || text.parse::<IpAddr>().is_ok_and(|at| at.is_ipv4()) {
        return Ok(text.to_owned());
    }
    Err("give a name alone, such as `render.example.org`, without a scheme, a port or a path".to_owned())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn other_names_are_let_in_only_where_they_are_allowed() {
        let mut reach = Reach::local(None);
        for (host, is_let_in) in [
            ("localhost:3000", true),
            ("127.0.0.1:3000", true),
            ("localhost:3001", false),
            ("pc:3000", false),
        ] {
            assert_eq!(reach.admits(host.as_bytes(), 3000), is_let_in, "{host}");
        }
        reach.allow_host = vec!["PC.example".to_owned()];
        for (host, is_let_in) in [
            ("pc.example", true),
            ("pc.example:8080", true),
            ("pc.example.org", false),
            ("evil-pc.example", false),
            ("pc.example:", false),
            ("pc.example:80:80", false),
            ("localhost:3001", false),
        ] {
            assert_eq!(reach.admits(host.as_bytes(), 3000), is_let_in, "{host}");
        }
        reach.host = [10, 0, 0, 7].into();
        assert!(reach.admits(b"10.0.0.7:3000", 3000) && !reach.admits(b"10.0.0.8:3000", 3000));
    }

    #[test]
    fn all_addresses_take_a_name() {
        let mut reach = Reach { host: Ipv4Addr::UNSPECIFIED.into(), ..Reach::local(None) };
        assert!(reach.check().is_err());
        reach.allow_host.push("pc".to_owned());
        assert!(reach.check().is_ok());
        assert_eq!(reach.authority(3000), "pc:3000");
    }

    #[test]
    fn a_name_is_no_address_of_a_page() {
        for text in ["", "http://pc", "pc:3000", "pc/", "a b", "[::1]"] {
            assert!(name(text).is_err(), "{text}");
        }
        assert_eq!(name("pc-1.example.org").as_deref(), Ok("pc-1.example.org"));
    }
}
