//! The number of values that an attribute takes, and groups of attributes from which a scene gives one.

use crate::text;

/// The numbers of values that an attribute may take.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Counts {
    /// One of these numbers of values.
    Of(&'static [usize]),
    /// A list of groups: the number of values in each group, and the least and the most number of groups.
    List {
        /// The number of values in a group.
        group: usize,
        /// The least number of groups.
        least: usize,
        /// The most number of groups.
        most: usize,
    },
}

impl Counts {
    /// Tells whether an attribute may take this number of values.
    pub fn allow(self, count: usize) -> bool {
        match self {
            Self::Of(counts) => counts.contains(&count),
            Self::List { group, least, most } => {
                count.is_multiple_of(group) && (least..=most).contains(&(count / group))
            }
        }
    }

    /// Returns the greatest number of values.
    pub fn most(self) -> usize {
        match self {
            Self::Of(counts) => counts.iter().copied().max().unwrap_or(0),
            Self::List { group, most, .. } => group * most,
        }
    }

    /// Returns some of the numbers of values: all of a few, and the first four of a list.
    pub fn examples(self) -> Vec<usize> {
        match self {
            Self::Of(counts) => counts.to_vec(),
            Self::List { group, least, most } => {
                (least..=most).take(4).map(|groups| group * groups).collect()
            }
        }
    }

    /// Describes a number of values. The noun for the values ends the phrase: "1 or 3 numbers", "2 to 64 pairs of
    /// numbers".
    pub fn describe(self, noun: &str) -> String {
        match self {
            Self::Of([1]) => format!("1 {noun}"),
            Self::Of(counts) => {
                let counts: Vec<_> = counts.iter().map(usize::to_string).collect();
                format!("{} {noun}s", counts.join(" or "))
            }
            Self::List { group, least, most } => {
                let groups = match group {
                    1 => format!("{noun}s"),
                    2 => format!("pairs of {noun}s"),
                    3 => format!("triples of {noun}s"),
                    more => format!("groups of {more} {noun}s"),
                };
                format!("{least} to {most} {groups}")
            }
        }
    }

    /// Describes the number of values that an attribute was given instead.
    pub fn not(self, given: &str) -> String {
        match self {
            Self::Of(_) => given.to_owned(),
            Self::List { .. } => format!("{given} {}", if given == "1" { "value" } else { "values" }),
        }
    }
}

/// Attributes from which a scene gives exactly one. As a row of a table, it stands beside the rows of the attributes,
/// which by themselves may be left out.
pub struct OneOf {
    /// The noun for each of the attributes, with its article: "the profile curve".
    pub meaning: &'static str,
    /// The names of the attributes.
    pub names: &'static [&'static str],
}

impl OneOf {
    /// Lists the names for messages: `surfer` or `profile`.
    pub fn describe(&self, conjunction: &str) -> String {
        let names: Vec<_> = self.names.iter().map(|name| format!("`{name}`")).collect();
        names.join(&format!(" {conjunction} "))
    }

    /// Says that a scene gives several of the attributes: "both a `surfer` and a `profile`".
    pub fn several(&self, given: &[&str]) -> String {
        let given: Vec<_> = given.iter().map(|name| format!("{} `{name}`", text::article(name))).collect();
        let both = if given.len() == 2 { "both " } else { "" };
        format!("{both}{}", given.join(" and "))
    }
}
