//! The texts of a scene: its own, those of included files, and the options that set values. All are joined to one text,
//! so that a place is a range of it.

use super::encoding;
use super::fault::Fault;
use super::options::ReadOptions;
use super::parsed::Word;
use super::parts::TextPart;
use super::report::Report;
use super::sets::{OPTION, Sets};
use super::tokens::{Token, TokenForm, Tokens};
use crate::syntax::Syntax;
use std::borrow::Cow;
use std::collections::HashMap;
use std::io::{self, Read};
use std::ops::Range;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use tabray_core::files;
use tabray_core::files::held::SceneFile;
use tabray_core::text::{self, nearest_file};
use toml::de::{DeTable, DeValue};

/// The maximum length of all texts together, in bytes.
const LARGEST: u64 = 1 << 30;

/// The maximum number of files that a scene includes, and their maximum nesting.
const MAX_FILES: usize = 1000;
const DEEPEST: usize = 16;

/// The texts of a scene.
pub struct Sources<'t> {
    /// All texts.
    pub text: Cow<'t, str>,
    /// The parts of the text, or none for a single one.
    pub parts: Vec<TextPart>,
    /// The part for each `include`, or the reason why the file cannot be included, by the place of the file's name.
    includes: HashMap<usize, Result<usize, Fault>>,
    /// The range of the scene's own text.
    pub own: Range<usize>,
    /// The range of the options that set values.
    options: Option<Range<usize>>,
    /// The included files, whether they exist or not.
    pub files: Vec<PathBuf>,
}

/// An open file: its path, and the index of the file that includes it.
struct OpenSource {
    path: PathBuf,
    includer: Option<usize>,
}

impl<'t> Sources<'t> {
    /// Reads the files that a scene includes, and adds the options.
    pub fn read(
        (name, folder): (&str, &Path),
        text: &'t str,
        syntax: Syntax,
        options: ReadOptions<'_>,
        room: u64,
    ) -> Self {
        let mut sources = Self::of(text);
        if !text.contains("include") && options.sets.is_empty() {
            return sources;
        }
        sources.parts.push(TextPart { name: name.to_owned(), range: sources.own.clone(), included_at: None });
        let own = folder.join(Path::new(name).file_name().unwrap_or_default());
        let mut readings = vec![OpenSource { path: own, includer: None }];
        let mut room = room.min(LARGEST).saturating_sub(text.len() as u64);
        let mut at = 0;
        while at < readings.len() {
            for (place, file) in included(syntax, &sources.text, sources.parts[at].range.clone()) {
                let word = (place.clone(), &*file);
                let read = sources.include(&mut readings, at, word, (syntax, options.open), &mut room);
                let read = read.map_err(|(message, help)| {
                    let fault = Fault::error(Some(place.clone()), message);
                    Fault { help, ..fault }
                });
                sources.includes.insert(place.start, read);
            }
            at += 1;
        }
        sources.add_options(options);
        sources
    }

    /// Adds the options to a text that includes no file.
    pub fn alone(name: &str, text: &'t str, options: ReadOptions<'_>) -> Self {
        let mut sources = Self::of(text);
        sources.parts.push(TextPart { name: name.to_owned(), range: sources.own.clone(), included_at: None });
        sources.add_options(options);
        sources
    }

    fn of(text: &'t str) -> Self {
        Self {
            text: Cow::Borrowed(text),
            parts: Vec::new(),
            includes: HashMap::new(),
            own: 0..text.len(),
            options: None,
            files: Vec::new(),
        }
    }

    fn add_options(&mut self, ReadOptions { sets, set_by, .. }: ReadOptions<'_>) {
        if sets.is_empty() {
            return;
        }
        let (own, others) = sets.split_at(sets.len() - set_by.len());
        let start = self.text.len() + 1;
        if !own.is_empty() {
            self.add(OPTION.to_owned(), &own.join("\n"));
        }
        for (name, set) in set_by.iter().zip(others) {
            self.add(text::visible(name).into_owned(), set);
        }
        self.options = Some(start..self.text.len());
    }

    /// Begins the report on the texts of a scene.
    pub fn report(&self, name: &str, syntax: Syntax) -> Report<'_> {
        let mut report = Report::new(name, &*self.text, syntax).in_parts(&self.parts);
        self.files.iter().for_each(|file| report.add_file(file.clone()));
        report
    }

    /// Returns the range of the file that an `include` names, or reports the reason why there is none. `stands`
    /// describes where an `include` is allowed.
    pub fn file(&self, file: &Word<'_>, stands: &str, report: &mut Report<'_>) -> Option<Range<usize>> {
        let place = file.place.as_ref().map_or(0, |place| place.start);
        match self.includes.get(&place) {
            Some(Ok(part)) => return Some(self.parts[*part].range.clone()),
            Some(Err(fault)) => report.add(fault.clone()),
            None => {
                let fault = Fault::error(file.place.clone(), "a file cannot be included here");
                report.add(fault.help(format!("an `include` stands {stands}")));
            }
        }
        None
    }

    /// Returns the values set by the options.
    pub fn sets(&self, report: &mut Report<'_>) -> Sets<'_> {
        let options = self.options.as_ref();
        options.map_or_else(Sets::default, |options| Sets::of(&self.text, options.clone(), report))
    }

    /// Adds a text, and returns its range.
    fn add(&mut self, name: String, text: &str) -> Range<usize> {
        let all = self.text.to_mut();
        all.push('\n');
        let range = all.len()..all.len() + text.len();
        *all += text;
        self.parts.push(TextPart { name, range: range.clone(), included_at: None });
        range
    }

    /// Reads a file and returns the index of its part, or an error and its correction.
    fn include(
        &mut self,
        readings: &mut Vec<OpenSource>,
        includer: usize,
        (place, file): (Range<usize>, &str),
        (syntax, open): (Syntax, &[(PathBuf, Arc<str>)]),
        room: &mut u64,
    ) -> Result<usize, Refused> {
        let path = readings[includer].path.with_file_name(file);
        self.files.push(path.clone());
        may_include(readings, includer, file, &path)?;
        if Syntax::of_name(&path).unwrap_or(syntax) != syntax {
            let help = "`tabray convert` writes a file in the other syntax";
            return Err((format!("`{file}` is in a different syntax from the scene"), Some(help.to_owned())));
        }
        let bytes = read(file, &path, open, *room)?;
        *room = room
            .checked_sub(bytes.len() as u64)
            .ok_or_else(|| (format!("`{file}` is too large to be included"), None))?;
        let text = std::str::from_utf8(&bytes).ok().filter(|text| !text.contains('\0'));
        let Some(text) = text else {
            let other = encoding::other(&bytes).map(|name| format!("probably encoded in {name}"));
            let what = other.unwrap_or_else(|| "not text".to_owned());
            let help = "a scene is plain text, in UTF-8";
            return Err((format!("`{file}` is {what}"), Some(help.to_owned())));
        };
        let name = text::shown(Path::new(&self.parts[includer].name).with_file_name(file));
        self.add(name, text.strip_prefix('\u{feff}').unwrap_or(text));
        let real = path.canonicalize().unwrap_or_else(|_| path.clone());
        if Syntax::of_name(&real).is_none()
            && let Some(part) = self.parts.last_mut()
        {
            part.included_at = Some(place);
        }
        readings.push(OpenSource { path, includer: Some(includer) });
        Ok(self.parts.len() - 1)
    }
}

