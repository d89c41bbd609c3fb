//! The page as HTML: the part of all pages, and the additions of one of them.

/// The part of all pages, with slots.
const PAGE: &str = include_str!("html/page.html");
const STYLE: &str = include_str!("html/style.css");

/// The scripts of all pages; the scripts of a single page stand between them.
const FIRST: &str = include_str!("html/state.js");
const SHARED: &str = concat!(
    include_str!("html/colours.js"),
    include_str!("html/scene.js"),
    include_str!("html/display.js"),
    include_str!("html/image.js"),
    include_str!("html/zoom.js"),
    include_str!("html/camera.js"),
    include_str!("html/compare.js"),
    include_str!("html/tabs.js"),
    include_str!("html/explain.js"),
    include_str!("html/fields.js"),
);
const LAST: &str = concat!(include_str!("html/pointer.js"), include_str!("html/keys.js"));

/// The beginning of a line that marks a slot.
const SLOT: &str = "<!-- slot: ";

/// The additions of one page.
pub struct Own<'p> {
    /// For each slot that is filled, the line of the slot and its content.
    pub html: &'p str,
    /// The style sheet.
    pub style: &'p str,
    /// The script that asks the program: `request`, `post`, `ask` and `follow`.
    pub link: &'p str,
    /// The other scripts.
    pub scripts: &'p str,
}

/// Assembles a page. It is one file, so no part of it can be missing.
pub fn page(own: &Own) -> String {
    let Own { html, style, link, scripts } = own;
    let (head, body) = PAGE.split_once("<header>").unwrap_or((PAGE, ""));
    let [head, body] = [head, body].map(|part| filled(part, html));
    format!(
        "{head}<style>\n{STYLE}{style}</style>\n<header>{body}<script>\n{FIRST}{link}{SHARED}{scripts}{LAST}</script>\n"
    )
}

/// Puts the content of each slot of `own` into the slot.
fn filled(shared: &str, own: &str) -> String {
    let fill = |line| {
        let is_slot = str::starts_with(line, SLOT);
        let given = || own.split_once(line).and_then(|(_, rest)| rest.split(SLOT).next());
        if is_slot { given().unwrap_or_default() } else { line }
    };
    shared.split_inclusive('\n').map(fill).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn slots_are_filled_and_empty_ones_go() {
        let shared = "<a>\n<!-- slot: one -->\n<!-- slot: two -->\n</a>\n";
        let own = "<!-- slot: two -->\n<b>\n</b>\n<!-- slot: three -->\n<c>\n";
        assert_eq!(filled(shared, own), "<a>\n<b>\n</b>\n</a>\n");
    }

    #[test]
    fn a_page_has_no_slot_left() {
        let page = page(&Own { html: "", style: "", link: "", scripts: "" });
        assert!(!page.contains(SLOT) && page.contains("<style>") && page.contains("<header>"));
    }
}
