// A panel with the page for browsers, which shows a document as it is typed and changes it.

const fs = require("node:fs");
const { workspace, Position, Range, Uri, WorkspaceEdit } = require("vscode");
const { guarded } = require("./page");

const POLICY = "default-src 'none'; script-src 'unsafe-inline' 'wasm-unsafe-eval' blob:; worker-src blob:; connect-src blob: data:; style-src 'unsafe-inline'; img-src data: blob:";

// How long, in milliseconds, a text must have been left alone before it is shown.
const REST = 60;

// The page has line feeds alone.
const textOf = (document) => document.getText().replaceAll("\r\n", "\n");

exports.follow = function (panel, document, page) {
    const uri = document.uri.toString();
    const given = new Map();
    let soon;
    const send = () => panel.webview.postMessage({ text: textOf(document) });
    const give = async (names) => {
        const all = await Promise.all(names.map(async (name) => {
            const file = name.startsWith("/") ? Uri.file(name) : Uri.joinPath(document.uri, "..", name);
            given.set(file.toString(), name);
            return workspace.fs.readFile(file).then((bytes) => ({ name, bytes }), () => null);
        }));
        const files = all.filter(Boolean);
        if (files.length) await panel.webview.postMessage({ files });
    };
    const parts = [
        panel.webview.onDidReceiveMessage((message) => {
            if (message.ready) return send();
            if (message.lacks) return give(message.lacks);
            return write(document, message);
        }),
        workspace.onDidChangeTextDocument((event) => {
            if (event.document.uri.toString() !== uri) return;
            clearTimeout(soon);
            soon = setTimeout(send, REST);
        }),
        workspace.onDidSaveTextDocument((saved) => {
            const name = given.get(saved.uri.toString());
            if (name !== undefined) give([name]);
        }),
    ];
    panel.webview.html = guarded(fs.readFileSync(page, "utf8"), POLICY);
    return {
        dispose() {
            clearTimeout(soon);
            for (const part of parts) part.dispose();
        },
    };
};

// Writes what the page has changed, unless more has been typed meanwhile: then that holds.
function write(document, { text, before }) {
    if (typeof text !== "string" || textOf(document) !== before) return;
    let start = 0;
    while (start < text.length && text[start] === before[start]) start++;
    let end = 0;
    while (end < Math.min(text.length, before.length) - start && text.at(-1 - end) === before.at(-1 - end)) end++;
    const place = (at) => {
        const lines = before.slice(0, at).split("\n");
        return new Position(lines.length - 1, lines.at(-1).length);
    };
    const edit = new WorkspaceEdit();
    edit.replace(document.uri, new Range(place(start), place(before.length - end)), text.slice(start, text.length - end));
    return workspace.applyEdit(edit);
}
