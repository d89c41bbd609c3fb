//! The imports of each file of a crate, read from its tokens: `use`, and paths in any body, macros included.

use proc_macro2::{Delimiter, TokenStream, TokenTree};
use std::collections::{BTreeMap, BTreeSet};
use std::fmt;
use std::path::{Path, PathBuf};

/// The path of a module from the root of the crate: `["world", "light"]`.
type Module = Vec<String>;

/// An import of one file from another.
#[derive(PartialEq, Eq, PartialOrd, Ord)]
pub struct Import {
    pub from: Module,
    pub to: Module,
    place: (PathBuf, usize),
}

impl fmt::Display for Import {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { from, to, place: (path, line) } = self;
        write!(f, "{}:{line}: `{}` takes from `{}`", path.display(), from.join("::"), to.join("::"))
    }
}

/// The files of a crate, and their imports.
pub struct Tree {
    pub imports: Vec<Import>,
    files: BTreeMap<Module, File>,
}

/// The relevant content of a file.
#[derive(Default)]
struct File {
    path: PathBuf,
    /// Paths to items of this crate from its root, with their lines.
    paths: Vec<(usize, Module)>,
    /// The re-exported items.
    exports: BTreeMap<String, Module>,
    types: BTreeSet<String>,
    /// Methods, with the types that they belong to.
    methods: BTreeSet<(String, String)>,
    /// The names of called methods, each with the line of one call.
    calls: BTreeMap<String, usize>,
}

/// Returns the module of a file: `src/core/world/light.rs` and `src/core/world/light/mod.rs` are `world::light`.
fn module_of(path: &Path) -> Module {
    let parts = path.with_extension("");
    let mut module: Module = parts.iter().skip(2).map(|part| part.to_string_lossy().into_owned()).collect();
    if module.last().is_some_and(|last| last == "mod" || last == "lib") {
        module.pop();
    }
    module
}

fn tokens(text: &str) -> Vec<TokenTree> {
    text.parse::<TokenStream>().expect("tokens of Rust").into_iter().collect()
}

impl Tree {
    pub fn new(files: impl Iterator<Item = (PathBuf, String)>) -> Self {
        let texts: BTreeMap<Module, (PathBuf, String)> =
            files.map(|(path, text)| (module_of(&path), (path, text))).collect();
        let modules: BTreeSet<Module> = texts.keys().cloned().collect();
        let mut read = BTreeMap::new();
        for (module, (path, text)) in texts {
            let mut file = File { path, ..File::default() };
            Reader { file: &mut file, scope: module.clone(), children: &modules }.read(&tokens(&text));
            read.insert(module, file);
        }
        // Removes files that contain only tests.
        read.retain(|module, _| module.last().is_none_or(|last| last != "tests"));
        let mut tree = Self { imports: Vec::new(), files: read };
        tree.imports = tree.all_imports();
        tree
    }

    /// Returns the modules at the root.
    pub fn rooms(&self) -> Vec<String> {
        self.files.keys().filter(|module| module.len() == 1).map(|module| module[0].clone()).collect()
    }

    fn all_imports(&self) -> Vec<Import> {
        let mut imports: BTreeMap<(&Module, Module), usize> = BTreeMap::new();
        for (from, file) in self.files.iter().filter(|(module, _)| !module.is_empty()) {
            for (line, path) in &file.paths {
                let to = self.resolve(path, 0);
                if !to.is_empty() && to != *from {
                    imports.entry((from, to)).or_insert(*line);
                }
            }
            for (name, line) in &file.calls {
                if let Some(to) = self.written_elsewhere(from, name) {
                    imports.entry((from, to.clone())).or_insert(*line);
                }
            }
        }
        let all = imports.into_iter();
        all.map(|((from, to), line)| Import {
            place: (self.files[from].path.clone(), line),
            from: from.clone(),
            to,
        })
        .collect()
    }

