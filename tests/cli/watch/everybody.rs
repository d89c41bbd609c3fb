//! The page on a phone, in light and dark colours, by keys alone, and for readers of the screen.

use crate::watch::browser::Browser;
use crate::watch::camera::{LOOK_AT, around_middle, distance, numbers, written};
use crate::watch::page::{click, opened};
use crate::watch::program::Watching;
use std::{env, fs};

const PHONE: [u32; 2] = [390, 844];
const HIGH_PHONE: [u32; 2] = [390, 3000];
const DESK: [u32; 2] = [1360, 850];
const TAB: char = '\u{e004}';

/// What brings the page from one state to the next.
type Step = fn(&Watching, &Browser);

/// The states of the page, one after another, each with the step that leads to it.
const STATES: [(&str, Step); 8] = [
    ("plain", |_, _| {}),
    ("two images compared", |_, browser| {
        browser.press('d');
        browser.wait("document.documentElement.dataset.compared && !document.querySelector('#line').hidden");
    }),
    ("the plan", |_, browser| {
        browser.press('d');
        browser.press('t');
        browser.wait("document.querySelector('#plan').textContent");
    }),
    ("the tab of the chart", |_, browser| {
        browser.press('t');
        browser.wait("!document.querySelector('#chart').hidden");
    }),
    ("an explained pixel, and the values of its object", |_, browser| {
        browser.press('t');
        click(browser, [40, 30]);
        browser.wait("document.querySelector('#field-radius-0') && !document.querySelector('#told').hidden");
    }),
    ("the mode `camera`", |_, browser| {
        browser.run("document.querySelector('#steer').click()");
        browser.wait("document.querySelector('#field-position-0')");
    }),
    ("an error", |watching, browser| {
        watching.save(&LOOK_AT.replace("radius", "raduis"));
        browser.wait("!document.querySelector('#report').hidden");
    }),
    ("without the program", |_, browser| {
        browser.run("state('lost', 'tabray is not running; waiting for it')");
    }),
];

/// Brings the page into each of its states on a desk and on a phone, in both schemes of colours. The phone is so high that
/// nothing lies under the image.
fn in_all_states(mut look: impl FnMut(&Browser, &str)) {
    for (size, has_fingers, scheme) in [
        (DESK, false, "dark"),
        (DESK, false, "light"),
        (HIGH_PHONE, true, "light"),
        (HIGH_PHONE, true, "dark"),
    ] {
        let Some((watching, browser)) = opened(LOOK_AT) else { return };
        browser.emulate(size, has_fingers, scheme);
        for (state, reach) in STATES {
            reach(&watching, &browser);
            look(&browser, &format!("{state}, {} pixels wide, {scheme}", size[0]));
        }
    }
}

/// CONTRIBUTING.md has the commands that install axe-core and run this test.
#[test]
fn axe_finds_nothing_serious_on_the_page() {
    let Some(path) = env::var_os("TABRAY_AXE") else {
        eprintln!("SKIPPED: TABRAY_AXE does not name the file axe.min.js of axe-core (see CONTRIBUTING.md)");
        return;
    };
    let axe = fs::read_to_string(path).expect("the library");
    let mut passed = Vec::new();
    in_all_states(|browser, state| {
        browser.run(&axe);
        let found = browser.run_until_done("axe.run().then(done, (error) => done({ error: String(error) }))");
        let list = |kind: &str| found[kind].as_array().unwrap_or_else(|| panic!("{found}")).clone();
        assert!(list("passes").iter().any(|rule| rule["id"] == "color-contrast"), "{state}: {found}");
        let violations = list("violations");
        assert!(violations.is_empty(), "{state}: {violations:#?}");
        let undecided: Vec<_> = list("incomplete").iter().map(|rule| rule["id"].to_string()).collect();
        let undecided = undecided.join(" ");
        passed.push(format!(
            "{state}: {} rules kept, 0 findings; undecided: {undecided}",
            list("passes").len()
        ));
    });
    println!("{}", passed.join("\n"));
}

#[test]
fn nothing_is_wider_than_a_phone() {
    in_all_states(|browser, state| {
        // What is scrolled in a box of its own may be wider.
        let out = browser.text(
            "const wide = document.documentElement.clientWidth
             const isCut = (one) => one.closest('#sheet, #text, #told pre, #report, #said')
             const outside = [...document.querySelectorAll('body *')].filter((one) => !isCut(one)
               && one.getBoundingClientRect().width > 0
               && (one.getBoundingClientRect().right > wide + 0.5 || one.getBoundingClientRect().left < -0.5))
             if (document.documentElement.scrollWidth > wide) outside.push(document.documentElement)
             return outside.map((one) => `${one.tagName} ${one.id}`).join()",
        );
        assert_eq!(out, "", "{state}");
    });
}

