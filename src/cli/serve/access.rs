//! Who is let in: a page on this machine that was opened from the address that the program printed.
//!
//! The address carries a token. Every user of a machine can connect to its loopback address, but only who has seen the
//! address knows the token. It is not kept in a cookie: a browser sends those to every port of a host, so to servers of
//! other users, too.
//!
//! A page from elsewhere, which a browser on this machine may show as well, does not know the token. It is also kept out
//! by what it cannot forge: the `Host` header, where a foreign name was made to lead here, and the `Origin` and
//! `Sec-Fetch-Site` headers. What is sent to change something must have an origin.

use hyper::header::{self, HeaderName, HeaderValue};
use hyper::{Method, Request};
use sha2::{Digest, Sha256};

const SITE: HeaderName = HeaderName::from_static("sec-fetch-site");
const DESTINATION: HeaderName = HeaderName::from_static("sec-fetch-dest");

/// The query of an address up to its token.
const QUERY: &str = "token=";

/// Tells the requests that are let in at a port from all others.
pub struct Access {
    port: u16,
    /// 128 random bits, in hexadecimal digits.
    token: String,
}

impl Access {
    /// Makes a new token for a port.
    ///
    /// # Errors
    /// Where the system has no random numbers.
    pub fn new(port: u16) -> Result<Self, getrandom::Error> {
        let mut bytes = [0; 16];
        getrandom::fill(&mut bytes)?;
        Ok(Self { port, token: format!("{:032x}", u128::from_ne_bytes(bytes)) })
    }

    /// The address of the page, with the token.
    pub fn url(&self) -> String {
        format!("http://127.0.0.1:{}/?{QUERY}{}", self.port, self.token)
    }

    /// Refuses a request that comes from elsewhere or does not have the token, by its head alone.
    pub fn admit<B>(&self, request: &Request<B>) -> Result<(), &'static str> {
        let values = |name: HeaderName| request.headers().get_all(name).iter().map(HeaderValue::as_bytes);
        let ours = [format!("127.0.0.1:{}", self.port), format!("localhost:{}", self.port)];
        let is_ours = |host: &[u8]| ours.iter().any(|ours| host.eq_ignore_ascii_case(ours.as_bytes()));
        if values(header::HOST).count() != 1 || !values(header::HOST).all(is_ours) {
            return Err("the request is for another host");
        }
        if request.method() != Method::GET && !request.headers().contains_key(header::ORIGIN) {
            return Err("a request that changes something must name its origin");
        }
        // Whoever has the address may follow it from anywhere, such as from a terminal that is a page itself.
        let is_visit = request.method() == Method::GET
            && request.uri().path() == "/"
            && values(DESTINATION).eq([b"document".as_slice()]);
        let is_own_site = |site: &[u8]| [b"same-origin".as_slice(), b"none"].contains(&site);
        if !values(header::ORIGIN).all(|origin| origin.strip_prefix(b"http://").is_some_and(is_ours))
            || !(is_visit || values(SITE).all(is_own_site))
        {
            return Err("the request comes from another page");
        }
        let token = request.uri().query().and_then(|query| query.strip_prefix(QUERY));
        if !token.is_some_and(|token| self.is_token(token)) {
            return Err("the address lacks the token of this program: open the address that it printed");
        }
        Ok(())
    }

    /// Compares hashes: how long that takes tells nothing about the token.
    fn is_token(&self, given: &str) -> bool {
        Sha256::digest(given) == Sha256::digest(&self.token)
    }
}
