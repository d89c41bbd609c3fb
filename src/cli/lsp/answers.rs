//! Answers to what an editor asks.

use super::documents::{Document, Documents};
use super::faults::{Faults, diagnostic};
use super::protocol::{Question, markdown, path, range, span};
use crate::editor::{self, Files, Found, Group, Position, Symbol, View, What};
use crate::scene::kind::Kind;
use crate::scene::syntax::Syntax;
use serde_json::{Value, json};
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// What the server knows.
pub struct Server<'r> {
    documents: Documents<'r>,
    faults: &'r Faults,
    /// Whether the editor fills in places of what it completes.
    has_snippets: bool,
}

/// A question about a text: where it is, and what it says.
struct Asked {
    path: PathBuf,
    view: Arc<View>,
    /// The position, in bytes.
    at: usize,
    question: Question,
}

impl<'r> Server<'r> {
    /// Begins with what an editor says of itself.
    pub fn new(documents: Documents<'r>, faults: &'r Faults, parameters: &Value) -> Self {
        let item = &parameters["capabilities"]["textDocument"]["completion"]["completionItem"];
        let has_snippets = item["snippetSupport"].as_bool() == Some(true);
        Self { documents, faults, has_snippets }
    }

    /// Takes note of what happens in the editor.
    pub fn note(&mut self, method: &str, parameters: Value) {
        let Ok(question) = serde_json::from_value::<Question>(parameters) else { return };
        let Question { text_document: document, content_changes, .. } = question;
        let path = path(&document.uri);
        match method {
            "textDocument/didOpen" => {
                self.documents.open(document.uri, document.version, document.text);
                self.read(&path, false);
            }
            "textDocument/didChange" => {
                self.documents.change(&path, document.version, &content_changes);
                self.read(&path, false);
            }
            "textDocument/didSave" => self.read(&path, true),
            "textDocument/didClose" => {
                self.documents.close(&path);
                self.faults.read(&path, &document.uri, 0, None);
            }
            "workspace/didChangeWatchedFiles" => {
                self.documents.paths().iter().for_each(|path| self.read(path, true));
            }
            _ => {}
        }
    }

    /// Has a scene read. One that an open scene includes is read with that one, as it is stored.
    fn read(&self, path: &Path, is_stored: bool) {
        let scenes = self.documents.paths();
        let includes = |scene: &&PathBuf| {
            *scene != path && editor::group(&self.documents, scene, &[]).iter().any(|(file, _)| file == path)
        };
        let outer: Vec<_> = scenes.iter().filter(includes).collect();
        for scene in outer.iter().copied().filter(|_| is_stored).map(PathBuf::as_path).chain(
            // A file in TOML may be about something else.
            Some(path).filter(|_| outer.is_empty()),
        ) {
            let Some(Document { uri, version, text, .. }) = self.documents.get(scene) else { continue };
            let is_scene = self.documents.view(scene).is_some_and(|view| view.is_scene());
            self.faults.read(scene, uri, *version, is_scene.then(|| text.shared()));
        }
    }

    /// Answers a question; `None` where it is not known.
    ///
    /// # Errors
    /// Why there is no answer.
    pub fn answer(&mut self, method: &str, parameters: Value) -> Result<Option<Value>, String> {
        let answer = match method {
            "textDocument/completion" => Self::completion,
            "textDocument/hover" => Self::hover,
            "textDocument/signatureHelp" => Self::signature,
            "textDocument/definition" => Self::definition,
            "textDocument/references" => Self::references,
            "textDocument/documentHighlight" => Self::highlights,
            "textDocument/prepareRename" => Self::prepare_rename,
            "textDocument/rename" => Self::rename,
            "textDocument/documentSymbol" => Self::symbols,
            "textDocument/foldingRange" => Self::folds,
            "textDocument/formatting" => Self::format,
            "textDocument/documentColor" => Self::colours,
            "textDocument/colorPresentation" => Self::presentations,
            "textDocument/inlayHint" => Self::hints,
            "textDocument/codeAction" => Self::actions,
            _ => return Ok(None),
        };
        let question: Question = serde_json::from_value(parameters).map_err(|error| error.to_string())?;
        let path = path(&question.text_document.uri);
        let Some(view) = self.documents.view(&path) else { return Ok(Some(Value::Null)) };
        if !view.is_scene() && method != "textDocument/completion" {
            return Ok(Some(Value::Null));
        }
        let at = view.text.offset(question.position);
        answer(self, &Asked { path, view, at, question }).map(Some)
    }

    fn group(&self, asked: &Asked) -> Group {
        editor::group(&self.documents, &asked.path, &self.documents.paths())
    }

