//! Clients that are not let in: other users of the machine, who do not have the address, and other pages in the
//! browser, even with the address.

use super::{REVIEW, Running, WATCH, folder};
use crate::watch::program::ball;
use assert_cmd::cargo::cargo_bin;
use std::fs;
use std::os::unix::fs::PermissionsExt;
use std::process::Command;
use std::time::{Duration, Instant};

const NO_TOKEN: &str = "the address lacks the token of this program: open the address that it printed";
const OTHER_HOST: &str = "the request is for another host";
const OTHER_PAGE: &str = "the request comes from another page";
const NO_ORIGIN: &str = "a request that changes something must name its origin";

/// All paths that the servers answer, and some that they do not.
const PATHS: [&str; 9] = [
    "GET /",
    "GET /events",
    "GET /probe/1/40/30",
    "GET /layer/1/depth",
    "GET /favicon.ico",
    "GET /../../etc/passwd",
    "POST /accept",
    "POST /reject",
    "OPTIONS /accept",
];

#[test]
fn another_user_without_the_token_gets_nothing() {
    let servers = Running::both();
    for (server, other) in servers.iter().zip(servers.iter().rev()) {
        let (token, files) = (server.token.as_str(), server.files());
        assert_eq!(token.len(), 32, "128 bits");
        let last = if token.ends_with('0') { "1" } else { "0" };
        let nearly = format!("?token={}{last}", &token[..31]);
        for query in [
            "",
            "?",
            "?token",
            "?token=",
            &nearly,
            &format!("?token={}", &token[..31]),
            &format!("?token={token}0"),
            &format!("?token={}", other.token),
            &format!("?token={}", "0".repeat(32)),
            &format!("?Token={token}"),
            &format!("?{token}"),
            &format!("?token=%20{token}"),
            &format!("?token={token}&token={token}"),
            &format!("?a=b&token={token}"),
            &format!("/{token}"),
            &format!("/token={token}"),
        ] {
            for path in PATHS {
                let asked =
                    server.ask(&format!("{path}{query} HTTP/1.1\nHost: HOST\nOrigin: http://HOST\n\n"));
                assert_eq!(asked, (403, NO_TOKEN.to_owned()), "{path}{query}");
            }
        }
        for header in [
            format!("Cookie: token={token}"),
            format!("Authorization: Bearer {token}"),
            format!("Authorization: token {token}"),
            format!("Token: {token}"),
            format!("X-Token: {token}"),
            format!("Referer: http://{}/?token={token}", server.host),
        ] {
            for path in PATHS {
                let head = format!("{path} HTTP/1.1\nHost: HOST\nOrigin: http://HOST\n{header}\n\n");
                assert_eq!(server.ask(&head), (403, NO_TOKEN.to_owned()), "{path} {header}");
            }
        }
        for body in [format!("token={token}"), format!("{{\"token\":\"{token}\"}}")] {
            let length = body.len();
            let head = format!("HTTP/1.1\nHost: HOST\nOrigin: http://HOST\nContent-Length: {length}\n\n");
            let asked = server.ask(&format!("POST /accept {head}{body}"));
            assert_eq!(asked, (403, NO_TOKEN.to_owned()), "{body}");
        }
        assert_eq!(server.files(), files);
        assert_eq!(server.page(), 200);
    }
}

