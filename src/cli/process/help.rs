//! The help of the whole command line: the commands in groups by their purpose.

use crate::command::{Command, Group};
use crate::process::program;
use clap::builder::{Resettable, StyledStr};
use std::fmt::Write;

const BEGINNING: &str = "{about-with-newline}\n{usage-heading} {usage}\n";

/// Returns the groups that have commands, with the names of these.
fn groups() -> impl Iterator<Item = (Group, Vec<&'static str>)> {
    let of = |group| {
        let mut names: Vec<_> = Command::of(group).into_iter().map(Command::name).collect();
        names.extend((group == Group::Tools).then_some("help"));
        (group, names)
    };
    // Those of a guest that is not linked are missing.
    Group::ALL.into_iter().map(of).filter(|(_, names)| !names.is_empty())
}

/// Writes the row of a command.
fn row(template: &mut StyledStr, line: &clap::Command, name: &str) {
    let literal = line.get_styles().get_literal();
    // As it is: each start of the program makes this, and taking styles out takes longer than a small image.
    let about = line.find_subcommand(name).and_then(clap::Command::get_about);
    let about = about
        .map_or_else(|| "Explain a command and its options".to_owned(), |about| about.ansi().to_string());
    let _ = writeln!(template, "  {literal}{name:<11}{literal:#}  {about}");
}

/// Makes `--help` list the commands in groups.
pub fn grouped(line: clap::Command) -> clap::Command {
    let header = line.get_styles().get_header();
    let mut template = StyledStr::from(BEGINNING);
    for (group, names) in groups() {
        let _ = write!(template, "\n{header}{}:{header:#}\n", group.heading());
        names.into_iter().for_each(|name| row(&mut template, &line, name));
    }
    let _ = write!(template, "\n{header}Options:{header:#}\n{{options}}{{after-help}}");
    line.help_template(template)
}

/// Makes the help fit on one screen: it says what the commands do that everybody needs first, and names the others.
pub fn on_one_screen(line: clap::Command) -> clap::Command {
    let header = line.get_styles().get_header();
    let mut template = StyledStr::from(BEGINNING);
    for (group, names) in groups() {
        if group == Group::First {
            let _ = writeln!(template);
            names.into_iter().for_each(|name| row(&mut template, &line, name));
            let _ = writeln!(template);
        } else {
            let heading = format!("{}:", group.heading());
            let _ = writeln!(template, "{header}{heading:<19}{header:#}  {}", names.join(", "));
        }
    }
    let name = program::name();
    let _ = write!(template, "\n`{name} help render` explains a command, and `{name} --help` all of them.");
    line.help_template(template).long_about(Resettable::Reset)
}

#[cfg(test)]
mod tests {
    use crate::line;

    #[test]
    fn the_first_help_names_every_command() {
        let help = super::on_one_screen(line()).render_help().to_string();
        for command in line().get_subcommands() {
            assert!(help.contains(command.get_name()), "{help}");
        }
    }

    // No guest is linked here, and all commands about rays are guests'.
    #[test]
    fn a_group_without_commands_has_no_heading() {
        let help = line().render_help().to_string();
        assert!(help.contains("\nScenes:\n") && !help.contains("\nRays:\n"), "{help}");
        let long = line().render_long_help().to_string();
        // Examples have the name of the running program, here that of a test.
        assert!(long.contains(" render ball.ray") && !long.contains(" watch ball.ray"), "{long}");
    }
}