    fn completion(&self, asked: &Asked) -> Result<Value, String> {
        let proposals = editor::completions(self.documents.registry(), &self.group(asked), asked.at);
        let item = |(index, proposal): (usize, editor::Completion)| {
            let kind = match proposal.what {
                What::Type => 7,
                What::Attribute => 10,
                What::Choice => 20,
                What::Name => 18,
                What::File => 17,
                What::Folder => 19,
                What::Number => 21,
                What::Function => 3,
                What::Keyword => 14,
            };
            let text = match proposal.has_places && !self.has_snippets {
                true => &proposal.label,
                false => &proposal.snippet,
            };
            let mut item = json!({
                "label": proposal.label,
                "kind": kind,
                "sortText": format!("{index:05}"),
                "insertTextFormat": if proposal.has_places && self.has_snippets { 2 } else { 1 },
                "textEdit": { "range": range(&asked.view.text, &proposal.place), "newText": text },
            });
            if !proposal.detail.is_empty() {
                item["detail"] = proposal.detail.into();
            }
            if !proposal.about.is_empty() {
                item["documentation"] = markdown(&proposal.about);
            }
            item
        };
        Ok(proposals.into_iter().enumerate().map(item).collect::<Vec<_>>().into())
    }

    fn hover(&self, asked: &Asked) -> Result<Value, String> {
        let hover = editor::hover(&self.group(asked), asked.at);
        Ok(hover.map_or(Value::Null, |hover| {
            json!({ "contents": markdown(&hover.text), "range": range(&asked.view.text, &hover.place) })
        }))
    }

    fn signature(&self, asked: &Asked) -> Result<Value, String> {
        let Some(signature) = editor::signature(&asked.view, asked.at) else { return Ok(Value::Null) };
        let values: Vec<_> =
            signature.values.iter().map(|value| json!({ "label": [value.start, value.end] })).collect();
        Ok(json!({
            "signatures": [{
                "label": signature.label,
                "documentation": markdown(&signature.about),
                "parameters": values,
            }],
            "activeSignature": 0,
            "activeParameter": signature.active,
        }))
    }

    fn located(&self, group: &Group, found: &Found) -> Value {
        let view = group.iter().find(|(path, _)| *path == found.path).map(|(_, view)| view);
        let range = view.map_or(Value::Null, |view| range(&view.text, &found.place));
        json!({ "uri": self.documents.uri(&found.path), "range": range })
    }

    fn definition(&self, asked: &Asked) -> Result<Value, String> {
        let group = self.group(asked);
        Ok(editor::definitions(&group, asked.at).iter().map(|found| self.located(&group, found)).collect())
    }

    fn references(&self, asked: &Asked) -> Result<Value, String> {
        let group = self.group(asked);
        let with_definition = asked.question.context.include_declaration;
        let found = editor::usages(&group, asked.at, with_definition);
        Ok(found.iter().map(|found| self.located(&group, found)).collect())
    }

    fn highlights(&self, asked: &Asked) -> Result<Value, String> {
        let found = editor::usages(&self.group(asked), asked.at, true);
        let here = found.iter().filter(|found| found.path == asked.path);
        Ok(here.map(|found| json!({ "range": range(&asked.view.text, &found.place) })).collect())
    }

    fn prepare_rename(&self, asked: &Asked) -> Result<Value, String> {
        let meant = editor::meant(&asked.view, asked.at).ok_or("there is no name that the scene gives")?;
        if editor::definitions(&self.group(asked), asked.at).is_empty() {
            return Err(format!("the {} `{}` is not defined", meant.what, meant.text));
        }
        Ok(json!({ "range": range(&asked.view.text, &meant.place), "placeholder": meant.text }))
    }

    fn rename(&self, asked: &Asked) -> Result<Value, String> {
        let group = self.group(asked);
        let mut changes: BTreeMap<String, Vec<Value>> = BTreeMap::new();
        for (found, text) in editor::renamed(&group, asked.at, &asked.question.new_name)? {
            let mut edit = self.located(&group, &found);
            let uri = edit["uri"].as_str().unwrap_or_default().to_owned();
            changes.entry(uri).or_default().push(json!({ "range": edit["range"].take(), "newText": text }));
        }
        Ok(json!({ "changes": changes }))
    }

    fn symbols(&self, asked: &Asked) -> Result<Value, String> {
        fn symbol(view: &View, entry: &Symbol) -> Value {
            let kind = match entry.kind {
                Some(Kind::Camera) => 8,
                Some(Kind::Material) => 7,
                Some(Kind::Texture) => 1,
                Some(Kind::Light) => 24,
                Some(_) => 19,
                None if entry.detail == "repeat" => 18,
                None if entry.detail == "include" => 2,
                None => 14,
            };
            json!({
                "name": entry.name,
                "detail": entry.detail,
                "kind": kind,
                "range": range(&view.text, &entry.place),
                "selectionRange": range(&view.text, &entry.name_place),
                "children": entry.inner.iter().map(|entry| symbol(view, entry)).collect::<Vec<_>>(),
            })
        }
        Ok(editor::outline(&asked.view).iter().map(|entry| symbol(&asked.view, entry)).collect())
    }

