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
        let commands = Command::of(group);
        // Those of a guest that is not linked; `help` itself is among the tools.
        if commands.is_empty() && group != Group::Tools {
            continue;
        }
        let _ = write!(template, "\n{header}{}:{header:#}\n", group.heading());
        for name in commands.into_iter().map(Command::name) {
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
