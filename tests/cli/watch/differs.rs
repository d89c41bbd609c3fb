//! What the page shows when its values differ from the scene's file, and what it writes into the file.

use crate::common::{model, render};
use crate::watch::browser::Browser;
use crate::watch::camera::post;
use crate::watch::page::{canvas, click, opened, shown, type_in};
use crate::watch::program::{Watching, ball};
use std::fs;

const SAID: &str = "document.querySelector('#differs:not([hidden]) span')?.textContent";

fn text(watching: &Watching) -> String {
    fs::read_to_string(watching.scene()).expect("a scene")
}

#[test]
fn a_page_that_comes_later_says_what_differs_from_the_file() {
    let Some((watching, browser)) = opened(&ball("9 0 0")) else { return };
    click(&browser, [40, 30]);
    type_in(&browser, "#field-radius-0", "1.25");
    shown(&browser, 2);
    browser.wait(&format!("{SAID} === '1 value differs from the file'"));
    for (attribute, values) in [("center", "[\"4\",\"3\",\"-4\"]"), ("radius", "[\"1.25\"]")] {
        let body = format!("{{\"name\":\"ball\",\"attribute\":\"{attribute}\",\"values\":{values}}}");
        assert_eq!(post(&watching, "try", &body).0, 200);
    }
    let other = Browser::open(&watching.url("")).expect("another page");
    other.wait(&format!("{SAID} === '2 values differ from the file'"));
    let rows = other.text(
        "return [...document.querySelectorAll('#differs li span')].map(li => li.textContent).join('|')",
    );
    assert_eq!(rows, "ball center 4 3 -3 → 4 3 -4|ball radius 2 → 1.25");
    other.run("document.querySelectorAll('#differs li')[0].querySelectorAll('button')[1].click()");
    other.wait(&format!("{SAID} === '1 value differs from the file'"));
    other.run("document.querySelector('#differs li button').click()");
    other.wait("document.querySelector('#differs').hidden");
    browser.wait("document.querySelector('#differs').hidden && !document.querySelector('#fields .tried')");
    let written = ball("9 0 0").replace("radius 2", "radius 1.25");
    assert_eq!(text(&watching), written);
    browser.wait("document.documentElement.dataset.state === 'done'");
    assert!(canvas(&browser) == render(&model(&written)));
}

#[test]
fn a_named_number_has_a_slider_and_is_written_into_the_scene() {
    let scene = |size: &str| {
        format!("let size {size} # of the ball\n{}", ball("9 0 0")).replace("radius 2", "radius \"size\"")
    };
    let Some((watching, browser)) = opened(&scene("2")) else { return };
    browser.press('v');
    browser.wait("document.querySelector('#field-size-0')");
    browser.run("const slider = document.querySelector('#fields input[type=range]'); slider.value = 1.2; slider.dispatchEvent(new Event('input'))");
    shown(&browser, 2);
    assert!(canvas(&browser) == render(&model(&scene("1.2"))));
    browser.wait(&format!("{SAID} === '1 value differs from the file'"));
    let row = "document.querySelector('#differs li span').textContent";
    assert_eq!(browser.text(&format!("return {row}")), "size 2 → 1.2");
    browser.run("document.querySelector('#write').click()");
    browser.wait("document.querySelector('#fields p span').textContent === 'written'");
    assert_eq!(text(&watching), scene("1.2"));
    browser.wait("document.querySelector('#differs').hidden && document.querySelector('#field-size-0').value === '1.2'");
}

#[test]
fn what_check_refuses_is_not_written() {
    let watching = Watching::text(&ball("9 0 0"));
    let mut events = watching.events();
    events.until("done");
    for (radius, said) in [("-1", "must be positive"), ("1e999", "1e999"), ("0", "must be positive")] {
        let body = format!("{{\"name\":\"ball\",\"attribute\":\"radius\",\"values\":[\"{radius}\"]}}");
        assert_eq!(post(&watching, "try", &body).0, 200, "{radius}");
        assert!(events.until("tried").to_string().contains(radius));
        let (status, answer) = post(&watching, "write", "");
        assert!(
            status == 409 && answer.starts_with("nothing is written, because of errors\nerror: "),
            "{answer}"
        );
        assert!(answer.contains(said) && answer.contains("scene.ray:6:"), "{answer}");
        assert_eq!(text(&watching), ball("9 0 0"));
    }
    assert_eq!(post(&watching, "write", "{}").0, 400);
    assert_eq!(post(&watching, "discard", "").0, 200);
    assert_eq!(events.until("tried").as_array().map(Vec::len), Some(0));
}

