use super::reach::Reach;
use super::{Answer, Body, Limits, Server, Work, stream, text};
use http_body_util::BodyExt;
use http_body_util::channel::Channel;
use hyper::body::Bytes;
use hyper::{Request, StatusCode};
use std::io::{Read, Write};
use std::net::TcpStream;
use std::ops::ControlFlow;
use std::sync::Arc;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::mpsc;
use std::thread;
use std::time::{Duration, Instant};

/// Longer than any machine needs.
const PATIENCE: Duration = Duration::from_secs(100);

const LIMITS: Limits = Limits { idle: 8, requests: 4, request_time: PATIENCE, write_time: PATIENCE };

/// Counts of events in answers.
#[derive(Default)]
struct Counts {
    /// Endless answers that were given up.
    given_up: AtomicUsize,
    /// Jobs that were started.
    begun: AtomicUsize,
    /// Jobs that learned that no client waits for them.
    left: AtomicUsize,
}

/// A server on a thread of its own.
struct Served {
    host: String,
    token: String,
    /// Receives a message when the server has ended.
    ended: mpsc::Receiver<()>,
    counts: Arc<Counts>,
}

impl Served {
    fn new(limits: Limits) -> Self {
        let Ok(server) = Server::open(Reach::local(Some(0))) else { panic!("a port") };
        let url = server.url();
        let (host, token) = url.trim_start_matches("http://").split_once('/').expect("a path");
        let (host, token) = (host.to_owned(), token.to_owned());
        let (send, ended) = mpsc::channel();
        let counts = Arc::<Counts>::default();
        let counted = counts.clone();
        thread::spawn(move || {
            let work = Work::new(2);
            let run = server.run_within(limits, async move |request: Request<Bytes>| {
                answer(&request, &work, &counted).await
            });
            run.expect("it begins");
            send.send(())
        });
        Self { host, token, ended, counts }
    }

    /// Opens a connection and sends this text, with `TOKEN` and `HOST` filled in.
    fn send(&self, text: &str) -> TcpStream {
        let mut stream = TcpStream::connect(&self.host).expect("it listens");
        stream.set_read_timeout(Some(PATIENCE)).expect("a time");
        let text = text.replace("TOKEN", &self.token).replace("HOST", &self.host).replace('\n', "\r\n");
        stream.write_all(text.as_bytes()).expect("it listens");
        stream
    }

    /// Returns the status of the answer to a request for a path.
    fn get(&self, path: &str) -> u16 {
        status(self.send(&format!("GET /{path}TOKEN HTTP/1.1\nHost: HOST\n\n")))
    }

    /// Ends the server by its last answer.
    fn end(self) {
        assert_eq!(self.get("end"), 200);
        self.ended.recv_timeout(PATIENCE).expect("the last answer ends it");
    }
}

/// Returns the status of an answer, or 0 if the connection ends without one.
fn status(mut stream: TcpStream) -> u16 {
    let mut answer = Vec::new();
    // The answer to a request that was refused before it was read may be cut off.
    let _ = stream.read_to_end(&mut answer);
    let answer = String::from_utf8_lossy(&answer).into_owned();
    answer.split(' ').nth(1).and_then(|status| status.parse().ok()).unwrap_or(0)
}

/// Waits until a condition holds.
fn wait(so: impl Fn() -> bool) {
    let start = Instant::now();
    while !so() {
        assert!(start.elapsed() < PATIENCE);
        thread::sleep(Duration::from_millis(5));
    }
}

async fn answer(request: &Request<Bytes>, work: &Work, counts: &Arc<Counts>) -> Answer {
    let fine = text(StatusCode::OK, "fine");
    match request.uri().path() {
        "/panic" => panic!("in an answer"),
        "/job-panic" => match work.run(|_| -> () { panic!("in a job") }).await {
            Some(()) => ControlFlow::Continue(fine),
            None => ControlFlow::Continue(text(StatusCode::INTERNAL_SERVER_ERROR, "internal error")),
        },
        "/job" => {
            let counts = counts.clone();
            let wait = work.run(move |client| {
                counts.begun.fetch_add(1, Ordering::Relaxed);
                while client.check().is_continue() {
                    thread::sleep(Duration::from_millis(1));
                }
                counts.left.fetch_add(1, Ordering::Relaxed);
            });
            wait.await;
            ControlFlow::Continue(fine)
        }
        "/endless" => ControlFlow::Continue(stream("text/plain", endless(counts.clone()))),
        "/end" => ControlFlow::Break(fine),
        _ => ControlFlow::Continue(fine),
    }
}