#[test]
fn what_fingers_touch_is_large_and_a_slider_follows_them() {
    let Some((watching, browser)) = opened(LOOK_AT) else { return };
    browser.emulate(PHONE, true, "light");
    let [at] = around_middle(&browser, [[0, 0]]);
    browser.touch(&[&[at]]);
    browser.wait("document.querySelector('#field-radius-0') && !document.querySelector('#told').hidden");
    let small = browser.text(
        "const seen = [...document.querySelectorAll('button, select, input:not([type=radio]), #layers label')]
         const small = seen.filter((one) => { const { width, height } = one.getBoundingClientRect(); return width > 0 && (height < 44 || width < 44) })
         return small.map((one) => one.outerHTML).join()",
    );
    assert_eq!(small, "");
    let place = browser.run(
        "const slider = [...document.querySelectorAll('#fields input[type=range]')].at(-1)
         slider.scrollIntoView({ block: 'center' })
         const box = slider.getBoundingClientRect()
         return [box.left + box.width / 2, box.top + box.height / 2].map(Math.round)",
    );
    let from = [0, 1].map(|side| place[side].as_i64().expect("a number"));
    browser.touch(&[&[from, [from[0] + 20, from[1]], [from[0] + 30, from[1]]]]);
    browser.wait("document.documentElement.dataset.version !== '1'");
    let [radius] = numbers::<1>(&written(&watching, &browser), "radius");
    assert!(radius > 2.0, "{radius}");
}

#[test]
fn two_fingers_zoom_the_sheet_or_take_the_camera_nearer() {
    let Some((watching, browser)) = opened(LOOK_AT) else { return };
    browser.emulate(PHONE, true, "dark");
    let spread = |browser: &Browser| {
        let [left, middle_left, far_left, right, middle_right, far_right] =
            around_middle(browser, [[-20, 0], [-40, 0], [-60, 0], [20, 0], [40, 0], [60, 0]]);
        browser.touch(&[&[left, middle_left, far_left], &[right, middle_right, far_right]]);
    };
    let wide = |browser: &Browser| {
        browser
            .run("return document.querySelector('canvas').getBoundingClientRect().width")
            .as_f64()
            .expect("a number")
    };
    let before = wide(&browser);
    spread(&browser);
    assert!((wide(&browser) / before - 3.0).abs() < 0.1, "{} of {before}", wide(&browser));
    browser.press('0');
    browser.run("document.querySelector('#steer').click()");
    browser.wait("document.querySelector('#field-position-0')");
    spread(&browser);
    let text = written(&watching, &browser);
    let to_ball = distance(numbers(&text, "position"), [4.0, 3.0, -1.0]);
    // The point that is looked at is 7 units away.
    assert!((to_ball - 7.0 / 3.0).abs() < 0.2, "{to_ball}");
    assert_eq!(wide(&browser), before, "the sheet stays");
}

#[test]
fn every_control_is_reached_by_tab_and_shows_that_it_is() {
    let Some((_watching, browser)) = opened(LOOK_AT) else { return };
    click(&browser, [40, 30]);
    browser.wait("document.querySelector('#field-radius-0') && !document.querySelector('#told').hidden");
    browser.run("document.querySelector('#layers input').focus(); window.reached = new Set()");
    let mut unseen = Vec::new();
    for _ in 0..60 {
        browser.press(TAB);
        let is_seen = browser.run(
            "const one = document.activeElement
             window.reached.add(one)
             if (one === document.body) return true
             const style = getComputedStyle(one.closest('#layers label') ?? one)
             return style.outlineStyle === 'solid' && parseFloat(style.outlineWidth) >= 2",
        );
        if is_seen != true {
            unseen.push(browser.text("return document.activeElement.outerHTML.slice(0, 80)"));
        }
    }
    assert!(unseen.is_empty(), "{unseen:?}");
    let missed = browser.text(
        "const all = [...document.querySelectorAll('button, select, input:not([type=radio]), [tabindex]')]
         const there = all.filter((one) => one.getBoundingClientRect().width > 0)
         return there.filter((one) => !window.reached.has(one)).map((one) => one.outerHTML).join()",
    );
    assert_eq!(missed, "");
}

#[test]
fn what_is_closed_gives_the_keys_back_to_the_image() {
    let Some((_watching, browser)) = opened(LOOK_AT) else { return };
    click(&browser, [40, 30]);
    browser.wait("document.querySelector('#field-radius-0')");
    browser.run("document.querySelector('#field-radius-0').focus()");
    browser.press('\u{e00c}');
    browser.wait("document.querySelector('#fields').hidden");
    assert_eq!(browser.text("return document.activeElement.id"), "stage");
    browser.press('\u{e012}');
    browser.wait("document.querySelector('#said').textContent === 'pixel 40 29: sphere ball'");
}