#[test]
fn keys_work_while_a_slider_has_the_focus() {
    let Some((_watching, browser)) = opened(&ball("9 0 0")) else { return };
    click(&browser, [40, 30]);
    browser.wait("document.querySelector('#fields input[type=range]')");
    browser.run("document.querySelector('#fields input[type=range]').focus()");
    browser.press('2');
    browser.wait("document.documentElement.dataset.layer === '1 depth'");
    browser.run("document.querySelector('#fields input[type=number]').focus()");
    browser.press('1');
    // A field takes the digit.
    shown(&browser, 2);
    browser.wait("document.documentElement.dataset.layer === '2 depth'");
}

#[test]
fn a_colour_has_a_swatch_that_picks_another() {
    let Some((watching, browser)) = opened(&ball("0.2 0.4 0.6")) else { return };
    browser.run("document.querySelector('#values').click()");
    browser.wait("document.querySelector('#field-viewpoint-0')");
    browser.run(
        "const select = document.querySelector('#fields select'); select.value = 'material paint'
         select.dispatchEvent(new Event('change', { bubbles: true }))",
    );
    browser.wait("document.querySelector('#field-ambient-colour')");
    assert_eq!(browser.text("return document.querySelector('#field-ambient-colour').value"), "#336699");
    browser.run(
        "const box = document.querySelector('#field-ambient-colour'); box.value = '#ff0033'
         box.dispatchEvent(new Event('input', { bubbles: true }))",
    );
    shown(&browser, 2);
    browser.run("document.querySelector('#write').click()");
    browser.wait("document.querySelector('#fields p span').textContent === 'written'");
    assert_eq!(text(&watching), ball("1 0 0.2"));
}

#[test]
fn the_text_is_edited_on_the_page_and_saved_if_nobody_else_has() {
    let crlf = ball("9 0 0").replace('\n', "\r\n");
    let Some((watching, browser)) = opened(&crlf) else { return };
    browser.press('e');
    let change = |from: &str, to: &str| {
        browser.run(&format!(
            "const box = document.querySelector('#editor'); box.value = box.value.replace('{from}', '{to}')
             box.dispatchEvent(new Event('input'))
             document.querySelector('#save').click()"
        ));
    };
    let said = "document.querySelector('#editing span').textContent";
    change("radius 2", "raduis 2");
    browser.wait(&format!("{said} === 'nothing is written, because of errors'"));
    // The text has its colours while it is changed.
    let ground = "[...document.querySelectorAll('#ground div')].map((row) => row.textContent).join('\\n')";
    browser.wait(&format!("{ground} === document.querySelector('#editor').value"));
    browser.wait("document.querySelector('#ground .type').textContent === 'camera'");
    browser.wait(
        "document.querySelector('#unsaved:not([hidden])').textContent.includes('did you mean `radius`?')",
    );
    assert_eq!(text(&watching), crlf);
    change("raduis 2", "radius 1.5");
    browser.wait(&format!("{said} === 'saved'"));
    let saved = crlf.replace("radius 2", "radius 1.5");
    assert_eq!(text(&watching), saved);
    shown(&browser, 2);
    // Somebody else saves meanwhile.
    browser.press('e');
    let other = saved.replace("9 0 0", "0 9 0");
    watching.save(&other);
    shown(&browser, 3);
    change("radius 1.5", "radius 1");
    browser.wait(&format!("{said} === 'the scene has changed meanwhile: try again'"));
    assert_eq!(text(&watching), other);
    assert!(
        browser
            .text("return document.querySelector('#paper:not([hidden]) #editor').value")
            .contains("radius 1\n")
    );
}

#[test]
fn on_a_phone_the_picture_comes_first() {
    let Some((_watching, browser)) = opened(&ball("9 0 0")) else { return };
    browser.emulate([390, 844], true, "light");
    browser.wait("document.querySelector('main').getBoundingClientRect().top === 0");
    let top = "document.querySelector('header').getBoundingClientRect().top";
    assert_eq!(
        browser
            .run(&format!("return {top} >= document.querySelector('main').getBoundingClientRect().bottom")),
        true
    );
    if let Some(folder) = std::env::var_os("TABRAY_SCREENSHOTS") {
        click(&browser, [40, 30]);
        type_in(&browser, "#field-radius-0", "1.25");
        shown(&browser, 2);
        browser.run("window.scrollTo(0, 0); document.activeElement.blur()");
        let shoot = |name: &str| {
            fs::write(std::path::Path::new(&folder).join(name), browser.screenshot()).expect("a file");
        };
        shoot("phone.png");
        browser.emulate([1360, 850], false, "light");
        browser.run("document.querySelector('#differs details').open = true");
        shoot("desk.png");
        browser.run(
            "const select = document.querySelector('#fields select'); select.value = 'material paint'
             select.dispatchEvent(new Event('change', { bubbles: true }))",
        );
        browser.wait("document.querySelector('#field-ambient-colour')");
        browser.run("document.activeElement.blur()");
        browser.press('e');
        shoot("edit.png");
    }
}
