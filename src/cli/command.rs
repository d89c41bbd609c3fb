//! Commands: each registers itself in its own file, as entity types do.

use crate::process::failure::{Failure, report};
use clap::{ArgMatches, Args};
use std::panic::Location;
use std::process::ExitCode;
use std::sync::LazyLock;
use tabray_core::text;
use tabray_lang::registry::Registry;

/// A subcommand of the program.
pub struct Command {
    name: &'static str,
    group: Group,
    /// The places in the help of its group, and among all commands in what shells and manuals are told.
    places: [u8; 2],
    /// Whether it watches `--time-limit` by itself from its beginning.
    pub(crate) keeps_time_limit: bool,
    action: &'static dyn Action,
    place: &'static Location<'static>,
}

inventory::collect!(Command);

/// The purpose under which the help lists a command, in the order of the help.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Group {
    /// What everybody needs first.
    First,
    /// Images and films.
    Rendering,
    /// Scenes as files.
    Scenes,
    /// What a scene or an image holds.
    Inside,
    /// What rays hit.
    Rays,
    /// Speed and accuracy.
    Measuring,
    /// What editors and shells use.
    Tools,
}

impl Group {
    /// Returns all groups, in the order of the help.
    pub(crate) const ALL: [Self; 7] =
        [Self::First, Self::Rendering, Self::Scenes, Self::Inside, Self::Rays, Self::Measuring, Self::Tools];

    /// Returns the heading.
    pub(crate) fn heading(self) -> &'static str {
        match self {
            Self::First => "First",
            Self::Rendering => "Rendering",
            Self::Scenes => "Scenes",
            Self::Inside => "Looking inside",
            Self::Rays => "Rays",
            Self::Measuring => "Speed and accuracy",
            Self::Tools => "Tools",
        }
    }
}

/// What a command does: a function of the entity types and of the command's own arguments.
pub struct Run<A, E>(pub fn(&'static Registry, A) -> E);

/// How a command ends.
pub trait Outcome {
    /// Returns the exit status. A failure is printed.
    fn exit_code(self) -> ExitCode;
}

impl Outcome for ExitCode {
    fn exit_code(self) -> ExitCode {
        self
    }
}

impl Outcome for Result<(), Failure> {
    fn exit_code(self) -> ExitCode {
        match self {
            Ok(()) => ExitCode::SUCCESS,
            Err(failure) => report(&failure),
        }
    }
}

/// A [`Run`] with its types erased.
trait Action: Sync {
    /// Adds the arguments to a command line.
    fn augment(&self, command: clap::Command) -> clap::Command;
    /// Runs the command.
    fn run(&self, registry: &'static Registry, matches: &ArgMatches) -> ExitCode;
}

impl<A: Args, E: Outcome> Action for Run<A, E> {
    fn augment(&self, command: clap::Command) -> clap::Command {
        A::augment_args(command)
    }

    fn run(&self, registry: &'static Registry, matches: &ArgMatches) -> ExitCode {
        let args = A::from_arg_matches(matches).unwrap_or_else(|error| error.exit());
        (self.0)(registry, args).exit_code()
    }
}

impl Command {
    /// Describes a command, which is listed after those of tabray. The documentation of the arguments' type is the
    /// command's help.
    #[track_caller]
    pub const fn new<A: Args, E: Outcome>(
        name: &'static str,
        group: Group,
        action: &'static Run<A, E>,
    ) -> Self {
        let (places, keeps_time_limit) = ([u8::MAX; 2], false);
        Self { name, group, places, keeps_time_limit, action, place: Location::caller() }
    }

    /// Gives the command its places in the help of its group, and among all commands for shells and manuals.
    pub const fn placed(mut self, in_help: u8, among_all: u8) -> Self {
        self.places = [in_help, among_all];
        self
    }

    /// Leaves it to the command to watch `--time-limit`, from its beginning.
    pub const fn keeping_time_limit(mut self) -> Self {
        self.keeps_time_limit = true;
        self
    }

    /// Returns the name.
    pub(crate) fn name(&self) -> &'static str {
        self.name
    }

    /// Runs the command.
    pub(crate) fn run(&self, registry: &'static Registry, matches: &ArgMatches) -> ExitCode {
        self.action.run(registry, matches)
    }

    /// Finds the command of this name.
    pub(crate) fn named(name: &str) -> Option<&'static Self> {
        inventory::iter::<Self>().find(|command| command.name == name)
    }

    /// Returns the commands of a group, as the help lists them.
    pub(crate) fn of(group: Group) -> Vec<&'static Self> {
        let mut all: Vec<_> = inventory::iter::<Self>().filter(|command| command.group == group).collect();
        all.sort_unstable_by_key(|command| (command.places[0], command.name));
        all
    }
}

/// Returns an error message if two commands have one name, with one line for each, including both source positions.
pub(crate) fn contradictions() -> Option<&'static str> {
    static FAULTS: LazyLock<String> = LazyLock::new(|| faults(inventory::iter::<Command>()).join("\n"));
    (!FAULTS.is_empty()).then_some(FAULTS.as_str())
}

fn faults<'c>(commands: impl IntoIterator<Item = &'c Command>) -> Vec<String> {
    // `inventory` returns them in the linker's order.
    let mut sorted: Vec<_> = commands.into_iter().collect();
    sorted.sort_unstable_by_key(|command| (command.name, command.place));
    let twice = sorted.windows(2).filter(|pair| pair[0].name == pair[1].name);
    let fault = |pair: &[&Command]| {
        let [first, second] = [0, 1].map(|index| text::place(pair[index].place));
        format!(
            "the command `{}` is registered twice, at {first} and at {second}: rename one of them",
            pair[0].name
        )
    };
    twice.map(fault).collect()
}

/// Adds all commands to a command line.
pub(crate) fn with_all(line: clap::Command) -> clap::Command {
    let mut all: Vec<_> = inventory::iter::<Command>().collect();
    all.sort_unstable_by_key(|command| (command.places[1], command.name));
    line.subcommands(all.into_iter().map(|command| command.action.augment(clap::Command::new(command.name))))
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::slice;

    #[derive(clap::Args)]
    struct Nothing {}

    fn nothing(_: &Registry, _: Nothing) -> ExitCode {
        ExitCode::SUCCESS
    }

    #[test]
    fn a_command_registered_twice_is_refused_with_both_places() {
        static ONE: Command = Command::new("twice", Group::Tools, &Run(nothing));
        static OTHER: Command = Command::new("twice", Group::Rays, &Run(nothing));
        static ALONE: Command = Command::new("alone", Group::Rays, &Run(nothing));
        let expected = format!(
            "the command `twice` is registered twice, at {} and at {}: rename one of them",
            text::place(ONE.place),
            text::place(OTHER.place)
        );
        for order in [[&ONE, &ALONE, &OTHER], [&OTHER, &ONE, &ALONE]] {
            assert_eq!(faults(order), slice::from_ref(&expected));
        }
        assert_eq!(contradictions(), None);
    }
}
