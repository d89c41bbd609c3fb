//! The plan and the chart of a scene, in tabs of the page.

use crate::watch::page::{opened, shown};
use crate::watch::program::{PATIENCE, Watching, ball, client};
use assert_cmd::cargo::cargo_bin_cmd;
use std::path::Path;
use std::thread;
use std::time::{Duration, Instant};

fn plan(scene: &Path) -> String {
    let output = cargo_bin_cmd!("tabray").arg("plan").arg(scene).output().expect("the program runs");
    String::from_utf8(output.stdout).expect("text")
}

/// Waits until a chart is being measured.
fn begun(watching: &Watching) {
    let start = Instant::now();
    while watching.get("charting/1").1.starts_with(b"[0,") {
        assert!(start.elapsed() < PATIENCE, "it does not begin");
        thread::sleep(Duration::from_millis(10));
    }
}

#[test]
fn the_plan_is_that_of_the_command_and_follows_the_scene() {
    let Some((watching, browser)) = opened(&ball("9 0 0")) else { return };
    let words = || browser.text("return document.querySelector('#plan').textContent");
    browser.press('t');
    browser.wait("document.documentElement.dataset.plan === '1'");
    let first = plan(&watching.scene());
    assert_eq!(words(), first);
    watching.save(&ball("9 0 0").replace("viewpoint", "samples 16 viewpoint"));
    browser.wait("document.documentElement.dataset.plan === '2'");
    let second = plan(&watching.scene());
    assert_eq!(words(), second);
    assert_ne!(first, second);
    let seen = "return [...document.querySelectorAll('#pages > :not(#tabs)')].filter((one) => !one.hidden).map((one) => one.id).join()";
    assert_eq!(browser.text(seen), "plan");
    browser.press('t');
    assert_eq!(browser.text(seen), "chart");
    browser.run("document.activeElement.blur(); document.querySelector('#tab-chart').focus()");
    browser.press('\u{e014}');
    assert_eq!(browser.text(seen), "source", "the arrow keys go through the tabs");
    assert_eq!(browser.text("return document.activeElement.id"), "tab-text");
}

#[test]
fn a_chart_is_measured_on_demand() {
    let Some((_watching, browser)) = opened(&ball("9 0 0")) else { return };
    browser.run(
        "document.querySelector('#tab-chart').click()
         document.querySelector('#chart input').value = '4'
         document.querySelector('#chart button').click()",
    );
    assert_eq!(browser.text("return document.querySelector('#chart button').textContent"), "stop");
    browser.wait("document.documentElement.dataset.charted === '1'");
    browser.wait("document.querySelector('#chart img').naturalWidth > 300");
    let words = browser.text("return document.querySelector('#chart pre').textContent");
    assert!(words.contains("best") || words.contains("exact"), "{words}");
    assert_eq!(browser.run("return document.querySelector('#chart progress').hidden"), true);
}

#[test]
fn a_chart_ends_when_the_scene_changes() {
    let Some((watching, browser)) = opened(&ball("9 0 0")) else { return };
    browser.run(
        "document.querySelector('#tab-chart').click(); document.querySelector('#chart input').value = '3600'",
    );
    browser.run("document.querySelector('#chart button').click()");
    begun(&watching);
    watching.save(&ball("0 9 0"));
    shown(&browser, 2);
    browser
        .wait("document.querySelector('#chart span').textContent === 'the scene has changed: measure again'");
    browser.wait("document.querySelector('#chart button').textContent === 'measure'");
}

#[test]
fn a_chart_ends_when_its_page_closes() {
    let watching = Watching::text(&ball("9 0 0"));
    watching.events().until("done");
    for wrong in ["chart/1/0", "chart/1/3601", "chart/1/soon"] {
        assert_eq!(watching.get(wrong).0, 404, "{wrong}");
    }
    let url = watching.url("chart/1/3600");
    let page = thread::spawn(move || {
        let agent: ureq::Agent =
            ureq::Agent::config_builder().timeout_global(Some(Duration::from_secs(2))).build().into();
        agent.get(url).call().is_err()
    });
    begun(&watching);
    let mut said = client().get(watching.url("chart/1/3600")).call().expect("an answer");
    let reason = said.body_mut().read_to_string().expect("text");
    assert_eq!(
        (said.status().as_u16(), &*reason),
        (409, "the chart of this scene is being measured already\n")
    );
    assert!(page.join().expect("it ends"), "the page did not wait");
    let start = Instant::now();
    loop {
        let (status, answer) = watching.get("chart/1/1");
        if status == 200 || !answer.starts_with(b"the chart of this scene") {
            return;
        }
        assert!(start.elapsed() < PATIENCE, "the measurement goes on");
        thread::sleep(Duration::from_millis(50));
    }
}