    fn folds(&self, asked: &Asked) -> Result<Value, String> {
        let fold = |fold: &editor::Fold| {
            let [start, end] = fold.lines;
            let mut told = json!({ "startLine": start, "endLine": end });
            if fold.is_comment {
                told["kind"] = "comment".into();
            }
            told
        };
        Ok(editor::folds(&asked.view).iter().map(fold).collect())
    }

    fn format(&self, asked: &Asked) -> Result<Value, String> {
        let Some(new) = editor::formatted(&asked.view) else {
            let what = editor::problem(&asked.view).map_or("", |(_, message)| message.as_str());
            return Err(format!("a scene whose form has errors is not formatted: {what}"));
        };
        // What is the same at the beginning and at the end stays, and the cursor with it.
        let old = asked.view.text.as_str();
        let same = |one: &mut dyn Iterator<Item = &str>, other: &mut dyn Iterator<Item = &str>| -> usize {
            one.zip(other).take_while(|(one, other)| one == other).map(|(one, _)| one.len()).sum()
        };
        let start = same(&mut old.split_inclusive('\n'), &mut new.split_inclusive('\n'));
        let (rest, new_rest) = (&old[start..], &new[start..]);
        let end = same(&mut rest.split_inclusive('\n').rev(), &mut new_rest.split_inclusive('\n').rev());
        if rest == new_rest {
            return Ok(json!([]));
        }
        let place = start..old.len() - end;
        Ok(json!([{ "range": range(&asked.view.text, &place), "newText": new_rest[..new_rest.len() - end] }]))
    }

    fn colours(&self, asked: &Asked) -> Result<Value, String> {
        let colour = |swatch: editor::Swatch| {
            let [red, green, blue] = swatch.colour;
            json!({
                "range": range(&asked.view.text, &swatch.place),
                "color": { "red": red, "green": green, "blue": blue, "alpha": 1.0 },
            })
        };
        Ok(editor::colours(&asked.view).into_iter().map(colour).collect())
    }

    fn presentations(&self, asked: &Asked) -> Result<Value, String> {
        let place = self.asked_range(asked);
        let colour = asked.question.color;
        let text = editor::presented(&asked.view, &place, [colour.red, colour.green, colour.blue]);
        let edit =
            json!({ "range": span([asked.question.range.start, asked.question.range.end]), "newText": text });
        Ok(json!([{ "label": text, "textEdit": edit }]))
    }

    fn asked_range(&self, asked: &Asked) -> std::ops::Range<usize> {
        let offset = |position: Position| asked.view.text.offset(position);
        let start = offset(asked.question.range.start);
        start..offset(asked.question.range.end).max(start)
    }

    fn hints(&self, asked: &Asked) -> Result<Value, String> {
        let hint = |hint: &editor::Hint| {
            json!({
                "position": asked.view.text.position(hint.at),
                "label": format!("{}:", hint.name),
                "kind": 2,
                "paddingRight": true,
            })
        };
        Ok(editor::hints(&asked.view, &self.asked_range(asked)).iter().map(hint).collect())
    }

    /// Returns what would put right the faults in a range.
    fn actions(&self, asked: &Asked) -> Result<Value, String> {
        let wanted = self.asked_range(asked);
        let mut actions = Vec::new();
        for fault in self.faults.in_file(&asked.path) {
            let place = asked.view.text.offset(fault.range[0])..asked.view.text.offset(fault.range[1]);
            // The text may have changed since it was read.
            let is_there = asked.view.slice(place.clone()) == fault.marked;
            let Some(meant) = fault.meant.as_ref().filter(|_| is_there) else { continue };
            if place.end < wanted.start || place.start > wanted.end {
                continue;
            }
            let text = match fault.marked.chars().next().filter(|first| "\"'".contains(*first)) {
                Some(quote) => format!("{quote}{meant}{quote}"),
                None => Syntax::key(asked.view.syntax, meant),
            };
            let edit = json!({ "range": range(&asked.view.text, &place), "newText": text });
            let uri = self.documents.uri(&asked.path);
            actions.push(json!({
                "title": format!("change to `{meant}`"),
                "kind": "quickfix",
                "isPreferred": true,
                "diagnostics": [diagnostic(&fault)],
                "edit": { "changes": { uri: [edit] } },
            }));
        }
        Ok(actions.into())
    }
}