/// An error of an included file, and its correction.
type Refused = (String, Option<String>);

/// Checks that a file does not include itself, directly or through others, and that there are not too many files.
fn may_include(readings: &[OpenSource], includer: usize, file: &str, path: &Path) -> Result<(), Refused> {
    let same = |other: &Path| match (other.canonicalize(), path.canonicalize()) {
        (Ok(other), Ok(path)) => other == path,
        _ => false,
    };
    let mut outer = Some(includer);
    let mut depth = 0;
    while let Some(reading) = outer.map(|outer| &readings[outer]) {
        if same(&reading.path) {
            let help = "a file cannot include itself, directly or through others";
            return Err((format!("`{file}` includes itself"), Some(help.to_owned())));
        }
        outer = reading.includer;
        depth += 1;
    }
    if depth > DEEPEST || readings.len() > MAX_FILES {
        let help = format!("a scene includes at most {MAX_FILES} files, at most {DEEPEST} within each other");
        return Err((format!("`{file}` is one file too many"), Some(help)));
    }
    Ok(())
}

/// Reads a file, or takes its text from an editor. One byte more than the limit is enough to refuse it.
fn read(file: &str, path: &Path, open: &[(PathBuf, Arc<str>)], room: u64) -> Result<Vec<u8>, Refused> {
    let plain = files::plain(path);
    if let Some((_, text)) = open.iter().find(|(known, _)| *known == plain) {
        return Ok(text.as_bytes().to_vec());
    }
    let mut bytes = Vec::new();
    let read = SceneFile::open(path).and_then(|opened| opened.take(room + 1).read_to_end(&mut bytes));
    let Err(error) = read else { return Ok(bytes) };
    let near = nearest_file(path).filter(|_| error.kind() == io::ErrorKind::NotFound);
    let near = near.map(|near| Path::new(file).with_file_name(near));
    let help = match near {
        Some(near) => format!("did you mean `{}`?", text::shown(near)),
        None => "the name is relative to the file that includes it".to_owned(),
    };
    Err((format!("cannot read `{file}`: {}", text::reason(&error)), Some(help)))
}

/// Returns the files that a part of a text includes, each with the place of its name.
fn included(syntax: Syntax, text: &str, part: Range<usize>) -> Vec<(Range<usize>, String)> {
    if !text[part.clone()].contains("include") {
        return Vec::new();
    }
    match syntax {
        Syntax::Notes => in_words(&text[..part.end], part.start),
        Syntax::Toml => in_toml(&text[part.clone()], part.start),
    }
}

fn in_words(text: &str, start: usize) -> Vec<(Range<usize>, String)> {
    let nowhere = &mut Report::default();
    let mut tokens = Tokens::from(text, start, nowhere);
    let (mut depth, mut files) = (0_usize, Vec::new());
    while let Some(Token { form, .. }) = tokens.ahead[0] {
        let is_include =
            form == TokenForm::Word && tokens.ahead[0].map(|token| tokens.raw(token)) == Some("include");
        match form {
            TokenForm::Open => depth += 1,
            TokenForm::Close => depth = depth.saturating_sub(1),
            _ if depth == 0 && is_include => {
                let file = tokens.ahead[1].filter(|file| !file.is_brace());
                files.extend(file.map(|file| (file.place(), tokens.text(file).into_owned())));
            }
            _ => {}
        }
        tokens.step(nowhere);
    }
    files
}

fn in_toml(text: &str, start: usize) -> Vec<(Range<usize>, String)> {
    let (document, _) = DeTable::parse_recoverable(text);
    let include = document.into_inner().into_iter().find(|(key, _)| key.get_ref() == "include");
    let values = include.map(|(_, value)| match value.get_ref() {
        DeValue::Array(files) => files.iter().cloned().collect(),
        _ => vec![value],
    });
    let file = |value: toml::Spanned<DeValue<'_>>| match value.get_ref() {
        DeValue::String(file) => {
            Some((start + value.span().start..start + value.span().end, file.to_string()))
        }
        _ => None,
    };
    values.into_iter().flatten().filter_map(file).collect()
}
