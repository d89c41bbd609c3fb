//! Answers to what an editor asks.

use super::documents::{Document, Documents, LARGEST};
use super::faults::{Faults, diagnostic};
use super::protocol::{
    ColorInformation, DocumentSymbol, FoldingRange, InlayHint, RequestParams, SemanticTokens, Span, markdown,
    path, range, span, text_of,
};
use crate::{self as editor, CompletionKind, Files, Group, Location, Position, View};
use serde_json::{Value, json};
use std::collections::BTreeMap;
use std::ops::Range;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use tabray_core::text::{self, short};
use tabray_lang::syntax::Syntax;

/// The state of the server.
pub struct Server<'r> {
    documents: Documents<'r>,
    faults: &'r Faults,
    /// Whether the editor fills in places of what it completes.
    has_snippets: bool,
    /// Whether the editor shows why an action is not possible.
    has_disabled: bool,
}

/// A request about a text: its parameters, and the text.
struct TextRequest {
    path: PathBuf,
    view: Arc<View>,
    /// The position, in bytes.
    at: usize,
    params: RequestParams,
}

impl TextRequest {
    /// Returns the range that the request is about, in bytes.
    fn range(&self) -> Range<usize> {
        let Span { start, end } = self.params.range;
        let [start, end] = [start, end].map(|position: Position| self.view.text.offset(position));
        start..end.max(start)
    }
}

impl<'r> Server<'r> {
    /// Begins with what an editor says of itself.
    pub fn new(documents: Documents<'r>, faults: &'r Faults, parameters: &Value) -> Self {
        let item = &parameters["capabilities"]["textDocument"]["completion"]["completionItem"];
        let has_snippets = item["snippetSupport"].as_bool() == Some(true);
        let action = &parameters["capabilities"]["textDocument"]["codeAction"];
        let has_disabled = action["disabledSupport"].as_bool() == Some(true);
        Self { documents, faults, has_snippets, has_disabled }
    }

    /// Takes note of what happens in the editor; returns what it is to be told.
    pub fn note(&mut self, method: &str, parameters: Value) -> Option<String> {
        let params = serde_json::from_value::<RequestParams>(parameters).ok()?;
        let RequestParams { text_document: document, content_changes, .. } = params;
        let path = path(&document.uri);
        match method {
            "textDocument/didOpen" => {
                self.documents.open(document.uri, document.version, document.text);
                self.read(&path);
            }
            "textDocument/didChange" => {
                // A text that was too large before was told then.
                self.documents.get(&path)?;
                self.documents.change(&path, document.version, &content_changes);
                self.read(&path);
            }
            "textDocument/didSave" => self.read(&path),
            "textDocument/didClose" => {
                self.documents.close(&path);
                self.faults.read(&path, &document.uri, 0, None);
                self.read(&path);
            }
            "workspace/didChangeWatchedFiles" => {
                self.documents.paths().iter().for_each(|path| self.read(path));
            }
            _ => {}
        }
        let is_gone = ["textDocument/didOpen", "textDocument/didChange"].contains(&method)
            && self.documents.get(&path).is_none();
        is_gone.then(|| {
            format!("`{}` is larger than {} MiB, and is not read", text::shown(&path), LARGEST >> 20)
        })
    }

    /// Has a scene read. Of a file that open scenes include, these are read.
    fn read(&self, path: &Path) {
        let scenes = self.documents.paths();
        let includes = |scene: &&PathBuf| {
            *scene != path && editor::group(&self.documents, scene, &[]).iter().any(|(file, _)| file == path)
        };
        let outer: Vec<_> = scenes.iter().filter(includes).map(PathBuf::as_path).collect();
        let read = if outer.is_empty() { vec![path] } else { outer };
        for path in read {
            if let Some(Document { uri, version, .. }) = self.documents.get(path) {
                self.faults.read(path, uri, *version, self.documents.scene(path));
            }
        }
    }

