//! The Language Server Protocol, as far as it is used here: the requests of an editor, and the answers to it.

use crate::{self as editor, Fold, Hint, Position, SemanticToken, Symbol, Text, TokenKind};
use lsp_server::{ErrorCode, RequestId};
use serde::{Deserialize, Serialize};
use serde_json::{Value, json};
use std::ops::Range;
use std::path::{Path, PathBuf};
use tabray_core::scene::kind::Kind;

/// The parameters of a request of any kind; those that a request does not have get a default.
#[derive(Default, Deserialize)]
#[serde(rename_all = "camelCase", default)]
pub struct RequestParams {
    pub text_document: TextDocument,
    pub position: Position,
    pub range: Span,
    pub new_name: String,
    pub color: Colour,
    pub context: ReferenceContext,
    pub content_changes: Vec<ContentChange>,
}

#[derive(Default, Deserialize)]
#[serde(rename_all = "camelCase", default)]
pub struct TextDocument {
    pub uri: String,
    pub version: i64,
    pub text: String,
}

#[derive(Clone, Copy, Default, Deserialize, Serialize)]
#[serde(default)]
pub struct Span {
    pub start: Position,
    pub end: Position,
}

#[derive(Clone, Copy, Default, Deserialize)]
#[serde(default)]
pub struct Colour {
    pub red: f64,
    pub green: f64,
    pub blue: f64,
}

#[derive(Default, Deserialize)]
#[serde(rename_all = "camelCase", default)]
pub struct ReferenceContext {
    pub include_declaration: bool,
}

#[derive(Default, Deserialize)]
#[serde(default)]
pub struct ContentChange {
    pub range: Option<Span>,
    pub text: String,
}

/// Returns the capabilities of the server.
pub fn capabilities() -> Value {
    json!({
        "textDocumentSync": { "openClose": true, "change": 2, "save": true },
        "completionProvider": { "triggerCharacters": [" ", "\"", "[", ".", "/"] },
        "hoverProvider": true,
        "signatureHelpProvider": { "triggerCharacters": [" ", "=", "[", ","] },
        "definitionProvider": true,
        "referencesProvider": true,
        "documentHighlightProvider": true,
        "documentSymbolProvider": true,
        "codeActionProvider": { "codeActionKinds": ["quickfix", "refactor.rewrite"] },
        "colorProvider": true,
        "documentFormattingProvider": true,
        "foldingRangeProvider": true,
        "renameProvider": { "prepareProvider": true },
        "inlayHintProvider": true,
        "semanticTokensProvider": {
            "legend": {
                "tokenTypes": TokenKind::ALL.map(TokenKind::name),
                "tokenModifiers": ["definition"],
            },
            "full": true,
        },
    })
}

/// An entry of the outline.
#[derive(Serialize)]
#[serde(rename_all = "camelCase")]
pub struct DocumentSymbol<'s> {
    name: &'s str,
    detail: &'s str,
    kind: u8,
    range: Span,
    selection_range: Span,
    children: Vec<DocumentSymbol<'s>>,
}

impl<'s> DocumentSymbol<'s> {
    pub fn of(text: &Text, symbol: &'s Symbol) -> Self {
        let kind = match symbol.kind {
            Some(Kind::Camera) => 8,
            Some(Kind::Material) => 7,
            Some(Kind::Texture) => 1,
            Some(Kind::Light) => 24,
            Some(_) => 19,
            None if symbol.detail == "repeat" => 18,
            None if symbol.detail == "include" => 2,
            None => 14,
        };
        Self {
            name: &symbol.name,
            detail: &symbol.detail,
            kind,
            range: Span::of(text, &symbol.place),
            selection_range: Span::of(text, &symbol.name_place),
            children: symbol.inner.iter().map(|inner| Self::of(text, inner)).collect(),
        }
    }
}

/// Lines that can be folded.
#[derive(Serialize)]
#[serde(rename_all = "camelCase")]
pub struct FoldingRange {
    start_line: usize,
    end_line: usize,
    #[serde(skip_serializing_if = "Option::is_none")]
    kind: Option<&'static str>,
}

impl FoldingRange {
    pub fn of(fold: &Fold) -> Self {
        let [start_line, end_line] = fold.lines;
        Self { start_line, end_line, kind: fold.is_comment.then_some("comment") }
    }
}

/// A colour in a text.
#[derive(Serialize)]
pub struct ColorInformation {
    range: Span,
    color: Rgba,
}

#[derive(Serialize)]
struct Rgba {
    red: f64,
    green: f64,
    blue: f64,
    alpha: f64,
}

impl ColorInformation {
    pub fn of(text: &Text, swatch: &editor::Swatch) -> Self {
        let [red, green, blue] = swatch.colour;
        Self { range: Span::of(text, &swatch.place), color: Rgba { red, green, blue, alpha: 1.0 } }
    }
}

/// The name of a value, shown before it.
#[derive(Serialize)]
#[serde(rename_all = "camelCase")]
pub struct InlayHint {
    position: Position,
    label: String,
    kind: u8,
    padding_right: bool,
}

impl InlayHint {
    pub fn of(text: &Text, hint: &Hint) -> Self {
        let label = format!("{}:", hint.name);
        Self { position: text.position(hint.at), label, kind: 2, padding_right: true }
    }
}

