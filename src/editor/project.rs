//! The files of a scene: the definitions and the uses of names in them.

use super::names::{Definition, Name, NameContext, Names, Namespace, check_name, written};
use super::view::{Item, View};
use std::ops::Range;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use tabray_core::files::plain;

/// The maximum number of files of a scene that are read.
const MAX_FILES: usize = 1000;

/// Gives access to files, with the contents in the editor if they are open there, and otherwise as stored.
pub trait Files {
    /// Returns the view of a file, if it can be read.
    fn view(&self, path: &Path) -> Option<Arc<View>>;
}

/// A place in a file.
#[derive(Clone, Debug, PartialEq)]
pub struct Location {
    /// The file.
    pub path: PathBuf,
    /// The range of the text, in bytes.
    pub place: Range<usize>,
}

/// The files of one scene or of several, with their contents.
pub type Group = Vec<(PathBuf, Arc<View>)>;

/// Returns a file and the files that it includes, directly or not.
fn with_included(files: &dyn Files, root: &Path) -> Group {
    let mut group: Group = Vec::new();
    let mut waiting = vec![root.to_owned()];
    while let Some(path) = waiting.pop() {
        if group.len() >= MAX_FILES || group.iter().any(|(known, _)| *known == path) {
            continue;
        }
        let Some(view) = files.view(&path) else { continue };
        for item in &view.items {
            if let Item::Include(include) = item {
                let file = |word| path.with_file_name(view.word(word).as_ref());
                waiting.extend(include.files.iter().map(|word| plain(&file(*word))));
            }
        }
        group.push((path, view));
    }
    group
}

/// Returns a file, the files that it includes, and the files of those `scenes` that include it.
pub fn group(files: &dyn Files, path: &Path, scenes: &[PathBuf]) -> Group {
    let mut group = with_included(files, path);
    for scene in scenes.iter().filter(|scene| *scene != path) {
        let others = with_included(files, scene);
        if others.iter().any(|(other, _)| other == path) {
            for (path, view) in others {
                if !group.iter().any(|(known, _)| *known == path) {
                    group.push((path, view));
                }
            }
        }
    }
    group
}

/// A definition: the index of its file, and its index there.
type Id = (usize, usize);

/// Returns the definition that a name in a file refers to, and the number of bytes at the end of the name that are
/// round numbers.
fn resolved(names: &[&Names], file: usize, name: &Name) -> Option<(Id, usize)> {
    let mut text = name.text.as_str();
    let mut rounds = 0;
    loop {
        let is_visible = |of: usize, definition: &Definition| match &definition.scope {
            None => rounds == 0,
            Some(scope) if rounds == 0 => of == file && scope.contains(&name.place.start),
            Some(_) => definition.depth >= rounds,
        };
        let candidates = (0..names.len()).flat_map(|of| {
            let visible = names[of].named(name.namespace, text).iter().map(move |index| (of, *index));
            visible.filter(|(of, index)| is_visible(*of, &names[*of].definitions[*index]))
        });
        // The innermost definition counts, and of several the last one before the use.
        let nearness = |(of, index): &Id| {
            let definition = &names[*of].definitions[*index];
            let is_before = *of == file && definition.name.place.start <= name.place.start;
            (definition.depth, *of == file, is_before, definition.name.place.start)
        };
        if let Some(id) = candidates.max_by_key(nearness) {
            return Some((id, name.text.len() - text.len()));
        }
        if !matches!(name.namespace, Namespace::Entity(_)) {
            return None;
        }
        let (before, round) = text.rsplit_once('_')?;
        if round.is_empty() || !round.bytes().all(|byte| byte.is_ascii_digit()) {
            return None;
        }
        (text, rounds) = (before, rounds + 1);
    }
}

/// Returns the definition of the name at a position of the first file.
fn definition(names: &[&Names], at: usize) -> Option<Id> {
    let (name, given) = names.first()?.at(at)?;
    given.map_or_else(|| resolved(names, 0, name).map(|(id, _)| id), |index| Some((0, index)))
}

