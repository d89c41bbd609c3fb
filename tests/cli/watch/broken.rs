//! A page whose connection breaks. What it does when the program is started again is among the tests of the server.

use crate::common::{model, render};
use crate::watch::browser::Browser;
use crate::watch::page::{canvas, click, shown, type_in};
use crate::watch::program::{Watching, ball};
use std::io::{self, Read, Write};
use std::net::{Ipv4Addr, Shutdown, TcpListener, TcpStream};
use std::sync::{Arc, Mutex};
use std::thread;

/// A cable between a browser and a program, which can be cut.
struct Cable {
    port: u16,
    /// The connections that go through it; `None` while it is cut.
    connections: Arc<Mutex<Option<Vec<TcpStream>>>>,
}

impl Cable {
    /// Leads from a port of its own to that of a program.
    fn to(program: u16) -> Self {
        let listener = TcpListener::bind((Ipv4Addr::LOCALHOST, 0)).expect("a port");
        let port = listener.local_addr().expect("its address").port();
        let connections = Arc::new(Mutex::new(Some(Vec::new())));
        let open = connections.clone();
        thread::spawn(move || {
            for browser in listener.incoming().map_while(Result::ok) {
                let Ok(server) = TcpStream::connect((Ipv4Addr::LOCALHOST, program)) else { continue };
                if let Some(open) = open.lock().expect("nobody panics").as_mut() {
                    open.extend([&browser, &server].map(|end| end.try_clone().expect("another handle")));
                    thread::spawn(move || pass(browser, server, [port, program]));
                }
            }
        });
        Self { port, connections }
    }

    fn cut(&self) {
        for end in self.connections.lock().expect("nobody panics").take().into_iter().flatten() {
            let _ = end.shutdown(Shutdown::Both);
        }
    }

    fn mend(&self) {
        *self.connections.lock().expect("nobody panics") = Some(Vec::new());
    }
}

/// Passes a request on, with the port at the other end in place of this one, and the answer back.
fn pass(mut browser: TcpStream, mut server: TcpStream, [from, to]: [u16; 2]) {
    let mut head = vec![0; 1 << 16];
    let Ok(length) = browser.read(&mut head) else { return };
    let head = String::from_utf8_lossy(&head[..length]);
    let _ = server.write_all(head.replace(&format!(":{from}"), &format!(":{to}")).as_bytes());
    let [Ok(mut rest), Ok(mut there)] = [browser.try_clone(), server.try_clone()] else { return };
    thread::spawn(move || io::copy(&mut rest, &mut there));
    let _ = io::copy(&mut server, &mut browser);
    let _ = browser.shutdown(Shutdown::Both);
}

#[test]
fn a_page_whose_connection_broke_follows_again() {
    let watching = Watching::text(&ball("9 0 0"));
    let cable = Cable::to(watching.port);
    let url = watching.url("").replace(&watching.port.to_string(), &cable.port.to_string());
    let Some(browser) = Browser::open(&url) else { return };
    shown(&browser, 1);
    click(&browser, [40, 30]);
    type_in(&browser, "#field-radius-0", "1.25");
    shown(&browser, 2);
    let smaller = |ambient: &str| render(&model(&ball(ambient).replace("radius 2", "radius 1.25")));
    cable.cut();
    browser.wait("document.querySelector('#state').textContent === 'tabray is not running; waiting for it'");
    watching.save(&ball("0 9 0"));
    assert!(canvas(&browser) == smaller("9 0 0"), "the last image stays");
    cable.mend();
    shown(&browser, 3);
    assert!(canvas(&browser) == smaller("0 9 0"), "with the value that is tried out");
    assert_eq!(browser.text("return document.documentElement.dataset.state"), "done");
}