/// What words of a text are: of each, five numbers.
#[derive(Default, Serialize)]
pub struct SemanticTokens {
    data: Vec<u32>,
}

impl SemanticTokens {
    /// Writes each word beside the one before: lines between, units between on one line, its length, its kind, and 1 in a
    /// definition. A word on several lines is written as one on each.
    pub fn of(text: &Text, tokens: &[SemanticToken]) -> Self {
        let (mut all, mut before) = (Self::default(), Position::default());
        for token in tokens {
            let mut start = token.place.start;
            for line in text.as_str()[token.place.clone()].split_inclusive('\n') {
                let here = text.position(start);
                let length = line.trim_end_matches(['\n', '\r']).chars().map(char::len_utf16).sum::<usize>();
                start += line.len();
                if length == 0 {
                    continue;
                }
                let is_same_line = here.line == before.line;
                let units = here.character - if is_same_line { before.character } else { 0 };
                let kind = TokenKind::ALL.iter().position(|kind| *kind == token.kind).unwrap_or(0);
                let (length, kind) = (length as u32, kind as u32);
                let definition = u32::from(token.is_definition);
                all.data.extend([here.line - before.line, units, length, kind, definition]);
                before = here;
            }
        }
        all
    }
}

/// Writes a value in JSON.
pub fn text_of(value: &impl Serialize) -> String {
    serde_json::to_string(value).unwrap_or_else(|_| "null".to_owned())
}

/// Writes an answer, whose result is in JSON.
pub fn response(id: &RequestId, result: &str) -> String {
    format!(r#"{{"jsonrpc":"2.0","id":{},"result":{result}}}"#, text_of(id))
}

/// Writes why there is no answer.
pub fn error_response(id: &RequestId, code: ErrorCode, message: &str) -> String {
    json!({ "jsonrpc": "2.0", "id": id, "error": { "code": code as i32, "message": message } }).to_string()
}

/// Writes that what came was no message.
pub fn malformed(why: &str) -> String {
    let error = json!({ "code": ErrorCode::ParseError as i32, "message": why });
    json!({ "jsonrpc": "2.0", "id": null, "error": error }).to_string()
}

/// Writes what an editor is told without having asked.
pub fn notification(method: &str, parameters: &Value) -> String {
    json!({ "jsonrpc": "2.0", "method": method, "params": parameters }).to_string()
}

impl Span {
    /// Returns the positions of a range of a text.
    fn of(text: &Text, place: &Range<usize>) -> Self {
        let [start, end] = [place.start, place.end].map(|at| text.position(at));
        Self { start, end }
    }
}

/// Writes a range of a text.
pub fn range(text: &Text, place: &Range<usize>) -> Value {
    let Span { start, end } = Span::of(text, place);
    span([start, end])
}

/// Writes the range between two positions.
pub fn span([start, end]: [Position; 2]) -> Value {
    json!({ "start": start, "end": end })
}

/// Writes Markdown.
pub fn markdown(text: &str) -> Value {
    json!({ "kind": "markdown", "value": text })
}

/// Returns the path of a file's address. Another address, as of a text without a file, is taken as it is.
pub fn path(uri: &str) -> PathBuf {
    let Some(path) = uri.strip_prefix("file://") else { return PathBuf::from(uri) };
    let mut bytes = Vec::new();
    let mut rest = path.as_bytes();
    while let Some((first, after)) = rest.split_first() {
        let digits = after.get(..2).and_then(|digits| std::str::from_utf8(digits).ok());
        let code = digits.filter(|_| *first == b'%').and_then(|digits| u8::from_str_radix(digits, 16).ok());
        bytes.push(code.unwrap_or(*first));
        rest = if code.is_some() { &after[2..] } else { after };
    }
    let path = String::from_utf8_lossy(&bytes).into_owned();
    // On Windows, `/c:/folder` is `c:/folder`.
    let is_drive = path.as_bytes().get(2) == Some(&b':') && cfg!(windows);
    PathBuf::from(if is_drive { path[1..].to_owned() } else { path })
}

/// Returns the address of a file.
pub fn uri(path: &Path) -> String {
    let path = path.to_string_lossy();
    if path.contains("://") || path.starts_with("untitled:") {
        return path.into_owned();
    }
    let mut uri = String::from("file://");
    let path = path.replace('\\', if cfg!(windows) { "/" } else { "\\" });
    uri += if path.starts_with('/') { "" } else { "/" };
    for byte in path.bytes() {
        if byte.is_ascii_alphanumeric() || b"/-._~".contains(&byte) {
            uri.push(byte.into());
        } else {
            uri += &format!("%{byte:02X}");
        }
    }
    uri
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_address_is_that_of_its_path() {
        for file in ["/a b/ä%20#.ray", "/x/y-z_1.toml"] {
            assert_eq!(path(&uri(Path::new(file))), Path::new(file));
        }
        assert_eq!(uri(Path::new("/a b.ray")), "file:///a%20b.ray");
        assert_eq!(uri(&path("untitled:Untitled-1")), "untitled:Untitled-1");
        assert_eq!(path("file:///a%2"), Path::new("/a%2"));
    }
}
