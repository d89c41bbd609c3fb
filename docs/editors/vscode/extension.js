// Starts `tabray lsp` for scenes, and shows their images in panels beside the text.

const { window, workspace, commands } = require("vscode");
const { LanguageClient } = require("vscode-languageclient/node");
const { show } = require("./preview");

let client;

function program() {
    return workspace.getConfiguration("tabray").get("path", "tabray");
}

exports.activate = function (context) {
    const open = () => {
        const document = window.activeTextEditor?.document;
        return document && show(document, context.extensionPath, program());
    };
    context.subscriptions.push(commands.registerCommand("tabray.watch", open));
    const documentSelector = [{ language: "tabray" }, { language: "toml" }];
    client = new LanguageClient("tabray", "tabray", { command: program(), args: ["lsp"] }, { documentSelector });
    return client.start();
};

exports.deactivate = function () {
    return client?.stop();
};