fn endless(counts: Arc<Counts>) -> Body {
    let (mut sender, body) = Channel::new(1);
    tokio::spawn(async move {
        while sender.send_data(Bytes::from_static(&[b'a'; 1 << 16])).await.is_ok() {}
        counts.given_up.fetch_add(1, Ordering::Relaxed);
    });
    body.boxed()
}

#[test]
fn a_panic_ends_one_answer_alone() {
    let served = Served::new(LIMITS);
    for path in ["panic", "job-panic", "panic", "job-panic", "job-panic"] {
        assert_eq!(served.get(path), 500, "{path}");
        assert_eq!(served.get("fine"), 200);
    }
    served.end();
}

#[test]
fn a_request_that_does_not_come_is_not_waited_for() {
    let served = Served::new(Limits { request_time: Duration::from_millis(200), ..LIMITS });
    let head = "GET /TOKEN HTTP/1.1\nHost: HOST\n";
    for (sent, answered) in [
        ("", 0),
        ("GET", 0),
        (head, 0),
        (&format!("{head}Content-Length: 9\n\nhalf"), 408),
        (&format!("{head}Transfer-Encoding: chunked\n\n1\na"), 408),
        (&format!("{head}Content-Length: 99999\n\n{}", "a".repeat(70_000)), 413),
    ] {
        assert_eq!(status(served.send(sent)), answered, "{sent:.80}");
    }
    served.end();
}

#[test]
fn a_head_that_does_not_end_is_refused() {
    let served = Served::new(LIMITS);
    let refused =
        status(served.send(&format!("GET /TOKEN HTTP/1.1\nHost: HOST\nA: {}", "a".repeat(1 << 14))));
    assert!([0, 431].contains(&refused), "{refused}");
    served.end();
}

#[test]
fn a_reader_that_does_not_read_is_given_up() {
    let served = Served::new(Limits { write_time: Duration::from_millis(200), ..LIMITS });
    let endless = "GET /endlessTOKEN HTTP/1.1\nHost: HOST\n\n";
    let silent = [served.send(endless), served.send(endless)];
    // A client that reads in small steps makes progress.
    let mut slow = served.send(endless);
    let mut bytes = [0; 1 << 16];
    while served.counts.given_up.load(Ordering::Relaxed) < 2 {
        slow.read_exact(&mut bytes).expect("more");
        thread::sleep(Duration::from_millis(1));
    }
    drop(silent);
    slow.read_exact(&mut bytes).expect("more");
    assert_eq!(served.counts.given_up.load(Ordering::Relaxed), 2);
    served.end();
}

#[test]
fn requests_beyond_the_most_at_once_are_refused_until_one_is_done() {
    let served = Served::new(LIMITS);
    let endless: Vec<_> = (0..4).map(|_| served.send("GET /endlessTOKEN HTTP/1.1\nHost: HOST\n\n")).collect();
    wait(|| served.get("fine") == 503);
    drop(endless);
    wait(|| served.get("fine") == 200);
    served.end();
}

#[test]
fn the_oldest_idle_connection_is_closed_where_there_are_too_many() {
    let served = Served::new(LIMITS);
    let silent: Vec<_> = (0..100).map(|_| served.send("GET")).collect();
    assert_eq!(served.get("fine"), 200);
    // The last few may stay: the limits on time are longer than the test.
    for stream in silent.into_iter().take(100 - LIMITS.idle) {
        assert_eq!(status(stream), 0);
    }
    served.end();
}

#[test]
fn a_job_learns_that_nobody_waits_and_the_next_gets_its_turn() {
    let served = Served::new(LIMITS);
    let job = "GET /jobTOKEN HTTP/1.1\nHost: HOST\n\n";
    // Two jobs run at the same time, and the third is never started.
    let waiting: Vec<_> = (0..3).map(|_| served.send(job)).collect();
    wait(|| served.counts.begun.load(Ordering::Relaxed) == 2);
    drop(waiting);
    wait(|| served.counts.left.load(Ordering::Relaxed) >= 2);
    assert_eq!(served.get("job-panic"), 500, "it has its turn");
    assert_eq!(served.counts.begun.load(Ordering::Relaxed), 2);
    served.end();
}
