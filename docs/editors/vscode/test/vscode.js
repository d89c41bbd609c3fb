// What the extension uses of Visual Studio Code, without a window. Tests look at what it was asked for.

const Module = require("node:module");
const fs = require("node:fs/promises");
const path = require("node:path");

function emitter() {
    const all = new Set();
    const on = (act) => {
        all.add(act);
        return { dispose: () => all.delete(act) };
    };
    return { on, tell: (event) => Promise.all([...all].map((act) => act(event))), count: () => all.size };
}

class Uri {
    constructor(fsPath, scheme = "file") {
        Object.assign(this, { fsPath, scheme, path: fsPath });
    }
    toString() {
        return `${this.scheme}://${this.path}`;
    }
    static file(name) {
        return new Uri(name);
    }
    static joinPath(uri, ...names) {
        return new Uri(path.join(uri.path, ...names), uri.scheme);
    }
}

class Position {
    constructor(line, character) {
        Object.assign(this, { line, character });
    }
}

class Range {
    constructor(start, end) {
        Object.assign(this, { start, end });
    }
}

class WorkspaceEdit {
    all = [];
    replace(uri, range, text) {
        this.all.push({ uri, range, text });
    }
}

const changed = emitter(), saved = emitter();
const state = { settings: {}, errors: [], panels: [], documents: new Map(), changed, saved };

// A text in an editor.
state.open = (uri, text) => {
    const document = { uri, text, getText: () => document.text };
    state.documents.set(uri.toString(), document);
    return document;
};

const at = (text, { line, character }) => text.split("\n").slice(0, line).reduce((sum, one) => sum + one.length + 1, character);

const stub = {
    Uri,
    Position,
    Range,
    WorkspaceEdit,
    ViewColumn: { Beside: -2 },
    window: {
        showErrorMessage: (said) => state.errors.push(said),
        createWebviewPanel(kind, title, where, options) {
            const heard = emitter(), gone = emitter(), sent = [];
            const webview = { html: "", onDidReceiveMessage: heard.on, postMessage: async (message) => sent.push(message) };
            const panel = { kind, title, where, options, webview, sent, heard, onDidDispose: gone.on, reveal: () => {}, dispose: gone.tell };
            state.panels.push(panel);
            return panel;
        },
    },
    workspace: {
        fs: { readFile: async (uri) => new Uint8Array(await fs.readFile(uri.fsPath)) },
        getConfiguration: () => ({ get: (name, otherwise) => state.settings[name] ?? otherwise }),
        onDidChangeTextDocument: changed.on,
        onDidSaveTextDocument: saved.on,
        async applyEdit({ all }) {
            for (const { uri, range, text } of all) {
                const document = state.documents.get(uri.toString()), old = document.text;
                document.text = old.slice(0, at(old, range.start)) + text + old.slice(at(old, range.end));
                await changed.tell({ document });
            }
            state.edits = all;
            return true;
        },
    },
};

const load = Module._load;
Module._load = function (name, ...rest) {
    return name === "vscode" ? stub : load.call(this, name, ...rest);
};

exports.state = state;
exports.Uri = Uri;
