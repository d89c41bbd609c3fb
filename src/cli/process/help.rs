//! The help of the whole command line: the commands in groups by their purpose.

use crate::command::{Command, Group};
use clap::builder::StyledStr;
use std::fmt::Write;

/// Makes `--help` list the commands in groups.
pub fn grouped(line: clap::Command) -> clap::Command {
    let styles = line.get_styles();
    let (header, literal) = (styles.get_header(), styles.get_literal());
    let mut template = StyledStr::new();
    let row = |template: &mut StyledStr, name: &str, about: String| {
        let _ = writeln!(template, "  {literal}{name:<11}{literal:#}  {about}");
    };
    let _ = write!(template, "{{about-with-newline}}\n{{usage-heading}} {{usage}}\n");
    for group in Group::ALL {
        let _ = write!(template, "\n{header}{}:{header:#}\n", group.heading());
        for name in Command::of(group).into_iter().map(Command::name) {
            // As it is: each start of the program makes this, and taking styles out takes longer than a small image.
            let about = line.find_subcommand(name).and_then(clap::Command::get_about);
            row(&mut template, name, about.map(|about| about.ansi().to_string()).unwrap_or_default());
        }
    }
    row(&mut template, "help", "Explain a command and its options".to_owned());
    let _ = write!(template, "\n{header}Options:{header:#}\n{{options}}{{after-help}}");
    line.help_template(template)
}

#[cfg(test)]
mod tests {
    use crate::line;
    use clap::Command;
    use clap::error::ErrorKind;
    use std::fs;
    use std::path::Path;

    /// Appends a command and its subcommands.
    fn collect<'c>(command: &'c Command, all: &mut Vec<&'c Command>) {
        all.push(command);
        command.get_subcommands().for_each(|command| collect(command, all));
    }

    #[test]
    fn every_example_is_a_command_line() {
        let command = line();
        let mut all = Vec::new();
        collect(&command, &mut all);
        for explained in all.into_iter().filter(|command| command.get_name() != "lsp") {
            let text = explained.get_after_long_help().map(ToString::to_string).unwrap_or_default();
            let Some((_, examples)) = text.split_once("Examples:\n") else {
                panic!("`{}` has no examples", explained.get_name());
            };
            for line in examples.lines() {
                let words = line.split(['#', '>', '<']).next().expect("a line").split_whitespace();
                let fault = command.clone().try_get_matches_from(words).err();
                let fault = fault.filter(|fault| fault.kind() != ErrorKind::DisplayHelp);
                assert!(fault.is_none(), "{line}: {fault:?}");
            }
        }
    }

    /// Returns the words of a shell's command line, up to a pipe, a redirection or a comment.
    fn words(line: &str) -> Vec<String> {
        let (mut words, mut quote, mut is_open) = (Vec::new(), None, false);
        for letter in line.chars() {
            match (quote, letter) {
                (None, '|' | '<' | '>' | ';' | '&' | '#') => break,
                (None, '"' | '\'') => quote = Some(letter),
                (Some(open), _) if open == letter => quote = None,
                (None, ' ') => is_open = false,
                _ => {
                    if !is_open {
                        words.push(String::new());
                    }
                    words.last_mut().expect("a word").push(letter);
                    is_open = true;
                }
            }
        }
        words
    }

    #[test]
    fn every_command_line_of_the_docs_is_one() {
        let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("../..");
        let entries =
            fs::read_dir(root.join("docs")).expect("the docs").map(|entry| entry.expect("an entry").path());
        let pages = entries.filter(|path| path.extension().is_some_and(|end| end == "md"));
        let mut count = 0;
        for page in pages.chain(["README.md", "CONTRIBUTING.md", "SECURITY.md"].map(|page| root.join(page))) {
            let text = fs::read_to_string(&page).expect("a page").replace("\\\n", " ");
            let blocks = text.split("```").skip(1).step_by(2);
            for line in blocks.flat_map(str::lines) {
                let line = line.replace("cargo run --release -- ", "tabray ");
                let begins = |at: &usize| {
                    *at == 0 || ["| ", "&& ", "do "].iter().any(|before| line[..*at].ends_with(before))
                };
                let Some(at) = line.find("tabray ").filter(begins) else { continue };
                let words = words(&line[at..]);
                let fault = crate::line().try_get_matches_from(words).err();
                assert!(fault.is_none(), "{}: {line}: {fault:?}", page.display());
                count += 1;
            }
        }
        assert!(count > 20, "{count} command lines are found");
    }
}
