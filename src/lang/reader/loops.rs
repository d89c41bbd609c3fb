//! Loops of other languages, and the `repeat` that each means.

use tabray_exact::formula::is_taken;

/// The words that begin a loop.
const LOOPS: [&str; 6] = ["repeat", "for", "foreach", "loop", "while", "do"];

/// Words of a loop's head that are neither its name nor another variable.
const FILLERS: [&str; 14] = [
    "int", "float", "double", "let", "var", "const", "each", "in", "of", "range", "from", "to", "until",
    "times",
];

/// What a loop runs over.
pub struct Run<'t> {
    /// The name of its number.
    pub name: &'t str,
    /// The first number.
    first: u32,
    /// How many numbers there are.
    pub count: u32,
}

impl Run<'_> {
    /// Returns how to write the loop.
    pub fn cure(&self) -> String {
        let Self { name, first, count } = self;
        let value = if *first == 0 { (*name).to_owned() } else { format!("{name} + {first}") };
        let goes = match count {
            1 => format!("is {first}"),
            _ => format!("goes from {first} to {}", first + (count - 1)),
        };
        format!("write `repeat {name} {count} {{`; in its braces, `\"{value}\"` {goes}")
    }
}

/// Returns the word of a loop with which a word begins: `for(i` begins with `for`.
pub fn word(word: &str) -> Option<&str> {
    let word = word.split('(').next()?;
    LOOPS.contains(&word).then_some(word)
}

/// Returns what stands on a line from a byte on, up to a brace.
pub fn head(text: &str, start: usize) -> Option<&str> {
    let rest = text.get(start..)?;
    rest.split(['\n', '{', '}']).next()
}

/// Returns what a loop runs over, if its head tells so: whole numbers from 0 on, in steps of 1.
pub fn run(head: &str) -> Option<Run<'_>> {
    let ranges = head.replace("...", "..=");
    let pieces = ranges.replace("..=", " ").replace("..", " ").replace("++", "");
    if pieces.contains(['.', '-', '>', '*', '/', '+', '[', '"']) {
        return None;
    }
    let words = || head.split(|letter: char| !(letter.is_alphanumeric() || letter == '_'));
    let mut names = words().filter(|word| word.starts_with(char::is_alphabetic) && !FILLERS.contains(word));
    let name = names.next().unwrap_or("i");
    if names.any(|other| other != name) {
        return None;
    }
    // What has a meaning in formulas cannot be the name of a number.
    let name = if is_taken(name) { "i" } else { name };
    let numbers = words().filter(|word| word.starts_with(|letter: char| letter.is_ascii_digit()));
    let numbers = numbers.map(|word| word.parse().ok()).collect::<Option<Vec<u32>>>()?;
    let (first, end) = match numbers[..] {
        [end] => (0, end),
        [first, end] => (first, end),
        _ => return None,
    };
    let is_between = |mark: usize| {
        let ends = [head[..mark].chars().next_back(), head[mark + 1..].chars().next()];
        ends.iter().all(|letter| letter.is_some_and(|letter| letter.is_ascii_digit()))
    };
    let has_last = ranges.contains("<=")
        || ranges.contains("..=")
        || words().any(|word| word == "to")
        || head.match_indices(':').any(|(mark, _)| is_between(mark));
    let count = end.checked_add(u32::from(has_last))?.checked_sub(first).filter(|count| *count > 0)?;
    Some(Run { name, first, count })
}

#[cfg(test)]
mod tests {
    use super::run;

    #[test]
    fn the_head_of_a_loop_tells_its_name_and_its_numbers() {
        for (head, expected) in [
            (" i 5 ", Some(("i", 0, 5))),
            (" (int i = 0; i <= 5; i++)", Some(("i", 0, 6))),
            ("(let k=1;k<8;k++)", Some(("k", 1, 7))),
            (" i in range(2, 6):", Some(("i", 2, 4))),
            (" i = 1 to 10", Some(("i", 1, 10))),
            (" i in 1..=10 ", Some(("i", 1, 10))),
            (" i = 1:5 ", Some(("i", 1, 5))),
            (" i in 0..10 ", Some(("i", 0, 10))),
            (" i < 10 ", Some(("i", 0, 10))),
            (" 5 times ", Some(("i", 0, 5))),
            (" x 1 10 ", Some(("i", 1, 9))),
            (" i in range(0, 10, 2) ", None),
            (" (i = 10; i > 0; i--) ", None),
            (" (x = 0; x < 8; x += 2) ", None),
            (" x in [1, 2] ", None),
            (" i in 0 to n ", None),
            (" (x = 0; x < 0.5; x++) ", None),
            (" i in range(6, 2) ", None),
            (" (true) ", None),
        ] {
            let read = run(head).map(|run| (run.name, run.first, run.count));
            assert_eq!(read, expected, "{head}");
        }
    }
}
