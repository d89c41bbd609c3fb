//! Access control: only a page that was opened from the printed address is let in.
//!
//! The address contains a token. Every user of a machine can connect to its loopback address, but only someone who has
//! seen the address knows the token. The token is not kept in a cookie: a browser sends cookies to every port of a
//! host, and so to servers of other users too.
//!
//! A page from elsewhere, which a browser on this machine may also show, does not know the token. It is also kept out
//! by headers that it cannot forge: `Host`, in case a foreign name resolves to this machine, and `Origin` and
//! `Sec-Fetch-Site`. A request that changes something must have an origin.

use super::reach::Reach;
use hyper::header::{self, HeaderName, HeaderValue};
use hyper::{Method, Request};
use sha2::{Digest, Sha256};

const SITE: HeaderName = HeaderName::from_static("sec-fetch-site");
const DESTINATION: HeaderName = HeaderName::from_static("sec-fetch-dest");

/// The query of an address, up to the token.
const QUERY: &str = "token=";

/// Decides which requests at a port are let in.
pub struct Access {
    reach: Reach,
    /// The port that is listened on.
    port: u16,
    /// 128 random bits, as hexadecimal digits.
    token: String,
}

impl Access {
    /// Makes a new token for a port.
    ///
    /// # Errors
    /// If the system provides no random numbers.
    pub fn new(reach: Reach, port: u16) -> Result<Self, getrandom::Error> {
        let mut bytes = [0; 16];
        getrandom::fill(&mut bytes)?;
        Ok(Self { reach, port, token: format!("{:032x}", u128::from_ne_bytes(bytes)) })
    }

    /// Returns the address of the page, with the token.
    pub fn url(&self) -> String {
        format!("http://{}/?{QUERY}{}", self.reach.authority(self.port), self.token)
    }

    /// Refuses a request that comes from elsewhere or lacks the token, judging by its head alone.
    pub fn admit<B>(&self, request: &Request<B>) -> Result<(), &'static str> {
        let values = |name: HeaderName| request.headers().get_all(name).iter().map(HeaderValue::as_bytes);
        let is_ours = |host: &[u8]| self.reach.admits(host, self.port);
        // A proxy may encrypt what a browser sends.
        let is_behind_proxy = |host: &[u8]| self.reach.allows(host);
        let is_own_origin = |origin: &[u8]| {
            origin.strip_prefix(b"http://").is_some_and(is_ours)
                || origin.strip_prefix(b"https://").is_some_and(is_behind_proxy)
        };
        if values(header::HOST).count() != 1 || !values(header::HOST).all(is_ours) {
            return Err("the request is for another host");
        }
        if request.method() != Method::GET && !request.headers().contains_key(header::ORIGIN) {
            return Err("a request that changes something must name its origin");
        }
        // A user may follow the address from anywhere, for example from a terminal that is itself a web page.
        let is_visit = request.method() == Method::GET
            && request.uri().path() == "/"
            && values(DESTINATION).eq([b"document".as_slice()]);
        let is_own_site = |site: &[u8]| [b"same-origin".as_slice(), b"none"].contains(&site);
        if !values(header::ORIGIN).all(is_own_origin) || !(is_visit || values(SITE).all(is_own_site)) {
            return Err("the request comes from another page");
        }
        let token = request.uri().query().and_then(|query| query.strip_prefix(QUERY));
        if !token.is_some_and(|token| self.is_token(token)) {
            return Err("the address lacks the token of this program: open the address that it printed");
        }
        Ok(())
    }

    /// Compares hashes, so that the time of the comparison reveals nothing about the token.
    fn is_token(&self, given: &str) -> bool {
        Sha256::digest(given) == Sha256::digest(&self.token)
    }
}
