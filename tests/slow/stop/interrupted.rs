//! The first and the second interruption of a render.

use crate::common::program::names_in;
use crate::stop::{Running, bytes, render, stop_midway, workplace};
use nix::sys::signal::Signal;
use std::fs;
use std::io::{BufRead, BufReader, Read};
use std::thread;
use std::time::Duration;

#[test]
fn each_reason_to_stop_is_told() {
    let folder = workplace();
    let args = ["hall.ray", "--size", "2000", "--samples", "16", "-o", "a.png"];
    let err = stop_midway(&folder, &args);
    assert!(err.starts_with("the time limit of ") && err.contains("ms has been reached\nwrote "), "{err}");

    let mut running = Running::render(&folder, &[&args[..], &["--resume"]].concat());
    running.until_it_renders();
    running.send(Signal::SIGTERM);
    let (status, err) = running.end();
    assert_eq!(status, 130);
    assert!(err.starts_with("interrupted; press Ctrl-C again to quit at once\nwrote "), "{err}");
}

/// The arguments of a render of which one tile takes seconds.
const SLOWEST: [&str; 5] = ["hall.ray", "--samples", "65536", "-o", "a.png"];

#[test]
fn a_picture_that_was_not_begun_is_not_written() {
    let folder = workplace();
    fs::write(folder.path().join("a.png"), "precious").expect("a file");
    let said =
        "the time limit of 1ns has been reached\nnothing has been rendered yet, and nothing is written\n";
    let (status, _, err) = render(&folder, &[&SLOWEST[..], &["--time-limit", "1ns"]].concat());
    assert_eq!((status, err.as_str()), (130, said));
    assert_eq!(bytes(&folder, "a.png"), b"precious");
    assert_eq!(names_in(folder.path()), ["a.png", "hall.ray"]);
}

/// The time after which a person may press Ctrl-C again.
const AGAIN: Duration = Duration::from_millis(200);

/// `timeout` sends a signal to the program, and then to its process group.
#[test]
fn two_signals_at_once_are_one_interruption() {
    let folder = workplace();
    let mut running =
        Running::render(&folder, &["hall.ray", "--size", "2000", "--samples", "16", "-o", "a.png"]);
    running.until_it_has_computed(Duration::from_secs(2));
    running.send(Signal::SIGTERM);
    thread::sleep(Duration::from_millis(5));
    running.send(Signal::SIGTERM);
    let (status, err) = running.end();
    assert!(
        status == 130 && err.contains("\nwrote ") && err.contains("from which `--resume`"),
        "{status} {err}"
    );
}

#[test]
fn a_second_interruption_ends_at_once() {
    let folder = workplace();
    fs::write(folder.path().join("a.png"), "precious").expect("a file");
    let mut running = Running::render(&folder, &SLOWEST);
    running.until_it_renders();
    while running.0.try_wait().expect("its status").is_none() {
        running.send(Signal::SIGINT);
        thread::sleep(Duration::from_millis(10));
    }
    let (status, err) = running.end();
    assert!(status == 130 && !err.contains("wrote"), "{status} {err}");
    assert_eq!(bytes(&folder, "a.png"), b"precious");
    assert_eq!(names_in(folder.path()), ["a.png", "hall.ray"]);
}

#[test]
fn a_second_interruption_ends_the_writing_too() {
    // As nobody reads its output, the program would wait forever.
    let folder = workplace();
    let mut running = Running::render(&folder, &["hall.ray", "--size", "3000", "-o", "-"]);
    running.until_it_renders();
    running.send(Signal::SIGINT);
    let mut err = BufReader::new(running.0.stderr.take().expect("it is piped"));
    let mut line = String::new();
    err.read_line(&mut line).expect("a line");
    assert_eq!(line, "interrupted; press Ctrl-C again to quit at once\n");
    thread::sleep(AGAIN);
    running.send(Signal::SIGINT);
    let mut rest = String::new();
    err.read_to_string(&mut rest).expect("text");
    assert_eq!((running.0.wait().expect("it ends").code(), rest.as_str()), (Some(130), ""));

    fs::write(folder.path().join("a.png"), "precious").expect("a file");
    let large = ["hall.ray", "--size", "16000x1000", "-o", "a.png"];
    let mut running = Running::render(&folder, &large);
    running.until_it_renders();
    running.send(Signal::SIGINT);
    let mut err = BufReader::new(running.0.stderr.take().expect("it is piped"));
    err.read_line(&mut line).expect("a line");
    thread::sleep(AGAIN);
    running.send(Signal::SIGINT);
    assert_eq!(running.0.wait().expect("it ends").code(), Some(130));
    assert_eq!(bytes(&folder, "a.png"), b"precious");
    assert_eq!(names_in(folder.path()), ["a.png", "hall.ray"]);
}