    /// Answers a request in JSON; `None` where its method is not known.
    ///
    /// # Errors
    /// Why there is no answer.
    pub fn answer(&mut self, method: &str, parameters: Value) -> Result<Option<String>, String> {
        // A large scene has thousands of these, so they are written without a tree of values in between.
        let large: Option<fn(&TextRequest) -> String> = match method {
            "textDocument/documentSymbol" => Some(Self::symbols),
            "textDocument/foldingRange" => Some(Self::folds),
            "textDocument/documentColor" => Some(Self::colours),
            "textDocument/inlayHint" => Some(Self::hints),
            "textDocument/semanticTokens/full" => Some(Self::tokens),
            _ => None,
        };
        if let Some(answer) = large {
            return Ok(Some(
                self.request(parameters)?
                    .filter(|request| request.view.is_scene())
                    .map_or_else(|| text_of(&Value::Null), |request| answer(&request)),
            ));
        }
        let answer = match method {
            "textDocument/completion" => Self::completion,
            "textDocument/hover" => Self::hover,
            "textDocument/signatureHelp" => Self::signature,
            "textDocument/definition" => Self::definition,
            "textDocument/references" => Self::references,
            "textDocument/documentHighlight" => Self::highlights,
            "textDocument/prepareRename" => Self::prepare_rename,
            "textDocument/rename" => Self::rename,
            "textDocument/formatting" => Self::format,
            "textDocument/colorPresentation" => Self::presentations,
            "textDocument/codeAction" => Self::actions,
            _ => return Ok(None),
        };
        let request = self.request(parameters)?;
        let request =
            request.filter(|request| request.view.is_scene() || method == "textDocument/completion");
        request.map_or(Ok(Value::Null), |request| answer(self, &request)).map(|answer| Some(text_of(&answer)))
    }

    /// Reads a request; `None` where its text is not known.
    fn request(&self, parameters: Value) -> Result<Option<TextRequest>, String> {
        let params: RequestParams = serde_json::from_value(parameters).map_err(|error| error.to_string())?;
        let path = path(&params.text_document.uri);
        let Some(view) = self.documents.view(&path) else { return Ok(None) };
        let at = view.text.offset(params.position);
        Ok(Some(TextRequest { path, view, at, params }))
    }

    fn group(&self, request: &TextRequest) -> Group {
        editor::group(&self.documents, &request.path, &self.documents.paths())
    }

