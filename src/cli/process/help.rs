//! The help of the whole command line: the commands in groups by their purpose.

use clap::Command;
use clap::builder::StyledStr;
use std::fmt::Write;

/// The commands by their purpose, as `--help` lists them.
const GROUPS: [(&str, &[&str]); 6] = [
    ("Rendering", &["render", "watch", "merge", "film", "farm"]),
    ("Scenes", &["new", "list", "check", "fmt", "convert", "mesh", "dump"]),
    ("Looking inside", &["plan", "probe", "diff", "grade", "review"]),
    ("Rays", &["hits", "judge", "hard"]),
    ("Speed and accuracy", &["choose", "chart", "verify", "bench"]),
    ("Tools", &["lsp", "schema", "grammar", "completions", "man", "help"]),
];

/// Makes `--help` list the commands in groups.
pub fn grouped(command: Command) -> Command {
    let styles = command.get_styles();
    let (header, literal) = (styles.get_header(), styles.get_literal());
    let mut template = StyledStr::new();
    let _ = write!(template, "{{about-with-newline}}\n{{usage-heading}} {{usage}}\n");
    for (purpose, names) in GROUPS {
        let _ = write!(template, "\n{header}{purpose}:{header:#}\n");
        for name in names {
            let about = match command.find_subcommand(name) {
                // As it is: each start of the program makes this, and taking styles out takes longer than a small image.
                Some(command) => {
                    command.get_about().map(|about| about.ansi().to_string()).unwrap_or_default()
                }
                None => "Explain a command and its options".to_owned(),
            };
            let _ = writeln!(template, "  {literal}{name:<11}{literal:#}  {about}");
        }
    }
    let _ = write!(template, "\n{header}Options:{header:#}\n{{options}}{{after-help}}");
    command.help_template(template)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::command;
    use clap::error::ErrorKind;
    use std::fs;
    use std::path::Path;

    #[test]
    fn every_command_is_in_one_group() {
        let command = command();
        let mut known: Vec<&str> = command.get_subcommands().map(Command::get_name).chain(["help"]).collect();
        let mut grouped: Vec<&str> = GROUPS.iter().flat_map(|(_, names)| *names).copied().collect();
        known.sort_unstable();
        grouped.sort_unstable();
        assert_eq!(grouped, known);
    }

    /// Appends a command and its subcommands.
    fn collect<'c>(command: &'c Command, all: &mut Vec<&'c Command>) {
        all.push(command);
        command.get_subcommands().for_each(|command| collect(command, all));
    }

    #[test]
    fn every_example_is_a_command_line() {
        let command = command();
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
                let fault = command().try_get_matches_from(words).err();
                assert!(fault.is_none(), "{}: {line}: {fault:?}", page.display());
                count += 1;
            }
        }
        assert!(count > 20, "{count} command lines are found");
    }
}