    /// Returns the file to which a path leads, through re-exports.
    fn resolve(&self, path: &[String], depth: usize) -> Module {
        let end = (0..=path.len()).rev().find(|end| self.files.contains_key(&path[..*end])).unwrap_or(0);
        let (module, rest) = path.split_at(end);
        let handed_on = rest.first().and_then(|name| self.files.get(module)?.exports.get(name));
        match handed_on {
            // An item imported through the prelude is imported from the prelude.
            Some(_) if module == ["prelude"] => module.to_vec(),
            Some(target) if depth < 10 => self.resolve(&[target, &rest[1..]].concat(), depth + 1),
            _ => module.to_vec(),
        }
    }

    /// Finds another file of the same folder that is the only one in the crate with a method of this name, of a type
    /// from another file.
    fn written_elsewhere(&self, caller: &Module, name: &str) -> Option<&Module> {
        let has = |file: &File| file.methods.iter().any(|(_, method)| method == name);
        let mut having = self.files.iter().filter(|(_, file)| has(file));
        let ((module, file), second) = (having.next()?, having.next());
        let is_foreign =
            file.methods.iter().any(|(owner, method)| method == name && !file.types.contains(owner));
        let is_near = module.starts_with(&caller[..caller.len() - 1]);
        (second.is_none() && is_foreign && is_near && module != caller).then_some(module)
    }
}

/// Reads the tokens of a module.
struct Reader<'r> {
    file: &'r mut File,
    scope: Module,
    /// All modules that are files.
    children: &'r BTreeSet<Module>,
}

