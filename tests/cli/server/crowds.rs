//! Many connections, and slow ones: a request is answered soon, whatever other clients do.

use super::{REVIEW, Running, WATCH, answer, folder};
use crate::watch::program::ball;
use nix::sys::resource::{Resource, getrlimit, setrlimit};
use std::net::TcpStream;
use std::time::{Duration, Instant};

/// The time in which an answer must come, on a busy machine.
const SOON: Duration = Duration::from_secs(9);

/// The number of connections that a hostile user opens.
const CROWD: usize = 1200;

/// Asserts that the page, and an answer that takes some computing, come soon.
fn is_prompt(server: &Running, when: &str) {
    let start = Instant::now();
    assert_eq!(server.page(), 200, "{when}: {}", server.said());
    let (status, said) = server.ask("GET /probe/1/0/0?token=TOKEN HTTP/1.1\nHost: HOST\n\n");
    assert!([200, 404].contains(&status), "{when}: {said}");
    assert!(start.elapsed() < SOON, "{when}: {:?}", start.elapsed());
}

/// Allows this process as many open files as these tests need.
fn more_files() {
    let (soft, hard) = getrlimit(Resource::RLIMIT_NOFILE).expect("a limit");
    let wanted = 8 * CROWD as u64;
    if soft < wanted {
        setrlimit(Resource::RLIMIT_NOFILE, wanted.min(hard), hard).expect("a higher limit");
    }
}

/// Starts both servers, each allowed this many open files.
fn both(files: u32) -> [Running; 2] {
    [WATCH, REVIEW].map(|args| {
        let limit = format!("ulimit -n {files}");
        let server = Running::start_after(&limit, &[args, &["--port", "0"]].concat(), folder(&ball("9 0 0")));
        // The scene has been read once there is a pixel to explain.
        let start = Instant::now();
        while args == WATCH && server.ask("GET /probe/1/0/0?token=TOKEN HTTP/1.1\nHost: HOST\n\n").0 != 200 {
            assert!(start.elapsed() < SOON);
        }
        server
    })
}

#[test]
fn connections_that_say_nothing_or_half_of_it_hold_nobody_up() {
    more_files();
    for server in both(256).into_iter().chain(both(40)) {
        for sent in [
            "",
            "GET /?token=",
            "GET / HTTP/1.1\nHost: HOST\nA: b\n",
            "POST /accept HTTP/1.1\nHost: HOST\nOrigin: http://HOST\nContent-Length: 900\n\nhalf",
        ] {
            let mut crowd = Vec::new();
            for number in 1..=CROWD {
                crowd.push(server.send(sent));
                if number % 300 == 0 {
                    is_prompt(&server, &format!("after {number} of {sent:?}"));
                }
            }
            drop(crowd);
            is_prompt(&server, &format!("without {sent:?}"));
        }
    }
}

#[test]
fn files_are_left_for_answers_wherever_the_limit_lies() {
    more_files();
    for server in (36..46).flat_map(both) {
        let mut crowd = Vec::new();
        for _ in 0..60 {
            crowd.extend((0..30).map(|_| server.send("")));
            assert_eq!(server.page(), 200, "{}", server.said());
        }
    }
}

#[test]
fn too_few_open_files_are_told_once_and_hold_nobody_up() {
    for server in both(24) {
        let crowd: Vec<_> = (0..100).map(|_| server.send("")).collect();
        is_prompt(&server, "after 100");
        assert_eq!(server.said(), "warning: cannot accept every connection: too many open files\n");
        drop(crowd);
        is_prompt(&server, "without");
    }
}

#[test]
fn requests_that_are_let_in_and_do_not_go_on_hold_nobody_up() {
    for server in both(256) {
        let post =
            "POST /accept?token=TOKEN HTTP/1.1\nHost: HOST\nOrigin: http://HOST\nContent-Length: 900\n\nhalf";
        let half: Vec<_> = (0..40).map(|_| server.send(post)).collect();
        is_prompt(&server, "during half a body");
        for stream in half {
            assert_eq!(answer(stream), (408, "the request did not arrive in time".to_owned()));
        }
        is_prompt(&server, "after half a body");
    }
}

#[test]
fn a_page_that_reads_no_events_holds_nobody_up() {
    // The events take more memory than the system buffers for a reader.
    let scene = ball("9 0 0").replace("80 60", "1600 1200");
    let server = Running::start(WATCH, folder(&scene));
    let events = "GET /events?token=TOKEN HTTP/1.1\nHost: HOST\n\n";
    let silent: Vec<TcpStream> = (0..20).map(|_| server.send(events)).collect();
    // A client that reads receives the whole image.
    let mut reader = std::io::BufReader::new(server.send(events));
    let mut line = String::new();
    while !line.starts_with("event: done") {
        line.clear();
        assert!(std::io::BufRead::read_line(&mut reader, &mut line).expect("text") > 0);
    }
    is_prompt(&server, "during");
    drop(silent);
    is_prompt(&server, "after");
}
