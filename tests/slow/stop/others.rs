//! Interruptions of commands other than `render`: each command says what it leaves behind.

use crate::common::program::names_in;
use crate::stop::{Running, tabray_path, workplace};
use nix::sys::signal::Signal;
use std::fs;
use std::time::Duration;

/// Interrupts a command when it has used this much CPU time. Returns its exit status and its standard error.
fn interrupted(args: &[&str], time: Duration) -> (i32, String) {
    let folder = workplace();
    fs::write(folder.path().join("edge.ray"), EDGE).expect("a file");
    let before = names_in(folder.path());
    let mut running = Running::start(&tabray_path(), &folder, args);
    running.until_it_catches();
    running.until_it_has_computed(time);
    running.send(Signal::SIGINT);
    let ended = running.end();
    let is_there = names_in(folder.path()) != before;
    assert_eq!(is_there, ended.1.contains("wrote "), "{args:?} says what it writes: {}", ended.1);
    ended
}

/// A small scene, whose charts are measured quickly.
const EDGE: &str = "camera eye { pixeldim 16 12 worlddim 8 6 viewpoint 4 3 6 }
    material white { ambient 8 8 8 }
    sphere ball { material white center 4.3 3.1 -1 radius 1.7 }
    light lamp { location 1 7 3 emissivity 9 9 9 size 0.5 }";

#[test]
fn what_was_begun_and_is_not_there_is_told() {
    for (args, said) in [
        (&["verify", "hall.ray", "-o", "a.png"][..], "the image was not finished"),
        (&["choose", "hall.ray", "--max-error", "0.1%"], "nothing has been chosen"),
        (&["chart", "hall.ray"], "nothing has been measured yet"),
        (&["render", "hall.ray", "-o", "-", "--debug", "find"], "the image was not finished"),
    ] {
        let (status, err) = interrupted(args, Duration::ZERO);
        assert_eq!(status, 130, "{args:?}: {err}");
        // The debug lines come first.
        assert!(err.ends_with(&format!("interrupted: {said}\n")), "{args:?}: {err}");
    }
}

#[test]
fn pictures_beside_that_are_not_finished_are_told() {
    let args = ["render", "hall.ray", "--size", "32", "--samples", "1024", "-o", "a.png", "--aov", "error"];
    let mut time = Duration::from_millis(200);
    loop {
        let (status, err) = interrupted(&args, time);
        assert_eq!(status, 130, "{err}");
        // The main image may not be finished by then.
        if err.starts_with("wrote a.png ") {
            assert!(err.lines().next().is_some_and(|line| line.ends_with(" s)")), "{err}");
            assert!(err.ends_with("\ninterrupted: the image was not finished\n"), "{err}");
            return;
        }
        time = time * 3 / 2;
    }
}

#[test]
fn a_chart_keeps_what_is_measured() {
    let mut time = Duration::from_millis(100);
    loop {
        let (status, err) = interrupted(&["chart", "edge.ray"], time);
        assert_eq!(status, 130, "{err}");
        if err != "interrupted: nothing has been measured yet\n" {
            let said = "wrote ./edge-chart.txt\ninterrupted: the chart shows what has been measured so far\n";
            assert!(err.starts_with("wrote ./edge-chart.svg\n") && err.ends_with(said), "{err}");
            return;
        }
        time = time * 6 / 5;
    }
}
