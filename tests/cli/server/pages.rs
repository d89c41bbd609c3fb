//! The pages of the servers in a browser: what they may do, and their messages when they no longer may. These tests are
//! skipped where there is no Chromium.

use super::{REVIEW, Running, WATCH, folder};
use crate::watch::browser::Browser;
use crate::watch::program::ball;
use std::io::{Read, Write};
use std::net::{Ipv4Addr, TcpListener};
use std::thread;

/// Starts a server again on its old port.
fn again(server: Running, args: &[&str]) -> Running {
    let (_, port) = server.host.split_once(':').expect("a port");
    let port = port.to_owned();
    Running::start_after("", &[args, &["--port", &port]].concat(), server.end())
}

#[test]
fn a_page_of_watch_says_that_it_must_be_opened_anew() {
    let server = Running::start(WATCH, folder(&ball("9 0 0")));
    let Some(browser) = Browser::open(&server.url()) else { return };
    browser.wait("document.documentElement.dataset.shown === '1'");
    let server = again(server, WATCH);
    browser.wait(
        "document.querySelector('#state').textContent === 'tabray was started again: open the address that it printed'",
    );
    browser.go(&server.url());
    browser.wait("document.documentElement.dataset.shown === '1'");
}

#[test]
fn a_page_of_review_accepts_and_says_when_it_must_be_opened_anew() {
    let server = Running::start(REVIEW, folder(""));
    let Some(browser) = Browser::open(&server.url()) else { return };
    browser.wait("document.querySelector('button.accept')");
    let mut server = again(server, REVIEW);
    browser.press('a');
    browser.wait(
        "document.querySelector('[role=status]')?.textContent === \
         'the address lacks the token of this program: open the address that it printed'",
    );
    assert!(server.folder.path().join("snapshots/a.snap.new").exists());
    browser.go(&server.url());
    browser.wait("document.querySelector('button.accept')");
    browser.run("location.reload()");
    browser.wait("document.querySelector('button.accept')");
    browser.press('a');
    assert!(server.program.wait().expect("it ends").success());
    assert!(server.folder.path().join("snapshots/a.snap").exists());
}

#[test]
fn a_page_of_another_port_gets_nothing_even_with_the_address() {
    let servers = Running::both();
    let listener = TcpListener::bind((Ipv4Addr::LOCALHOST, 0)).expect("a port");
    let address = listener.local_addr().expect("its address");
    thread::spawn(move || {
        for mut stream in listener.incoming().map_while(Result::ok) {
            let _ = stream.read(&mut [0; 4096]);
            let head = "HTTP/1.1 200 OK\r\nContent-Type: text/html\r\nConnection: close\r\n\r\n";
            let _ = stream.write_all(format!("{head}<title>evil</title>").as_bytes());
        }
    });
    let Some(browser) = Browser::open(&format!("http://{address}/")) else { return };
    browser.wait("document.title === 'evil'");
    for server in servers {
        let files = server.files();
        let at = |path: &str| server.url().replace("/?", &format!("/{path}?"));
        // The outcome of each attempt is in `got`, by its number.
        browser.run(&format!(
            "const page = '{}', accept = '{}', events = '{}'
             window.got = []
             const put = (number, value) => window.got[number] = value
             fetch(page).then(() => put(0, 'read'), () => put(0, 'refused'))
             fetch(page, {{ mode: 'no-cors' }}).then(() => put(1, 'read'), () => put(1, 'refused'))
             fetch(accept, {{ method: 'POST', mode: 'no-cors', body: '{{}}' }})
                 .then(() => put(2, 'read'), () => put(2, 'refused'))
             const image = new Image()
             image.onload = () => put(3, 'read')
             image.onerror = () => put(3, 'refused')
             image.src = page
             const source = new EventSource(events)
             source.onopen = () => put(4, 'read')
             source.onerror = () => {{ source.close(); put(4, 'refused') }}
             const script = document.createElement('script')
             script.onload = () => put(5, 'read')
             script.onerror = () => put(5, 'refused')
             script.src = page
             document.body.append(script)
             const frame = document.createElement('iframe')
             frame.name = 'frame'
             document.body.append(frame)
             frame.onload = () => {{
                 let shows = 'refused'
                 try {{ shows = frame.contentDocument ? 'read' : 'refused' }} catch {{}}
                 put(6, shows)
             }}
             const form = document.createElement('form')
             Object.assign(form, {{ method: 'POST', action: accept, target: 'frame', enctype: 'text/plain' }})
             document.body.append(form)
             form.submit()",
            at(""),
            at("accept"),
            at("events"),
        ));
        browser.wait("window.got.length === 7 && !window.got.includes(undefined)");
        let got = browser.run("return window.got");
        assert_eq!(got, serde_json::json!(vec!["refused"; 7]), "{}", server.host);
        assert_eq!(server.files(), files);
    }
}
