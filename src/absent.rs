//! What a tabray without the guest `import` says of files that the guest reads.

use tabray_lang::Syntax;
use tabray_lang::import::{Imported, Program};
use tabray_lang::reader::{Fault, Report};

inventory::submit! {
    Program { what: "a surface of SURFER", extensions: &["jsurf"], has_written: |_| false, read: refuse }
}

inventory::submit! {
    Program { what: "a script of surf", extensions: &["surf", "pic"], has_written: |_| false, read: refuse }
}

fn refuse(name: &str, text: &str) -> Result<Imported, Report> {
    let mut report = Report::new(name, text.to_owned(), Syntax::Notes);
    let first = text.lines().next().map_or(0, str::len);
    let message = "this tabray was built without its feature `import`, which reads files of SURFER and surf";
    let cure = "a tabray with all features reads it; its `tabray convert` writes a scene for this one";
    report.add(Fault::error(Some(0..first), message).help(cure));
    Err(report)
}
