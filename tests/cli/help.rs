//! The examples in the help and in the docs.

use crate::common::root;
use clap::Command;
use clap::error::ErrorKind;
use std::fs;
use tabray::cli::line;

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
    let root = root();
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
            let fault = tabray::cli::line().try_get_matches_from(words).err();
            assert!(fault.is_none(), "{}: {line}: {fault:?}", page.display());
            count += 1;
        }
    }
    assert!(count > 20, "{count} command lines are found");
}