    fn completion(&self, request: &TextRequest) -> Result<Value, String> {
        let proposals = editor::completions(self.documents.registry(), &self.group(request), request.at);
        let item = |(index, proposal): (usize, editor::Completion)| {
            let kind = match proposal.kind {
                CompletionKind::Type => 7,
                CompletionKind::Attribute => 10,
                CompletionKind::Choice => 20,
                CompletionKind::Name => 18,
                CompletionKind::File => 17,
                CompletionKind::Folder => 19,
                CompletionKind::Number => 21,
                CompletionKind::Function => 3,
                CompletionKind::Keyword => 14,
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
                "textEdit": { "range": range(&request.view.text, &proposal.place), "newText": text },
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

    fn hover(&self, request: &TextRequest) -> Result<Value, String> {
        let hover = editor::hover(&self.group(request), request.at);
        Ok(hover.map_or(Value::Null, |hover| {
            json!({ "contents": markdown(&hover.text), "range": range(&request.view.text, &hover.place) })
        }))
    }

    fn signature(&self, request: &TextRequest) -> Result<Value, String> {
        let Some(signature) = editor::signature(&request.view, request.at) else { return Ok(Value::Null) };
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

    fn located(&self, group: &Group, found: &Location) -> Value {
        let view = group.iter().find(|(path, _)| *path == found.path).map(|(_, view)| view);
        let range = view.map_or(Value::Null, |view| range(&view.text, &found.place));
        json!({ "uri": self.documents.uri(&found.path), "range": range })
    }

    fn definition(&self, request: &TextRequest) -> Result<Value, String> {
        let group = self.group(request);
        Ok(editor::definitions(&group, request.at).iter().map(|found| self.located(&group, found)).collect())
    }

    fn references(&self, request: &TextRequest) -> Result<Value, String> {
        let group = self.group(request);
        let with_definition = request.params.context.include_declaration;
        let found = editor::usages(&group, request.at, with_definition);
        Ok(found.iter().map(|found| self.located(&group, found)).collect())
    }

    fn highlights(&self, request: &TextRequest) -> Result<Value, String> {
        let found = editor::usages(&self.group(request), request.at, true);
        let here = found.iter().filter(|found| found.path == request.path);
        Ok(here.map(|found| json!({ "range": range(&request.view.text, &found.place) })).collect())
    }

    fn prepare_rename(&self, request: &TextRequest) -> Result<Value, String> {
        let meant =
            editor::name_at_cursor(&request.view, request.at).ok_or("there is no name of the scene here")?;
        if editor::definitions(&self.group(request), request.at).is_empty() {
            return Err(format!("the {} `{}` is not defined", meant.kind, meant.text));
        }
        Ok(json!({ "range": range(&request.view.text, &meant.place), "placeholder": meant.text }))
    }

    fn rename(&self, request: &TextRequest) -> Result<Value, String> {
        let group = self.group(request);
        let mut changes: BTreeMap<String, Vec<Value>> = BTreeMap::new();
        for (found, text) in editor::renamed(&group, request.at, &request.params.new_name)? {
            let mut edit = self.located(&group, &found);
            let uri = edit["uri"].as_str().unwrap_or_default().to_owned();
            changes.entry(uri).or_default().push(json!({ "range": edit["range"].take(), "newText": text }));
        }
        Ok(json!({ "changes": changes }))
    }

    fn symbols(request: &TextRequest) -> String {
        let outline = editor::outline(&request.view);
        text_of(
            &outline.iter().map(|entry| DocumentSymbol::of(&request.view.text, entry)).collect::<Vec<_>>(),
        )
    }

    fn folds(request: &TextRequest) -> String {
        text_of(&editor::folds(&request.view).iter().map(FoldingRange::of).collect::<Vec<_>>())
    }

    fn format(&self, request: &TextRequest) -> Result<Value, String> {
        let Some(new) = editor::formatted(&request.view) else {
            let what = editor::problem(&request.view).map_or_else(String::new, |fault| fault.message);
            return Err(format!("a scene with syntax errors cannot be formatted: {what}"));
        };
        // What is the same at the beginning and at the end stays, and the cursor with it.
        let old = request.view.text.as_str();
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
        Ok(
            json!([{ "range": range(&request.view.text, &place), "newText": new_rest[..new_rest.len() - end] }]),
        )
    }

    fn colours(request: &TextRequest) -> String {
        let colours = editor::colours(&request.view);
        text_of(
            &colours
                .iter()
                .map(|swatch| ColorInformation::of(&request.view.text, swatch))
                .collect::<Vec<_>>(),
        )
    }

    fn presentations(&self, request: &TextRequest) -> Result<Value, String> {
        let place = request.range();
        let colour = request.params.color;
        let text = editor::presented(&request.view, &place, [colour.red, colour.green, colour.blue]);
        let edit =
            json!({ "range": span([request.params.range.start, request.params.range.end]), "newText": text });
        Ok(json!([{ "label": text, "textEdit": edit }]))
    }

    fn hints(request: &TextRequest) -> String {
        let hints = editor::hints(&request.view, &request.range());
        text_of(&hints.iter().map(|hint| InlayHint::of(&request.view.text, hint)).collect::<Vec<_>>())
    }

    fn tokens(request: &TextRequest) -> String {
        let (text, tokens) = (&request.view.text, editor::semantic_tokens(&request.view));
        text_of(&SemanticTokens::of(text, &tokens))
    }

    /// Returns the corrections of the errors in a range.
    fn actions(&self, request: &TextRequest) -> Result<Value, String> {
        let wanted = request.range();
        let mut actions = Vec::new();
        for fault in self.faults.in_file(&request.path) {
            let place = request.view.text.offset(fault.range[0])..request.view.text.offset(fault.range[1]);
            // The text may have changed since it was read.
            let is_there = request.view.slice(place.clone()) == fault.marked;
            let Some(meant) = fault.meant.as_ref().filter(|_| is_there) else { continue };
            if place.end < wanted.start || place.start > wanted.end {
                continue;
            }
            let text = match fault.marked.chars().next().filter(|first| "\"'".contains(*first)) {
                Some(quote) => format!("{quote}{meant}{quote}"),
                None => Syntax::key(request.view.syntax, meant),
            };
            let edit = json!({ "range": range(&request.view.text, &place), "newText": text });
            let uri = self.documents.uri(&request.path);
            actions.push(json!({
                "title": format!("change to `{meant}`"),
                "kind": "quickfix",
                "isPreferred": true,
                "diagnostics": [diagnostic(&fault)],
                "edit": { "changes": { uri: [edit] } },
            }));
        }
        actions.extend(self.look_at(request, &wanted));
        Ok(actions.into())
    }

    /// Offers to turn a `camera` into a `look_at`, or says why that is not possible.
    fn look_at(&self, request: &TextRequest, wanted: &Range<usize>) -> Option<Value> {
        let mut action =
            json!({ "title": "turn into a `look_at` with the same view", "kind": "refactor.rewrite" });
        match editor::look_at(&request.view, wanted)? {
            Ok(turned) => {
                let turn = turned.change.turn;
                if turn > 0.0 {
                    let turn = short(turn);
                    action["title"] =
                        format!("turn into a `look_at`: its view turns by {turn} degrees, to the middle of the image plane").into();
                }
                let edit = |(place, with): &(Range<usize>, String)| json!({ "range": range(&request.view.text, place), "newText": with });
                let edits: Vec<_> = turned.edits.iter().map(edit).collect();
                let uri = self.documents.uri(&request.path);
                action["edit"] = json!({ "changes": { uri: edits } });
            }
            Err(reason) => {
                action["disabled"] = json!({ "reason": reason });
            }
        }
        (self.has_disabled || action.get("disabled").is_none()).then_some(action)
    }
}