fn all_names(group: &Group) -> Vec<&Names> {
    group.iter().map(|(_, view)| view.names()).collect()
}

/// Returns the definition of the name at a position of the group's first file.
pub fn definitions(group: &Group, at: usize) -> Vec<Location> {
    let names = all_names(group);
    let found = definition(&names, at).map(|(file, index)| Location {
        path: group[file].0.clone(),
        place: names[file].definitions[index].name.place.clone(),
    });
    found.or_else(|| included(group, at)).into_iter().collect()
}

/// Returns the included file whose name is at a position.
fn included(group: &Group, at: usize) -> Option<Location> {
    let (path, view) = group.first()?;
    let Some(Item::Include(include)) = view.at(at) else { return None };
    let word = include.files.iter().find(|word| word.has(at))?;
    let file = plain(&path.with_file_name(view.word(*word).as_ref()));
    group.iter().any(|(known, _)| *known == file).then_some(Location { path: file, place: 0..0 })
}

/// A use of a name: the file, the name, and the number of bytes at its end that are round numbers.
type Use<'n> = (usize, &'n Name, usize);

fn uses<'n>(names: &[&'n Names], id: Id, with_definition: bool) -> Vec<Use<'n>> {
    let defined = &names[id.0].definitions[id.1];
    let mut found = Vec::new();
    if with_definition {
        found.extend(std::iter::once(&defined.name).chain(&defined.again).map(|name| (id.0, name, 0)));
    }
    for (file, all) in names.iter().enumerate() {
        let like = |name: &&Name| {
            name.namespace == defined.name.namespace && name.text.starts_with(&defined.name.text)
        };
        for name in all.uses.iter().filter(like) {
            if let Some((meant, rounds)) = resolved(names, file, name)
                && meant == id
            {
                found.push((file, name, rounds));
            }
        }
    }
    found.sort_by_key(|(file, name, _)| (*file, name.place.start));
    found
}

/// Returns the uses of the name at a position of the group's first file.
pub fn usages(group: &Group, at: usize, with_definition: bool) -> Vec<Location> {
    let names = all_names(group);
    let Some(id) = definition(&names, at) else { return Vec::new() };
    let found =
        |(file, name, _): Use<'_>| Location { path: group[file].0.clone(), place: name.place.clone() };
    uses(&names, id, with_definition).into_iter().map(found).collect()
}

/// Returns the changes that rename the name at a position of the group's first file.
///
/// # Errors
/// Returns the reason why the name cannot be changed.
pub fn renamed(group: &Group, at: usize, new: &str) -> Result<Vec<(Location, String)>, String> {
    let names = all_names(group);
    let id = definition(&names, at).ok_or("there is no name of the scene here")?;
    let defined = &names[id.0].definitions[id.1];
    check_name(defined.name.namespace, new)?;
    if new == defined.name.text {
        return Ok(Vec::new());
    }
    let is_taken = |(file, all): (usize, &&Names)| {
        all.named(defined.name.namespace, new).iter().any(|index| {
            let other = &all.definitions[*index];
            let may_meet = |scope: &Range<usize>| file == id.0 && scope.contains(&defined.name.place.start);
            other.scope.as_ref().is_none_or(may_meet)
        })
    };
    if names.iter().enumerate().any(is_taken) {
        return Err(format!("a {} `{new}` already exists", super::names::describe(defined.name.namespace)));
    }
    let change = |(file, name, rounds): Use<'_>| {
        let (path, view) = &group[file];
        let text = format!("{new}{}", &name.text[name.text.len() - rounds..]);
        let place = match name.context {
            NameContext::Key(word) | NameContext::Value(word) => word.place(),
            NameContext::Formula => name.place.clone(),
        };
        (Location { path: path.clone(), place }, written(view.syntax, name.context, &text))
    };
    Ok(uses(&names, id, true).into_iter().map(change).collect())
}
