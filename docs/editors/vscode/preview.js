// The panel beside a scene. Where the page for browsers is packed beside this file, it shows the text as it is typed; else,
// and where the setting says so, the panel is the page of a `tabray watch` that runs for it, which shows what is saved.

const fs = require("node:fs");
const path = require("node:path");
const { window, workspace, ViewColumn } = require("vscode");
const { follow } = require("./live");
const { watch } = require("./saved");

// The open panels, by the addresses of their scenes.
const panels = new Map();

exports.show = function (document, folder, program) {
    const key = document.uri.toString();
    if (panels.has(key)) return panels.get(key).reveal(undefined, true);
    const page = path.join(folder, "tabray.html");
    const isLive = fs.existsSync(page) && workspace.getConfiguration("tabray").get("preview", "typed") === "typed";
    if (!isLive && document.uri.scheme !== "file") {
        window.showErrorMessage("tabray: save the scene first");
        return;
    }
    const panel = window.createWebviewPanel(
        "tabray.preview",
        `tabray ${path.basename(document.uri.path)}`,
        { viewColumn: ViewColumn.Beside, preserveFocus: true },
        { enableScripts: true, retainContextWhenHidden: true, localResourceRoots: [] },
    );
    panels.set(key, panel);
    const part = isLive ? follow(panel, document, page) : watch(panel, document.uri.fsPath, program);
    panel.onDidDispose(() => {
        panels.delete(key);
        part.dispose();
    });
    return panel;
};