#[test]
fn a_snapshot_is_not_accepted_without_the_token() {
    let server = Running::start(REVIEW, folder(""));
    let (_, page) = server.ask("GET /?token=TOKEN HTTP/1.1\nHost: HOST\n\n");
    let (_, rest) = page.split_once("\"version\":\"").expect("a version");
    let body = format!(r#"{{"snapshot":"snapshots/a.snap","version":"{}"}}"#, &rest[..16]);
    let accept = |query: &str| {
        let length = body.len();
        let head = format!("HTTP/1.1\nHost: HOST\nOrigin: http://HOST\nContent-Length: {length}\n\n");
        server.ask(&format!("POST /accept{query} {head}{body}"))
    };
    let files = server.files();
    assert_eq!(accept(""), (403, NO_TOKEN.to_owned()));
    assert_eq!(accept(&format!("?token={}", "f".repeat(32))), (403, NO_TOKEN.to_owned()));
    assert_eq!(server.files(), files);
    assert_eq!(accept("?token=TOKEN"), (200, "accepted snapshots/a.snap".to_owned()));
    assert_ne!(server.files(), files);
}

#[test]
fn another_page_in_the_browser_gets_nothing_even_with_the_token() {
    let from = |origin: &str, site: &str, mode: &str, to: &str| {
        let origin = if origin.is_empty() { String::new() } else { format!("Origin: {origin}\n") };
        format!("{origin}Sec-Fetch-Site: {site}\nSec-Fetch-Mode: {mode}\nSec-Fetch-Dest: {to}\n")
    };
    let evil = "http://evil.example";
    for server in Running::both() {
        let (_, port) = server.host.split_once(':').expect("a port");
        let files = server.files();
        for (headers, said) in [
            // A script that fetches, from another site, from another port of this machine, and from a sandbox.
            (from(evil, "cross-site", "cors", "empty"), OTHER_PAGE),
            (from("http://127.0.0.1:9", "same-site", "cors", "empty"), OTHER_PAGE),
            (from("null", "cross-site", "cors", "empty"), OTHER_PAGE),
            ("Origin: null\n".to_owned(), OTHER_PAGE),
            (format!("Origin: https://127.0.0.1:{port}\n"), OTHER_PAGE),
            (format!("Origin: http://127.0.0.1:{port}.evil.example\n"), OTHER_PAGE),
            (format!("Origin: http://127.0.0.1:{port}\nOrigin: null\n"), OTHER_PAGE),
            // An image, a script, a style, a frame and a prefetched page have no origin.
            (from("", "cross-site", "no-cors", "image"), OTHER_PAGE),
            (from("", "same-site", "no-cors", "image"), OTHER_PAGE),
            (from("", "cross-site", "no-cors", "script"), OTHER_PAGE),
            (from("", "cross-site", "no-cors", "empty"), OTHER_PAGE),
            (from("", "cross-site", "navigate", "iframe"), OTHER_PAGE),
            // Another page submits a form.
            (from(evil, "cross-site", "navigate", "document"), OTHER_PAGE),
            (from("null", "cross-site", "navigate", "document"), OTHER_PAGE),
            // A browser sends this for a host name that was made to resolve to this machine.
            (format!("Host: evil.example:{port}\n"), OTHER_HOST),
        ] {
            let host = if headers.starts_with("Host") { "" } else { "Host: HOST\n" };
            for path in PATHS {
                // A request that changes something and has no origin is refused for that reason.
                let is_bare = !path.starts_with("GET") && !headers.contains("Origin");
                let said = if is_bare && said == OTHER_PAGE { NO_ORIGIN } else { said };
                let asked = server.ask(&format!("{path}?token=TOKEN HTTP/1.1\n{host}{headers}\n"));
                assert_eq!(asked, (403, said.to_owned()), "{path} {headers}");
            }
        }
        for host in [
            "Host: 127.0.0.1\n",
            "Host: 0.0.0.0:PORT\n",
            "Host: [::1]:PORT\n",
            "Host: 127.0.0.1.evil.example:PORT\n",
            "Host: HOST\nHost: evil.example:PORT\n",
            "",
        ] {
            let host = host.replace("PORT", port);
            let asked = server.ask(&format!("GET /?token=TOKEN HTTP/1.1\n{host}\n"));
            assert_eq!(asked, (403, OTHER_HOST.to_owned()), "{host}");
        }
        assert_eq!(server.files(), files);
    }
}

#[test]
fn a_proxy_is_let_in_by_the_name_that_is_allowed_and_with_the_token_alone() {
    let args = [WATCH, &["--host", "0.0.0.0", "--allow-host", "desk.example"]].concat();
    let mut server = Running::start(&args, folder(&ball("9 0 0")));
    assert!(server.host.starts_with("desk.example:"), "{}", server.host);
    server.host = server.host.replace("desk.example", "127.0.0.1");
    let page = |query: &str, headers: &str| server.ask(&format!("GET /{query} HTTP/1.1\n{headers}\n\n")).0;
    for (query, headers, status) in [
        ("?token=TOKEN", "Host: desk.example", 200),
        ("?token=TOKEN", "Host: Desk.example:8443\nOrigin: https://desk.example:8443", 200),
        ("?token=TOKEN", "Host: HOST", 200),
        ("", "Host: desk.example", 403),
        ("?token=TOKEN", "Host: evil.example", 403),
        ("?token=TOKEN", "Host: desk.example\nOrigin: https://evil.example", 403),
    ] {
        assert_eq!(page(query, headers), status, "{query} {headers}");
    }
}

#[test]
fn all_addresses_of_the_machine_take_a_name_that_is_let_in() {
    let folder = folder(&ball("9 0 0"));
    let asked = Command::new(cargo_bin!("tabray"))
        .args([WATCH, &["--host", "0.0.0.0"]].concat())
        .current_dir(folder.path())
        .output()
        .expect("the program runs");
    assert_eq!(asked.status.code(), Some(2));
    let said = String::from_utf8_lossy(&asked.stderr).into_owned();
    assert!(
        said.contains("stands for all addresses of this machine") && said.contains("--allow-host NAME"),
        "{said}"
    );
}

#[test]
fn a_link_to_the_page_may_be_followed_from_anywhere() {
    for server in Running::both() {
        for site in ["none", "same-origin", "same-site", "cross-site"] {
            let head = format!("Host: HOST\nSec-Fetch-Site: {site}\nSec-Fetch-Mode: navigate\n");
            let visit = |path: &str| {
                let head = format!("{head}Sec-Fetch-Dest: document\n\n");
                server.ask(&format!("GET /{path}?token=TOKEN HTTP/1.1\n{head}")).0
            };
            assert_eq!(visit(""), 200, "{site}");
            let is_own = ["none", "same-origin"].contains(&site);
            assert_eq!(visit("nothing"), if is_own { 404 } else { 403 }, "{site}");
        }
    }
}

#[test]
fn who_is_not_let_in_is_told_before_anything_is_read_or_computed() {
    // The layer would take days.
    let heavy = ball("9 0 0").replace("80 60", "4000 4000").replace("viewpoint", "samples 65536 viewpoint");
    let servers = [Running::start(WATCH, folder(&heavy)), Running::start(REVIEW, folder(""))];
    for server in &servers {
        let start = Instant::now();
        assert_eq!(server.ask("GET /layer/1/cost HTTP/1.1\nHost: HOST\n\n").0, 403);
        // The body is never sent.
        let head = "HTTP/1.1\nHost: HOST\nOrigin: http://HOST\nContent-Length: 60000\n\n";
        assert_eq!(server.ask(&format!("POST /accept {head}")).0, 403);
        assert!(start.elapsed() < Duration::from_secs(8), "{:?}", start.elapsed());
    }
}

#[test]
fn each_run_has_another_token_and_no_answer_tells_it() {
    let (first, second) = (Running::both(), Running::both());
    let mut tokens: Vec<_> = first.iter().chain(&second).map(|server| &server.token).collect();
    tokens.sort();
    tokens.dedup();
    assert_eq!(tokens.len(), 4);
    for server in &first {
        for request in ["GET / HTTP/1.1\nHost: HOST\n\n", "GET /?token=TOKEN HTTP/1.1\nHost: HOST\n\n"] {
            let mut stream = server.send(request);
            let mut answer = String::new();
            std::io::Read::read_to_string(&mut stream, &mut answer).expect("text");
            assert!(!answer.contains(&server.token), "{answer}");
            assert!(answer.contains("referrer-policy: no-referrer\r\n"), "{answer}");
        }
        assert!(!server.said().contains(&server.token), "only once");
    }
}

#[test]
fn a_browser_is_not_given_the_address_where_others_can_read_it() {
    let folder = folder(&ball("9 0 0"));
    // A replacement for the program that opens browsers: it records its command line and the contents of the file named
    // there.
    let opener = folder.path().join("xdg-open");
    let script = "#!/bin/sh\nprintf '%s\\n' \"$@\" > arguments\ncp -p \"$1\" opened.html\n";
    fs::write(&opener, script).expect("a file");
    fs::set_permissions(&opener, fs::Permissions::from_mode(0o755)).expect("permissions");
    let line = "PATH=\"$PWD:$PATH\" HOME=\"$PWD\"; export PATH HOME; umask 0";
    let mut server = Running::start_after(line, &["watch", "scene.ray", "--open", "--port", "0"], folder);
    let path = |name: &str| server.folder.path().join(name);
    let start = Instant::now();
    while !path("opened.html").exists() {
        assert!(start.elapsed() < crate::watch::program::PATIENCE, "{}", server.said());
        std::thread::sleep(Duration::from_millis(10));
    }
    std::thread::sleep(Duration::from_millis(100));
    let arguments = fs::read_to_string(path("arguments")).expect("text");
    assert!(!arguments.contains(&server.token), "{arguments}");
    let page = fs::read_to_string(path("opened.html")).expect("text");
    assert!(page.contains(&format!("content=\"0; url={}\"", server.url())), "{page}");
    let file = fs::metadata(path("opened.html")).expect("a file");
    assert_eq!(file.permissions().mode() & 0o777, 0o600);

    let opened = arguments.trim_end().to_owned();
    assert!(fs::exists(&opened).expect("a folder"), "{opened}");
    let killed = Command::new("kill").args(["-INT", &server.program.id().to_string()]).status();
    assert!(killed.expect("kill runs").success());
    assert!(server.program.wait().expect("it ends").success());
    assert!(!fs::exists(&opened).expect("a folder"), "it goes with the program");
}
