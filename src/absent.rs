//! What a tabray without the guest `import` says of files that the guest reads.

use tabray_lang::Syntax;
use tabray_lang::import::{Imported, Program};
use tabray_lang::reader::{Fault, Report};

inventory::submit! {
    Program {
        what: "a file of SURFER or surf",
        cure: CURE,
        extensions: &["jsurf", "surf", "pic"],
        has_written: |_| false,
        read: refuse,
    }
}

const CURE: &str = "`tabray convert` of a tabray that was built with its feature `import` writes it as one";

fn refuse(name: &str, text: &str) -> Result<Imported, Report> {
    let mut report = Report::new(name, text.to_owned(), Syntax::Notes);
    let first = text.lines().next().map_or(0, str::len);
    report.add(Fault::error(Some(0..first), "this is a file of SURFER or surf, not a scene").help(CURE));
    Err(report)
}