impl Reader<'_> {
    fn read(&mut self, tokens: &[TokenTree]) {
        let word = |at: usize| match tokens.get(at) {
            Some(TokenTree::Ident(ident)) => Some(ident.to_string()),
            _ => None,
        };
        let is = |at: usize, mark: char| matches!(tokens.get(at), Some(TokenTree::Punct(punct)) if punct.as_char() == mark);
        let is_path = |at: usize| is(at, ':') && is(at + 1, ':');
        let group = |at: usize, wanted: Delimiter| match tokens.get(at) {
            Some(TokenTree::Group(group)) if group.delimiter() == wanted => {
                Some(group.stream().into_iter().collect())
            }
            _ => None::<Vec<_>>,
        };
        let mut at = 0;
        while at < tokens.len() {
            let line = tokens[at].span().start().line;
            let after_path = at >= 2 && is_path(at - 2);
            match word(at).as_deref() {
                None if is(at, '#')
                    && group(at + 1, Delimiter::Bracket).is_some_and(|inner| is_test(&inner)) =>
                {
                    at = end_of_item(tokens, at + 2);
                    continue;
                }
                None => {
                    if is(at, '.')
                        && let (Some(name), Some(_)) = (word(at + 1), group(at + 2, Delimiter::Parenthesis))
                    {
                        self.file.calls.entry(name).or_insert(line);
                    }
                    if let TokenTree::Group(group) = &tokens[at] {
                        let inner: Vec<_> = group.stream().into_iter().collect();
                        self.read(&inner);
                    }
                }
                Some("use") if !is(at + 1, '<') => {
                    let end = (at..tokens.len()).find(|end| is(*end, ';')).unwrap_or(tokens.len());
                    let before = at.checked_sub(1).and_then(|before| tokens.get(before));
                    let is_export = match before {
                        Some(TokenTree::Ident(ident)) => ident == "pub",
                        Some(TokenTree::Group(group)) => group.delimiter() == Delimiter::Parenthesis,
                        _ => false,
                    };
                    self.read_use(&[], &tokens[at + 1..end], is_export);
                    at = end;
                }
                Some("mod") => {
                    let name = word(at + 1).unwrap_or_default();
                    if let Some(inner) = group(at + 2, Delimiter::Brace) {
                        self.scope.push(name);
                        self.read(&inner);
                        self.scope.pop();
                        at += 2;
                    }
                }
                Some("struct" | "enum" | "union" | "trait") => self.file.types.extend(word(at + 1)),
                Some("impl") => self.read_impl(&tokens[at + 1..]),
                Some(first) if is_path(at + 1) && !after_path => {
                    let mut path = vec![first.to_owned()];
                    while is_path(at + 1)
                        && let Some(next) = word(at + 3)
                    {
                        path.push(next);
                        at += 3;
                    }
                    self.take(line, &path);
                }
                Some(_) => {}
            }
            at += 1;
        }
    }

    /// Reads the tree after `use`.
    fn read_use(&mut self, before: &[String], tokens: &[TokenTree], is_export: bool) {
        let is_comma = |token: &TokenTree| matches!(token, TokenTree::Punct(punct) if punct.as_char() == ',');
        for part in tokens.split(is_comma) {
            let (mut path, mut inner) = (before.to_vec(), None);
            for token in part {
                match token {
                    TokenTree::Ident(ident) => path.push(ident.to_string()),
                    TokenTree::Group(group) => inner = Some(group.stream().into_iter().collect::<Vec<_>>()),
                    _ => {}
                }
            }
            let Some(token) = part.first() else { continue };
            if let Some(inner) = inner {
                self.read_use(&path, &inner, is_export);
                continue;
            }
            let name = path.last().cloned().unwrap_or_default();
            if let Some(renamed) = path.iter().position(|word| word == "as") {
                path.truncate(renamed);
            }
            if path.len() > 1 && path.last().is_some_and(|last| last == "self") {
                path.pop();
            }
            self.take(token.span().start().line, &path);
            if let (true, Some(target)) = (is_export, self.rooted(&path)) {
                self.file.exports.insert(name, target);
            }
        }
    }

    /// Reads the methods of a type, except those of traits.
    fn read_impl(&mut self, tokens: &[TokenTree]) {
        let body = tokens.iter().position(
            |token| matches!(token, TokenTree::Group(group) if group.delimiter() == Delimiter::Brace),
        );
        let Some(body) = body else { return };
        let (mut depth, mut owner) = (0, None);
        for (index, token) in tokens[..body].iter().enumerate() {
            match token {
                TokenTree::Ident(ident) if ident == "for" => return,
                TokenTree::Ident(ident) if depth == 0 && owner.is_none() => owner = Some(ident.to_string()),
                TokenTree::Punct(punct) if punct.as_char() == '<' => depth += 1,
                // The `>` of an arrow closes nothing.
                TokenTree::Punct(punct) if punct.as_char() == '>' => {
                    let arrow = index > 0
                        && matches!(&tokens[index - 1], TokenTree::Punct(dash) if dash.as_char() == '-');
                    depth -= i32::from(!arrow);
                }
                _ => {}
            }
        }
        let (Some(owner), TokenTree::Group(body)) = (owner, &tokens[body]) else { return };
        let body: Vec<_> = body.stream().into_iter().collect();
        for pair in body.windows(2) {
            if let [TokenTree::Ident(key), TokenTree::Ident(name)] = pair
                && key == "fn"
            {
                self.file.methods.insert((owner.clone(), name.to_string()));
            }
        }
    }

    /// Returns a path in this crate, from its root.
    fn rooted(&self, path: &[String]) -> Option<Module> {
        let up = path.iter().take_while(|word| *word == "super").count();
        match path.first()?.as_str() {
            "crate" => Some(path[1..].to_vec()),
            "self" => Some([&self.scope, &path[1..]].concat()),
            "super" => Some([&self.scope[..self.scope.len().checked_sub(up)?], &path[up..]].concat()),
            child => {
                let child = [&self.scope[..], &[child.to_owned()]].concat();
                self.children.contains(&child).then(|| [&self.scope, path].concat())
            }
        }
    }

    fn take(&mut self, line: usize, path: &[String]) {
        if let Some(path) = self.rooted(path).filter(|path| !path.is_empty()) {
            self.file.paths.push((line, path));
        }
    }
}

/// Tells whether an attribute restricts what follows to tests.
fn is_test(attribute: &[TokenTree]) -> bool {
    let [TokenTree::Ident(name), TokenTree::Group(group)] = attribute else { return false };
    let first = group.stream().into_iter().next();
    name == "cfg" && matches!(first, Some(TokenTree::Ident(ident)) if ident == "test")
}

/// Returns the index after an item: after its body, or its semicolon.
fn end_of_item(tokens: &[TokenTree], from: usize) -> usize {
    let is_end = |token: &TokenTree| match token {
        TokenTree::Group(group) => group.delimiter() == Delimiter::Brace,
        TokenTree::Punct(punct) => punct.as_char() == ';',
        _ => false,
    };
    tokens[from..].iter().position(is_end).map_or(tokens.len(), |end| from + end + 1)
}
